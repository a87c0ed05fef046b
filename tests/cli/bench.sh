#!/bin/sh
# bench.sh -- `tyndall bench`: its table, report.json and records, resuming, bands, interruption.
. "$(dirname "$0")/lib.sh"

needs_device

cat >suite.json <<'END'
{ "name": "tiny", "size": [24, 24], "reference_spp": 64, "block": 4, "frames": 2, "timing_seconds": 0.2,
  "max_seconds": 5, "scenes": [ { "name": "cube", "scene": "cube.gltf", "g": 0.5 } ],
  "runs": [ { "method": "pop", "sweep": { "lattice.cells": [8, 16] } }, { "method": "single" } ],
  "baselines": [ { "name": "plain", "method": "path", "settings": { "path.mixture": 0 },
                   "sweep": { "spp": [1, 4, 16] } } ] }
END
works bench --suite suite.json --scenes "$scenes" --report report --quiet
grep -q "^cube, 24x24" out && grep -q "plain *needs for the same error" out || fail "bench: $(cat out)"
ls cache/tyndall/references/*.exr >/dev/null 2>&1 || fail "bench kept no reference"
for key in key name method group seed failed errors.1.rel_l1 \
    errors.0.smape errors.0.bias_se setup_ms frame_ms.cold frame_ms.camera_moved frame_ms.unchanged \
    memory.persistent nodes.0.gpu_ms nodes.0.ceiling imbalance.2 flicker non_finite negative warnings \
    inputs.scene date equal_error.0.ms picture shown; do
    get report/report.json "scenes.0.runs.1.$key" >/dev/null
done
for key in schema version tyndall date suite.hash device.type ceilings.fma_gflops seconds.references \
    scenes.0.size.0 scenes.0.fill scenes.0.reference.spp scenes.0.reference.noise.1.n scenes.0.left_out \
    scenes.0.fronts.0.runs.0 scenes.0.equal_error.0.speedup scenes.0.floors.0.error scenes.0.verdicts.0 \
    headline.0.geometric_mean bands stress; do
    get report/report.json "$key" >/dev/null
done
near "$(get report/report.json scenes.0.runs.1.errors.0.error)" 0.05 0.05 "bench: error of pop"
near "$(get report/report.json scenes.0.runs.2.errors.0.bias)" -0.5 0.4 "bench: bias of single"
near "$(get report/report.json scenes.0.runs.1.imbalance.0)" 0 0.01 "bench: imbalance of pop"
near "$(get report/report.json ceilings.fma_gflops)" 5000 4999.9 "bench: ceiling of multiplications"
[ "$(get report/report.json scenes.0.runs)" = "list 6" ] || fail "bench: not six runs"
[ -s report/pictures/cube/pop-cells-16.exr ] && [ -s report/report.html ] || fail "bench: no picture, no page"
# a record can be cited: it says what was measured, with what, on what
record=report/records/$(get report/report.json scenes.0.runs.1.key).json
for key in tyndall library date device.driver scene.hash reference.seed run/settings/lattice.cells run/all_settings/lattice.cells run.errors.0.error; do
    get "$record" "$key" >/dev/null
done
# a second time nothing is measured: the figures are those of the records, the one that is not there is made
before=$(get report/report.json scenes.0.runs.0.frame_ms.cold)
rm "$record"
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(get report/report.json scenes.0.runs.0.frame_ms.cold)" = "$before" ] || fail "bench: measured again"
[ -s "$record" ] || fail "bench: a missing record was not made anew"
# ... unless it is asked for
touch -d 2000-01-01 report/records/*.json
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 0 ] || fail "bench: measured what there were records of"
works bench --suite suite.json --scenes "$scenes" --report report --fresh --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 6 ] || fail "bench: --fresh did not measure anew"
# a reference of the user's own, and bands
cat >file.json <<'END'
{ "name": "file", "size": [24, 24], "block": 4, "frames": 1, "timing_seconds": 0, "ceilings": false,
  "scenes": [ { "name": "cube", "scene": "cube.gltf", "g": 0.5, "reference": "report/pictures/cube/reference.exr" } ],
  "runs": [ { "method": "pop", "settings": { "lattice.cells": 16 } } ] }
END
bands() { # LOW HIGH
    echo "{ \"bands\": [ { \"scene\": \"*\", \"run\": \"pop\", \"figure\": \"errors.0.bias\",
        \"low\": $1, \"high\": $2, \"reason\": \"a test\" } ] }" >bands.json
}
bands -0.1 0.1
works bench --suite file.json --scenes "$scenes" --bands bands.json --json --quiet
cp out file-report.json
[ "$(get file-report.json scenes.0.reference.method)" = file ] || fail "bench: reference from a file"
[ "$(get file-report.json bands.outside)" = "list 0" ] || fail "bench: bands in the report"
near "$(get file-report.json scenes.0.runs.0.errors.0.error)" \
    "$(get report/report.json scenes.0.runs.1.errors.0.error)" 0.0001 "bench: error against the same picture"
bands 0.5 0.6
run bench --suite file.json --scenes "$scenes" --bands bands.json --quiet
[ "$code" = 1 ] && [ "$(grep -c 'cube: pop: errors.0.bias is .*, outside of 0.5 to 0.6 (a test)' err)" = 1 ] ||
    fail "bench: a band that is left: exit $code, $(cat err)"
# Ctrl-C: what is done is kept
sed 's/\[1, 4, 16\]/[1, 4, 4000000]/; s/"max_seconds": 5/"max_seconds": 80000/' suite.json >long.json
"$tool" bench --suite long.json --scenes "$scenes" --report long --quiet >out 2>err &
process=$!
for i in $(seq 100); do
    [ "$(ls long/records 2>/dev/null | wc -l)" -ge 5 ] && break
    sleep 0.3
done
sleep 0.5
kill -INT $process
code=0
wait $process || code=$?
[ "$code" = 130 ] || fail "bench: interrupted, exit $code: $(cat err)"
[ "$(ls long/records | wc -l)" = 5 ] || fail "bench: interrupted, $(ls long/records | wc -l) records"

finish
