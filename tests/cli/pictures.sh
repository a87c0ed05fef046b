#!/bin/sh
# pictures.sh -- what the tool makes on a device: files, stats, probe, balance, graph, the same bytes twice.
. "$(dirname "$0")/lib.sh"

needs_device

# ---- render ----
refuses 2 "no device 'abacus'" render "$scenes/cube.gltf" --device abacus
refuses 2 "no device '99'" render "$scenes/cube.gltf" --device 99
# With layers of light all pixels are marched, so the march of the bare picture is told to do the same.
works render "$scenes/cube.gltf" --size 64x48 --quiet -D raymarch.sparse=0
[ -s cube.png ] || fail "render wrote no cube.png"
[ -s err ] && fail "--quiet printed: $(cat err)"
works render "$scenes/cube.gltf" --size 64x48 --quiet -o a.exr -o a.png --aov transmittance,depth,depth_t50,single,multiple --stats a.json
[ -s a.exr ] && [ -s a.png ] || fail "render wrote no a.exr or a.png"
cmp -s a.png cube.png || fail "the same picture in two ways differs"
works render "$scenes/cube.gltf" --size 64x48 --quiet -o b.exr --aov transmittance,depth,depth_t50,single,multiple
cmp -s a.exr b.exr || fail "pop: the same bytes twice"
works compare a.exr b.exr
near "$(value rel_l1)" 0 0 "rel_l1 of equal pictures"
leftover=$(ls | grep -vxE 'cube.png|[ab].(exr|png|json)|out|err|cache')
[ -z "$leftover" ] || fail "left behind: $leftover"
refuses 2 "does not make the layer 'error'" render "$scenes/cube.gltf" -o a.exr --aov error --method pop
refuses 2 "needs images of 60000 texels along a side, and this device has" render "$scenes/cube.gltf" --size 16000x16 --refine 4

# a second run finds the pipelines of the first
ls cache/tyndall/pipelines-* >/dev/null 2>&1 || fail "no pipeline cache was written"
echo "damaged" >cache/tyndall/pipelines-junk
for file in cache/tyndall/pipelines-*; do
    echo "damaged" >"$file"
done
works render "$scenes/cube.gltf" --size 16x16 --quiet -o c.png

# pictures of surfaces up to the size of all others: with fewer samples a pixel, which is said
works render "$scenes/cornell-smoke.gltf" --size 16384x2 -o wide.exr -D lattice.cells=8
grep -q "warning: .*16384 x 2 pixels .* 1 x 1" err || fail "fewer samples are not said: $(cat err)"
works render "$scenes/cornell-smoke.gltf" --size 2x8193 -o high.exr -D lattice.cells=8
grep -q "warning: .*2 x 8193 pixels .* 1 x 1" err || fail "fewer samples are not said: $(cat err)"
rm -f wide.exr high.exr

# ---- stats ----
[ "$(get a.json method)" = pop ] || fail "stats: method"
[ "$(get a.json size.0)" = 64 ] && [ "$(get a.json size.1)" = 48 ] || fail "stats: size"
for key in tyndall device setup_ms pipelines.compiled pipelines.from_cache pipelines.seconds frame_ms.cold memory.persistent memory.transient nodes.0.name \
    nodes.0.state nodes.0.gpu_ms nodes.0.cpu_ms nodes.0.dispatches nodes.0.bytes nodes.0.flops \
    nodes.0.work warnings settings/lattice.cells inputs; do
    get a.json "$key" >/dev/null
done
[ "$(get a.json frame_ms.unchanged)" = null ] || fail "stats: unchanged was not run"
works render "$scenes/cube.gltf" --size 64x48 --quiet --frames 3 --change none --stats n.json
near "$(get n.json frame_ms.unchanged)" 0 1e5 "stats: unchanged"
works render "$scenes/cube.gltf" --size 64x48 --quiet --frames 2 --change camera --stats c.json
near "$(get c.json frame_ms.camera_moved)" 0 1e5 "stats: camera_moved"
works render "$scenes/plume-contrast.gltf" --size 64x48 --quiet --frames 2 --change sky --stats d.json
near "$(get d.json frame_ms.sky_dimmed)" 0 1e5 "stats: sky_dimmed"
[ "$(get d.json nodes.2.name) $(get d.json nodes.2.state)" = "ordinates unchanged" ] && [ "$(get d.json nodes.3.name) $(get d.json nodes.3.state)" = "sky_light ran" ] ||
    fail "stats: a sky that is dimmed"
works render "$scenes/cube.gltf" --size 64x48 --quiet --frames 2 --stats f.json
near "$(get f.json frame_ms.cold)" 0 1e5 "stats: cold"

