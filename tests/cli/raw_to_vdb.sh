#!/bin/sh
# raw_to_vdb.sh -- a density as .vdb, made for Blender, is where and what it is as .raw.
. "$(dirname "$0")/lib.sh"
convert=$5

needs_device
# 5x4x4 voxels, x fastest, 0 at the faces of the box
{
    printf '\000%.0s' $(seq 25)
    printf '\000\377\100\010\000\000\040\200\377\000'
    printf '\000%.0s' $(seq 10)
    printf '\000\020\377\001\000\000\300\000\060\000'
    printf '\000%.0s' $(seq 25)
} >density.raw
[ "$(wc -c <density.raw)" = 80 ] || fail "the test's density has $(wc -c <density.raw) bytes"
# the voxels within, as a grid of their own: a .vdb reaches as far as its voxels that are not 0
printf '\377\100\010\040\200\377\020\377\001\300\000\060' >within.raw
scene() { # DENSITY SHAPE SCALE
    cat <<END2
{ "asset": { "version": "2.0" }, "extensionsUsed": [ "TYN_participating_media", "KHR_lights_punctual" ], "scene": 0, "scenes": [ { "nodes": [ 0, 1, 2 ] } ],
  "nodes": [ { "scale": [ $3 ], "extensions": { "TYN_participating_media": { "medium": 0, "shape": "$2" } } },
             { "rotation": [ -0.6, 0.2, 0, 0.7745967 ], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
             { "translation": [ 0, 0, 4 ], "camera": 0 } ],
  "cameras": [ { "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.1 } } ],
  "extensions": { "KHR_lights_punctual": { "lights": [ { "type": "directional" } ] },
    "TYN_participating_media": { "media": [ { "scattering": 5, "absorption": 1, "density": { $1 } } ] } } }
END2
}
scene '"uri": "within.raw", "size": [3, 2, 2], "type": "u8"' box "1.2, 0.5, 0.75" >raw.gltf
scene '"uri": "density.vdb"' grid "2, 1, 1.5" >vdb.gltf
"$convert" density.raw 5 4 4 u8 density.vdb || fail "raw_to_vdb: exit $?"
for kind in raw vdb; do
    works render $kind.gltf -o $kind.exr --method single --size 48x48 --no-background --quiet
done
works compare vdb.exr raw.exr
awk -v e="$(value rel_l1)" 'BEGIN { exit !(e != "" && e <= 1e-3) }' || fail "raw_to_vdb: the pictures differ by $(value rel_l1)"

# what a reader of .vdb would go over to 0 from is refused, and so is a file that is not so large
refuses_raw() { # WORDS ARGUMENTS
    words=$1
    shift
    "$convert" "$@" >out 2>err && fail "raw_to_vdb $*: no fault"
    grep -q "$words" err && [ "$(wc -l <err)" = 1 ] || fail "raw_to_vdb $*: no '$words': $(cat err)"
}
printf '\001%.0s' $(seq 80) >full.raw
refuses_raw "its voxels at the faces of the box are not all 0" full.raw 5 4 4 u8 none.vdb
refuses_raw "has 80 bytes, not 100" density.raw 5 5 4 u8 none.vdb
refuses_raw "the type must be" density.raw 5 4 4 u9 none.vdb
refuses_raw "must be above 0" density.raw 5 0 4 u8 none.vdb
refuses_raw "usage" density.raw
[ -e none.vdb ] && fail "raw_to_vdb: wrote a grid all the same"

finish
