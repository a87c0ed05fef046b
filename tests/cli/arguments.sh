#!/bin/sh
# arguments.sh -- what the tool says to wrong arguments and inputs, help, compare, info. No GPU.
. "$(dirname "$0")/lib.sh"

# ---- the command line ----
run
[ "$code" = 2 ] || fail "without a command: exit $code"
refuses 2 "unknown command 'paint'; 'tyndall --help'" paint
refuses 2 "unknown command 'rendr'; did you mean 'render'?" rendr
refuses 2 "unknown command 'comapre'; did you mean 'compare'?" comapre
refuses 2 "unknown option '--exposrue'; did you mean --exposure?" render --exposrue=3
refuses 2 "unknown command 'paint'" help paint
works help
works help render
grep -q "usage: tyndall render" out || fail "help render: $(head -1 out)"
works --help
grep -q "selftest" out || fail "--help lists no selftest"
works --version
grep -qE '^tyndall [0-9]+\.[0-9]+\.[0-9]+$' out || fail "--version: $(cat out)"
for command in render compare probe balance fluxes bench graph info merge selftest; do
    works $command --help
    grep -q "usage: tyndall $command" out || fail "$command --help: $(head -1 out)"
    refuses 2 "unknown option '--paint'" $command --paint
done
works --help-markdown
cmp -s out "$source/docs/cli.md" ||
    fail "docs/cli.md is not what 'tyndall --help-markdown' prints: make it again"
refuses 2 "--completion: must be bash, zsh or fish" --completion tcsh
refuses 2 "unknown command '--man'" --man paint

# ---- options ----
refuses 2 "SCENE is missing" render
refuses 2 "one argument too many" render a.gltf b.hdr c
refuses 2 "--size: '640' is not" render a.gltf --size 640
refuses 2 "--size: '0x5' is not" render a.gltf --size 0x5
refuses 2 "--size: '640x99999' is not" render a.gltf --size 640x99999
refuses 2 "--sigma-s: '1,2' is not three numbers" render a.gltf --sigma-s 1,2
refuses 2 "--look-at: '1' is not three numbers" render a.gltf --look-at 1
refuses 2 "--spp: '0' is not" render a.gltf --spp 0
refuses 2 "--spp: '-1' is not" render a.gltf --spp -1
refuses 2 "--spp: '1.5' is not" render a.gltf --spp 1.5
refuses 2 "--fov: '180' is not" render a.gltf --fov=180
refuses 2 "--fov: 'nan' is not" render a.gltf --fov nan
refuses 2 "--refine: '0' is no number of samples a pixel" render a.gltf --refine 0
refuses 2 "--refine: '1/0' is no number" render a.gltf --refine 1/0
refuses 2 "--refine: 'two' is no number" render a.gltf --refine two
refuses 2 "--refine: '1/1000' is no number" render a.gltf --refine 1/1000
refuses 2 "--refine and --method single: only pop is refined" render a.gltf --refine 2 --method single
refuses 2 "--refine 2 and --spp 3" render a.gltf --refine 2 --spp 3
refuses 2 "--refine 2: --max-error and --budget-ms choose the samples" render a.gltf --refine 2 --max-error 5%
refuses 2 "--until: '2' is neither" render a.gltf --until 2
refuses 2 "--until: 'soon' is neither" render a.gltf --until soon
refuses 2 "--until 1%: method 'pop' does not say how far it is off" render a.gltf --until 1% --method pop
refuses 2 "--until 1% goes with none of" render a.gltf --until 1% --resume -o a.exr --method path
refuses 2 "--spp needs a value" render a.gltf --spp
refuses 2 "--quiet takes no value" render a.gltf --quiet=1
refuses 2 "--quality: 'best' is not one of: draft, normal, high" render a.gltf --quality best
refuses 2 "--change: 'all' is not one of: none, camera, light, sky" render a.gltf --change all
refuses 2 "--exposure: 'bright' is neither a number from -64 to 64 nor 'auto'" render a.gltf --exposure bright
refuses 2 "--exposure: '65' is neither" render a.gltf --exposure 65
refuses 2 "--tonemap: 'reinhard' is not one of: filmic, linear" render a.gltf --tonemap reinhard
refuses 2 "--light-units: 'lumens' is not one of: radiometric, photometric" info a.gltf --light-units lumens
refuses 2 "--change needs --frames" render a.gltf --change none
refuses 2 "--frames: '5-1' is neither" render a.gltf --frames 5-1
refuses 2 "--frames: '0' is neither" render a.gltf --frames 0
refuses 2 "holds no %04d" render a.gltf --frames 1-5 -o a.png
refuses 2 "neither .exr nor .png" render a.gltf -o a.tif
refuses 2 "no layer 'paint'" render a.gltf -o a.exr --aov depth,paint
refuses 2 "no layer 'low'" render a.gltf -o a.exr --aov low
refuses 2 "method 'pop' does not take samples" render a.gltf -o a.exr --resume
refuses 2 "--resume needs an .exr" render a.gltf -o a.png --resume --method path
refuses 2 "--time: 'noon' is not a number" render a.gltf --time noon
refuses 2 "need an .exr" render a.gltf -o a.png --aov depth
refuses 1 "is not there" render a.gltf -o nowhere/a.png
refuses 1 "is not there" render a.gltf -o a.png --stats nowhere/a.json
refuses 1 "is not there" graph "$scenes/cube.gltf" --view beam -o nowhere/a.png
printf 'x,y,z\n0,0,0\n' >origin.csv
refuses 1 "is not there" probe "$scenes/cube.gltf" --points origin.csv -o nowhere/a.csv
refuses 2 "no method 'magic'; there are: " render a.gltf --method magic
refuses 2 "'lattice' is not PASS.PARAM=VALUE" render a.gltf -D lattice
refuses 2 "'single' cannot do that yet; these can: pop" balance "$scenes/cube.gltf" --method single
refuses 2 "--points is missing" probe "$scenes/cube.gltf"
refuses 2 "--view PASS and -o FILE.png go together" graph "$scenes/cube.gltf" --view beam
refuses 2 "one of SCENE, --devices, --passes, --methods" info
refuses 2 "one of SCENE, --devices, --passes, --methods" info --passes --methods
refuses 2 "magic" render a.gltf -D magic.power=3
refuses 2 "lattice" render a.gltf -D lattice.power=3
refuses 2 "cells" render a.gltf -D lattice.cells=many
refuses 2 "cells" render a.gltf -D lattice.cells=-5
refuses 2 "setting 'path.threads' is '1'; it must be 0 or a whole number from 256 to 1048576" render a.gltf -m path -D path.threads=1

