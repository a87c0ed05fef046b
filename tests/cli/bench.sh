#!/bin/sh
# bench.sh -- `tyndall bench`: its table, report.json and records, resuming, bands, interruption.
. "$(dirname "$0")/lib.sh"

needs_device

cat >suite.json <<'END'
{ "name": "tiny", "size": [24, 24], "reference_spp": 64, "block": 4, "frames": 2, "timing_seconds": 0.2, "warm_seconds": 0.1,
  "max_seconds": 5, "scenes": [ { "name": "cube", "scene": "cube.gltf", "g": 0.5 } ],
  "runs": [ { "method": "pop", "sweep": { "lattice.cells": [8, 16] } }, { "method": "single" } ],
  "baselines": [ { "name": "plain", "method": "path", "settings": { "path.guide": 0 },
                   "sweep": { "spp": [1, 4, 16] } } ] }
END
works bench --suite suite.json --scenes "$scenes" --report report --quiet
grep -q "^cube, 24x24" out && grep -q "for the same error plain needs" out || fail "bench: $(cat out)"
ls cache/tyndall/references/*.exr >/dev/null 2>&1 || fail "bench kept no reference"
for key in key name method group seed failed errors.1.rel_l1 \
    errors.0.smape errors.0.bias_se errors.2.error setup_ms frame_ms.animated_light frame_ms.camera_moved frame_ms.unchanged frame_ms.first_picture frame_ms.animated_medium preset \
    memory.persistent nodes.0.gpu_ms nodes.0.ceiling imbalance.2 flicker non_finite negative warnings \
    inputs.scene date equal_error.0.baseline_ms picture shown; do
    get report/report.json "scenes.0.runs.1.$key" >/dev/null
done
for key in schema version tyndall date suite.hash device.type ceilings.fma_gflops seconds.references \
    scenes.0.size.0 scenes.0.fill scenes.0.reference.spp scenes.0.reference.noise.1.n scenes.0.left_out \
    scenes.0.fronts.0.runs.0 scenes.0.equal_error.0.speedup scenes.0.floors.0.error scenes.0.verdicts.0 \
    headline.0.geometric_mean headline.0.frame presets bands stress scenes.0.times.camera_moved.promise \
    scenes.0.reference.stored; do
    get report/report.json "$key" >/dev/null
done
near "$(get report/report.json scenes.0.runs.1.errors.0.error)" 0.05 0.05 "bench: error of pop"
near "$(get report/report.json scenes.0.runs.2.errors.0.bias)" -0.5 0.4 "bench: bias of single"
# what it says of its runs follows from them
python3 "$(dirname "$0")/recompute.py" report/report.json >computed || fail "bench: $(cat computed)"
# flip is that of compare, up to the half floats of the picture
for i in 1 2; do
    works compare "report/$(get report/report.json scenes.0.runs.$i.picture)" report/pictures/cube/reference.exr
    near "$(get report/report.json scenes.0.runs.$i.errors.2.error)" "$(value flip)" 1e-4 "bench: flip of run $i"
    awk -v f="$(value flip)" 'BEGIN { exit !(f > 0.001 && f < 1) }' || fail "bench: flip of run $i is $(value flip)"
done
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
before=$(get report/report.json scenes.0.runs.0.frame_ms.animated_light)
rm "$record"
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(get report/report.json scenes.0.runs.0.frame_ms.animated_light)" = "$before" ] || fail "bench: measured again"
[ -s "$record" ] || fail "bench: a missing record was not made anew"
# ... unless it is asked for
touch -d 2000-01-01 report/records/*.json
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 0 ] || fail "bench: measured what there were records of"
works bench --suite suite.json --scenes "$scenes" --report report --fresh --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 6 ] || fail "bench: --fresh did not measure anew"
# figures say how many frames they are medians of
[ "$(get report/report.json scenes.0.runs.0.frames.animated_light)" -ge 1 ] || fail "bench: no number of frames"
# records that are cut, and pictures that are gone, are made anew; what the suite says of a run is the suite's
key() { # INDEX: of the run
    get report/report.json "scenes.0.runs.$1.key"
}
single=report/records/$(key 2).json pop=report/records/$(key 0).json plain=report/records/$(key 3).json
record() { # INDEX
    echo "report/records/$(key "$1").json"
}
echo "{\"version\": 1, \"key\": \"$(key 2)\"}" >"$single"
sed 's/"rel_l1"/"rel"/' "$pop" >cut && mv cut "$pop"
sed 's/"baseline":\t*true/"baseline": false/; s/"swept":\t*true/"swept": false/' "$plain" >stale && mv stale "$plain"
rm report/pictures/cube/pop-cells-16.exr
touch -d 2000-01-01 report/records/*.json
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 3 ] || fail "bench: not three of the records made anew"
[ -s report/pictures/cube/pop-cells-16.exr ] || fail "bench: a picture that is gone was not made"
[ "$(get report/report.json scenes.0.runs)" = "list 6" ] || fail "bench: a run is lost"
[ "$(get report/report.json scenes.0.runs.3.baseline)" = true ] || fail "bench: a record overrules the suite"
# ... so is a figure that is cut out, a list of nodes, a damaged picture, an empty one
sed 's/"error":/"err":/' "$pop" >cut && mv cut "$pop"
sed 's/"flicker":/"flick":/' "$(record 1)" >cut && mv cut "$(record 1)"
sed 's/"ceiling":/"ceil":/' "$single" >cut && mv cut "$single"
: >report/pictures/cube/plain-1-spp.exr
head -c 300 report/pictures/cube/plain-4-spp.exr >cut && mv cut report/pictures/cube/plain-4-spp.exr
touch -d 2000-01-01 report/records/*.json
works bench --suite suite.json --scenes "$scenes" --report report --quiet
[ "$(find report/records -name '*.json' -newer suite.json | wc -l)" = 5 ] || fail "bench: not five of the records made anew"
[ "$(wc -c <report/pictures/cube/plain-1-spp.exr)" -gt 300 ] || fail "bench: an empty picture was not made anew"
# a picture of which some values are not finite has no error, and is on no front
TYN_PLANT=nan "$helpers/tyndall_planted" bench --suite suite.json --scenes "$scenes" --report spoiled >out 2>err ||
    fail "bench: a picture with a NaN: $(cat err)"
grep -q "pop, cells 8: 1 values of the picture are not finite" err || fail "bench: nothing is said of a NaN: $(cat err)"
[ "$(get spoiled/report.json scenes.0.runs.1.errors.0.error)" = null ] || fail "bench: an error of a picture with a NaN"
[ "$(get spoiled/report.json scenes.0.runs.1.errors.2.error)" = null ] || fail "bench: flip of a picture with a NaN"
for front in 0 1; do
    for i in 0 1 2 3; do
        case "$("$helpers/json_get" spoiled/report.json "scenes.0.fronts.$front.runs.$i" 2>/dev/null)" in
        "$(get spoiled/report.json scenes.0.runs.0.key)" | "$(get spoiled/report.json scenes.0.runs.1.key)")
            fail "bench: a picture with a NaN is on a front" ;;
        esac
    done
done
# records without the device's ceilings are not those with them; a cache that cannot be written is said
sed 's/"frames"/"ceilings": false, "frames"/; s/"cells": \[8, 16\]/"cells": 8/' suite.json >without.json
sed 's/"ceilings": false/"ceilings": true/' without.json >with.json
: >no-cache
for suite in without with; do
    XDG_CACHE_HOME="$work/no-cache" run bench --suite $suite.json --scenes "$scenes" --report ceilings
    grep -q "no-cache/tyndall/references/.*: cannot be written; the reference is rendered again" err ||
        fail "bench: a reference is not kept: $(cat err)"
done
[ "$(get ceilings/report.json scenes.0.runs.1.nodes.0.ceiling)" != null ] || fail "bench: a node without a ceiling"
# names that look alike as files, none of which is the reference; samples in whatever order; files beside the suite
mkdir beside && "$helpers/exr_make" beside/map.exr 4 2 R=1 G=1 B=1
cat >beside/names.json <<'END'
{ "name": "names", "size": [16, 16], "reference_spp": 4, "block": 4, "frames": 1, "timing_seconds": 0, "ceilings": false,
  "max_seconds": 0.5, "scenes": [ { "name": "雲", "scene": "cube.gltf", "environment": "map.exr" } ],
  "runs": [ { "name": "reference", "method": "single" }, { "name": "a b", "method": "single" },
            { "name": "a-b", "method": "single" } ],
  "baselines": [ { "sweep": { "spp": [4000000, 1, 4] } } ] }
END
works bench --suite beside/names.json --scenes "$scenes" --report new/deep/names --quiet
mv new/deep/names names
for file in reference reference-2 a-b a-b-2 path-1-spp; do
    [ -s "names/pictures/scene/$file.exr" ] || fail "bench: no picture $file: $(ls names/pictures/*)"
done
cmp -s names/pictures/scene/reference.exr names/pictures/scene/reference-2.exr && fail "bench: a run is the reference"
[ "$(get names/report.json scenes.0.left_out)" = "list 1" ] || fail "bench: max_seconds depends on the order"
[ "$(get names/report.json scenes.0.runs.3.name)" = "path, 1 spp" ] || fail "bench: runs are not in the order of the suite"
# references that are stored with the suite: made once, to a noise, gone on with, taken as they are, told from others
cat >stored.json <<'END'
{ "name": "stored", "size": [16, 16], "references": "refs", "reference_noise": 0.2, "block": 4, "frames": 1, "timing_seconds": 0,
  "ceilings": false, "scenes": [ { "name": "cube", "scene": "cube.gltf" } ], "runs": [ { "method": "single" } ] }
END
samples() {
    sed -n 's/^cube, 16x16: \([0-9]*\) samples .*/\1/p' out
}
works bench --suite stored.json --scenes "$scenes" --references --quiet
coarse=$(samples)
works bench --suite stored.json --scenes "$scenes" --references --quiet
[ "$(samples)" = "$coarse" ] || fail "bench: a reference that is good enough was gone on with"
sed 's/0.2/0.05/' stored.json >finer.json
rm -r cache/tyndall/references
works bench --suite finer.json --scenes "$scenes" --references --quiet
[ "$(samples)" -gt $((8 * coarse)) ] || fail "bench: $(samples) samples for a fourth of the noise of $coarse"
awk '{ for (i = 1; i < NF; i++) if ($i == "noise") exit !($(i + 1) > 3 && $(i + 1) <= 5) }' out || fail "bench: noise: $(cat out)"
rm -rf cache/tyndall/references
works bench --suite stored.json --scenes "$scenes" --report stored --quiet
[ "$(get stored/report.json scenes.0.reference.stored)" = true ] && ! ls cache/tyndall/references/*.exr >/dev/null 2>&1 ||
    fail "bench: a stored reference was not taken"
sed 's/"cube.gltf"/"cube.gltf", "g": 0.3/' stored.json >other.json
run bench --suite other.json --scenes "$scenes" --report of-another
grep -q "refs/cube-16x16.exr: is of another scene, view or size: rendered anew" err || fail "bench: a reference of another scene: $(cat err)"
[ "$(get of-another/report.json scenes.0.reference.stored)" = false ] || fail "bench: a reference of another scene was taken"
refuses 2 "needs a suite that names their folder" bench --suite suite.json --scenes "$scenes" --references
# a reference of the user's own, and bands
cat >file.json <<'END'
{ "name": "file", "size": [24, 24], "block": 4, "frames": 1, "timing_seconds": 0, "ceilings": false,
  "scenes": [ { "name": "cube", "scene": "cube.gltf", "g": 0.5, "reference": "report/pictures/cube/reference.exr" } ],
  "runs": [ { "method": "pop", "settings": { "lattice.cells": 16 } } ] }
END
# ... which must be one
refuses_reference() { # WORDS CHANNELS
    words=$1
    shift
    "$helpers/exr_make" wrong.exr 24 24 "$@"
    sed 's/report.pictures.cube.reference/wrong/' file.json >wrong.json
    refuses 2 "wrong.exr: $words" bench --suite wrong.json --scenes "$scenes" --quiet
}
refuses_reference "R is nan at pixel (1, 0)" R=1,nan,1 G=1 B=1
refuses_reference "G is inf at pixel (0, 0)" R=1 G=inf B=1
refuses_reference "R, G and B sum to 0" R=0 G=0 B=0
refuses_reference "error.B is inf at pixel (0, 0)" R=1 G=1 B=1 error.R=0 error.G=0 error.B=inf
refuses_reference "error.R is -1 at pixel (2, 0)" R=1 G=1 B=1 error.R=0,0,-1 error.G=0 error.B=0
"$helpers/exr_make" wrong.exr 24 24 R=-0.1,1 G=1 B=1 # what a filter leaves
works bench --suite wrong.json --scenes "$scenes" --quiet
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
# peers: in the runs of a scene and beside the baselines, on no front though nothing is as fast and as good
peers() { # HASH
    cat >peers.json <<END
{ "schema": "tyndall-peer", "version": 1, "name": "Other 1.0", "group": "other", "date": "2026-11-22T00:00:00Z",
  "scenes": [ { "name": "cube", "reference": { "hash": "$1" }, "mean": { "bias": 0.01, "se": 0.02 }, "runs": [
    { "spp": 1, "ms": 0.002, "renderings": 3, "errors": [ { "block": 4, "rel_l1": 0.2 }, { "block": 1, "rel_l1": 0.8 }, { "block": 0, "error": 0 } ] },
    { "spp": 4, "ms": 0.008, "errors": [ { "block": 4, "rel_l1": 0.1 }, { "block": 1, "rel_l1": 0.4 }, { "block": 0, "error": 0 } ] } ] } ] }
END
}
sed 's/"block": 4/"peers": ["peers.json"], "block": 4/; s/ } } \] }$/ } } ], "baselines": [ { "sweep": { "spp": [1, 4] } } ] }/' file.json >peer-suite.json
peers "$(get file-report.json scenes.0.reference.key)"
works bench --suite peer-suite.json --scenes "$scenes" --report peer --quiet
grep -q "^  to 10 % on 4 px, Other 1.0 0.0[0-9]* ms, path .* ms, pop " out || fail "bench: no times of a peer: $(cat out)"
[ "$(get peer/report.json scenes.0.runs)" = "list 5" ] && [ "$(get peer/report.json scenes.0.runs.4.name)" = "Other 1.0, 4 spp" ] ||
    fail "bench: the runs of a peer are not in a scene"
for is in "runs.4.peer true" "runs.4.baseline false" "runs.4.sampling true" "runs.4.key null" "runs.4.frame_ms.animated_light 0.008" \
    "runs.3.frames.animated_light 3" "runs.4.frame_ms.camera_moved null" "runs.4.errors.2.block 0" "peers.0.name Other" "peers.0.mean.se 0.02" \
    "peers.0.equal_error.0.error 0.1" "peers.0.equal_error.0.measured true" "peers.0.equal_error.0.baseline path" "peers.0.equal_error.0.method pop"; do
    [ "$(get peer/report.json "scenes.0.${is% *}" | cut -d ' ' -f 1)" = "${is#* }" ] || fail "bench: a peer: $is: $(get peer/report.json "scenes.0.${is% *}")"
done
near "$(get peer/report.json scenes.0.peers.0.equal_error.0.ms)" 0.007 0.001 "bench: a peer's time to 10 %"
python3 "$(dirname "$0")/recompute.py" peer/report.json >computed || fail "bench: beside a peer: $(cat computed)"
grep -q '"other"' peer/report.json || fail "bench: no group of a peer"
for list in fronts.0.runs fronts.1.runs fronts.2.runs floors ranges equal_error; do
    count=$(get peer/report.json "scenes.0.$list") i=0
    while [ $i -lt "${count#list }" ]; do
        case $(get peer/report.json "scenes.0.$list.$i")$("$helpers/json_get" peer/report.json "scenes.0.$list.$i.method" 2>/dev/null) in
        "" | null | *other) fail "bench: a peer is in $list" ;;
        esac
        i=$((i + 1))
    done
done
# ... of another reference they are left out, and what is none is refused
peers 0123456789abcdef
run bench --suite peer-suite.json --scenes "$scenes" --report peer
grep -q "peers.json: 'cube' is measured against another reference, and left out" err || fail "bench: a peer of another reference: $(cat err)"
[ "$(get peer/report.json scenes.0.runs) $(get peer/report.json scenes.0.peers)" = "list 3 list 0" ] || fail "bench: a peer of another reference was taken"
absent() { # INDEX SCENE WHY
    [ "$(get peer/report.json "peers_left_out.$1.name"), $(get peer/report.json "peers_left_out.$1.scene"): $(get peer/report.json "peers_left_out.$1.why")" = "Other 1.0, $2: $3" ] ||
        fail "bench: $2 of a peer is not said to be left out"
    grep -q "^Other 1.0, $2: left out: $3" out || fail "bench: $2 of a peer is left out without a word: $(cat out)"
}
absent 0 cube "measured against another reference"
# ... as is a scene that the suite lacks; the error of a picture that is not finite nobody knows
peers "$(get file-report.json scenes.0.reference.key)"
sed 's/"rel_l1": 0.1 }/"rel_l1": 0.1, "nan": 2 }/; s/"scenes": \[/"scenes": [ { "name": "no cube", "reference": { "hash": "0" }, "runs": [ { "spp": 1, "ms": 1, "errors": [ { "block": 4, "rel_l1": 1 }, { "block": 1, "rel_l1": 1 }, { "block": 0, "error": 1 } ] } ] },/' peers.json >wrong && mv wrong peers.json
run bench --suite peer-suite.json --scenes "$scenes" --report peer
grep -q "peers.json: the suite has no scene 'no cube', which is left out" err || fail "bench: a peer's scene that is none: $(cat err)"
absent 0 "no cube" "no scene of the suite"
for i in 0 1 2; do
    [ "$(get peer/report.json scenes.0.runs.4.errors.$i.error)" = null ] || fail "bench: a peer's picture that is not finite has an error"
done
[ "$(get peer/report.json scenes.0.runs.3.errors.0.error)" != null ] || fail "bench: and so has none of its others"
python3 "$(dirname "$0")/recompute.py" peer/report.json >computed || fail "bench: beside a peer that is not finite: $(cat computed)"
refuses_peers() { # WORDS SED
    peers 0
    sed "$2" peers.json >wrong && mv wrong peers.json
    refuses 2 "peers.json: $1" bench --suite peer-suite.json --scenes "$scenes" --quiet
}
refuses_peers "is not a tyndall-peer of version 1" 's/"version": 1/"version": 2/'
refuses_peers "is not a tyndall-peer of version 1" 's/tyndall-peer/tyndall-report/'
refuses_peers "group: is that of a run or of another peer" 's/"other"/"pop"/'
refuses_peers "scenes[0].runs[1]: needs" 's/"ms": 0.008/"ms": 0/'
refuses_peers "scenes[0].runs[0].errors: must be over the blocks" 's/"block": 4/"block": 8/'
refuses_peers "scenes[0].runs[0].errors: the first two need" 's/"rel_l1": 0.8/"rel_l1": null/'
rm peers.json
refuses 2 "peers: 'peers.json' is neither beside the suite nor in" bench --suite peer-suite.json --scenes "$scenes" --quiet
sed 's/\["peers.json"\]/"peers.json"/' peer-suite.json >wrong.json
refuses 2 "peers: must be a list of up to 8 names of files" bench --suite wrong.json --scenes "$scenes" --quiet
bands 0.5 0.6
run bench --suite file.json --scenes "$scenes" --bands bands.json --quiet
[ "$code" = 1 ] && [ "$(grep -c 'cube: pop: errors.0.bias is .*, outside of 0.5 to 0.6 (a test)' err)" = 1 ] ||
    fail "bench: a band that is left: exit $code, $(cat err)"
# the stress suite in parts: cells of the same build are kept, others are not
run bench --stress --quick --axis "scale, lamp" --report parts --quiet
first=$(get parts/stress.json cells)
run bench --stress --quick --axis "storage, half" --report parts --quiet
cells=$(get parts/stress.json cells) expected=$(get parts/stress.json expected)
[ "${first#list }" -gt 0 ] && [ "${cells#list }" -gt "${first#list }" ] || fail "stress: $first cells, then $cells"
[ "$expected" -gt "${cells#list }" ] || fail "stress: $cells of $expected: a part is not told from the whole"
[ "$(get parts/stress.json schema) $(get parts/stress.json version) $(get parts/stress.json quick)" = "tyndall-stress 1 true" ] ||
    fail "stress: no schema"
sed 's/"library":[^,]*,/"library": "0123456789abcdef",/' parts/stress.json >other && mv other parts/stress.json
run bench --suite file.json --scenes "$scenes" --report parts
grep -q "parts/stress.json is not of this build" err || fail "stress of another build is not refused: $(cat err)"
[ "$(get parts/report.json stress)" = null ] || fail "stress of another build in a report"
run bench --stress --quick --axis "scale, lamp" --report parts --quiet
[ "$(get parts/stress.json cells)" = "$first" ] || fail "stress: cells of two builds in one file"
[ "$(get parts/report.json stress.cells)" = "$first" ] || fail "stress: not in the report that is there"
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
