#!/bin/sh
# choosing.sh -- render --max-error and --budget-ms: what is chosen, said and kept, and whether the error is as asked for
# in scenes that were never measured.
. "$(dirname "$0")/lib.sh"

needs_device
cube="$scenes/cube.gltf --size 32x32 -o x.png"

# ---- wrong ----
# shellcheck disable=SC2086
{
    refuses 2 "'abc' is neither a share like 0.05 nor a percentage like 5%" render $cube --max-error abc
    refuses 2 "'-5%' is neither" render $cube --max-error -5%
    refuses 2 "'nan%' is neither" render $cube --max-error nan%
    refuses 2 "'5' is a share, of 500 %; did you mean 5%?" render $cube --max-error 5
    refuses 2 "did you mean 1%?" render $cube --max-error 1
    refuses 2 "--quality draft: --max-error and --budget-ms choose" render $cube --max-error 5% --quality draft
    refuses 2 "--fronts needs --max-error or --budget-ms" render $cube --fronts f.json
    refuses 2 "--error-block needs --max-error or --budget-ms" render $cube --error-block 1
    refuses 2 "--spp 3: --max-error and --budget-ms choose the samples themselves" render $cube --max-error 5% --spp 3 --method path
    works render "$scenes/cube.gltf" --size 16x16 -o x.png --max-error 50% # the first choice of a day measures the device, and says so
    refuses 2 "say with --budget-ms how long it may take" render "$scenes/smoke.gltf" --size 512x512 -o x.png --max-error 0.01%
    refuses 2 "nothere.json" render $cube --max-error 5% --fronts nothere.json
    echo '{"schema": "tyndall-report"}' >report.json
    refuses 2 "not a file of fronts" render $cube --max-error 5% --fronts report.json
    refuses 2 "there is no method 'abacus'" render $cube --max-error 5% --method abacus
}

# ---- what is said and kept ----
works render "$scenes/cube.gltf" --size 32x32 -o x.png --max-error "5 %" --stats s.json -D raymarch.step=0.5
grep -q "chosen: .*; error on 8x8 pixels about .*, likely below .*; a cold frame about" err || fail "no word on the choice: $(cat err)"
grep -q "measured scenes nearest in regime (distance): cube" err || fail "no word on where it is from: $(cat err)"
[ "$(get s.json choice.method)" = "$(get s.json method)" ] || fail "stats: another method than chosen"
[ "$(get s.json settings/raymarch.step)" = 0.5 ] || [ "$(get s.json method)" = path ] || fail "-D does not stay"
near "$(get s.json choice.asked.max_error)" 0.05 1e-6 "stats: asked"
[ "$(get s.json choice.error_met)" = true ] || fail "5 % in the cube is not met"
works render "$scenes/cube.gltf" --size 32x32 -o x.png --max-error 0.05 --method single --stats s.json
[ "$(get s.json method)" = single ] || fail "--method does not restrict the choice"

# warned WORDS: a line of the stats' warnings, the method's own may come first
warned() {
    for line in 0 1 2; do
        get s.json "warnings.$line" 2>&1 | grep -q "$1" && return 0
    done
    return 1
}

[ "$(get s.json choice.error_met)" = false ] || fail "single claims 5 % in the cube"
warned "5 % is not likely here with single" || fail "stats: no warning of the error"
works render "$scenes/cube.gltf" --size 32x32 -o x.png --budget-ms 0.01 --stats s.json
warned "this is the fastest" || fail "stats: no warning of the time"
works render "$scenes/slab.gltf" --size 32x32 -o x.png --max-error 90% --stats s.json
case $(get s.json method) in pop | path) ;; *) fail "a method that refuses periods was chosen: $(get s.json method)" ;; esac

# ---- measurements of one's own ----
cat >suite.json <<END
{ "name": "small", "size": [32, 32], "reference_spp": 16, "block": 8, "frames": 1, "max_seconds": 1,
  "scenes": [ { "scene": "cube.gltf" } ],
  "runs": [ { "name": "pop", "method": "pop", "settings": { "lattice.cells": 8 } },
            { "name": "path", "method": "path", "spp": 4 } ] }
END
works bench --suite suite.json --scenes "$scenes" --quiet --report new/deep --write-fronts new/deep/own.json
works render "$scenes/cube.gltf" --size 32x32 -o x.png --max-error 80% --fronts new/deep/own.json --method pop --stats s.json
[ "$(get s.json choice.nearest.0.name)" = cube.gltf ] || [ "$(get s.json choice.nearest.0.name)" = cube ] || fail "not from the measurements given: $(get s.json choice.nearest.0.name)"
[ "$(get s.json settings/lattice.cells)" = 8 ] || fail "not with the measured settings"

# ---- scenes that were not measured: 10 % asked for, 15 % is the bound ----
# as_asked NAME ARGUMENTS
as_asked() {
    name=$1
    shift
    works render "$@" --size 64x64 --float --quiet --method path --spp 256 --seed 99 --aov error -o ref.exr
    works render "$@" --size 64x64 --float --quiet --max-error 10% -o x.exr --stats s.json
    works compare x.exr ref.exr --block 8
    error=$(value error)
    echo "$name: error $error; $(get s.json choice.why.0)"
    near "$error" 0 0.15 "$name: error where 10 % were asked for"
    near "$(get s.json choice.predicted.error_likely)" 0 0.1 "$name: promised"
}
as_asked "thin smoke" "$scenes/smoke.gltf" --density-scale 0.4 --g 0.5
as_asked "cloud in a courtyard" "$scenes/cloud.gltf" --density-scale 0.3 --env "$scenes/courtyard.exr"
as_asked "dark sphere" "$scenes/sphere.gltf" --albedo 0.7
as_asked "white cube" "$scenes/cube-oblique.gltf" --albedo 1 --density-scale 3 --camera oblique
as_asked "deep white cube" "$scenes/cube.gltf" --sigma-s 30 --sigma-a 0 --g 0
as_asked "deep white cube, forward" "$scenes/cube.gltf" --sigma-s 100 --sigma-a 0 --g 0.85
# Where pop breaks: a backward peak, and boxes that are flat or long. `box` SCALE: of the unit cube.
box() {
    sed "s/\"scale\": \[1, 1, 1\]/\"scale\": [$1]/" "$scenes/cube.gltf" >box.gltf
    grep -q "\"scale\": \[$1\]" box.gltf || fail "no box of $1"
}
box "1, 1, 1"
as_asked "backward peak" box.gltf --sigma-s 3 --sigma-a 0.15 --g -0.8
box "0.01, 1, 1"
as_asked "flat box" box.gltf --sigma-s 400 --sigma-a 20 --g 0.5
box "0.1, 1, 0.1"
as_asked "long box" box.gltf --sigma-s 100 --sigma-a 1
works render "$scenes/cube.gltf" --size 32x32 -o x.png --max-error 5% --method pop --sigma-s 10 --g -0.99 --stats s.json
[ "$(get s.json choice.error_met)" = false ] || fail "pop claims 5 % at g -0.99"
# 12 and 13 % off with 48 cells, of 6 mean free paths.
for albedo in 1 0.999; do
    works render "$scenes/cube.gltf" --size 32x32 -o x.png --max-error 10% --method pop --sigma-s 300 --sigma-a 0 --g 0 --albedo $albedo --stats s.json
    [ "$(get s.json choice.error_met)" = false ] || fail "pop claims 10 % in a cube of depth 300 and albedo $albedo"
done
finish