# ---- inputs ----
refuses 2 "nothere.gltf" info nothere.gltf
refuses 2 "nothere.gltf" render nothere.gltf
refuses 2 "nothere.exr" render "$scenes/cube.gltf" nothere.exr
refuses 2 "given twice" render "$scenes/cube.gltf" a.exr --env b.exr
echo "{" >broken.gltf
refuses 2 "broken.gltf" render broken.gltf
refuses 2 "no camera 'north'" render "$scenes/cube.gltf" --camera north
refuses 2 "no camera '99'" render "$scenes/cube.gltf" --camera 99
refuses 2 "orthographic" render "$scenes/cube.gltf" --camera side --fov 40
refuses 2 "do not give a direction" render "$scenes/cube.gltf" --look-from 1,1,1 --look-at 1,1,1
refuses 2 "sigma" render "$scenes/cube.gltf" --sigma-s=-1
refuses 2 "albedo" render "$scenes/cube.gltf" --albedo 1.5
refuses 2 "g" render "$scenes/cube.gltf" --g 1
refuses 2 "nothere.csv" probe "$scenes/cube.gltf" --points nothere.csv
printf 'x,y,z\n' >empty.csv
refuses 2 "holds no points" probe "$scenes/cube.gltf" --points empty.csv
printf 'x,y,z\n0,0,0\n1,2\n' >short.csv
refuses 2 "short.csv:3: '1,2' is not x,y,z" probe "$scenes/cube.gltf" --points short.csv

# ---- a machine without a driver ----
export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
for command in "render $scenes/cube.gltf -o a.png" "info --devices" selftest; do
    # shellcheck disable=SC2086
    refuses 1 "no Vulkan driver: install that of the graphics card, or Mesa's software device" $command
done
unset VK_DRIVER_FILES VK_ICD_FILENAMES

