// gltf_facets.c -- triangles cut where what a file paints on them varies.
#include "io/gltf_facets.h"
#include <math.h>
#include <string.h>

// Differences that are let be, how often a triangle is halved at most, and parts of a texture's side that are not cut any
// finer.
static const double TINT_STEP = 1 / 16.0, GLOW_STEP = 1 / 16.0;
enum { TINT_DEPTH = 5, GLOW_DEPTH = 6, MASK_DEPTH = 8, MASK_DEPTH_BEYOND = 3 };
static const double GLOW_PART = 1 / 64.0, MASK_PART = 1 / 256.0;
static const double STEPS =
    255; // of tint, and of the root of emission, so that facets share materials

typedef struct cutter {
    const gltf_painted *p;
    int64_t *budget;
    uint32_t count; // facets put
    gltf_facet_fn put;
    void *user;
} cutter;

// Of a facet's corner k, as the triangle's corners have it.
static double mixed(const double weights[3], double a, double b, double c)
{
    return weights[0] * a + weights[1] * b + weights[2] * c;
}

static void place_of(double (*uv)[2], const double weights[3], double out[2])
{
    for (int a = 0; a < 2; a++) {
        out[a] = mixed(weights, uv[0][a], uv[1][a], uv[2][a]);
    }
}

static double color_of(const gltf_painted *p, const double weights[3], int channel)
{
    double(*c)[4] = p->colors;
    return c ? mixed(weights, c[0][channel], c[1][channel], c[2][channel]) : 1;
}

static double alpha_of(const gltf_painted *p, const double weights[3])
{
    double uv[2], alpha = p->opacity * color_of(p, weights, 3);
    if (p->alpha) {
        place_of(p->alpha_uv, weights, uv);
        alpha *= tyn_gltf_picture_alpha(p->alpha, uv);
    }
    return alpha;
}

// The box of texture coordinates of a facet.
static void box_of(double (*uv)[2], double corners[3][3], double lo[2], double hi[2])
{
    for (int k = 0; k < 3; k++) {
        double at[2];
        place_of(uv, corners[k], at);
        for (int a = 0; a < 2; a++) {
            lo[a] = k ? fmin(lo[a], at[a]) : at[a];
            hi[a] = k ? fmax(hi[a], at[a]) : at[a];
        }
    }
}

// Is the box longer than that part of a side of the texture, and than so many texels?
static bool is_longer(const gltf_picture *picture, const double lo[2], const double hi[2],
                      double part, double texels)
{
    bool longer = false;
    for (int a = 0; a < 2; a++) {
        longer = longer || hi[a] - lo[a] > fmax(part, texels / picture->texture.size[a]);
    }
    return longer;
}

// Is the alpha of all of the facet known to be on one side of the cutoff? 1: it is there; -1: it is not; 0: that is not known.
static int sight_of(const gltf_painted *p, double corners[3][3], bool *coarse)
{
    double least = 1e300, largest = -1e300;
    *coarse = false;
    for (int k = 0; k < 3; k++) {
        const double of_color = p->opacity * color_of(p, corners[k], 3);
        least = fmin(least, of_color);
        largest = fmax(largest, of_color);
    }
    if (p->alpha) {
        double lo[2], hi[2], low[4], high[4];
        box_of(p->alpha_uv, corners, lo, hi);
        tyn_gltf_picture_range(p->alpha, lo, hi, low, high);
        least *= low[3];
        largest *= high[3];
        *coarse = is_longer(p->alpha, lo, hi, MASK_PART, 1);
    }
    return least >= p->cutoff ? 1 : largest < p->cutoff ? -1 : 0;
}

static bool tint_varies(const gltf_painted *p, double corners[3][3])
{
    bool varies = false;
    for (int channel = 0; p->colors && p->reflects && channel < 3; channel++) {
        double lo = 1e300, hi = -1e300;
        for (int k = 0; k < 3; k++) {
            const double c = color_of(p, corners[k], channel);
            lo = fmin(lo, c);
            hi = fmax(hi, c);
        }
        varies = varies || hi - lo > TINT_STEP;
    }
    return varies;
}

static bool glow_varies(const gltf_painted *p, double corners[3][3])
{
    if (!p->glow) {
        return false;
    }
    double lo[2], hi[2], low[4], high[4];
    box_of(p->glow_uv, corners, lo, hi);
    tyn_gltf_picture_range(p->glow, lo, hi, low, high);
    bool varies = false;
    for (int c = 0; c < 3; c++) {
        varies = varies || tyn_gltf_light_of(high[c]) - tyn_gltf_light_of(low[c]) > GLOW_STEP;
    }
    return varies && is_longer(p->glow, lo, hi, GLOW_PART, 0.25);
}

static float in_steps(double value)
{
    return (float)(round(fmin(fmax(value, 0), 1) * STEPS) / STEPS);
}

