// path_scene.h -- parameters that all passes of the path tracer have in common.
#pragma once
#include <tyndall/pass.h>
#include "shaders/path/path_args.h"
#include "shaders/surfaces/surface_args.h"
#include <string.h>

// Of every tracing pass. What is not in the parameter table is set by the method.
typedef struct tyn_path_params {
    int32_t guide;        // TYN_PATH_GUIDE_*
    uint32_t equiangular; // equi-angular distances for lamps; 0 = free flights alone
    int32_t max_steps;    // safety cap of one path: tentative collisions and brick crossings

    uint32_t seed;
    uint32_t first_sample, num_samples; // per pixel or point; 0 starts the statistics anew
    uint32_t max_depth;                 // longest path, scatterings; 0 = no limit
    uint32_t rr_depth;                  // Russian roulette from here on; 0 = 4
    uint32_t threads;     // at most, of a dispatch: what keeps one below the time limit; 0 = 16384
    uint32_t homogeneous; // one shape and no density grid
    uint32_t num_shapes;
    uint32_t sphere;    // the only shape is one
    uint32_t grey;      // sigma_s, sigma_a and g are equal in all channels
    uint32_t one_phase; // the phase function is
    uint32_t tabled;    // some phase function is a table
    uint32_t repeat;    // some axis is periodic
    uint32_t triangles;
    uint32_t textures;    // of their materials
    uint32_t keep_few;    // the device is a processor
    uint32_t short_loops; // tyn_capacity
    uint32_t emitters;    // some of them emit and are in the table
    uint32_t emissive;
    uint32_t glow, albedo; // by grids of colours, of some medium
    uint32_t num_lights;
    uint32_t num_lamps;   // point and spot lights among them
    uint32_t near_lamps;  // those in or near the media
    uint32_t environment; // TYN_PATH_ENV_*
    float sigma_guess;    // typical extinction, 1/m
    float stretch; // > 1: images and probes draw first flights for so many times the extinction
    uint32_t sample_offset; // images: of the random numbers
    uint32_t resumed;       // images: the statistics before are those that are gone on from
    uint32_t layers;        // images: single, multiple and transmittance as well
    uint32_t opaque;        // images: a background is seen, alpha is 1
    uint32_t ended;         // images: in a field, after max_depth scatterings
    uint32_t field;         // images: guided by one of pop's
    uint32_t scattered;     // probes: without light that has not scattered
    float world[3][3];      // probes: the world's axes in M
    float lamp_power[3];    // balance: of the lamps inside, W
    float box[2][3];        // balance of surfaces: corners of the box around everything, M
    uint32_t paths;         // balance: of a sample in each of its dispatches
    uint32_t chunks;        // balance: dispatches; fluxes: of num_samples paths of each thread
} tyn_path_params;

// By what directions are drawn beside the phase function.
enum { TYN_PATH_GUIDE_NONE, TYN_PATH_GUIDE_LIGHTS, TYN_PATH_GUIDE_FIELD };

// clang-format off
#define PATH_PARAMS \
    {"guide", TYN_PARAM_INT, offsetof(tyn_path_params, guide), TYN_PATH_GUIDE_FIELD, 0, 2, "", \
     "what directions are drawn by beside a forward phase function (g > 0.65): 0 nothing, 1 a " \
     "light, 2 pop's field in images, but a light among surfaces, in periodic and thin media and " \
     "with tables", NULL}, \
    {"equiangular", TYN_PARAM_BOOL, offsetof(tyn_path_params, equiangular), 1, 0, 1, "", \
     "draw distances by the angle seen from lamps as well; 0: free flights alone", NULL}, \
    {"max_steps", TYN_PARAM_INT, offsetof(tyn_path_params, max_steps), 200000, 100, 100000000, \
     "steps", "safety cap of one path; cut paths are counted", NULL}
// clang-format on

static const tyn_param path_params_table[] = {PATH_PARAMS};
// Of passes whose results do not depend on the number of threads, but for rounding. Below 256 a picture takes minutes.
static const tyn_param path_split_params_table[] = {
    PATH_PARAMS,
    {"threads", TYN_PARAM_INT, offsetof(tyn_path_params, threads), 0, 0, 1048576, "",
     "of a dispatch, at most; 0 = by the device", NULL, 256},
};

