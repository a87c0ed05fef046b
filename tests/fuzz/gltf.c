// gltf.c -- libFuzzer harness: glTF scenes, text or binary. Files that they name are not there.
#include "io/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const tyn_moment moment = {true, true, 7, 0.3};
    tyn_scene scene;
    tyn_scene_init(&scene);
    if (tyn_gltf_parse(&scene, data, size, "/nowhere/fuzz.gltf", NULL, &moment, NULL) == TYN_OK) {
        tyn_scene_finish(&scene);
    }
    return 0;
}
