// shadow_map_plan.c -- the frames of the lights and their places in the atlas.
//
// A map of a sun is fitted around the surfaces as the light sees them: what is outside is lit. Maps are a
// texel wider than need be on all sides, so that the texels around any place inside belong to the map.
#include "shadow_map.h"
#include "scene/matrix.h"
#include <math.h>
#include <string.h>

typedef struct frame { // rows of an affine map
    double rows[3][4];
} frame;

static bool normalise(double v[3])
{
    double length = sqrt(vec_dot(v, v));
    for (int c = 0; c < 3 && length > 0; c++) {
        v[c] /= length;
    }
    return length > 1e-9;
}

// u and v across the unit vector `axis`, u as near to `hint` as can be. False if that is along the axis.
static bool across(const double axis[3], const double hint[3], double u[3], double v[3])
{
    for (int c = 0; c < 3; c++) {
        u[c] = hint[c] - vec_dot(hint, axis) * axis[c];
    }
    bool possible = normalise(u);
    vec_cross(v, axis, u);
    return possible;
}

// Row `r` of a frame after the rigid change from the world to M.
static void compose(const double r[4], const struct surface_block *s, double out[4])
{
    for (int c = 0; c < 4; c++) {
        out[c] = c == 3 ? r[3] : 0;
        for (int k = 0; k < 3; k++) {
            out[c] += r[k] * (double)s->from_world[k][c];
        }
    }
}

// Range of a direction of M over the world box of the surfaces, in M.
static void range(const double direction[3], const struct surface_block *s, double *lo, double *hi)
{
    double r[4] = {direction[0], direction[1], direction[2], 0}, w[4];
    compose(r, s, w);
    *lo = *hi = w[3];
    for (int c = 0; c < 3; c++) {
        *lo += fmin(w[c] * (double)s->lo[c], w[c] * (double)s->hi[c]);
        *hi += fmax(w[c] * (double)s->lo[c], w[c] * (double)s->hi[c]);
    }
}

static void set_rows(struct shadow_light *l, const frame *f)
{
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 4; c++) {
            l->rows[r][c] = (float)f->rows[r][c];
        }
    }
}

// One clip row: `scale` times a row of the frame, from the world.
static void clip_row(float out[4], const double row[4], double scale, const struct surface_block *s)
{
    double world[4];
    compose(row, s, world);
    for (int c = 0; c < 4; c++) {
        out[c] = (float)(scale * world[c]);
    }
}

// ---- suns -------------------------------------------------------------------------------------

