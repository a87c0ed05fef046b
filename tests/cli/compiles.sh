#!/bin/sh
# compiles.sh -- a camera that moves makes the driver compile nothing: lavapipe compiles a kernel anew for every value
# of uniform buffers that its branches depend on, which takes longer than the frame. Told by the driver's cache of
# shaders, a file a kernel; where that stays empty, or is a database, nothing is told.
. "$(dirname "$0")/lib.sh"

needs_device

compiled() {
    find "$work/shaders" ! -type d ! -name index 2>/dev/null | wc -l
}

# What is compiled for the first of such frames may be compiled.
for scene in smoke-sky room fog-hall; do
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1.1,1.2,0.9 --look-at 2,1.5,0.5 --fov 40 -o a.exr
done
# A cache of this test's own, of links to what is there: Mesa replaces files, and writes only its index.
cp -rs "$MESA_SHADER_CACHE_DIR" "$work/shaders"
find "$work/shaders" -name index -delete
export MESA_SHADER_CACHE_DIR="$work/shaders"
if [ "$(compiled)" = 0 ] || [ -n "$(find "$work/shaders" -name '*.db')" ]; then
    echo "skipped: all cases (the driver keeps no cache with a file a kernel)"
    exit 77
fi
# Another place where the camera is, where it looks, and how wide, and a frame from beside it.
for scene in smoke-sky room fog-hall; do
    before=$(compiled)
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1.2,1.4,0.8 --look-at 1.9,1,0.4 --fov 55 -o a.exr \
        --frames 2 --change camera --stats s.json
    near "$(get s.json frame_ms.camera_moved)" 0 1e5 "$scene: a frame from beside"
    [ "$(compiled)" = "$before" ] || fail "$scene: $(($(compiled) - before)) kernels compiled as the camera moved"
done

finish
