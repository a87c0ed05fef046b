#!/bin/sh
# resume.sh -- what an .exr says of its picture; pictures that are interrupted and taken up again, or merged of parts.
. "$(dirname "$0")/lib.sh"

needs_device

# says FILE LINE: a line of what exr_tell tells of it
says() {
    "$helpers/exr_tell" "$1" | grep -qxF -- "$2" || fail "$1 does not say '$2': $("$helpers/exr_tell" "$1")"
}
# numbers FILE NAME: of an attribute
numbers() {
    "$helpers/exr_tell" "$1" | sed -n "s/^attribute $2 //p"
}
# samples FILE: of each pixel; 0: there is no file
samples() {
    [ -e "$1" ] && numbers "$1" tyndall:samples || echo 0
}

# ---- what a file says ----
cat >cam.gltf <<'END'
{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [0, 1, 2] } ],
  "extensionsUsed": ["TYN_participating_media", "KHR_lights_punctual"],
  "nodes": [ { "extensions": { "TYN_participating_media": { "medium": 0, "shape": "sphere" } } },
             { "name": "eye", "camera": 0, "translation": [1, 2, 6] },
             { "mesh": 0, "translation": [0.5, 1, -2], "scale": [2, 2, 1] } ],
  "cameras": [ { "type": "perspective", "perspective": { "yfov": 1.0, "aspectRatio": 2, "znear": 0.1 } } ],
  "materials": [ { "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0 } } ],
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 }, "material": 0 } ] } ],
  "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [3, 3, 0] } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
  "buffers": [ { "byteLength": 36,
      "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAABAQAAAgL8AAAAAAACAvwAAQEAAAAAA" } ],
  "extensions": { "TYN_participating_media": { "media": [ { "scattering": 1 } ] } } }
END
works render cam.gltf --size 48x24 --quiet -o cam.exr --aov depth,depth_t50,albedo,normal --no-background -D lattice.cells=8
for line in "attribute tyndall:method pop" "attribute software Tyndall $("$tool" --version | cut -d' ' -f2)" \
    "channel depth.Z float" "channel depth_t50.Z float" "channel R half" "channel albedo.R half" "channel normal.X half"; do
    says cam.exr "$line"
done
numbers cam.exr tyndall:settings | grep -q '"lattice.cells":8' || fail "the settings are not told"
numbers cam.exr tyndall:camera | grep -q '"name":"eye","projection":"perspective","yfov":1,' || fail "the camera is not told"
[ "$("$helpers/exr_tell" cam.exr | grep -c "tyndall:samples\|resume_")" = 0 ] || fail "pop has no samples"
near "$(numbers cam.exr chromaticities | cut -d' ' -f1)" 0.64 1e-6 "x of red"
near "$(numbers cam.exr screenWindowWidth)" 2.18520996 1e-6 "width of the picture at 1 m: 4 tan(1/2)"
# The point (0, 1, -4) is seen from (1, 2, 6) at x -1, y -1, z 10 in front: OpenEXR's frame is left-handed.
echo "0 1 -4 1 $(numbers cam.exr worldToCamera) $(numbers cam.exr worldToNDC)" >point
project() {
    awk -v at="$1" '{ for (c = 0; c < 4; c++) { v[c] = 0; for (r = 0; r < 4; r++) v[c] += $(r + 1) * $(at + 5 + 4 * r + c) }
        printf "%.7g %.7g %.7g %.7g\n", v[0], v[1], v[2], v[3] }' point
}
[ "$(project 0)" = "-1 -1 10 1" ] || fail "worldToCamera takes the point to $(project 0)"
project 16 | awk '{ x = $1 / $4 - (0.5 - 0.05 / (2 * 0.54630249)); y = $2 / $4 - (0.5 + 0.05 / 0.54630249)
    exit !(x * x + y * y < 1e-12) }' || fail "worldToNDC takes the point to $(project 16)"
near "$("$helpers/exr_tell" cam.exr albedo.G 24 12)" 0.25 1e-3 "albedo of the wall"
near "$("$helpers/exr_tell" cam.exr normal.Z 24 12)" 1 1e-3 "normal of the wall"
near "$("$helpers/exr_tell" cam.exr depth.Z 24 12)" 8.0017 1e-2 "depth of the wall"
works render cam.gltf --size 48x24 --quiet -o other.exr --aov albedo,normal --method path --spp 1
near "$("$helpers/exr_tell" other.exr albedo.R 24 12)" 0.5 1e-3 "albedo of the wall, path"
near "$("$helpers/exr_tell" other.exr albedo.R 0 0)" 0 0 "albedo of nothing"
refuses 2 "does not make the layer 'albedo'" render cam.gltf --size 8x8 -o x.exr --aov albedo --method single

