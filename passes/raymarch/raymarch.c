// raymarch.c -- the picture: light of the medium gathered along the rays of a camera.
#include "raymarch.h"
#include "raymarch_args.h"
#include "shaders/phase/scatter_lut_args.h"
#include "shaders/common/counters.h"
#include "passes/raymarch_tables.h"
#include <math.h>

// Less than a brick's voxels, so that what is moved into an empty brick comes from the next.
#define RAYMARCH_NOISE_MOST 7

// Steps among surfaces are up to this much longer than the medium alone asks for.
#define STEPS_AMONG_SURFACES 2.0f
#define DEPTH_AMONG_SURFACES 0.2f // ... where it is thin

enum {
    NUM_SPEC =
        7, // mode, number of suns, features, numbers of lamps, number of shapes and their kind
};

// 30 powers of two with this sum are all different.
_Static_assert((uint64_t)RAYMARCH_KERNELS + RAYMARCH_FIELD + RAYMARCH_ONE_CHANNEL +
                       RAYMARCH_UNSCALED + RAYMARCH_EMISSION + RAYMARCH_MEAN + RAYMARCH_HOST_DEPTH +
                       RAYMARCH_BACKGROUND + RAYMARCH_BEHIND + RAYMARCH_CLOSED +
                       RAYMARCH_SUPERSAMPLE + RAYMARCH_TRANSMITTANCE + RAYMARCH_DEPTH +
                       RAYMARCH_SINGLE + RAYMARCH_MULTIPLE + RAYMARCH_GLOW + RAYMARCH_SOFT_SUNS +
                       RAYMARCH_SURFACE + RAYMARCH_SURFACE_SEEN + RAYMARCH_WALLS +
                       RAYMARCH_SHADOWS + RAYMARCH_REPEAT + RAYMARCH_SPARSE_NODES +
                       RAYMARCH_SPARSE_FILL + RAYMARCH_SPARSE_PIXELS + RAYMARCH_SPOTS +
                       RAYMARCH_ROOMS + RAYMARCH_SPARSE_COARSE + RAYMARCH_NOISE + RAYMARCH_TABLED ==
                   UINT32_MAX >> 2,
               "features have bits of their own");

static const tyn_param params_table[] = {
    {"step", TYN_PARAM_FLOAT, offsetof(tyn_raymarch_params, step), 1, 0.05, 4, "voxels",
     "longest step along a ray", NULL},
    {"stop", TYN_PARAM_FLOAT, offsetof(tyn_raymarch_params, stop), 1e-3, 0, 0.1, "",
     "transmittance at which a ray ends; the rest is extrapolated", NULL},
    {"antialias", TYN_PARAM_BOOL, offsetof(tyn_raymarch_params, antialias), 1, 0, 1, "",
     "four rays a pixel where they disagree on which shapes they hit", NULL},
    {"sparse", TYN_PARAM_BOOL, offsetof(tyn_raymarch_params, sparse), 1, 0, 1, "",
     "one ray for 2x2 or 4x4 pixels where the light is smooth", NULL},
    {"noise", TYN_PARAM_FLOAT, offsetof(tyn_raymarch_params, noise), 0, 0, RAYMARCH_NOISE_MOST,
     "voxels",
     "by which places are moved where medium and light are looked up: detail that is not "
     "in the volume, nor in its shadows",
     NULL},
    {"noise_size", TYN_PARAM_FLOAT, offsetof(tyn_raymarch_params, noise_size), 8, 1, 128, "voxels",
     "of the largest of that detail's three octaves", NULL},
};

// Layers by their bit in `layers`.
static const struct {
    uint32_t layer, feature;
    uint8_t port;
} layers[] = {
    {RAYMARCH_LAYER_TRANSMITTANCE, RAYMARCH_TRANSMITTANCE, RAYMARCH_PORT_TRANSMITTANCE},
    {RAYMARCH_LAYER_DEPTH, RAYMARCH_DEPTH, RAYMARCH_PORT_DEPTH},
    {RAYMARCH_LAYER_SINGLE, RAYMARCH_SINGLE, RAYMARCH_PORT_SINGLE},
    {RAYMARCH_LAYER_MULTIPLE, RAYMARCH_MULTIPLE, RAYMARCH_PORT_MULTIPLE},
};
enum { NUM_LAYERS = sizeof(layers) / sizeof(layers[0]) };

// Of the whole picture, pixels.
static tyn_extent whole_of(const tyn_raymarch_params *p)
{
    return p->whole[0] ? (tyn_extent){p->whole[0], p->whole[1], 1}
                       : (tyn_extent){p->width, p->height, 1};
}

