#!/bin/sh
# lit_particles.sh -- samples/embed/lit_particles, built in a clean folder by its own meson.build against an installed copy: its
# grains and balls are as bright as what `tyndall probe` says of the light at their places makes them.
. "$(dirname "$0")/lib.sh"
scenes=$(cd "$scenes" && pwd)
DESTDIR=$work/installed meson install -C "$helpers/../.." --no-rebuild >log 2>&1 || {
    cat log
    fail "meson install failed"
    finish
}
pc=$work/$(dirname "$(find installed -name tyndall-io.pc)")
prefix=$work/installed$(sed -n 's/^prefix=//p' "$pc/tyndall.pc")
sed -i "s|^prefix=.*|prefix=$prefix|" "$pc"/*.pc
LD_LIBRARY_PATH=$(dirname "$pc")
export LD_LIBRARY_PATH PKG_CONFIG_PATH="$pc"
unset CC CXX
cp -r "$prefix/share/tyndall/samples/embed" sample
meson setup lit sample/lit_particles --werror >log 2>&1 && ninja -C lit >>log 2>&1 || {
    cat log
    fail "samples/embed/lit_particles does not build"
    finish
}
needs_device
HOST_VALIDATION=1 lit/lit-particles "$scenes/two-media.gltf" lit.png lit.csv 2>err || fail "lit-particles exits $?: $(cat err)"
[ -s lit.png ] || fail "there is no picture"
grains=$(awk -F, 'NR > 1 && $10 < 2' lit.csv | wc -l) balls=$(awk -F, '$10 == 2' lit.csv | wc -l)
[ "$grains" -ge 100 ] && [ "$balls" -ge 4 ] || fail "only $grains grains and $balls balls are seen"

# What is off on average, of the mean brightness, of grains and of balls: lobes and diffuse surfaces in the radiance
# (fluence + 3 w . flux) / (4 pi), as tyndall/light.glsl has it.
judge() {
    cut -d, -f1-3 lit.csv >points.csv
    tool=$prefix/bin/tyndall
    works probe "$scenes/two-media.gltf" --points points.csv -q "$@"
    awk -F, 'NR == FNR { for (i = 4; i <= 15; i++) probe[FNR, i] = $i; next }
        FNR > 1 {
            for (c = 0; c < 3; c++) {
                fluence = probe[FNR, 4 + c]
                along = probe[FNR, 7 + c] * $4 + probe[FNR, 10 + c] * $5 + probe[FNR, 13 + c] * $6
                if ($10 == 2) right = $(7 + c) / 3.14159265 * (fluence / 4 - along / 2)
                else right = $(7 + c) * (fluence + 3 * $10 * along) / 12.5663706
                if (right < 0) right = 0
                off = $(11 + c) - right
                wrong[$10 == 2] += off < 0 ? -off : off
                all[$10 == 2] += right
            }
        }
        END { print "grains", wrong[0] / all[0]; print "balls", wrong[1] / all[1] }' out lit.csv >judged
    mv judged out
    echo "$*: $(tr '\n' ' ' <out)"
}
# The images have 32 texels along each side: the rest is what lies between them.
judge -m pop
near "$(value grains)" 0.0034 0.003 "grains against the probe of pop"
near "$(value balls)" 0.0032 0.003 "balls against the probe of pop"
judge -m path --spp 1024
near "$(value grains)" 0.048 0.02 "grains against path"
near "$(value balls)" 0.04 0.02 "balls against path"
finish
