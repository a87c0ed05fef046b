// constellation.c -- the picture of the method constellation: slices back to front, with a shadow ray per light and slice.
#include "constellation.h"
#include "shaders/common/counters.h"
#include "passes/light_list/common/constellation_args.h"
#include "passes/constellation_tables.h"
#include <math.h>

static const char *const lightings[] = {"alpha", "primary", "self-shadowed"};
static const char *const norms[] = {"4pi", "16pi2"};
static const char *const quadratures[] = {"exact", "printed"};

static const tyn_param params_table[] = {
    {"lights", TYN_PARAM_INT, offsetof(tyn_constellation_params, lights), 20, 1,
     TYN_CONSTELLATION_MAX, "", "distant lights that stand for the environment", NULL},
    {"slice", TYN_PARAM_FLOAT, offsetof(tyn_constellation_params, slice), 0.5, 0.05, 5, "voxels",
     "distance between slices, and steps of shadow rays", NULL},
    {"lighting", TYN_PARAM_ENUM, offsetof(tyn_constellation_params, lighting),
     CONSTELLATION_SHADOWED, 0, 2, "",
     "alpha: a colour for all lights; primary: each light as if nothing were before it; "
     "self-shadowed: with a shadow ray",
     lightings},
    {"mask", TYN_PARAM_BOOL, offsetof(tyn_constellation_params, mask), 1, 0, 1, "",
     "rays that meet no medium are not marched, others from the farthest medium on", NULL},
    {"distance", TYN_PARAM_BOOL, offsetof(tyn_constellation_params, distance), 1, 0, 1, "",
     "rays skip what the distance map says is empty", NULL},
    {"norm", TYN_PARAM_ENUM, offsetof(tyn_constellation_params, norm), CONSTELLATION_NORM_4_PI, 0,
     1, "", "what scattered light is divided by: Eq 3 has 4 pi, Program 1 prints 16 pi^2", norms},
    {"quadrature", TYN_PARAM_ENUM, offsetof(tyn_constellation_params, quadrature),
     CONSTELLATION_QUADRATURE_EXACT, 0, 1, "",
     "light of a slice: the integral over it, or its beginning as Eqs 4 and 5 are printed",
     quadratures},
};

// Turns of a thread's loops in one dispatch, all together: software devices end them at 65535. Some are left for loops over
// samples of surfaces and of the background.
static const float MOST_TURNS = 60000;
// Rays that such devices march in a vector: all of it turns as long as one of them does.
static const float RAYS_AT_ONCE = 8;
static const float MOST_SLICES = 8192;

static float diagonal_of(const float v[3])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

struct slices_args tyn_constellation_slices(const struct medium_block *medium, float slice,
                                            float longest_step)
{
    const float voxel = fminf(medium->voxel[0], fminf(medium->voxel[1], medium->voxel[2]));
    const float *e = medium->extent;
    const float longest = fmaxf(e[0], fmaxf(e[1], e[2]));
    const float distance = slice * fminf(voxel, fminf(longest_step, longest / 64));
    return (struct slices_args){
        .distance = fmaxf(distance, diagonal_of(medium->extent) / MOST_SLICES),
        .margin = 0.5001f * diagonal_of(medium->voxel),
    };
}

// Slices of a ray, at most.
static float most_slices(const tyn_constellation_params *p)
{
    return floorf(diagonal_of(p->extent) / p->slices.distance) + 2;
}

// What a dispatch does to each ray so that no thread's loops turn too often: it lights `slices` slices by all lights, or one
// slice by `lights` of them.
typedef struct portion {
    uint32_t slices, lights;
    uint32_t per_slice; // dispatches that light a slice; > 1: slices = 1
} portion;

static portion portion_of(const tyn_constellation_params *p)
{
    const float slices = most_slices(p);
    const float lights = p->lighting == CONSTELLATION_ALPHA ? 0 : (float)p->num_lights;
    const float of_light =
        1 + (p->lighting == CONSTELLATION_SHADOWED ? 2 + ceilf(slices / 2) : 0); // two steps a turn
    const float of_slice = 3 + of_light * lights;
    // The last dispatch goes along all of a ray for the layer "depth". To find its next slices takes a ray as many turns as it
    // has slices in all; those of a vector wait for each other, for each slice that is lit no longer than a ray is.
    const float left = MOST_TURNS - slices;
    const float searches = p->distance ? RAYS_AT_ONCE * slices : slices;
    const float rounds = floorf(fmaxf((left - searches) / of_slice, left / (of_slice + slices)));
    if (rounds >= 1) {
        return (portion){(uint32_t)fminf(rounds, slices), (uint32_t)lights, 1};
    }
    const float most = floorf((left - slices - 3) / of_light); // >= 1: MOST_SLICES
    const float per_slice = ceilf(lights / most);
    return (portion){1, (uint32_t)ceilf(lights / per_slice), (uint32_t)per_slice};
}

