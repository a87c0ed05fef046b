#!/bin/sh
# flip_values.sh -- flip and hdr_flip of `tyndall compare` against what the authors' program gives the same pictures
# (../shared/data/flip; skipped where absent). No GPU.
. "$(dirname "$0")/lib.sh"

data=${TYN_SHARED:-$source/../shared}/data/flip
if [ ! -r "$data/values.csv" ]; then
    echo "skipped: all cases (no shared data: data/flip)"
    exit 77
fi

tail -n +2 "$data/values.csv" >values
pairs=0
while IFS=, read -r reference image ldr hdr; do
    works compare "$data/$image.png" "$data/$reference.png"
    png=$(value flip)
    near "$png" "$ldr" 1e-4 "flip of $image.png"
    works compare "$data/$image.exr" "$data/$reference.exr" --hdr-flip --exposures -3,3,4
    # The .png files are the .exr files after the tone map, in 8 bits.
    near "$(value flip)" "$ldr" 1e-4 "flip of $image.exr"
    near "$(value hdr_flip)" "$hdr" 1e-4 "hdr_flip of $image.exr"
    echo "$image: flip $png (png), $(value flip) (exr), expected $ldr; hdr_flip $(value hdr_flip), expected $hdr"
    pairs=$((pairs + 1))
done <values
[ "$pairs" -ge 6 ] || fail "only $pairs pairs in $data/values.csv"

finish
