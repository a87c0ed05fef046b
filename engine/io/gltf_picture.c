// gltf_picture.c -- a texture as it is asked over areas: least and largest values and means, by a pyramid.
#include "io/gltf_picture.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

double tyn_gltf_light_of(double srgb)
{
    return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

static uint32_t side(const gltf_picture *p, int axis, uint32_t level)
{
    return (p->texture.size[axis] + (1u << level) - 1) >> level;
}

static gltf_picture_cell cell_at(const gltf_picture *p, uint32_t level, uint32_t x, uint32_t y)
{
    if (level) {
        return p->levels[level - 1][(size_t)y * side(p, 0, level) + x];
    }
    gltf_picture_cell c;
    const uint8_t *texel = p->texture.texels + 4 * ((size_t)y * p->texture.size[0] + x);
    memcpy(c.lo, texel, 4);
    memcpy(c.hi, texel, 4);
    for (int k = 0; k < 3; k++) {
        c.mean[k] = (float)tyn_gltf_light_of(texel[k] / 255.0);
    }
    return c;
}

static void halve(gltf_picture *p, uint32_t level, gltf_picture_cell *to)
{
    const uint32_t from[2] = {side(p, 0, level - 1), side(p, 1, level - 1)};
    const uint32_t width = side(p, 0, level), height = side(p, 1, level);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            gltf_picture_cell sum = cell_at(p, level - 1, 2 * x, 2 * y);
            float count = 1;
            for (uint32_t k = 1; k < 4; k++) {
                const uint32_t i = 2 * x + k % 2, j = 2 * y + k / 2;
                if (i >= from[0] || j >= from[1]) {
                    continue;
                }
                const gltf_picture_cell c = cell_at(p, level - 1, i, j);
                for (int a = 0; a < 4; a++) {
                    sum.lo[a] = c.lo[a] < sum.lo[a] ? c.lo[a] : sum.lo[a];
                    sum.hi[a] = c.hi[a] > sum.hi[a] ? c.hi[a] : sum.hi[a];
                }
                for (int a = 0; a < 3; a++) {
                    sum.mean[a] += c.mean[a];
                }
                count++;
            }
            for (int a = 0; a < 3; a++) {
                sum.mean[a] /= count;
            }
            to[(size_t)y * width + x] = sum;
        }
    }
}

bool tyn_gltf_picture_make(gltf_picture *picture, const tyn_texture *texture)
{
    *picture = (gltf_picture){.texture = *texture};
    uint32_t level = 1;
    while (level <= GLTF_PICTURE_LEVELS &&
           (side(picture, 0, level - 1) > 1 || side(picture, 1, level - 1) > 1)) {
        gltf_picture_cell *cells =
            malloc((size_t)side(picture, 0, level) * side(picture, 1, level) * sizeof *cells);
        if (!cells) {
            tyn_gltf_picture_finish(picture);
            return false;
        }
        halve(picture, level, cells);
        picture->levels[level++ - 1] = cells;
    }
    return true;
}

void tyn_gltf_picture_finish(gltf_picture *picture)
{
    for (uint32_t i = 0; i < GLTF_PICTURE_LEVELS; i++) {
        free(picture->levels[i]);
    }
    free(picture->texture.texels);
    free(picture->texture.name);
    *picture = (gltf_picture){0};
}

// ---- wrapping ---------------------------------------------------------------------------------

static int64_t wrapped(int64_t i, int64_t size, tyn_wrap rule)
{
    if (rule == TYN_WRAP_CLAMP) {
        return i < 0 ? 0 : i >= size ? size - 1 : i;
    }
    const int64_t period = rule == TYN_WRAP_MIRROR ? 2 * size : size;
    const int64_t r = (i % period + period) % period;
    return r < size ? r : period - 1 - r;
}

// Texels [first, last] of an axis as at most two runs of texels that there are. Gives their number.
static int runs(int64_t first, int64_t last, int64_t size, tyn_wrap rule, int64_t out[2][2])
{
    const int64_t a = wrapped(first, size, rule), b = wrapped(last, size, rule);
    if (rule == TYN_WRAP_CLAMP || (last - first < size && a <= b && rule == TYN_WRAP_REPEAT)) {
        out[0][0] = a;
        out[0][1] = b;
        return 1;
    }
    if (rule == TYN_WRAP_REPEAT && last - first < size) {
        out[0][0] = 0;
        out[0][1] = b;
        out[1][0] = a;
        out[1][1] = size - 1;
        return 2;
    }
    // Mirrored within one copy, or everything.
    const bool one = rule == TYN_WRAP_MIRROR && last - first == llabs(b - a);
    out[0][0] = one ? (a < b ? a : b) : 0;
    out[0][1] = one ? (a < b ? b : a) : size - 1;
    return 1;
}

