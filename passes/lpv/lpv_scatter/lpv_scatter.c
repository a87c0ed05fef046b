// lpv_scatter.c -- rays of suns and lamps, and the light that scatters on them.
#include "lpv_scatter.h"
#include "shaders/common/counters.h"
#include "passes/lpv_scatter_tables.h"
#include <math.h>
#include <string.h>

// Rays along a side of each of a point light's six maps, or of a spot's one; less for more than four lamps.
enum { LAMP_TEXELS = 64 };

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(float v[3])
{
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3; a++) {
        v[a] /= fmaxf(length, 1e-20f);
    }
}

// u and v across the unit vector d.
static void across(const float d[3], float u[3], float v[3])
{
    int least = 0;
    for (int a = 1; a < 3; a++) {
        least = fabsf(d[a]) < fabsf(d[least]) ? a : least;
    }
    const float axis[3] = {least == 0, least == 1, least == 2};
    cross(d, axis, u);
    normalise(u);
    cross(d, u, v);
}

// Range over the box of a direction, m.
static void range(const float extent[3], const float d[3], float *lo, float *hi)
{
    *lo = *hi = 0;
    for (int a = 0; a < 3; a++) {
        *lo += fminf(0, d[a] * extent[a]);
        *hi += fmaxf(0, d[a] * extent[a]);
    }
}

static void plan_sun(struct lpv_scatter_bundle *b, const float extent[3],
                     const struct light_block *sun)
{
    float u[3], v[3], lo[3], hi[3];
    across(sun->direction, u, v);
    range(extent, u, &lo[0], &hi[0]);
    range(extent, v, &lo[1], &hi[1]);
    range(extent, sun->direction, &lo[2], &hi[2]);
    for (int a = 0; a < 3; a++) {
        b->origin[a] = lo[0] * u[a] + lo[1] * v[a] + lo[2] * sun->direction[a];
        b->origin_u[a] = (hi[0] - lo[0]) * u[a];
        b->origin_v[a] = (hi[1] - lo[1]) * v[a];
        b->direction[a] = sun->direction[a];
    }
    b->measure = (hi[0] - lo[0]) * (hi[1] - lo[1]);
}

// Directions of a lamp through the square of the half side `half` in the plane at 1 along `axis`.
static void plan_face(struct lpv_scatter_bundle *b, const struct light_block *lamp,
                      const float axis[3], float half)
{
    float u[3], v[3];
    across(axis, u, v);
    for (int a = 0; a < 3; a++) {
        b->origin[a] = lamp->position[a];
        b->direction[a] = axis[a] - half * (u[a] + v[a]);
        b->direction_u[a] = 2 * half * u[a];
        b->direction_v[a] = 2 * half * v[a];
    }
    b->measure = 4 * half * half;
}

static float strength(const struct light_block *light)
{
    return fmaxf(light->color[0], fmaxf(light->color[1], light->color[2]));
}