// Elements (pixels, points) are worked off in tiles of at most `threads`; where there are fewer, several
// threads share the samples of each. Depends on sizes alone, so that the frame keeps its structure whatever
// the number of samples.
typedef struct path_split {
    uint32_t tile, slots;
} path_split;

static inline path_split path_split_work(const tyn_path_params *p, uint32_t elements)
{
    uint32_t threads = p->threads ? p->threads : 16384;
    path_split s;
    s.tile = elements < threads ? elements : threads;
    s.slots = threads / s.tile;
    return s;
}

// Arguments of a tracing kernel for `num` elements from `first` on, each of which `slots` threads share.
static inline struct path_args path_trace_args(const tyn_path_params *p, uint32_t first,
                                               uint32_t num, uint32_t slots)
{
    struct path_args args = {0};
    args.first = first;
    args.num = num;
    args.slots = slots;
    args.first_sample = p->first_sample + p->sample_offset;
    args.num_samples = p->num_samples;
    args.seed = p->seed;
    args.num_lights = p->num_lights;
    args.max_depth = p->max_depth ? p->max_depth : UINT32_MAX;
    args.rr_depth = p->rr_depth ? p->rr_depth : 4;
    args.max_steps = (uint32_t)p->max_steps;
    args.sigma_guess = p->sigma_guess;
    args.stretch = p->stretch;
    memcpy(args.world, p->world, sizeof args.world);
    memcpy(args.box_lo, p->box[0], sizeof args.box_lo);
    memcpy(args.box_hi, p->box[1], sizeof args.box_hi);
    return args;
}

static inline void path_specialise(uint32_t spec[TYN_PATH_NUM_SPEC], const tyn_path_params *p)
{
    // Under a constant sky every direction is as good.
    bool lights = p->num_lights > 0 || p->environment == TYN_PATH_ENV_MAP || p->emitters;
    spec[TYN_PATH_SPEC_SHAPES] = p->num_shapes <= TYN_PATH_SHAPES_MAX ? p->num_shapes : 0;
    spec[TYN_PATH_SPEC_HOMOGENEOUS] = p->homogeneous ? 1 : 0;
    spec[TYN_PATH_SPEC_GREY] = p->grey ? 1 : 0;
    spec[TYN_PATH_SPEC_LIGHTS] = p->num_lights < 2 ? p->num_lights : 2;
    spec[TYN_PATH_SPEC_ENVIRONMENT] = p->environment;
    spec[TYN_PATH_SPEC_FEW] = p->triangles <= TYN_SURFACE_FEW ? p->triangles : 0;
    spec[TYN_PATH_SPEC_FLAGS] =
        (p->tabled ? TYN_PATH_TABLED : 0) | (p->repeat ? TYN_PATH_REPEAT : 0) |
        (p->sphere ? TYN_PATH_SPHERE : 0) | (p->emissive ? TYN_PATH_EMISSIVE : 0) |
        (p->field || (p->guide && lights) ? TYN_PATH_GUIDED : 0) |
        (p->num_lamps ? TYN_PATH_LAMPS : 0) |
        (p->equiangular && p->near_lamps ? TYN_PATH_EQUIANGULAR : 0) |
        (p->layers ? TYN_PATH_LAYERS : 0) | (p->scattered ? TYN_PATH_SCATTERED : 0) |
        (p->triangles || !p->homogeneous ? TYN_PATH_QUEUE : 0) | // cheap paths are not worth one
        (p->stretch > 1 ? TYN_PATH_THIN : 0) | (p->triangles ? TYN_PATH_SURFACES : 0) |
        (p->textures ? TYN_PATH_TEXTURES : 0) | (p->keep_few ? TYN_PATH_KEEP_FEW : 0) |
        (p->short_loops ? TYN_PATH_SHORT_LOOPS : 0) |
        (p->triangles && p->emitters ? TYN_PATH_EMITTERS : 0) | (p->glow ? TYN_PATH_GLOW : 0) |
        (p->albedo ? TYN_PATH_ALBEDO : 0) | (p->ended ? TYN_PATH_ENDED : 0) |
        (p->field ? TYN_PATH_FIELD : 0) | (p->one_phase ? TYN_PATH_ONE_PHASE : 0);
}