static uint32_t dispatches_of(const tyn_constellation_params *p)
{
    const portion of = portion_of(p);
    return (uint32_t)ceilf(most_slices(p) / (float)of.slices) * of.per_slice;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_constellation_params *p = params;
    const tyn_extent size = {p->width, p->height, 1};
    tyn_build_image(b, CONSTELLATION_PORT_RADIANCE, size, 1);
    if (p->layers & CONSTELLATION_LAYER_TRANSMITTANCE) {
        tyn_build_image(b, CONSTELLATION_PORT_TRANSMITTANCE, size, 1);
    }
    if (p->layers & CONSTELLATION_LAYER_DEPTH) {
        tyn_build_image(b, CONSTELLATION_PORT_DEPTH, size, 1);
    }
    const tyn_extent kept = dispatches_of(p) > 1 ? size : (tyn_extent){1, 1, 1};
    tyn_build_image(b, CONSTELLATION_PORT_STATE_LIGHT, kept, 1);
    tyn_build_image(b, CONSTELLATION_PORT_STATE_THROUGH, kept, 1);
    tyn_build_image(b, CONSTELLATION_PORT_STATE_UNCOVERED, kept, 1);
    return TYN_OK;
}

static uint32_t features_of(const tyn_recorder *r, const tyn_constellation_params *p)
{
    const bool surface = tyn_rec_has(r, CONSTELLATION_PORT_SURFACE);
    uint32_t features = 0;
    features |= tyn_rec_has(r, CONSTELLATION_PORT_MASK) ? CONSTELLATION_MASK : 0;
    features |= p->distance ? CONSTELLATION_DISTANCE : 0;
    features |= p->quadrature == CONSTELLATION_QUADRATURE_PRINTED ? CONSTELLATION_PRINTED : 0;
    features |= p->emissive ? CONSTELLATION_EMISSION : 0;
    features |= tyn_rec_has(r, CONSTELLATION_PORT_HOST_DEPTH) ? CONSTELLATION_HOST_DEPTH : 0;
    features |= p->background ? CONSTELLATION_BACKGROUND : 0;
    features |= surface ? CONSTELLATION_SURFACE : 0;
    features |= surface && p->surfaces ? CONSTELLATION_SURFACE_SEEN : 0;
    features |= tyn_rec_has(r, CONSTELLATION_PORT_SHADOW_ATLAS) ? CONSTELLATION_SHADOWS : 0;
    features |= p->layers & CONSTELLATION_LAYER_TRANSMITTANCE ? CONSTELLATION_TRANSMITTANCE : 0;
    features |= p->layers & CONSTELLATION_LAYER_DEPTH ? CONSTELLATION_DEPTH : 0;
    features |= p->lamps ? CONSTELLATION_LAMPS : 0;
    return features;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_constellation_params *p = params;
    const float pi = 3.14159265f;
    const portion of = portion_of(p);
    struct constellation_args args = {
        .depth = {p->depth[0], p->depth[1], p->depth[2], p->depth[3]},
        .slices = p->slices,
        .scale = p->norm == CONSTELLATION_NORM_4_PI ? 1 : 1 / (4 * pi),
        .rounds = of.slices,
    };

    // The binding of a layer that is not made is not written to, so any image will do.
    uint8_t absent[2][2], num_absent = 0, ports_of[TYN_MAX_BINDINGS];
    static const struct {
        uint32_t layer;
        uint8_t port;
    } layers[] = {
        {CONSTELLATION_LAYER_TRANSMITTANCE, CONSTELLATION_PORT_TRANSMITTANCE},
        {CONSTELLATION_LAYER_DEPTH, CONSTELLATION_PORT_DEPTH},
    };
    for (uint32_t k = 0; k < TYN_COUNT(layers); k++) {
        if (!(p->layers & layers[k].layer)) {
            absent[num_absent][0] = layers[k].port;
            absent[num_absent++][1] = CONSTELLATION_PORT_RADIANCE;
        }
    }
    const uint32_t kernel =
        p->mode == TYN_MEDIUM_DENSITY ? KERNEL_MARCH_DENSITY : KERNEL_MARCH_COEFFICIENTS;
    tyn_ports_exchanged(&kernels[kernel], (const uint8_t(*)[2])absent, num_absent, ports_of);
    const uint32_t spec[] = {p->mode, features_of(r, p), (uint32_t)p->lighting};
    const uint32_t count = dispatches_of(p);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t part = i % of.per_slice;
        args.first = i == 0;
        args.last = i + 1 == count;
        args.light_begin = part * of.lights;
        args.light_end = part + 1 < of.per_slice ? args.light_begin + of.lights : UINT32_MAX;
        TYN_DISPATCH(r, .kernel = kernel, .cells = {p->width, p->height, 1}, .args = &args,
                     .ports = ports_of, .spec = spec);
    }
}

const tyn_pass_desc tyn_pass_constellation = {
    .name = "constellation",
    .summary = "slices of the medium back to front, with a shadow ray per light",
    TYN_PASS_TABLES(tyn_constellation_params),
    TYN_SETTINGS(params_table),
    .of_pixels = true,
    .debug_port = CONSTELLATION_PORT_RADIANCE,
    .debug_meaning = "radiance, exposed by its own mean",
    TYN_COUNTS(CONSTELLATION_PORT_COUNTERS, struct counters_block, TYN_COUNTERS),
};