# ---- a camera that moves by 2 m in the first second: its place is in the file ----
cat >moving.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}], "nodes": [{"camera": 0, "translation": [0, 0, 3], "name": "eye"}, {"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}], "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "aspectRatio": 1}}], "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}, "materials": [{"doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0}}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]}, {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}, {"buffer": 0, "byteOffset": 44, "byteLength": 24}], "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAQEAAAABAAAAAAAAAQEA="}]}
END
place() {
    numbers "$1" worldToCamera | cut -d' ' -f13
}
run render moving.gltf --size 8x8 -o still.exr
grep -q "warning: 1 animation: " err || fail "that an animation is not shown is not said: $(cat err)"
near "$(place still.exr)" 0 0 "the camera without a time"
works render moving.gltf --size 8x8 --quiet -o at.exr --time 0.25
near "$(place at.exr)" -0.5 1e-6 "the camera after a quarter of a second"
works render moving.gltf --size 8x8 --quiet -o at#.exr --frames 6-7 --fps 12
near "$(place at6.exr)" -1 1e-6 "the camera in picture 6 of 12 a second"
near "$(place at7.exr)" -1.16666667 1e-6 "the camera in picture 7 of 12 a second"
rm -f moving.gltf still.exr at.exr at6.exr at7.exr

# ---- interrupted and taken up again: the same bytes ----
lit="$scenes/cornell-smoke.gltf --size 16x16 --method path --aov error,single,depth --quiet"
asked=600
works render $lit --spp $asked -o whole.exr --resume
says whole.exr "channel R float"
says whole.exr "channel resume_low.A float"
interrupted=0
for turn in 1 2 3 4 5; do
    "$tool" render $lit --spp $asked -o cut.exr -o cut.png --resume 2>err &
    pid=$!
    # Fast machines are done in a second, slow ones have not begun by then.
    sleep "$(awk -v turn=$turn 'BEGIN { print 0.4 * turn }')"
    case $turn in # 3: no time to write; what was kept before is there
        1 | 5) signal=INT ;;
        3) signal=KILL ;;
        *) signal=TERM ;;
    esac
    before=$(samples cut.exr)
    kill -$signal $pid 2>/dev/null
    wait $pid 2>/dev/null
    code=$?
    [ $code = 0 ] || [ $code = 130 ] || [ $signal = KILL ] || fail "interrupted by $signal: exit $code: $(cat err)"
    [ $code = 130 ] && interrupted=$((interrupted + 1))
    [ "$(samples cut.exr)" -ge "$before" ] || fail "interrupted by $signal: from $before to $(samples cut.exr) samples"
done
[ $interrupted -ge 1 ] || fail "the picture was never interrupted"
works render $lit --spp $asked -o cut.exr --resume
cmp -s whole.exr cut.exr || fail "a picture that was interrupted $interrupted times differs"
leftover=$(ls | grep -v '^\(whole\|cut\|cam\|other\)\.\(exr\|png\|gltf\)$' | grep -vx 'out\|err\|cache\|point')
[ -z "$leftover" ] || fail "left behind: $leftover"

# ---- more samples; what does not fit is refused and left as it is ----
cube="$scenes/cube.gltf --size 16x16 --quiet --aov error"
works render $cube --method path --spp 64 -o more.exr --resume
works render $cube --method path --spp 128 -o more.exr --resume
works render $cube --method path --spp 128 -o most.exr --resume
works compare more.exr most.exr
near "$(value rel_l1)" 0 1e-6 "128 samples, and 64 and 64"
[ "$(samples more.exr)" = 128 ] || fail "$(samples more.exr) samples"
cp more.exr kept.exr
works render $cube --method path --spp 100 -o more.exr --resume # has them already
refuses 2 "'more.png' is not made from it" render $cube --method path --spp 100 -o more.png -o more.exr --resume
works render $cube --method path --spp 129 -o more.exr --resume --tonemap linear --exposure 1 # the .exr is before it
works render $cube --method path --spp 130 -o more.exr -o more.png --resume --stats more.json
works render $cube --method path --spp 130 -o more.exr -o more.png --resume --stats more.json
rm more.png more.json
cp kept.exr more.exr
refuses 2 "was begun with --seed 0" render $cube --method path --spp 200 -o more.exr --resume --seed 1
refuses 2 "is another picture" render $cube --method path --spp 200 -o more.exr --resume --g 0.5
refuses 2 "is another picture" render $cube --method path --spp 200 -o more.exr --resume --max-depth 3
refuses 2 "has no channel single.R" render $cube,single --method path --spp 200 -o more.exr --resume
refuses 2 "method 'pop' does not take samples" render "$scenes/cube.gltf" --size 16x16 -o more.exr --resume
refuses 2 "needs an .exr" render "$scenes/cube.gltf" --method path -o more.png --resume
refuses 2 "rendered from its first sample" render $cube --method path --spp 200 -o more.exr --resume --frames 2
cmp -s more.exr kept.exr || fail "a picture that was refused is changed"
works render $cube --method path --spp 8 -o plain.exr
refuses 2 "has no channel resume_low.R" render $cube --method path --spp 16 -o plain.exr --resume
"$helpers/exr_make" foreign.exr 16 16 R=1 G=1 B=1
refuses 2 "does not say which samples it has" render $cube --method path --spp 16 -o foreign.exr --resume

