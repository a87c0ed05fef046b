// surfaces.c -- mip chains of textures, made when surfaces change.
#include "frame/surfaces.h"
#include "frame/surface_most.h"
#include "frame/surface_tables.h"
#include "frame/shadow_cull.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

// The scene's arrays are uploaded as they are.
static_assert(sizeof(tyn_surface_vertex) == sizeof(struct surface_vertex), "vertex");
static_assert(offsetof(tyn_surface_vertex, normal) == offsetof(struct surface_vertex, normal), "");
static_assert(sizeof(tyn_surface_triangle) == sizeof(struct surface_triangle), "triangle");
static_assert(sizeof(tyn_surface_material) == sizeof(struct surface_material), "material");
static_assert(offsetof(tyn_surface_material, emission) ==
                  offsetof(struct surface_material, emission),
              "");
static_assert(TYN_NO_TEXTURE == TYN_SURFACE_NO_TEXTURE, "texture");
static_assert(TYN_SURFACE_EMITS_BOTH_SIDES == TYN_SURFACE_DOUBLE_SIDED, "flags");
static_assert(sizeof(tyn_surface_node) == sizeof(struct surface_node), "node");
static_assert(TYN_SURFACE_MAX_DEPTH == TYN_SURFACE_STACK, "depth");

// ---- mip chains -------------------------------------------------------------------------------

static uint32_t level_side(uint32_t side, uint32_t level)
{
    return side >> level ? side >> level : 1;
}

static uint32_t level_count(const uint32_t size[2])
{
    uint32_t longest = size[0] > size[1] ? size[0] : size[1], levels = 1;
    while (longest >>= 1) {
        levels++;
    }
    return levels;
}

static void decode_table(float linear[256])
{
    for (int i = 0; i < 256; i++) {
        float v = (float)i / 255.0f;
        linear[i] = v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
    }
}

// The 8-bit sRGB value next to a linear one: bisection in the table.
static uint32_t encode(const float linear[256], float v)
{
    uint32_t lo = 0, hi = 255;
    while (lo < hi) {
        uint32_t mid = (lo + hi) / 2;
        if (0.5f * (linear[mid] + linear[mid + 1]) < v) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return lo;
}

// Halves a level: the area average of linear values, sides of any parity. Every texel of the next level covers
// from / to of this one along each axis.
static void halve(uint32_t *to, const uint32_t to_size[2], const uint32_t *from,
                  const uint32_t from_size[2], const float linear[256])
{
    const float scale[2] = {(float)from_size[0] / (float)to_size[0],
                            (float)from_size[1] / (float)to_size[1]};
    for (uint32_t y = 0; y < to_size[1]; y++) {
        const float y0 = (float)y * scale[1], y1 = y0 + scale[1];
        for (uint32_t x = 0; x < to_size[0]; x++) {
            const float x0 = (float)x * scale[0], x1 = x0 + scale[0];
            float sum[4] = {0}, weight = 0;
            for (uint32_t j = (uint32_t)y0; j < from_size[1] && (float)j < y1; j++) {
                float wy = fminf(y1, (float)j + 1) - fmaxf(y0, (float)j);
                for (uint32_t i = (uint32_t)x0; i < from_size[0] && (float)i < x1; i++) {
                    float w = wy * (fminf(x1, (float)i + 1) - fmaxf(x0, (float)i));
                    uint32_t texel = from[(size_t)j * from_size[0] + i];
                    for (int c = 0; c < 3; c++) {
                        sum[c] += w * linear[texel >> (8 * c) & 255];
                    }
                    sum[3] += w * (float)(texel >> 24);
                    weight += w;
                }
            }
            uint32_t texel = (uint32_t)(sum[3] / weight + 0.5f) << 24;
            for (int c = 0; c < 3; c++) {
                texel |= encode(linear, sum[c] / weight) << (8 * c);
            }
            to[(size_t)y * to_size[0] + x] = texel;
        }
    }
}

static void fill_chain(uint32_t *texels, const tyn_texture *t, const float linear[256])
{
    size_t count = (size_t)t->size[0] * t->size[1];
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = t->texels + 4 * i;
        texels[i] =
            (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
    for (uint32_t level = 1; level < level_count(t->size); level++) {
        const uint32_t from[2] = {level_side(t->size[0], level - 1),
                                  level_side(t->size[1], level - 1)};
        const uint32_t to[2] = {level_side(t->size[0], level), level_side(t->size[1], level)};
        uint32_t *next = texels + (size_t)from[0] * from[1];
        halve(next, to, texels, from, linear);
        texels = next;
    }
}

static tyn_result build_textures(tyn_surface_data *data, const tyn_surfaces *s, const tyn_log *log)
{
    size_t total = 0;
    data->num_textures = s->num_textures ? s->num_textures : 1;
    data->textures = calloc(data->num_textures, sizeof *data->textures);
    for (uint32_t i = 0; data->textures && i < s->num_textures; i++) {
        struct surface_texture *to = &data->textures[i];
        const tyn_texture *from = &s->textures[i];
        to->first = (uint32_t)total;
        to->levels = level_count(from->size);
        for (int a = 0; a < 2; a++) {
            to->size[a] = from->size[a];
            to->wrap[a] = (tyn_uint)from->wrap[a];
        }
        for (uint32_t l = 0; l < to->levels; l++) {
            total += (size_t)level_side(to->size[0], l) * level_side(to->size[1], l);
        }
        if (total > UINT32_MAX / 4) {
            return TYN_FAULT(
                log, TYN_ERR_UNSUPPORTED,
                "surfaces.textures[%u]: the textures up to this one take %.1f GiB; at most "
                "4 are possible",
                i, (double)total * 4 / (1u << 30));
        }
    }
    data->num_texels = total ? total : 1;
    data->texels = calloc(data->num_texels, sizeof *data->texels);
    if (!data->textures || !data->texels) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for %zu texels of textures", total);
    }
    float linear[256];
    decode_table(linear);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        fill_chain(data->texels + data->textures[i].first, &s->textures[i], linear);
    }
    return TYN_OK;
}