// (u, v, depth) of the map with the least area of three: turned so that one side is along an axis of
// the world's box.
static frame fit_sun(const float direction[3], double margin, const struct surface_block *s)
{
    double axis[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    normalise(axis);
    frame best = {{{0}}};
    double least = INFINITY;
    for (int a = 0; a < 3; a++) {
        double hint[3] = {(double)s->from_world[0][a], (double)s->from_world[1][a],
                          (double)s->from_world[2][a]};
        double uv[2][3], lo[2], hi[2];
        if (!across(axis, hint, uv[0], uv[1])) {
            continue;
        }
        range(uv[0], s, &lo[0], &hi[0]);
        range(uv[1], s, &lo[1], &hi[1]);
        const double least_side = 1e-6 * fmax(hi[0] - lo[0], hi[1] - lo[1]) + 1e-30;
        double area = (hi[0] - lo[0]) * (hi[1] - lo[1]);
        for (int k = 0; area < least && k < 2; k++) {
            double half = fmax(0.5 * (hi[k] - lo[k]), least_side) * margin;
            for (int c = 0; c < 3; c++) {
                best.rows[k][c] = uv[k][c] / half;
            }
            best.rows[k][3] = -0.5 * (lo[k] + hi[k]) / half;
        }
        least = fmin(area, least);
    }
    double lo, hi;
    range(axis, s, &lo, &hi);
    // The farthest surface is not at the depth of none. And depths are compared within SHADOW_EPSILON of this
    // range: where all surfaces lie in a plane across the sun that still is more than places are rounded by.
    double reach = 1e-30;
    for (int c = 0; c < 3; c++) {
        reach += fmax(fabs((double)s->lo[c]), fabs((double)s->hi[c]));
        reach += fabs((double)s->from_world[c][3]);
    }
    double slack = 1e-3 * (hi - lo) + 0.05 * reach;
    lo -= slack, hi += slack;
    for (int c = 0; c < 3; c++) {
        best.rows[2][c] = -axis[c] / (hi - lo);
    }
    best.rows[2][3] = hi / (hi - lo);
    return best;
}

static void plan_sun(tyn_shadow_map_params *p, struct shadow_light *l,
                     const struct light_block *sun, const struct surface_block *s)
{
    const double side = (double)l->texels;
    frame f = fit_sun(sun->direction, side / (side - 4), s);
    set_rows(l, &f);
    tyn_shadow_view *view = &p->views[p->num_views++];
    view->place[0] = (uint32_t)l->offset[0];
    view->place[1] = (uint32_t)l->offset[1];
    view->texels = (uint32_t)l->texels;
    view->drawn[0].count = s->num_triangles;
    view->light = (uint32_t)(l - p->lights);
    for (int r = 0; r < 3; r++) {
        clip_row(view->args.clip[r], f.rows[r], 1, s);
    }
    view->args.clip[3][3] = 1;
}

// ---- lamps ------------------------------------------------------------------------------------

static void plan_lamp(tyn_shadow_map_params *p, struct shadow_light *l,
                      const struct light_block *lamp, const struct surface_block *s)
{
    const double side = (double)l->texels;
    const bool cube = l->kind == TYN_SHADOW_CUBE;
    double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double tangent = 1;
    if (!cube) {
        for (int c = 0; c < 3; c++) {
            axes[2][c] = (double)lamp->direction[c];
        }
        normalise(axes[2]);
        const int a = fabs(axes[2][0]) < 0.6 ? 0 : 1;
        across(axes[2], (double[3]){a == 0, a == 1, 0}, axes[0], axes[1]);
        tangent = sqrt(fmax(1 - (double)lamp->cos_outer * (double)lamp->cos_outer, 1e-6)) /
                  (double)lamp->cos_outer;
    }
    frame f;
    for (int r = 0; r < 3; r++) {
        f.rows[r][3] = 0;
        for (int c = 0; c < 3; c++) {
            f.rows[r][c] = axes[r][c];
            f.rows[r][3] -= axes[r][c] * (double)lamp->position[c];
        }
    }
    set_rows(l, &f);
    double diagonal = 0;
    for (int c = 0; c < 3; c++) {
        diagonal += ((double)s->hi[c] - (double)s->lo[c]) * ((double)s->hi[c] - (double)s->lo[c]);
    }
    // Depths are as fine however near this is: as near as vertices are exact.
    l->near = (float)fmax(1e-7 * sqrt(diagonal), 1e-30);
    l->scale = (float)((side - 4) / side / tangent);
    for (int face = 0; face < (cube ? 6 : 1); face++) {
        // Of a cube the next two axes are u and v.
        const int w = cube ? face / 2 : 2;
        tyn_shadow_view *view = &p->views[p->num_views++];
        view->place[0] = (uint32_t)l->offset[0] + (uint32_t)(face % 3) * (uint32_t)l->texels;
        view->place[1] = (uint32_t)l->offset[1] + (uint32_t)(face / 3) * (uint32_t)l->texels;
        view->texels = (uint32_t)l->texels;
        view->drawn[0].count = s->num_triangles;
        view->light = (uint32_t)(l - p->lights);
        clip_row(view->args.clip[0], f.rows[(w + 1) % 3], (double)l->scale, s);
        clip_row(view->args.clip[1], f.rows[(w + 2) % 3], (double)l->scale, s);
        view->args.clip[2][3] = l->near;
        clip_row(view->args.clip[3], f.rows[w], face % 2 ? -1 : 1, s);
    }
}

// ---- the atlas --------------------------------------------------------------------------------

// Rows of blocks, filled from the left.
typedef struct shelves {
    uint32_t width, x, y, height;
} shelves;

static void place(shelves *s, uint32_t width, uint32_t height, float offset[2])
{
    if (s->x + width > s->width) {
        s->y += s->height;
        s->x = s->height = 0;
    }
    offset[0] = (float)s->x;
    offset[1] = (float)s->y;
    s->x += width;
    s->height = height > s->height ? height : s->height;
}

// The nearest one, at least 16: who reads maps may walk through them by halves.
static uint32_t power_of_two(double x)
{
    uint32_t power = 16;
    while (power * 1.4142 < x) {
        power *= 2;
    }
    return power;
}

// What wide lobes light is seen by a cube: one map would be coarse in its middle.
static tyn_uint kind_of(const struct light_block *lamp)
{
    return lamp->cos_outer > 0.45f ? TYN_SHADOW_CONE : TYN_SHADOW_CUBE;
}

void tyn_shadow_map_plan(tyn_shadow_map_params *p, const struct light_block *suns,
                         uint32_t num_suns, const struct light_block *lamps, uint32_t num_lamps,
                         const struct surface_block *surfaces)
{
    memset(p->lights, 0, sizeof p->lights);
    memset(p->views, 0, sizeof p->views);
    p->num_views = 0;
    p->num_triangles = surfaces->num_triangles;
    num_suns = num_suns < TYN_SHADOW_SUNS ? num_suns : TYN_SHADOW_SUNS;
    num_lamps = num_lamps < TYN_SHADOW_LAMPS ? num_lamps : TYN_SHADOW_LAMPS;
    for (uint32_t i = 0; i < TYN_SHADOW_SUNS; i++) {
        p->lights[i].rows[0][3] = 2; // without a map: outside of it
    }

    const uint32_t sun = power_of_two((double)p->sun_texels);
    // As many texels for many lamps as for four.
    double shrink = num_lamps > 4 ? sqrt(4.0 / num_lamps) : 1;
    const uint32_t face = power_of_two((double)p->lamp_texels * shrink);
    shelves atlas = {.width = num_suns > 1 ? 2 * sun : num_suns ? sun : 0};
    const uint32_t lamp_row = num_lamps > 1 ? 6 * face : num_lamps ? 3 * face : 16;
    atlas.width = atlas.width > lamp_row ? atlas.width : lamp_row;
    for (uint32_t i = 0; i < num_suns; i++) {
        struct shadow_light *l = &p->lights[i];
        l->kind = TYN_SHADOW_SUN;
        l->texels = (float)sun;
        place(&atlas, sun, sun, l->offset);
        plan_sun(p, l, &suns[i], surfaces);
    }
    for (uint32_t i = 0; i < num_lamps; i++) {
        struct shadow_light *l = &p->lights[TYN_SHADOW_LAMP(i)];
        l->kind = kind_of(&lamps[i]);
        const uint32_t side = l->kind == TYN_SHADOW_CONE ? 2 * face : face;
        l->texels = (float)side;
        place(&atlas, l->kind == TYN_SHADOW_CONE ? side : 3 * face, 2 * face, l->offset);
        plan_lamp(p, l, &lamps[i], surfaces);
    }
    p->size[0] = atlas.width;
    p->size[1] = atlas.y + (atlas.height ? atlas.height : 16);
}
