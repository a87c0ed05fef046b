// colors.c -- all grids of colours in one 3D texture: emission, radiance of black bodies, albedo.
#include "frame/frame_scene.h"
#include "base/half.h"
#include <tyndall/extend/hash.h>
#include <string.h>

void tyn_colors_plan(tyn_atlas *colors, const tyn_scene *scene)
{
    *colors = (tyn_atlas){.half = true};
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const uint32_t *n = scene->color_grids[i].size;
        colors->extent.x = n[0] > colors->extent.x ? n[0] : colors->extent.x;
        colors->extent.y = n[1] > colors->extent.y ? n[1] : colors->extent.y;
        colors->extent.z += n[2];
    }
}

static uint32_t first_layer(const tyn_scene *scene, uint32_t grid)
{
    uint32_t z = 0;
    for (uint32_t i = 0; i < grid; i++) {
        z += scene->color_grids[i].size[2];
    }
    return z;
}

struct shape_colors tyn_colors_place(const tyn_scene *scene, uint32_t slot)
{
    struct shape_colors c = {{0}, 0, 0};
    const tyn_color_grid *grid = slot ? &scene->color_grids[slot - 1] : NULL;
    if (grid && grid->max > 0) {
        memcpy(c.size, grid->size, sizeof c.size);
        c.layer = first_layer(scene, slot - 1);
        c.scale = grid->max;
    }
    return c;
}

// Values are over the grid's largest, so that half floats hold them whatever their unit.
void tyn_colors_fill(const tyn_atlas *colors, const tyn_scene *scene, void *texels)
{
    const tyn_extent e = colors->extent;
    memset(texels, 0, (size_t)e.x * e.y * e.z * 4 * (colors->half ? 2 : 4));
    uint32_t z0 = 0;
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const tyn_color_grid *grid = &scene->color_grids[i];
        const float *value = grid->data;
        for (uint32_t row = 0; row < grid->size[1] * grid->size[2]; row++) {
            const uint32_t y = row % grid->size[1], z = z0 + row / grid->size[1];
            size_t at = ((size_t)z * e.y + y) * e.x * 4;
            for (uint32_t x = 0; x < grid->size[0]; x++, at += 4, value += grid->channels) {
                for (uint32_t c = 0; c < 3; c++) {
                    const float v = value[grid->channels == 3 ? c : 0];
                    const float part = grid->max > 0 ? v / grid->max : 0;
                    if (colors->half) {
                        ((uint16_t *)texels)[at + c] = tyn_half_from_float(part);
                    } else {
                        ((float *)texels)[at + c] = part;
                    }
                }
            }
        }
        z0 += grid->size[2];
    }
}

uint64_t tyn_colors_hash(const tyn_scene *scene)
{
    uint64_t h = TYN_HASH_SEED;
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const tyn_color_grid *grid = &scene->color_grids[i];
        const size_t count = (size_t)grid->size[0] * grid->size[1] * grid->size[2] * grid->channels;
        h = tyn_hash_bytes(h, grid->size, sizeof grid->size);
        h = tyn_hash_u64(h, grid->channels);
        h = tyn_hash_bytes(h, &grid->max, sizeof grid->max);
        h = tyn_hash_u64(h, grid->hash
                                ? grid->hash
                                : tyn_hash_bytes(TYN_HASH_SEED, grid->data, count * sizeof(float)));
    }
    return h;
}