// Layers that need a ray in every pixel have one.
static bool is_sparse(const tyn_raymarch_params *p)
{
    const tyn_extent whole = whole_of(p);
    const uint32_t orders = RAYMARCH_LAYER_SINGLE | RAYMARCH_LAYER_MULTIPLE;
    const uint32_t dense = RAYMARCH_LAYER_DEPTH | (p->sparse_layers ? 0 : orders);
    return p->sparse && !(p->layers & dense) && !(p->noise > 0) &&
           (uint64_t)whole.x * whole.y <= RAYMARCH_REST_MAX;
}

static tyn_extent window_of(const tyn_raymarch_params *p)
{
    return p->end[0] == 0 ? (tyn_extent){p->width, p->height, 1}
                          : (tyn_extent){p->end[0] - p->first[0], p->end[1] - p->first[1], 1};
}

static tyn_extent grid_of(const tyn_raymarch_params *p, uint32_t spacing)
{
    tyn_extent window = window_of(p);
    return (tyn_extent){(window.x + spacing - 1) / spacing, (window.y + spacing - 1) / spacing, 1};
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_raymarch_params *p = params;
    tyn_extent size = {p->width, p->height, 1};
    tyn_build_image(b, RAYMARCH_PORT_RADIANCE, size, 1);
    for (uint32_t i = 0; i < NUM_LAYERS; i++) {
        if (p->layers & layers[i].layer) {
            tyn_build_image(b, layers[i].port, size, 1);
        }
    }
    tyn_extent texels = {1, 1, 1};
    uint64_t pixels = 0;
    if (is_sparse(p)) {
        // As large as for all pixels: the window follows the camera, and frames must keep their sizes.
        const uint32_t orders = RAYMARCH_LAYER_SINGLE | RAYMARCH_LAYER_MULTIPLE;
        const uint32_t rows = (p->height + 1) / 2, below = p->layers & orders ? 2 : 1;
        texels = (tyn_extent){2 * ((p->width + 1) / 2), rows + below * ((rows + 1) / 2), 1};
        pixels = (uint64_t)p->width * p->height;
    }
    tyn_build_image(b, RAYMARCH_PORT_SPARSE, texels, 1);
    tyn_build_buffer(b, RAYMARCH_PORT_REST, 2 * sizeof(struct raymarch_rest) + 4 * pixels);
    return TYN_OK;
}

static float shortest_voxel(tyn_extent size, const float extent[3])
{
    return fminf(fminf(extent[0] / fmaxf((float)size.x, 1), extent[1] / fmaxf((float)size.y, 1)),
                 extent[2] / fmaxf((float)size.z, 1));
}

// Voxels smaller than pixels have details between the nodes of a grid that its second differences do not tell of.
static bool voxels_are_seen(const tyn_raymarch_params *p, tyn_extent voxels)
{
    const tyn_extent whole = whole_of(p);
    const uint32_t across = p->across ? p->across : whole.x > whole.y ? whole.x : whole.y;
    return across >= voxels.x && across >= voxels.y && across >= voxels.z;
}

void tyn_raymarch_window(tyn_raymarch_params *params, const struct camera_block *camera)
{
    const float half[2] = {camera->half_width, camera->half_height};
    const float *axes[2] = {camera->right, camera->up};
    float lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int corner = 0; corner < 8; corner++) {
        float depth = 0, at[2] = {0, 0};
        for (int i = 0; i < 3; i++) {
            float d = (corner >> i & 1 ? params->extent[i] : 0) - camera->origin[i];
            depth += d * camera->forward[i];
            at[0] += d * axes[0][i];
            at[1] += d * axes[1][i];
        }
        float scale = camera->orthographic ? 1 : depth;
        bool beside = !camera->orthographic && depth <= 1e-3f * (fabsf(at[0]) + fabsf(at[1]));
        for (int i = 0; i < 2; i++) {
            float s = at[i] / (half[i] * scale) - camera->shift[i];
            lo[i] = beside ? -INFINITY : fminf(lo[i], s);
            hi[i] = beside ? INFINITY : fmaxf(hi[i], s);
        }
    }
    const float size[2] = {(float)params->width, (float)params->height}, nodes = RAYMARCH_NODES;
    const float from[2] = {lo[0], -hi[1]}, to[2] = {hi[0], -lo[1]}; // rows run down
    const tyn_extent whole = whole_of(params);
    const float ends[2] = {(float)whole.x, (float)whole.y};
    params->across = 1;
    for (int i = 0; i < 2; i++) {
        const float corner = (float)camera->corner[i];
        float a = floorf(0.5f * (from[i] + 1) * ends[i]) - 1, // of the whole picture
            b = ceilf(0.5f * (to[i] + 1) * ends[i]) + 1;
        a = fminf(nodes * floorf(fmaxf(a, 0) / nodes), ends[i]);
        b = fminf(fmaxf(b, a), ends[i]);
        params->across = (uint32_t)fmaxf((float)params->across, b - a);
        params->first[i] = (uint32_t)fminf(fmaxf(a - corner, 0), size[i]);
        params->end[i] = (uint32_t)fminf(fmaxf(b - corner, (float)params->first[i]), size[i]);
    }
    if (params->first[0] >= params->end[0] || params->first[1] >= params->end[1]) {
        // Out of sight: one pixel, as all zeros would mean all.
        params->first[0] = params->first[1] = 0;
        params->end[0] = params->end[1] = 1;
    }
}

