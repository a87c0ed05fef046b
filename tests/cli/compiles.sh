#!/bin/sh
# compiles.sh -- a camera that moves makes the driver compile nothing: lavapipe compiles a kernel anew for every value
# of uniform buffers that its branches depend on, which takes longer than the frame. Told by the driver's cache of
# shaders, a file a kernel; where that stays empty, or is a database, nothing is told.
. "$(dirname "$0")/lib.sh"

needs_device
# What other tests have had compiled need not be compiled again here.
mkdir -p "$MESA_SHADER_CACHE_DIR"
cp -r "$MESA_SHADER_CACHE_DIR" "$work/shaders"
export MESA_SHADER_CACHE_DIR="$work/shaders"

compiled() {
    find "$work/shaders" -type f ! -name index 2>/dev/null | wc -l
}

for scene in smoke-sky room fog-hall; do
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1,1,1 --look-at 2,1.5,0.5 -o a.exr
    if [ "$(compiled)" = 0 ] || [ -n "$(find "$work/shaders" -name '*.db')" ]; then
        echo "skipped: all cases (the driver keeps no cache with a file a kernel)"
        exit 77
    fi
    # Another place where the camera is, where it looks, and how wide: what is compiled for the first of such frames
    # may be compiled.
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1.1,1.2,0.9 --look-at 2,1.5,0.5 --fov 40 -o a.exr
    before=$(compiled)
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1.2,1.4,0.8 --look-at 1.9,1,0.4 --fov 55 -o a.exr
    works render "$scenes/$scene.gltf" --size 32x32 --quiet --look-from 1.4,1.3,1.1 --look-at 1.8,1,0.9 --fov 50 -o a.exr
    [ "$(compiled)" = "$before" ] || fail "$scene: $(($(compiled) - before)) kernels compiled as the camera moved"
done

finish