// Means over the facet: its middle, and the middles of the four triangles that halving would make.
static void shade(const gltf_painted *p, gltf_facet *f)
{
    static const double places[4][3] = {{1 / 3.0, 1 / 3.0, 1 / 3.0},
                                        {2 / 3.0, 1 / 6.0, 1 / 6.0},
                                        {1 / 6.0, 2 / 3.0, 1 / 6.0},
                                        {1 / 6.0, 1 / 6.0, 2 / 3.0}};
    double glow[3] = {0}, lo[2], hi[2], size[2] = {0};
    if (p->glow) {
        box_of(p->glow_uv, f->corners, lo, hi);
        size[0] = 0.5 * (hi[0] - lo[0]);
        size[1] = 0.5 * (hi[1] - lo[1]);
    }
    for (int k = 0; k < 4; k++) {
        double weights[3], uv[2], light[3];
        for (int c = 0; c < 3; c++) {
            weights[c] = mixed(places[k], f->corners[0][c], f->corners[1][c], f->corners[2][c]);
        }
        for (int c = 0; k == 0 && c < 3; c++) {
            f->tint[c] = p->colors && p->reflects ? in_steps(color_of(p, weights, c)) : 1;
        }
        if (p->glow) {
            place_of(p->glow_uv, weights, uv);
            tyn_gltf_picture_light(p->glow, uv, size, light);
        }
        for (int c = 0; c < 3; c++) {
            glow[c] += p->glow ? 0.25 * light[c] : 0.25;
        }
    }
    for (int c = 0; c < 3; c++) {
        const float root = in_steps(sqrt(glow[c])); // finer where it is dark
        f->glow[c] = p->glow ? root * root : 1;
    }
}

static bool put_facet(cutter *c, double corners[3][3], bool whole)
{
    gltf_facet f = {.whole = whole};
    memcpy(f.corners, corners, sizeof f.corners);
    shade(c->p, &f);
    *c->budget -= c->count++ > 0;
    return c->put(c->user, &f);
}

// What of a facet has enough alpha, by a straight edge between its corners.
static bool put_clipped(cutter *c, double corners[3][3])
{
    double polygon[4][3], alpha[3];
    int count = 0;
    for (int k = 0; k < 3; k++) {
        alpha[k] = alpha_of(c->p, corners[k]) - c->p->cutoff;
    }
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3;
        if (alpha[k] >= 0) {
            memcpy(polygon[count++], corners[k], sizeof polygon[0]);
        }
        if ((alpha[k] >= 0) != (alpha[next] >= 0)) {
            const double u = alpha[k] / (alpha[k] - alpha[next]);
            for (int a = 0; a < 3; a++) {
                polygon[count][a] = corners[k][a] + u * (corners[next][a] - corners[k][a]);
            }
            count++;
        }
    }
    for (int k = 2; k < count; k++) {
        double part[3][3];
        memcpy(part[0], polygon[0], sizeof part[0]);
        memcpy(part[1], polygon[k - 1], sizeof part[1]);
        memcpy(part[2], polygon[k], sizeof part[2]);
        if (!put_facet(c, part, false)) {
            return false;
        }
    }
    return true;
}

static bool cut(cutter *c, double corners[3][3], int depth)
{
    const gltf_painted *p = c->p;
    bool coarse = false;
    const int sight = p->cutoff > 0 ? sight_of(p, corners, &coarse) : 1;
    if (sight < 0) {
        return true;
    }
    // A mask is cut whatever it costs, but more coarsely: else all would be gone whose corners are.
    const bool rich = *c->budget > 0;
    const bool halve = (sight == 0 && coarse && depth < (rich ? MASK_DEPTH : MASK_DEPTH_BEYOND)) ||
                       (rich && depth < TINT_DEPTH && tint_varies(p, corners)) ||
                       (rich && depth < GLOW_DEPTH && glow_varies(p, corners));
    if (!halve) {
        return sight > 0 ? put_facet(c, corners, depth == 0) : put_clipped(c, corners);
    }
    double middle[3][3]; // of the sides after corner k
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++) {
            middle[k][a] = 0.5 * (corners[k][a] + corners[(k + 1) % 3][a]);
        }
    }
    double part[3][3];
    for (int k = 0; k < 3; k++) { // around corner k
        memcpy(part[0], corners[k], sizeof part[0]);
        memcpy(part[1], middle[k], sizeof part[1]);
        memcpy(part[2], middle[(k + 2) % 3], sizeof part[2]);
        if (!cut(c, part, depth + 1)) {
            return false;
        }
    }
    return cut(c, middle, depth + 1);
}

bool tyn_gltf_cut(const gltf_painted *painted, int64_t *budget, gltf_facet_fn put, void *user)
{
    double all[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    cutter c = {painted, budget, 0, put, user};
    return cut(&c, all, 0);
}
