// atlas.c -- all grids of densities in one 3D texture, and all grids of colours in another (emission, radiance of black
// bodies, albedo), so that shaders need no descriptor indexing.
#include "frame/frame_scene.h"
#include "base/half.h"
#include <tyndall/extend/hash.h>
#include <math.h>
#include <string.h>

// A grid in either texture.
typedef struct stacked {
    const uint32_t *size;
    const float *data; // NULL: the host's
    uint32_t channels;
    float most;
    uint64_t hash; // of data; 0: not known
} stacked;

static uint32_t count_of(const tyn_scene *scene, bool colors)
{
    return colors ? scene->num_color_grids : scene->num_volumes;
}

static stacked grid_at(const tyn_scene *scene, bool colors, uint32_t index)
{
    if (colors) {
        const tyn_color_grid *c = &scene->color_grids[index];
        return (stacked){c->size, c->data, c->channels, c->max, c->hash};
    }
    const tyn_volume *v = &scene->volumes[index];
    return (stacked){v->size, v->data, 1, v->max_density, v->hash};
}

static uint32_t first_layer(const tyn_scene *scene, bool colors, uint32_t index)
{
    uint32_t z = 0;
    for (uint32_t i = 0; i < index; i++) {
        z += grid_at(scene, colors, i).size[2];
    }
    return z;
}

uint32_t tyn_atlas_offset(const tyn_scene *scene, int32_t volume)
{
    return first_layer(scene, false, volume < 0 ? scene->num_volumes : (uint32_t)volume);
}

struct shape_colors tyn_colors_place(const tyn_scene *scene, uint32_t slot)
{
    struct shape_colors c = {{0}, 0, 0};
    const tyn_color_grid *grid = slot ? &scene->color_grids[slot - 1] : NULL;
    if (grid && grid->max > 0) {
        memcpy(c.size, grid->size, sizeof c.size);
        c.layer = first_layer(scene, true, slot - 1);
        c.scale = grid->max;
    }
    return c;
}

static void stack(tyn_atlas *atlas, const tyn_scene *scene, bool colors)
{
    *atlas = (tyn_atlas){.scene = scene, .colors = colors, .extent = {1, 1, 0}, .half = true};
    for (uint32_t i = 0; i < count_of(scene, colors); i++) {
        const stacked g = grid_at(scene, colors, i);
        atlas->host |= !g.data;
        atlas->extent.x = g.size[0] > atlas->extent.x ? g.size[0] : atlas->extent.x;
        atlas->extent.y = g.size[1] > atlas->extent.y ? g.size[1] : atlas->extent.y;
        atlas->extent.z += g.size[2];
        // Half floats keep 11 bits: enough unless values leave their range. Colours are over the grid's largest.
        atlas->half &= colors || (g.most >= 0.015625f && g.most <= 60000.0f);
    }
}

void tyn_colors_plan(tyn_atlas *colors, const tyn_scene *scene)
{
    stack(colors, scene, true);
}

tyn_result tyn_atlas_plan(tyn_atlas *atlas, const tyn_scene *scene, const tyn_log *log)
{
    bool homogeneous = scene->num_volumes == 0;
    for (uint32_t i = 0; i < scene->num_media; i++) {
        homogeneous |= scene->media[i].volume < 0;
    }
    stack(atlas, scene, false);
    atlas->extent.z += homogeneous ? 1 : 0;
    if (atlas->host && (scene->num_volumes != 1 || homogeneous)) {
        return TYN_FAULT(
            log, TYN_ERR_UNSUPPORTED,
            "a host's density image must be the scene's only volume, and no medium may be "
            "homogeneous; the scene has %u volumes",
            scene->num_volumes);
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

// Densities of a row; or colours over the grid's largest, so that half floats hold them whatever their unit.
static void fill_row(const tyn_atlas *atlas, const stacked *g, const float *value, void *texels,
                     size_t at)
{
    const float scale = g->most > 0 ? g->most : INFINITY;
    for (uint32_t x = 0; !atlas->colors && x < g->size[0]; x++) {
        put(atlas, texels, at + x, value[x]);
    }
    for (uint32_t i = 0; atlas->colors && i < 3 * g->size[0]; i++) {
        const uint32_t x = i / 3, c = i % 3;
        const float v = value[g->channels == 3 ? i : x];
        put(atlas, texels, at + 4 * (size_t)x + c, v / scale);
    }
}

static void fill_grid(const tyn_atlas *atlas, const stacked *g, uint32_t z0, void *texels)
{
    const tyn_extent e = atlas->extent;
    const size_t width = atlas->colors ? 4 : 1;
    const float *value = g->data;
    for (uint32_t row = 0; row < g->size[1] * g->size[2]; row++) {
        const uint32_t y = row % g->size[1], z = z0 + row / g->size[1];
        fill_row(atlas, g, value, texels, ((size_t)z * e.y + y) * e.x * width);
        value += (size_t)g->size[0] * g->channels;
    }
}

void tyn_atlas_fill(void *user, void *texels)
{
    const tyn_atlas *atlas = user;
    const tyn_extent e = atlas->extent;
    memset(texels, 0, (size_t)e.x * e.y * e.z * (atlas->colors ? 4 : 1) * (atlas->half ? 2 : 4));
    uint32_t z = 0;
    for (uint32_t i = 0; i < count_of(atlas->scene, atlas->colors); i++) {
        const stacked g = grid_at(atlas->scene, atlas->colors, i);
        fill_grid(atlas, &g, z, texels);
        z += g.size[2];
    }
    if (z < e.z) {
        put(atlas, texels, (size_t)z * e.y * e.x, 1.0f);
    }
}

uint64_t tyn_atlas_hash(const tyn_atlas *atlas)
{
    uint64_t h = tyn_hash_bytes(TYN_HASH_SEED, &atlas->extent, sizeof atlas->extent);
    for (uint32_t i = 0; i < count_of(atlas->scene, atlas->colors); i++) {
        const stacked g = grid_at(atlas->scene, atlas->colors, i);
        const size_t count = (size_t)g.size[0] * g.size[1] * g.size[2] * g.channels;
        h = tyn_hash_bytes(h, g.size, 3 * sizeof *g.size);
        h = tyn_hash_u64(h, g.channels);
        h = tyn_hash_bytes(h, &g.most, sizeof g.most);
        h = tyn_hash_u64(h, g.hash   ? g.hash
                            : g.data ? tyn_hash_bytes(TYN_HASH_SEED, g.data, count * sizeof(float))
                                     : 1);
    }
    return h;
}
