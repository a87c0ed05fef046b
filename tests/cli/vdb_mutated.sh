#!/bin/sh
# vdb_mutated.sh -- OpenVDB files with bytes changed, 200 and more: none is read for ever or takes all memory. No GPU.
. "$(dirname "$0")/lib.sh"
convert=$5

# half of the voxels are not 0, in several leaves: compressed with Blosc and by masks, as OpenVDB writes them
awk 'BEGIN { n = 24; for (z = 0; z < n; z++) for (y = 0; y < n; y++) for (x = 0; x < n; x++)
    printf "%c", (x % (n - 1) && y % (n - 1) && z % (n - 1) && (x + y + z) % 2) ? 65 + (x * 7 + y * 5 + z) % 50 : 32 }' |
    tr ' ' '\000' >density.raw
"$convert" density.raw 24 24 24 u8 density.vdb || fail "raw_to_vdb: exit $?"
works info density.vdb
"$helpers/vdb_mutate" density.vdb 160 >list || fail "$(grep FAILED list)"
tail -1 list
"$helpers/fire_make" fire.vdb hot.vdb || fail "fire_make: exit $?"
"$helpers/vdb_mutate" fire.vdb 160 >list || fail "$(grep FAILED list)" # vectors, and several grids
tail -1 list
shared=${TYN_SHARED:-$source/../shared}/data/smoke.vdb
if [ -e "$shared" ]; then
    "$helpers/vdb_mutate" "$shared" 80 >list || fail "$(grep FAILED list)"
    tail -1 list
else
    echo "skipped: an older file, of half floats and zlib (no data/smoke.vdb)"
fi
finish