void tyn_lpv_scatter_plan(tyn_lpv_scatter_params *p, const float extent[3], float majorant,
                          const struct light_block *suns, uint32_t num_suns,
                          const struct light_block *lamps, uint32_t num_lamps)
{
    p->num_suns = num_suns;
    p->num_bundles = 0;
    p->power = 0;
    p->majorant = majorant;
    for (uint32_t i = 0; i < num_suns; i++) {
        struct lpv_scatter_bundle *b = &p->bundles[p->num_bundles++];
        *b = (struct lpv_scatter_bundle){.light = i, .texels = (uint32_t)p->sun_texels};
        plan_sun(b, extent, &suns[i]);
        p->power += b->measure * strength(&suns[i]);
    }
    uint32_t side = LAMP_TEXELS;
    for (uint32_t n = 4; n < num_lamps && side > 16; n *= 4) {
        side /= 2;
    }
    for (uint32_t i = 0; i < num_lamps; i++) {
        const bool narrow = lamps[i].cos_outer > 0.3f;
        const float c = lamps[i].cos_outer, tangent = sqrtf(1 - c * c) / fmaxf(c, 0.3f);
        for (uint32_t face = 0; face < (narrow ? 1u : 6u); face++) {
            struct lpv_scatter_bundle *b = &p->bundles[p->num_bundles++];
            *b = (struct lpv_scatter_bundle){.light = TYN_SHADOW_LAMP(i), .texels = side};
            float axis[3] = {face / 2 == 0, face / 2 == 1, face / 2 == 2};
            for (int a = 0; a < 3; a++) {
                axis[a] = narrow ? lamps[i].direction[a] : face % 2 ? -axis[a] : axis[a];
            }
            plan_face(b, &lamps[i], axis, narrow ? tangent : 1);
        }
        p->power += light_lobe_integral(lamps[i]) * strength(&lamps[i]);
    }
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_lpv_scatter_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    tyn_build_buffer(b, LPV_SCATTER_PORT_SCATTERED,
                     16 + 16ull * dims.x * dims.y * dims.z * p->shape.channels);
    tyn_build_buffer(b, LPV_SCATTER_PORT_RAYS,
                     sizeof p->bundles[0] * (p->num_bundles ? p->num_bundles : 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_lpv_scatter_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    // No sample brings more than its ray has, or than the majorant lets it on its part of the ray; rays at the rims of square
    // maps are 1.1 times the lobe's integral.
    const float *e = p->shape.extent;
    const float deepest = p->majorant * sqrtf(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    const float bound = 1.5f * p->power * fminf((float)p->samples, deepest);
    struct lpv_scatter_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .unit = bound > 0 ? bound / 1073741824.0f : 1,
        .samples = (uint32_t)p->samples,
        .majorant = p->majorant,
    };
    const uint32_t spec[3] = {p->mode, tyn_rec_has(r, LPV_SCATTER_PORT_SHADOW_ATLAS),
                              tyn_rec_has(r, LPV_SCATTER_PORT_WALL_LINKS)};
    tyn_rec_fill(r, LPV_SCATTER_PORT_SCATTERED, 0);
    if (p->num_bundles == 0) {
        return;
    }
    tyn_rec_update(r, LPV_SCATTER_PORT_RAYS, 0, p->bundles, sizeof p->bundles[0] * p->num_bundles);
    for (uint32_t end = 0; args.first < p->num_bundles; args.first = end) {
        const uint32_t texels = p->bundles[args.first].texels;
        while (end < p->num_bundles && p->bundles[end].texels == texels) {
            end++;
        }
        const uint32_t count = end - args.first;
        TYN_DISPATCH(r, .cells = {texels, texels, count}, .args = &args, .spec = spec);
        tyn_rec_work(r, "samples", (double)texels * texels * count * p->samples);
    }
}

static const tyn_param param_table[] = {
    {"sun_texels", TYN_PARAM_INT, offsetof(tyn_lpv_scatter_params, sun_texels), 256, 16, 1024,
     "texels", "rays along a side of the map of a directional light", NULL},
    {"samples", TYN_PARAM_INT, offsetof(tyn_lpv_scatter_params, samples), 8, 1, 64, "",
     "places on a ray where light scatters", NULL},
};

const tyn_pass_desc tyn_pass_lpv_scatter = {
    .name = "lpv_scatter",
    .summary = "light that scatters first, by samples along the rays of suns and lamps",
    .serves = "suns and lamps, with lpv.inject=shadow_map",
    TYN_PASS_TABLES(tyn_lpv_scatter_params),
    TYN_SETTINGS(param_table),
    .debug_port = LPV_SCATTER_PORT_SCATTERED,
    .debug_meaning = "power that starts in cells, in units of a bound of the sum",
    TYN_COUNTS(LPV_SCATTER_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE,
               {"bounded", offsetof(struct counters_block, clamped)}),
};