# the suns of a map are said, and how many ordinates carry the rest
works info "$scenes/smoke-sky.gltf"
grep -q "sun 0 of the map: .* radius 0.5" out || fail "info: no sun in: $(grep -A1 environment out)"
works info "$scenes/plume-contrast.gltf"
grep -q "of the map" out && fail "info: a sun in the courtyard"
[ "$("$tool" info --methods | grep -c "^pop-paper ")" = 0 ] || {
works render "$scenes/smoke-sky.gltf" --size 16x16 --quiet --method pop-paper -D ordinates.count=12 -o o.png --stats o.json
grep -q '"ordinates":' o.json || fail "stats: ordinates: $(grep -A3 '"ordinates"' o.json)"
}

# ---- parts ----
refuses 2 "'40,20' is not X,Y,WxH" render "$scenes/smoke.gltf" --crop 40,20 -o crop.png
refuses 2 "89x31 pixels from column 40, row 20 on are not within the picture's 128x96" render "$scenes/smoke.gltf" --size 128x96 --crop 40,20,89x31 -o crop.png
# part_is_off WHAT SHARE FARTHEST: of crop.exr so many of the values differ from whole.exr's, by so much of themselves at most
part_is_off() {
    "$helpers/part_of" whole.exr crop.exr >off || fail "--crop of $1: $(cat off)"
    echo "--crop of $1: values, those that differ, by how much: $(cat off)"
    awk -v share="$2" -v most="$3" '{ exit !($1 > 0 && $2 <= share * $1 && $3 <= most) }' off || fail "--crop of $1: above $2, $3"
}
# a part of each is the same pixels as the whole, where nodes of the march and patterns of shared light do not begin at it either
for case in "smoke 0" "fog-hall 1e-6"; do # among surfaces rounding of the samples' places
    set -- $case; scene=$1
    works render "$scenes/$scene.gltf" --size 160x120 --quiet --float --method pop -D lattice.cells=16 -o whole.png -o whole.exr
    works render "$scenes/$scene.gltf" --size 160x120 --quiet --float --method pop -D lattice.cells=16 --crop 93,70,50x31 -o crop.png -o crop.exr --stats crop.json
    [ "$(get crop.json size.0) $(get crop.json part_of.0) $(get crop.json part_of.3)" = "50 93 120" ] || fail "stats: part_of"
    part_is_off $scene 0 $2
    PYTHONPATH=$source/tests/view python3 - <<'END' || fail "--crop of $scene is not the part of the whole picture"
from screen import read_png
width, _, whole = read_png("whole.png")
w, h, crop = read_png("crop.png")
part = b"".join(whole[3 * (width * (70 + y) + 93):3 * (width * (70 + y) + 93 + w)] for y in range(h))
assert (w, h) == (50, 31) and part == crop and sum(crop) > 1000
END
done
# large enough for blocks of pixels, at the last row and column; and where rounding at edges shows (docs/surfaces.md, "Limits"):
# 2.4 % of lantern's values are off, by 2.3 % at most
for part in "fog-hall 400x390 352,341,48x49 0 1e-6" "lantern 256x192 93,70,50x41 0.028 0.027"; do
    set -- $part
    works render "$scenes/$1.gltf" --size $2 --quiet --float -D lattice.cells=16 -o whole.exr
    works render "$scenes/$1.gltf" --size $2 --quiet --float -D lattice.cells=16 --crop $3 -o crop.exr
    part_is_off "$1, $3 of $2" $4 $5
done
# a part is drawn as finely as its own size allows
works render "$scenes/fog-hall.gltf" --size 9000x9000 --crop 4000,4000,64x64 -D lattice.cells=8 -o part.png
grep -q "edges are less smooth" err && fail "a part of 64x64: $(cat err)"

# ---- path ----
works render "$scenes/cube.gltf" --size 32x32 --quiet --method path --spp 8 -o p.exr --aov error --stats p.json
works render "$scenes/cube.gltf" --size 32x32 --quiet --method path --spp 8 -o q.exr --aov error
cmp -s p.exr q.exr || fail "path: the same bytes twice"
works render "$scenes/cube.gltf" --size 32x32 --quiet --method path --spp 8 -o r.exr --aov error --seed 1
cmp -s p.exr r.exr && fail "path: another seed gives the same bytes"
works compare p.exr r.exr
awk -v n="$(value n)" -v r="$(value rel_l1)" 'BEGIN { exit !(n > 0 && r < 2 * n && n < 2 * r) }' ||
    fail "path: two seeds differ by $(value rel_l1), their errors explain $(value n)"
[ "$(get p.json settings/spp)" = 8 ] || fail "stats: spp"

# ---- sequences ----
works render "$scenes/cube.gltf" --size 16x16 --quiet --frames 3-4 -o s_%04d.png -o t_##.exr
[ -s s_0003.png ] && [ -s s_0004.png ] && [ -s t_03.exr ] && [ -s t_04.exr ] || fail "--frames 3-4: $(ls)"

