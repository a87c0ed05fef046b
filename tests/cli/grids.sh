#!/bin/sh
# grids.sh -- every grid of a volume file is listed, none is taken for what it is not, and a fire glows.
. "$(dirname "$0")/lib.sh"

"$helpers/fire_make" fire.vdb hot.vdb || fail "fire_make: exit $?"
scene() { # GRIDS
    cat <<END2
{ "asset": { "version": "2.0" }, "extensionsUsed": [ "TYN_participating_media" ], "scene": 0, "scenes": [ { "nodes": [ 0, 1 ] } ],
  "nodes": [ { "extensions": { "TYN_participating_media": { "medium": 0, "shape": "grid" } } }, { "translation": [ 0, 1, 5 ], "camera": 0 } ],
  "cameras": [ { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } } ],
  "extensions": { "TYN_participating_media": { "media": [ { "scattering": 2, "absorption": 4, $1 } ] } } }
END2
}
density='"density": { "uri": "fire.vdb" }'
hot='"temperature": { "uri": "fire.vdb", "scale": 1500, "offset": 300, "strength": 0.1 }'

# the list, in words and as JSON
works info fire.vdb --quiet
[ "$(grep -c "^  grid '" out)" = 4 ] || fail "info fire.vdb: not four grids: $(cat out)"
grep -q "grid 'vel': vec3s, staggered, 2880 active voxels, values -4 to 15" out || fail "info: no vel: $(cat out)"
grep -q "box 0 3 0 to 11 19 11 (12x17x12), voxels of 0.1; in the world -0.6 0.3 -0.6 to 0.6 2 0.6" out ||
    fail "info: the density is not where it is: $(cat out)"
run info fire.vdb
grep -q 'left out of the file: "temperature" (heat: .*"Cd" (.*"vel" (velocity: media do not move' err ||
    fail "info: what is left out is not told: $(cat err)"
[ "$(wc -l <err)" = 1 ] || fail "info: more than one warning: $(cat err)"
works info fire.vdb --json --quiet
mv out fire.json
i=0
while [ $i -lt 4 ]; do
    name=$(get fire.json files.0.grids.$i.name)
    case $name in
    temperature) expected="float 2304 0 15" ;;
    vel) expected="vec3s 2880 0 19" ;;
    density) expected="float 2448 3 19" ;;
    Cd) expected="vec3s 2448 3 19" ;;
    *) fail "info --json: a grid '$name'" ;;
    esac
    is="$(get fire.json files.0.grids.$i.type) $(get fire.json files.0.grids.$i.active_voxels)"
    is="$is $(get fire.json files.0.grids.$i.index_min.1) $(get fire.json files.0.grids.$i.index_max.1)"
    [ "$is" = "$expected" ] || fail "info --json: $name is $is, expected $expected"
    near "$(get fire.json files.0.grids.$i.voxel.2)" 0.1 1e-9 "voxel of $name"
    i=$((i + 1))
done

# what is no density is not taken for one; the list is printed all the same
run info hot.vdb
[ "$code" = 2 ] || fail "info hot.vdb: exit $code"
grep -q "grid 'temperature'" out || fail "info hot.vdb: no list"
grep -q 'no grid that is a density by its name: there are .*"temperature" (float)' err || fail "info hot.vdb: $(cat err)"
refuses 2 "no grid that is a density" render hot.vdb -o hot.exr

# a scene
scene "$density, $hot" >fire.gltf
works info fire.gltf --quiet
grep -q "black bodies of colours 0" out || fail "info fire.gltf: $(cat out)"
grep -q "media that emit 100 %" out || fail "info fire.gltf: no emission: $(cat out)"
scene "$density, \"temperature\": { \"uri\": \"fire.vdb\" }" >cold.gltf
run info cold.gltf
grep -q "nothing is hot enough to glow" err || fail "info cold.gltf: $(cat err)"
scene "$density, \"temperatur\": 1" >odd.gltf
run info odd.gltf
grep -q "temperatur: not known and left out; known here: .* temperature emission_density albedo" err ||
    fail "info odd.gltf: $(cat err)"
for wrong in '"temperature": { "uri": "fire.vdb", "grid": "vel" }|holds vec3s values' \
    '"albedo": { "uri": "fire.vdb", "grid": "Cs" }|no grid "Cs": there are' \
    '"temperature": 3|must be an object' \
    '"temperature": { "uri": "fire.vdb", "strength": -1 }|a number >= 0'; do
    scene "$density, ${wrong%|*}" >wrong.gltf
    refuses 2 "${wrong#*|}" info wrong.gltf
done

if ! "$tool" info --devices 2>/dev/null | grep -q usable; then
    echo "skipped: the pictures (no Vulkan device)"
    finish
fi
scene "$density, $hot, \"albedo\": { \"uri\": \"fire.vdb\" }" >all.gltf
works render all.gltf -o path.exr --method path --spp 256 --size 32x48 --quiet
works render all.gltf -o pop.exr --method pop --size 32x48 --quiet
works compare pop.exr path.exr --block 8
echo "pop against path: $(value rel_l1)"
near "$(value rel_l1)" 0 0.12 "pop against path"
finish