# ---- suites of the bench ----
refuses 2 "nothere.json" bench --suite nothere.json
printf '{\n"name": "x",\n"scenes" [] }\n' >broken.json
refuses 2 "broken.json:3: is not JSON" bench --suite broken.json
# Suites of the project are read before the bands are looked for.
for suite in "$source"/tools/bench/suites/*.json; do
    refuses 2 "nothere.json" bench --suite "$suite" --scenes "$scenes" --bands nothere.json
done
# MESSAGE JSON: a suite
bad_suite() {
    echo "$2" >suite.json
    refuses 2 "$1" bench --suite suite.json --scenes "$scenes"
}
# MESSAGE RUNS: of a suite of one scene
bad_runs() {
    bad_suite "$1" "{\"name\": \"x\", \"scenes\": [{\"scene\": \"cube.gltf\"}], \"runs\": [$2]}"
}
# MESSAGE SCENE RUN: of a suite with a scene and a run before, all of which is tried before anything is measured
bad_scene() {
    bad_suite "$1" "{\"name\": \"x\", \"scenes\": [{\"name\": \"first\", \"scene\": \"cube.gltf\"}, $2],
        \"runs\": [{\"only\": [\"first\"]}${3+, $3}]}"
}
bad_suite "scenes[0].fog: is not a known key" '{"name": "x", "scenes": [{"scene": "cube.gltf", "fog": 1}], "runs": [{}]}'
bad_suite "'nothere.gltf' is neither" '{"name": "x", "scenes": [{"scene": "nothere.gltf"}], "runs": [{}]}'
bad_suite "ratios[0].to: must be the name of a scene" '{"name": "x", "scenes": [{"scene": "cube.gltf"}], "runs": [{}],
    "ratios": [{"name": "r", "of": "cube.gltf", "to": "other"}]}'
bad_suite "scenes[0].reference: 'nothere.exr' is neither" \
    '{"name": "x", "scenes": [{"scene": "cube.gltf", "reference": "nothere.exr"}], "runs": [{}]}'
bad_suite "baselines[0] 'pop, 1 spp': method 'pop' does not sample" \
    '{"name": "x", "scenes": [{"scene": "cube.gltf"}], "runs": [{}], "baselines": [{"method": "pop"}]}'
bad_suite "block: must be a number from 2" \
    '{"name": "x", "block": 1, "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}'
bad_suite "suite.json: must be an object" '[]'
bad_runs "runs: must be a list" ''
bad_runs "a.b" '{"settings": {"a.b": 1}}'
bad_runs "runs[0].settings.lattice.cells: is there twice" '{"settings": {"lattice.cells": 8, "lattice.cells": 16}}'
bad_runs "runs[0].sweep.lattice.cells: must be a list of values, one at least" '{"sweep": {"lattice.cells": 8}}'
bad_runs "runs[0].sweep: must hold up to 4 lists" '{"sweep": {"a.a": [1], "a.b": [1], "a.c": [1], "a.d": [1], "a.e": [1]}}'
bad_runs "runs[0].sweep.lattice.cells: 299 values give more than 256 runs" "{\"sweep\": {\"lattice.cells\": [$(seq -s , 299)]}}"
# the fault's place, in the suite's words
bad_runs "suite.json: runs[0] 'nope': method: there is no method 'nope'" '{"method": "nope"}'
bad_runs "suite.json: runs[1] 'b': setting 'raymarch.stepp'" '{}, {"name": "b", "settings": {"raymarch.stepp": 1}}'
bad_runs "suite.json: runs[0] 'pop': settings: 'raymarch.step=' is not" '{"settings": {"raymarch.step": ""}}'
# what would do nothing, and lines of two kinds of runs
bad_runs "runs[0] 'pop': spp: method 'pop' does not sample" '{"spp": 16}'
bad_runs "runs[0] 'pop, 1 spp': spp: method 'pop' does not sample" '{"sweep": {"spp": [1, 4]}}'
bad_runs "runs[0] 'single': seed: method 'single' does not sample" '{"method": "single", "seed": 3}'
bad_runs "suite.json: group 'pop': 'path' samples and 'pop' does not" '{}, {"method": "path", "group": "pop"}'
bad_runs "runs[0].spp: must be a number from 1" '{"sweep": {"spp": [1, 0]}, "method": "path"}'
bad_runs "runs[0].spp: must be a whole number" '{"method": "path", "spp": 1.5}'
bad_runs "'path': seed 1000003: those from 1000003 on are of references" '{"method": "path", "seed": 1000003}'
bad_runs "lattice.cells" '{"sweep": {"lattice.cells": [8, 1e9]}}'
bad_runs "only: must be a list of names of scenes" '{"only": ["fog"]}'
bad_runs "only: must be a list of names of scenes of this suite, one at least" '{"only": []}'
bad_runs "runs: two have the name 'pop'" '{}, {"settings": {"lattice.cells": 8}}'
bad_runs "gives more than 256 runs" '{"sweep": {"lattice.cells": [8, 12, 16, 20], "raymarch.step": [0.1, 0.2, 0.3, 0.4],
    "ordinates.count": [4, 8, 16, 32], "lattice.sweeps": [1, 2, 3, 4, 5]}}'
bad_scene "scenes[1]: no run is for it" '{"scene": "cube.gltf"}'
all='{"name": "all"}'
bad_scene "scenes[1].size: must be [width, height], whole numbers" '{"scene": "cube.gltf", "size": [16.7, 16]}' "$all"
bad_suite "suite.json: size: must be [width, height]" \
    '{"name": "x", "size": [0, 64], "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}'
bad_suite "suite.json: reference_spp: must be a number from 2 to 16777216" \
    '{"name": "x", "reference_spp": 1, "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}'
bad_scene "suite.json: scenes[1] 'deep': sigma_s = inf" '{"name": "deep", "scene": "cube.gltf", "sigma_s": 1e39}' "$all"
bad_scene "scenes[1] 'cube.gltf': fov: the camera is orthographic" '{"scene": "cube.gltf", "camera": "side", "fov": 40}' "$all"
bad_scene "scenes[1] 'cube.gltf': camera: there is no camera 'nope'" '{"scene": "cube.gltf", "camera": "nope"}' "$all"
bad_scene "g" '{"scene": "cube.gltf", "g": 2}' "$all"
bad_scene "scenes[1].environment: 'nothere.hdr' is neither beside the suite" \
    '{"scene": "cube.gltf", "environment": "nothere.hdr"}' "$all"
# text that is not one JSON value in UTF-8
printf '{"name": "x", "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}\n\n}\n' >after.json
refuses 2 "after.json:3: is not JSON" bench --suite after.json --scenes "$scenes"
printf '{"name":\n "caf\351", "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}\n' >latin.json
refuses 2 "latin.json:2: is not UTF-8" bench --suite latin.json --scenes "$scenes"
# options that would do nothing
echo '{"name": "x", "block": 4, "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}' >block.json
refuses 2 "--suite goes with no --stress" bench --stress --axis nosuch --suite nothere.json --bands nothere.json
refuses 2 "--axis: no axis has 'nosuch'" bench --stress --axis nosuch
refuses 2 "--quick needs --stress" bench --quick --suite block.json
refuses 2 "--methods: 'nosuch' is no method" bench --stress --methods pop,nosuch
refuses 2 "--methods needs --stress" bench --methods pop --suite block.json
refuses 2 "--axis needs --stress" bench --axis sigma --suite block.json
refuses 2 "--fresh needs --report" bench --fresh --suite block.json
refuses 2 "--write-fronts needs a suite whose \"block\" is 8, not 4" \
    bench --suite block.json --scenes "$scenes" --write-fronts f.json
refuses 2 "--write-fronts goes with no --references" bench --references --suite block.json --write-fronts f.json
for bands in '{}' '{"bands": [{}]}' '{"bands": [{"scene": "*", "run": "*", "figure": "f", "reason": "r", "low": 1, "high": 0}]}' \
    '{"bands": [{"scene": "*", "run": "*", "figure": "f", "reason": "r", "low": 0, "high": 1, "hi": 2}]}'; do
    echo "$bands" >bands.json
    refuses 2 "bands.json: " bench --bands bands.json --scenes "$scenes"
done
band='"scene": "*", "run": "*", "figure": "f", "reason": "r", "low": 0, "high": 1'
printf '{"bands": [{%s}]}\n}\n' "$band" >bands.json
refuses 2 "bands.json:2: is not JSON" bench --bands bands.json --scenes "$scenes"
echo "{\"bands\": [{$band, \"low\": 1}]}" >bands.json
refuses 2 "bands.json: bands[0].low: is there twice" bench --bands bands.json --scenes "$scenes"
# outputs are tried before anything is measured, and nothing is lost by that
echo '{"name": "x", "scenes": [{"scene": "cube.gltf"}], "runs": [{}]}' >suite.json
refuses 1 "nowhere/f.json: cannot be written: the folder 'nowhere' is not there" \
    bench --suite suite.json --scenes "$scenes" --report new/deep/report --write-fronts nowhere/f.json
[ -d new/deep/report ] || fail "bench: the folder of --report was not made with those above it"
refuses 1 "new: cannot be written: it is a folder" bench --suite suite.json --scenes "$scenes" --write-fronts new
for what in "--suite suite.json" --stress; do
    # shellcheck disable=SC2086
    refuses 1 "--report: the folder 'suite.json/report' cannot be made: Not a directory" \
        bench $what --report suite.json/report
done

# ---- info ----
works info "$scenes/smoke.gltf"
grep -q "96x160x96 voxels" out || fail "info smoke: $(cat out)"
grep -q "camera 0 'view'" out || fail "info smoke: no camera"
works info "$scenes/cube.gltf" --sigma-s 1,2,3 --albedo 0.5
grep -q "absorption *0.5 1 1.5 1/m" out || fail "info with overrides: $(grep absorption out)"
# units of lights: by the generator, or by the option
light() { # WHAT ARGUMENTS: info shows this light
    light=$1
    shift
    works info "$@"
    grep -q "directional, $light W/m^2" out || fail "info $*: not '$light': $(grep light out)"
}
unsigned=$(sed 's/, "generator": "tyndall-scenes"//' "$scenes/cube.gltf")
echo "$unsigned" >unsigned.gltf
grep -q generator unsigned.gltf && fail "cube.gltf has its generator still"
sed 's/"tyndall-scenes"/"Khronos glTF Blender I\/O v3.4.50"/' "$scenes/cube.gltf" >blender.gltf
power=$("$tool" info "$scenes/cube.gltf" | sed -n 's/.*directional, \([0-9.]*\) .*/\1/p')
less=$(awk -v p="$power" 'BEGIN { printf "%.6g", p / 683 }')
light "$power $power $power" "$scenes/cube.gltf"
light "$power $power $power" unsigned.gltf
light "$less $less $less" blender.gltf
grep -q "683 lm to the watt, as 'Khronos glTF Blender I/O v3.4.50' writes them" err || fail "no line of the units: $(cat err)"
light "$power $power $power" blender.gltf --light-units radiometric
light "$less $less $less" unsigned.gltf --light-units photometric
[ "$power" ] || fail "no power in cube.gltf"
works info --methods
grep -q "^pop " out || fail "info --methods lists no pop: $(cat out)"
for method in "pop light" "lpv light" "photon light" "path fluxes" "single composite" "pop-paper composite"; do
    grep -q "^${method% *} " out || continue # not in this build
    sed -n "/^${method% *} /,/ limits:/p" out | grep -q " outputs:.* ${method#* }\( \|\$\)" || fail "info --methods: not '$method': $(cat out)"