// ---- all --------------------------------------------------------------------------------------

void tyn_surface_data_finish(tyn_surface_data *data)
{
    free(data->textures);
    free(data->texels);
    free(data->below);
    free(data->seen);
    free(data->emitters);
    free(data->areas);
    memset(data, 0, sizeof *data);
}

tyn_result tyn_surface_data_update(tyn_surface_data *data, const tyn_surfaces *surfaces,
                                   const tyn_log *log)
{
    uint64_t hash = tyn_surfaces_hash(surfaces);
    if (hash == data->hash && (!hash || surfaces->num_nodes == data->num_nodes)) {
        return TYN_OK;
    }
    tyn_surface_data_finish(data);
    tyn_result result = hash ? tyn_surfaces_check(surfaces, log) : TYN_OK;
    if (hash && result == TYN_OK) {
        result = build_textures(data, surfaces, log);
    }
    if (hash && result == TYN_OK && surfaces->num_nodes) {
        data->num_nodes = surfaces->num_nodes;
        data->below = tyn_views_prepare(surfaces);
        data->seen = calloc(1, sizeof *data->seen);
        if (!data->below || !data->seen) {
            result = TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for %u nodes", surfaces->num_nodes);
        }
    }
    if (result != TYN_OK) {
        tyn_surface_data_finish(data);
        return result;
    }
    tyn_surfaces_bounds(surfaces, data->lo, data->hi);
    if (hash && !tyn_surfaces_most(surfaces, data->most_lo, data->most_hi)) {
        tyn_surface_data_finish(data);
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory for the surfaces");
    }
    data->leaf.count = surfaces->num_triangles;
    memcpy(data->leaf.lo, data->lo, sizeof data->leaf.lo);
    memcpy(data->leaf.hi, data->hi, sizeof data->leaf.hi);
    data->hash = hash;
    return TYN_OK;
}

// Once for the same surfaces.
static tyn_result make_table(const tyn_surface_data *data, const tyn_surfaces *surfaces,
                             tyn_surface_table_kind kind, bool *made, void **table, size_t *size)
{
    *made = *made || (data->hash && tyn_surface_table_build(surfaces, kind, table, size));
    return *made || !data->hash ? TYN_OK : TYN_ERR_MEMORY;
}

tyn_result tyn_surface_data_tables(tyn_surface_data *data, const tyn_surfaces *surfaces, bool areas)
{
    const tyn_result result = make_table(data, surfaces, TYN_SURFACE_EMITTERS, &data->has_emitters,
                                         &data->emitters, &data->emitters_size);
    return result || !areas ? result
                            : make_table(data, surfaces, TYN_SURFACE_AREAS, &data->has_areas,
                                         &data->areas, &data->areas_size);
}