// A texel coordinate; what is far off is taken to be at the end, where nothing is lost.
static int64_t texel_of(double x)
{
    return (int64_t)floor(fmin(fmax(x, -1e15), 1e15));
}

// ---- questions --------------------------------------------------------------------------------

void tyn_gltf_picture_range(const gltf_picture *picture, const double lo[2], const double hi[2],
                            double least[4], double largest[4])
{
    int64_t run[2][2][2];
    int count[2];
    uint32_t level = 0;
    for (int a = 0; a < 2; a++) {
        const uint32_t size = picture->texture.size[a];
        // Between texel centres both neighbours count.
        const int64_t first = texel_of(lo[a] * size - 0.5), last = texel_of(hi[a] * size - 0.5) + 1;
        count[a] = runs(first, last, size, picture->texture.wrap[a], run[a]);
        for (int k = 0; k < count[a]; k++) {
            while (level < GLTF_PICTURE_LEVELS && picture->levels[level] &&
                   (run[a][k][1] >> level) - (run[a][k][0] >> level) > 3) {
                level++;
            }
        }
    }
    uint8_t lowest[4] = {255, 255, 255, 255}, highest[4] = {0};
    for (int j = 0; j < count[1]; j++) {
        for (int i = 0; i < count[0]; i++) {
            for (int64_t y = run[1][j][0] >> level; y <= run[1][j][1] >> level; y++) {
                for (int64_t x = run[0][i][0] >> level; x <= run[0][i][1] >> level; x++) {
                    const gltf_picture_cell c = cell_at(picture, level, (uint32_t)x, (uint32_t)y);
                    for (int a = 0; a < 4; a++) {
                        lowest[a] = c.lo[a] < lowest[a] ? c.lo[a] : lowest[a];
                        highest[a] = c.hi[a] > highest[a] ? c.hi[a] : highest[a];
                    }
                }
            }
        }
    }
    for (int a = 0; a < 4; a++) {
        least[a] = lowest[a] / 255.0;
        largest[a] = highest[a] / 255.0;
    }
}

// The four texels around a place, and what each counts for.
typedef struct neighbours {
    size_t texel[4];
    double weight[4];
} neighbours;

static neighbours neighbours_of(const tyn_texture *t, const double uv[2])
{
    neighbours n;
    double w[2];
    int64_t at[2];
    for (int a = 0; a < 2; a++) {
        const double x = uv[a] * t->size[a] - 0.5;
        at[a] = texel_of(x);
        w[a] = fmin(fmax(x - (double)at[a], 0), 1);
    }
    for (int k = 0; k < 4; k++) {
        const int64_t x = wrapped(at[0] + k % 2, t->size[0], t->wrap[0]);
        const int64_t y = wrapped(at[1] + k / 2, t->size[1], t->wrap[1]);
        n.texel[k] = (size_t)y * t->size[0] + (size_t)x;
        n.weight[k] = (k % 2 ? w[0] : 1 - w[0]) * (k / 2 ? w[1] : 1 - w[1]);
    }
    return n;
}

double tyn_gltf_picture_alpha(const gltf_picture *picture, const double uv[2])
{
    const neighbours n = neighbours_of(&picture->texture, uv);
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        sum += n.weight[k] * picture->texture.texels[4 * n.texel[k] + 3] / 255.0;
    }
    return sum;
}

void tyn_gltf_picture_light(const gltf_picture *picture, const double uv[2], const double size[2],
                            double light[3])
{
    const tyn_texture *t = &picture->texture;
    const double extent = fmin(size[0] * t->size[0], size[1] * t->size[1]);
    uint32_t level = 0, at[2];
    while (level < GLTF_PICTURE_LEVELS && picture->levels[level] && 2 << level <= extent) {
        level++;
    }
    light[0] = light[1] = light[2] = 0;
    if (level == 0) {
        const neighbours n = neighbours_of(t, uv);
        for (int k = 0; k < 12; k++) {
            const double stored = t->texels[4 * n.texel[k / 3] + (size_t)(k % 3)] / 255.0;
            light[k % 3] += n.weight[k / 3] * tyn_gltf_light_of(stored);
        }
        return;
    }
    for (int a = 0; a < 2; a++) {
        at[a] = (uint32_t)wrapped(texel_of(uv[a] * t->size[a]), t->size[a], t->wrap[a]);
    }
    const gltf_picture_cell c = cell_at(picture, level, at[0] >> level, at[1] >> level);
    for (int k = 0; k < 3; k++) {
        light[k] = (double)c.mean[k];
    }
}