# an animated volume, alone and named by a scene: one picture a frame, each of its own
"$helpers/sequence_make" . || fail "sequence_make"
works render puff.%04d.nvdb --size 32x32 --quiet --frames 2-5 -o v_####.exr -o v_####.png --stats v_####.json
works render puffs.gltf --size 32x32 --quiet --frames 2-5 -o g_####.exr --stats g_%04d.json -D lattice.cells=12
for pair in 2:3 3:4 4:5; do
    for name in v g; do
        [ -s ${name}_000${pair#*:}.exr ] && [ -s ${name}_000${pair#*:}.json ] || fail "a sequence lacks files: $(ls)"
        works compare ${name}_000${pair%:*}.exr ${name}_000${pair#*:}.exr
        awk -v r="$(value rel_l1)" 'BEGIN { exit !(r > 0.02) }' || fail "pictures $pair of ${name} are the same"
    done
done
[ -s v_0005.png ] || fail "a sequence lacks its .png"
# the puff thins out: the coefficients that suit the first picture are those of all
works compare v_0005.exr v_0002.exr
awk -v b="$(value bias)" 'BEGIN { exit !(b < 0.5) }' || fail "a thinner puff is brighter by $(value bias)"
# a picture of a sequence is the picture
works render puffs.gltf --size 32x32 --quiet --frames 4-4 -o one_#.exr -D lattice.cells=12
works compare one_4.exr g_0004.exr
[ "$(value rel_l1)" = 0 ] || fail "a picture of a sequence is not the picture alone"
works render puffs.gltf --size 32x32 --quiet --frames 2-4 -o h_#.exr -D lattice.cells=12
cmp -s h_4.exr g_0004.exr || fail "a sequence: the same bytes twice"
cmp -s h_2.exr one_4.exr && fail "the puff does not move"
[ "$(get g_0002.json frame_ms.cold)" != null ] && [ "$(get g_0003.json frame_ms.cold)" = null ] ||
    fail "only the first picture of a sequence is a cold one"
refuses 2 "puff.0006.nvdb" render puffs.gltf --size 32x32 --quiet --frames 6-7 -o n_#.exr
refuses 2 "puff.####.nvdb" render puffs.gltf --size 32x32 --quiet -o n.exr
refuses 2 "puff.0001.nvdb" render puff.####.nvdb --size 32x32 --quiet --frames 1-2 -o n_#.exr

# ---- interruption: exit 130, and what there is (resume.sh has more) ----
"$tool" render "$scenes/cube.gltf" --size 512x512 --quiet --method path --spp 100000 -o i.exr &
pid=$!
sleep 2
kill -INT $pid
wait $pid
code=$?
[ "$code" = 130 ] || fail "interrupted: exit $code"
rm -f i.exr # not there if no samples were done yet

# ---- probe, balance, graph ----
printf 'x,y,z\n0.5,0.5,0.5\n0.25,0.5,0.5\n' >points.csv
works probe "$scenes/cube.gltf" --points points.csv --quiet -o field.csv
[ "$(wc -l <field.csv)" = 3 ] || fail "probe: $(cat field.csv)"
[ "$(head -1 field.csv | tr ',' '\n' | wc -l)" = 15 ] || fail "probe: header $(head -1 field.csv)"
works probe "$scenes/cube.gltf" --points points.csv --quiet --method path --spp 4096
[ "$(head -1 out | tr ',' '\n' | wc -l)" = 27 ] || fail "probe --method path: $(head -1 out)"
sed -n 2p out | grep -q '^0.5,0.5,0.5,' || fail "probe: order of the points"
works balance "$scenes/cube.gltf" --json --quiet
cp out balance.json
for key in entering emitted absorbed_media absorbed_surfaces escaped imbalance imbalance_se; do
    [ "$("$helpers/json_get" balance.json $key)" = "list 3" ] || fail "balance: $key"
done
for key in absorbed_media absorbed_surfaces escaped; do
    [ "$("$helpers/json_get" balance.json shares.$key)" = "list 3" ] || fail "balance: shares.$key"
done
near "$(get balance.json shares.escaped.0)" 1 0.01 "share that leaves the cube"
near "$(get balance.json scales.suns.0)" 1 0.01 "least factor of the cube's sun"
near "$(get balance.json scales.suns.1)" 1 0.01 "most factor of the cube's sun"
near "$(get balance.json entering.0)" 1 1e-3 "power that enters the cube, W"
near "$(get balance.json imbalance.0)" 0 0.01 "imbalance of the cube"
works fluxes "$scenes/slab.gltf" --json --quiet
cp out fluxes.json
for key in incident reflected reflected_se transmitted absorbed_media missing leaving.+y leaving.+y_se; do
    [ "$("$helpers/json_get" fluxes.json $key)" = "list 3" ] || fail "fluxes: $key"
done
near "$(get fluxes.json incident.0)" 1 1e-5 "power that enters the slab, W"
near "$(get fluxes.json missing.0)" 0 1e-4 "energy of the slab's fluxes"
works fluxes "$scenes/slab.gltf" --quiet --spp 2
grep -q '^reflected .* +- ' out || fail "fluxes: $(cat out)"
refuses 2 "output 'fluxes': there are lamps" fluxes "$scenes/room.gltf"
works graph "$scenes/cube.gltf" --quiet
grep -q raymarch out || fail "graph: no raymarch: $(head -5 out)"
works graph "$scenes/cube.gltf" --dot --quiet
grep -q digraph out || fail "graph --dot: $(head -2 out)"
for pass in beam lattice merge; do
    works graph "$scenes/cube.gltf" --size 16x16 --quiet --view $pass -o view.png
    [ -s view.png ] || fail "graph --view $pass wrote no picture"
    rm -f view.png
done
refuses 2 "makes no image" graph "$scenes/cube.gltf" --size 16x16 --view composite -o view.png
refuses 2 "has no pass 'paint'; it has: medium" graph "$scenes/cube.gltf" --view paint -o view.png

# ---- a node that a scene does not need is not there, and the graph says what it is for ----
# nodes FILE: "name milliseconds" of each in the stats
nodes() {
    awk -F'"' '/"name":/ { name = $4 } /"gpu_ms":/ { gsub(/[^0-9.e+-]/, "", $3); print name, $3 }' "$1"
}
# has_nodes WHAT FILE NAMES / lacks_nodes WHAT FILE NAMES
has_nodes() {
    what=$1 file=$2
    shift 2
    for name; do
        nodes "$file" | grep -q "^$name " || fail "$what: no node $name: $(nodes "$file")"
    done
}
lacks_nodes() {
    what=$1 file=$2
    shift 2
    for name; do
        nodes "$file" | grep -q "^$name " && fail "$what: a node $name: $(nodes "$file")"
        grep -q "^left out $name: only for " out || fail "$what: the graph does not tell of $name"
        grep -q "label=\"$name.nleft out" dot || fail "$what: graph --dot does not tell of $name"
    done
}
# drawn SCENE ARGUMENTS: leaves k.json, out and dot
drawn() {
    scene=$scenes/$1.gltf
    shift
    works render "$scene" --size 32x32 --quiet -o k.exr --stats k.json "$@"
    [ "$3" = --frames ] && set -- "$1" "$2" # not of graph
    works graph "$scene" --size 32x32 --quiet --dot "$@"
    cp out dot
    works graph "$scene" --size 32x32 --quiet "$@"
}
raster="shadow_map rsm gbuffer"
local="vpl radial_beam radial_lights lattice_lamps"
field="medium beam scatter_lut lattice_cells walls lattice_source lattice merge"
drawn smoke-sky -D lattice.cells=12
has_nodes "no surfaces" k.json medium beam lattice merge raymarch
lacks_nodes "no surfaces" k.json $raster $local shade walls wall_light
drawn fog-hall -D vpl.count=0 -D lattice.cells=12
has_nodes "surfaces, a sun and a sky" k.json shadow_map gbuffer shade walls beam lattice raymarch
lacks_nodes "no lamps, no virtual ones" k.json rsm wall_light $local
drawn fog-hall --density-scale 0 --frames 3
has_nodes "no medium" k.json $raster vpl shade raymarch
lacks_nodes "no medium" k.json $field radial_beam lattice_lamps
# What is left of the march lays the surfaces over the background.
nodes k.json | awk '$1 == "raymarch" { march = $2 } { all += $2 } END { exit !(march < 0.5 * all) }' ||
    fail "no medium: the march costs more than the surfaces: $(nodes k.json)"
drawn room -D vpl.count=16 -D lattice.cells=12
has_nodes "a lamp" k.json $raster $local medium scatter_lut lattice_cells walls lattice merge shade raymarch
lacks_nodes "no suns" k.json beam lattice_source

# ---- warnings: once, and in the stats ----
run render "$scenes/two-media.gltf" --size 16x16 --frames 3 -o w.png --stats w.json
warnings=$(grep -c warning: err)
near "$warnings" 1 1 "warnings of two-media: $(cat err)"
[ "$(get w.json warnings)" = "list $warnings" ] || fail "stats: warnings are not those on stderr"

# ---- selftest ----
works selftest --json --quiet
cp out selftest.json
[ "$(get selftest.json ok)" = true ] || fail "selftest: $(cat selftest.json)"

finish
