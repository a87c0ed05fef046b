#!/bin/sh
# exposure.sh -- lines where a picture is clipped or nothing shines, --exposure auto, --tonemap.
. "$(dirname "$0")/lib.sh"
needs_device

small="--size 48x48 --quality draft"
# shellcheck disable=SC2086
{
    sed 's/"intensity": *[0-9.]*/"intensity": 6830/' "$scenes/cube.gltf" >bright.gltf
    grep -q 6830 bright.gltf || fail "cube.gltf has no intensity"
    works render bright.gltf $small -o white.png
    grep -q "warning: [0-9]* % of the picture is clipped, try --exposure -[0-9]*" err || fail "clipped: $(cat err)"
    ev=$(sed -n 's/.*--exposure \(-[0-9]*\).*/\1/p' err | head -1)
    works render bright.gltf $small -o seen.png --exposure "$ev"
    grep -q clipped err && fail "clipped also at what was advised: $(cat err)"
    works render bright.gltf $small -o auto.png --exposure auto
    grep -q -- "--exposure -" err && ! grep -q clipped err || fail "--exposure auto: $(cat err)"
    works compare auto.png seen.png
    awk -v f="$(value flip)" 'BEGIN { exit !(f < 0.25) }' || fail "--exposure auto is far from what is advised: $(value flip)"
    works compare white.png seen.png
    awk -v f="$(value flip)" 'BEGIN { exit !(f > 0.25) }' || fail "the clipped picture is like the other: $(value flip)"
    works render bright.gltf $small -o linear.png --exposure "$ev" --tonemap linear
    works render bright.gltf $small -o set.png --exposure "$ev" -D tonemap.curve=linear
    cmp -s linear.png set.png || fail "--tonemap linear is not tonemap.curve=linear"
    cmp -s linear.png seen.png && fail "--tonemap linear changed nothing"
    works render "$scenes/cube.gltf" $small -o cube.png
    grep -q "clipped\|shines" err && fail "a fair picture: $(cat err)"
    sed 's/"intensity": *[0-9.]*/"intensity": 0/' "$scenes/cube.gltf" >dark.gltf
    works render dark.gltf $small -o dark.png
    grep -q "warning: nothing in the scene shines" err || fail "a dark scene: $(cat err)"
}
finish