done
[ "$(grep -c " outputs:.* light" out)" = "$(grep -cE '^(pop|lpv|photon) ' out)" ] || fail "info --methods: light of others than pop, lpv and photon: $(cat out)"
works info --passes
grep -q -- "-D lattice.cells=.*default" out || fail "info --passes: no lattice.cells"

# ---- compare ----
make() {
    "$helpers/exr_make" "$@" || fail "exr_make $*"
}
make a.exr 2 1 R=1,2 G=0,0 B=3,1
make b.exr 2 1 R=1,1 G=0,2 B=2,1
works compare a.exr b.exr
near "$(value rel_l1)" 0.571428571 1e-6 "rel_l1"
near "$(value rmse)" 1 1e-6 "rmse"
near "$(value rel_rmse)" 0.738548946 1e-6 "rel_rmse"
near "$(value smape)" 0.511111111 1e-6 "smape"
near "$(value bias)" 0 1e-6 "bias"
near "$(value p95)" 0.994200497 1e-6 "p95"
near "$(value nan)" 0 0 "nan"
[ -z "$(value n)" ] || fail "n without an error layer"
works compare a.exr b.exr --block 2
near "$(value rel_l1)" 0.571428571 1e-6 "rel_l1 of blocks"
make ae.exr 2 1 R=1,2 G=0,0 B=3,1 error.R=0.1 error.G=0.1 error.B=0.1
works compare ae.exr b.exr --json --heat heat.png
cp out compare.json
near "$("$helpers/json_get" compare.json n)" 0.0683901 1e-6 "n as JSON"
near "$("$helpers/json_get" compare.json error)" 0.567321302 1e-6 "error as JSON"
[ "$(head -c 4 heat.png | od -An -tx1 | tr -d ' \n')" = 89504e47 ] || fail "--heat wrote no PNG"
make c.exr 1 2 R=1 G=1 B=1
make zero.exr 2 1 R=0 G=0 B=0
make nan.exr 2 1 R=nan,2 G=0,0 B=3,1
make xyz.exr 2 1 X=1
refuses 2 "both need the same size" compare a.exr c.exr
refuses 2 "sum to 0" compare a.exr zero.exr
refuses 2 "no channel 'R'" compare xyz.exr b.exr
refuses 2 "nothere.exr" compare nothere.exr b.exr
refuses 2 "b.csv" compare a.exr b.csv
refuses 2 "not a .png" compare a.exr b.exr --heat heat.jpg
refuses 2 "--block: '0' is not" compare a.exr b.exr --block 0
refuses 1 "nowhere" compare a.exr b.exr --heat nowhere/heat.png
run compare nan.exr b.exr --hdr-flip
[ "$code" = 1 ] || fail "compare with a NaN: exit $code"
near "$(value nan)" 1 0 "nan"
for measure in rel_l1 rmse rel_rmse rel_mse smape bias p95 flip hdr_flip; do
    [ "$(value $measure)" = nan ] || fail "$measure with a NaN: $(value $measure)"