static uint32_t features_of(const tyn_recorder *r, const tyn_raymarch_params *p)
{
    bool field = tyn_rec_has(r, RAYMARCH_PORT_INSCATTER);
    bool glow = tyn_rec_has(r, RAYMARCH_PORT_GLOW);
    bool surface = tyn_rec_has(r, RAYMARCH_PORT_SURFACE);
    bool behind = p->background || surface || glow || p->layers & RAYMARCH_LAYER_TRANSMITTANCE;
    uint32_t features = 0;
    for (uint32_t k = 0; k < NUM_LAYERS; k++) {
        features |= p->layers & layers[k].layer ? layers[k].feature : 0;
    }
    features |= p->kernels ? RAYMARCH_KERNELS : 0;
    features |= p->tabled ? RAYMARCH_TABLED : 0;
    features |= tyn_rec_extent(r, RAYMARCH_PORT_LUT).x > TYN_LUT_DEPTHS ? RAYMARCH_SOFT_SUNS : 0;
    features |= field ? RAYMARCH_FIELD : 0;
    features |= p->field != TYN_INSCATTER_SCALED ? RAYMARCH_UNSCALED : 0;
    features |= glow ? RAYMARCH_GLOW : 0;
    features |= p->emissive ? RAYMARCH_EMISSION : 0;
    features |= p->mean ? RAYMARCH_MEAN : 0;
    features |= tyn_rec_has(r, RAYMARCH_PORT_HOST_DEPTH) ? RAYMARCH_HOST_DEPTH : 0;
    features |= p->background ? RAYMARCH_BACKGROUND : 0;
    features |= surface ? RAYMARCH_SURFACE : 0;
    features |= surface && p->surfaces ? RAYMARCH_SURFACE_SEEN : 0;
    features |= behind ? RAYMARCH_BEHIND : 0;
    features |= p->closed ? RAYMARCH_CLOSED : 0;
    features |= p->repeat ? RAYMARCH_REPEAT : 0;
    features |= p->antialias ? RAYMARCH_SUPERSAMPLE : 0;
    features |= p->noise > 0 ? RAYMARCH_NOISE : 0;
    features |= p->spots ? RAYMARCH_SPOTS : 0;
    features |= p->one_channel ? RAYMARCH_ONE_CHANNEL : 0;
    features |= tyn_rec_has(r, RAYMARCH_PORT_WALL_LINKS) ? RAYMARCH_WALLS : 0;
    features |= tyn_rec_has(r, RAYMARCH_PORT_WALL_LINKS) && tyn_rec_has(r, RAYMARCH_PORT_ROOMS)
                    ? RAYMARCH_ROOMS
                    : 0;
    features |= tyn_rec_has(r, RAYMARCH_PORT_SHADOW_ATLAS) ? RAYMARCH_SHADOWS : 0;
    return features;
}