"$helpers/exr_make" damaged.exr of kept.exr resume_deviation.G=-1
refuses 2 "resume_deviation.G is -1 at pixel 0, 0" render $cube --method path --spp 200 -o damaged.exr --resume
refuses 2 "resume_deviation.G is -1 at pixel 0, 0" merge damaged.exr plain.exr -o x.exr
"$helpers/exr_make" damaged.exr of kept.exr R=nan
refuses 2 "channel R is nan at pixel 0, 0" merge plain.exr damaged.exr -o x.exr

# ---- parts of one run, merged: that run, within rounding ----
parts= seeds=
for n in 0 1 2 3 4 5 6 7; do
    works render $cube,single --method path --spp 32 --sample-offset $((32 * n)) -o part$n.exr --resume
    works render $cube,single --method path --spp 32 --seed $n -o seed$n.exr --resume
    parts="$parts part$n.exr" seeds="$seeds seed$n.exr"
done
works render $cube,single --method path --spp 256 -o run.exr --float
works merge $parts -o merged.exr --float
works compare merged.exr run.exr
near "$(value rel_l1)" 0 1e-6 "eight parts, and one run of their samples"
[ "$(samples merged.exr)" = 256 ] || fail "merged: $(samples merged.exr) samples"
for channel in error.G single.B A; do
    near "$("$helpers/exr_tell" merged.exr $channel 7 5)" "$("$helpers/exr_tell" run.exr $channel 7 5)" 1e-6 "$channel of the parts"
done
# Of other seeds: the mean of the parts within rounding, and the run within its noise.
works merge $seeds -o seeds.exr --float
mean=$(for n in 0 1 2 3 4 5 6 7; do "$helpers/exr_tell" seed$n.exr R 7 5; done | awk '{ s += $1 } END { printf "%.9g", s / 8 }')
near "$("$helpers/exr_tell" seeds.exr R 7 5)" "$mean" 1e-7 "mean of eight seeds"
works compare seeds.exr run.exr
awk -v n="$(value n)" -v r="$(value rel_l1)" 'BEGIN { exit !(n > 0 && r < 1.5 * n && n < 1.5 * r) }' ||
    fail "eight seeds and one run differ by $(value rel_l1), their errors explain $(value n)"
# Weighted by samples, and merged once more.
works render $cube,single --method path --spp 160 --seed 9 -o many.exr
works merge seed0.exr many.exr -o two.exr
a=$("$helpers/exr_tell" seed0.exr R 7 5) b=$("$helpers/exr_tell" many.exr R 7 5)
near "$("$helpers/exr_tell" two.exr R 7 5)" "$(awk -v a="$a" -v b="$b" 'BEGIN { print (a * 32 + b * 160) / 192 }')" 1e-4 "weights"
works merge seed0.exr seed1.exr -o pair.exr
works merge pair.exr seed2.exr seed3.exr seed4.exr seed5.exr seed6.exr seed7.exr -o again.exr --float
works compare again.exr seeds.exr
near "$(value rel_l1)" 0 1e-6 "a merged picture, merged again"

refuses 2 "have the same samples, of seed 0" merge seed0.exr part0.exr -o x.exr
refuses 2 "have the same samples, of seed 1" merge seeds.exr seed1.exr -o x.exr
refuses 2 "are different pictures" merge seed0.exr whole.exr -o x.exr
refuses 2 "does not say which samples it has" merge seed0.exr foreign.exr -o x.exr
refuses 2 "two pictures at least" merge seed0.exr -o x.exr
refuses 2 "must be given, and end with .exr" merge seed0.exr seed1.exr -o x.png
refuses 2 "PICTURE... is missing" merge
refuses 2 "cannot be gone on with" render $cube,single --method path --spp 512 -o merged.exr --resume
works render $cube --method path --spp 32 --seed 3 -o bare.exr
refuses 2 "has no channel single" merge seed0.exr bare.exr -o x.exr
[ -e x.exr ] && fail "what was refused was written"

finish