done
make black.exr 2 1 R=nan,nan G=nan,nan B=nan,nan
run compare black.exr b.exr
[ "$code $(value rel_l1) $(value nan)" = "1 nan 6" ] || fail "compare of NaN alone: exit $code, $(cat out err)"
make noisy.exr 2 1 R=1,2 G=0,0 B=3,1 error.R=0.1,-0.5 error.G=0,0 error.B=0,0
refuses 2 "error.R is -0.5 at pixel (1, 0)" compare noisy.exr b.exr
works compare a.exr a.exr --hdr-flip --flip-map map.png
[ "$(value flip) $(value hdr_flip)" = "0 0" ] || fail "FLIP of equal pictures: $(value flip) $(value hdr_flip)"
[ "$(head -c 4 map.png | od -An -tx1 | tr -d ' \n')" = 89504e47 ] || fail "--flip-map wrote no PNG"
make green.exr 2 1 R=0 G=1 B=0
make blue.exr 2 1 R=0 G=0 B=1
works compare green.exr blue.exr --json --hdr-flip --exposures 0,1,2
cp out compare.json
near "$("$helpers/json_get" compare.json flip)" 1 1e-5 "flip of green and blue as JSON"
"$helpers/json_get" compare.json hdr_flip >/dev/null || fail "no hdr_flip as JSON"
# .png files have flip alone
works compare heat.png map.png --flip-map map2.png
[ "$(cut -d' ' -f1 out)" = flip ] || fail "compare of .png files: $(cat out)"
awk -v f="$(value flip)" 'BEGIN { exit !(f > 0.1 && f <= 1) }' || fail "flip of two .png files: $(value flip)"
works compare map.png map.png
near "$(value flip)" 0 0 "flip of equal .png files"
make c3.exr 3 1 R=1 G=1 B=1
works compare c3.exr c3.exr --flip-map map3.png
cp b.exr false.png
refuses 2 "not one of each" compare a.exr map.png
refuses 2 "not one of each" compare map.png a.exr
refuses 2 "both need the same size" compare map3.png map.png
refuses 2 "must be a PNG picture" compare map.png false.png
refuses 2 "nothere.png" compare map.png nothere.png
refuses 2 "--block: is for .exr" compare map.png heat.png --block 8
refuses 2 "--heat: is for .exr" compare map.png heat.png --heat heat2.png
refuses 2 "--hdr-flip: is for .exr" compare map.png heat.png --hdr-flip
refuses 2 "--exposures: is for --hdr-flip" compare a.exr b.exr --exposures -3,3,4
refuses 2 "must be START,STOP,COUNT" compare a.exr b.exr --hdr-flip --exposures 3,-3,4
refuses 2 "must be START,STOP,COUNT" compare a.exr b.exr --hdr-flip --exposures -3,3,2.5
refuses 2 "--flip-map: 'map.jpg' is not a .png" compare a.exr b.exr --flip-map map.jpg

finish
