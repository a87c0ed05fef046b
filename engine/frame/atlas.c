// atlas.c -- all density grids in one 3D texture, so that shaders need no descriptor indexing.
#include "frame/frame_scene.h"
#include "base/half.h"
#include <tyndall/extend/hash.h>
#include <string.h>

uint32_t tyn_atlas_offset(const tyn_scene *scene, int32_t volume)
{
    uint32_t z = 0;
    uint32_t end = volume < 0 ? scene->num_volumes : (uint32_t)volume;
    for (uint32_t i = 0; i < end; i++) {
        z += scene->volumes[i].size[2];
    }
    return z;
}

tyn_result tyn_atlas_plan(tyn_atlas *atlas, const tyn_scene *scene, const tyn_log *log)
{
    *atlas = (tyn_atlas){.extent = {1, 1, 0}};
    bool homogeneous = scene->num_volumes == 0;
    for (uint32_t i = 0; i < scene->num_media; i++) {
        homogeneous |= scene->media[i].volume < 0;
    }
    // Half floats keep 11 bits: enough unless values leave their range.
    atlas->half = true;
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        if (!v->data) {
            atlas->host = true;
        }
        atlas->extent.x = v->size[0] > atlas->extent.x ? v->size[0] : atlas->extent.x;
        atlas->extent.y = v->size[1] > atlas->extent.y ? v->size[1] : atlas->extent.y;
        atlas->extent.z += v->size[2];
        atlas->half &= v->max_density >= 0.015625f && v->max_density <= 60000.0f;
    }
    atlas->extent.z += homogeneous ? 1 : 0;
    if (atlas->host && (scene->num_volumes != 1 || homogeneous)) {
        tyn_log_print(
            log, TYN_LOG_ERROR,
            "a host's density image must be the scene's only volume, and no medium may be "
            "homogeneous; the scene has %u volumes",
            scene->num_volumes);
        return TYN_ERR_UNSUPPORTED;
    }
    return TYN_OK;
}

static void put(const tyn_atlas *atlas, void *texels, size_t index, float value)
{
    if (atlas->half) {
        ((uint16_t *)texels)[index] = tyn_half_from_float(value);
    } else {
        ((float *)texels)[index] = value;
    }
}

void tyn_atlas_fill(const tyn_atlas *atlas, const tyn_scene *scene, void *texels)
{
    const tyn_extent e = atlas->extent;
    memset(texels, 0, (size_t)e.x * e.y * e.z * (atlas->half ? 2 : 4));
    uint32_t z0 = 0;
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        const float *value = v->data;
        for (uint32_t z = 0; z < v->size[2]; z++) {
            for (uint32_t y = 0; y < v->size[1]; y++) {
                size_t row = ((size_t)(z0 + z) * e.y + y) * e.x;
                for (uint32_t x = 0; x < v->size[0]; x++) {
                    put(atlas, texels, row + x, *value++);
                }
            }
        }
        z0 += v->size[2];
    }
    if (z0 < e.z) {
        put(atlas, texels, (size_t)z0 * e.y * e.x, 1.0f);
    }
}

uint64_t tyn_atlas_hash(const tyn_atlas *atlas, const tyn_scene *scene)
{
    uint64_t h = tyn_hash_bytes(TYN_HASH_SEED, &atlas->extent, sizeof atlas->extent);
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const tyn_volume *v = &scene->volumes[i];
        h = tyn_hash_bytes(h, v->size, sizeof v->size);
        h = tyn_hash_bytes(h, &v->max_density, sizeof v->max_density);
        size_t count = (size_t)v->size[0] * v->size[1] * v->size[2];
        h = tyn_hash_u64(h, v->hash ? v->hash
                            : v->data
                                ? tyn_hash_bytes(TYN_HASH_SEED, v->data, count * sizeof(float))
                                : 1);
    }
    return h;
}