// Rays of the nodes of a grid, of those of a finer one where that is needed, and of the pixels where that is.
static void record_sparse(tyn_recorder *r, const tyn_raymarch_params *p, tyn_dispatch rays,
                          uint32_t *spec, struct raymarch_args *args)
{
    const uint32_t features = spec[2], both = RAYMARCH_SPARSE_NODES | RAYMARCH_SPARSE_PIXELS;
    const uint32_t nodes = p->parted ? RAYMARCH_SPARSE_NODES : both;
    const uint32_t pixels = p->parted ? RAYMARCH_SPARSE_PIXELS : both;
    const struct raymarch_rest none = {.groups = {RAYMARCH_REST_GROUPS, 0, 1}};
    const struct raymarch_rest empty[2] = {none, none};
    tyn_rec_update(r, RAYMARCH_PORT_REST, 0, empty, sizeof empty);
    args->rays = RAYMARCH_ALL_NODES;
    rays.cells = grid_of(p, RAYMARCH_NODES);
    rays.label = "sparse rays";
    spec[2] = features | nodes;
    tyn_rec_dispatch(r, &rays);
    rays.label = "nodes that lie between";
    spec[2] = features | RAYMARCH_SPARSE_FILL | RAYMARCH_SPARSE_COARSE;
    tyn_rec_dispatch(r, &rays);
    rays.label = "rays of the other nodes";
    args->rays = RAYMARCH_LISTED_NODES;
    spec[2] = features | nodes;
    tyn_rec_dispatch_indirect(r, &rays, RAYMARCH_PORT_REST, 0);
    rays.label = "pixels that lie between";
    rays.cells = grid_of(p, 2);
    spec[2] = features | RAYMARCH_SPARSE_FILL;
    tyn_rec_dispatch(r, &rays);
    rays.label = "rays of the other pixels";
    args->rays = RAYMARCH_LISTED_PIXELS;
    spec[2] = features | pixels;
    tyn_rec_dispatch_indirect(r, &rays, RAYMARCH_PORT_REST, sizeof(struct raymarch_rest));
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_raymarch_params *p = params;
    const uint32_t features = features_of(r, p);
    uint32_t spec[NUM_SPEC] = {p->mode,           p->num_suns,   features, p->num_lamps,
                               p->num_near_lamps, p->num_shapes, p->kind};
    float voxel = shortest_voxel(tyn_rec_extent(r, RAYMARCH_PORT_DENSITY), p->extent);
    // Edges of shadows are found within steps, and what is left is far less than what the lattice is off by there.
    bool surfaces = features & (RAYMARCH_WALLS | RAYMARCH_SHADOWS) && features & RAYMARCH_FIELD;
    float longest = fminf(voxel, p->longest_step);
    float thin = surfaces ? STEPS_AMONG_SURFACES * longest : longest;
    if (surfaces && p->majorant > 0) { // nowhere deeper
        longest = fmaxf(longest, fminf(thin, DEPTH_AMONG_SURFACES / p->majorant));
    }
    struct raymarch_args args = {
        .step = p->step * longest,
        .longest = p->step * thin,
        .step_depth = p->step * DEPTH_AMONG_SURFACES,
        .stop = p->stop,
        .depth = {p->depth[0], p->depth[1], p->depth[2], p->depth[3]},
        .first = {p->first[0], p->first[1]},
        .end = {p->end[0], p->end[1]},
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .reach = p->reach,
        .noise = p->noise * voxel,
        .noise_size = p->noise_size * voxel,
    };
    if (p->end[0] == 0) {
        args.end[0] = p->width;
        args.end[1] = p->height;
    }
    // What lies outside the window first, as the window's edges are not on workgroups.
    // The binding of a layer that is not made is not written to, so any image will do.
    uint8_t absent[NUM_LAYERS][2], background_ports[TYN_MAX_BINDINGS], ports_of[TYN_MAX_BINDINGS];
    uint32_t num_absent = 0;
    for (uint32_t k = 0; k < NUM_LAYERS; k++) {
        absent[num_absent][0] = layers[k].port;
        absent[num_absent][1] = RAYMARCH_PORT_RADIANCE;
        num_absent += p->layers & layers[k].layer ? 0 : 1;
    }
    const uint32_t kernel = p->grey ? KERNEL_GREY : KERNEL_COLOUR;
    const uint8_t(*pairs)[2] = (const uint8_t(*)[2])absent;
    tyn_ports_exchanged(&kernels[KERNEL_BACKGROUND], pairs, num_absent, background_ports);
    tyn_ports_exchanged(&kernels[kernel], pairs, num_absent, ports_of);
    TYN_DISPATCH(r, .kernel = KERNEL_BACKGROUND, .cells = {p->width, p->height, 1}, .args = &args,
                 .ports = background_ports, .spec = spec);
    tyn_dispatch rays = {.kernel = kernel, .args = &args, .ports = ports_of, .spec = spec};
    if (is_sparse(p) && voxels_are_seen(p, tyn_rec_extent(r, RAYMARCH_PORT_DENSITY))) {
        record_sparse(r, p, rays, spec, &args);
    } else {
        rays.cells = window_of(p);
        tyn_rec_dispatch(r, &rays);
    }
}

const tyn_pass_desc tyn_pass_raymarch = {
    .name = "raymarch",
    .summary = "light of the medium gathered along the rays of a camera",
    TYN_PASS_TABLES(tyn_raymarch_params),
    .of_pixels = true,
    TYN_SETTINGS(params_table),
    .debug_port = RAYMARCH_PORT_RADIANCE,
    .debug_meaning = "radiance, exposed by its own mean",
    TYN_COUNTS(
        RAYMARCH_PORT_COUNTERS, struct counters_block, TYN_COUNTERS,
        TYN_COUNTER_HIDDEN("of the picture's light",
                           "accuracy: pixels would be negative and are set to 0: %g %% of the "
                           "picture's light")),
};
