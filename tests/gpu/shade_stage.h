// shade_stage.h -- a stage for tests of the pass shade: planes seen by a camera, lights and a medium, all made by hand.
//
// The G-buffer is made here, of planes of which the test says where the picture shows them. M is the world.
#pragma once
#include "gpu_test.h"
#include "passes/shade/shade.h"
#include "shaders/beams/radial_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "shaders/surfaces/surface_args.h"

enum { WIDTH = 24, HEIGHT = 16, MOST_SAMPLES = 4, MAP = 64, CELLS = 4, VPL_MAP = 8, GRIDS = 16 };
enum { NONE, WHOLE, SEVERAL }; // what a pixel of the G-buffer shows
enum { LIT, DARK, HALF };      // shadow maps: HALF hides what is at u > 0

typedef struct shade_piece { // a plane
    float at[3], facet[3], normal[3], albedo[3], emission[3];
} shade_piece;

typedef struct shade_stage {
    tyn_shade_params params;
    struct medium_block medium;
    struct camera_block camera;
    struct env_block environment;
    struct light_block suns[TYN_LIGHTS_MAX], lights[TYN_LIGHTS_MAX];
    shade_piece pieces[2];
    int (*shown)(double x, double y); // the piece at a place of the picture, pixels; -1: none
    int samples;                      // along each side of a pixel
    bool fog;                         // beams and radials
    float mean[3];                    // of the medium: density, or sigma_s; then sigma_a
    float scaled[3];                  // (1 - f) sigma_s
    int shadows;                      // -1: none
    struct shadow_light maps[TYN_SHADOW_MAX];
    struct radial_vpls vpls;
    int hidden_vpl; // -1: no maps
    bool lattice;   // within it are surfaces
    float moments[3][4];
    const uint32_t *rooms;
    struct surface_triangle triangles[4];
    struct surface_vertex vertices[12];
    struct surface_node node;
} shade_stage;

extern shade_stage stage; // large

// A floor z = 0 seen from above through parallel rays, in a medium's box of 4 m.
void shade_start(void);
// A camera at `at` that looks along `forward`; half as high as it is wide, about.
void shade_look(const float at[3], const float forward[3], float half_height, bool parallel);
// A triangle in a piece's plane, its front where the facet points.
void shade_triangle(uint32_t k);
// What virtual light k has of the medium on its ways: its grid is no other's.
double shade_vpl_density(uint32_t k);
void shade_draw(gpu_test *t);
// Of a pixel that shows two pieces, as it is stored: 0 or 1, m.
double shade_group_distance(int x, int y, int group);

// Where the ray through a place of the picture (pixels) meets a piece's plane; returns the distance.
double shade_meet(const shade_piece *on, double x, double y, double p[3]);
// Irradiance at p on a side n; the pixel that is asked about is (shade_x, shade_y).
typedef void (*shade_light_at)(const double p[3], const double n[3], double irradiance[3]);
extern int shade_x, shade_y;
// All samples against emission + albedo / pi irradiance, within `tolerance` of the largest channel; what is a thousandth
// of the picture's brightest counts as that. Samples for which `sure` is false are left out. Returns what all of the
// picture's light is off by, as a part of it.
double shade_compare(shade_light_at light, bool (*sure)(const double p[3]), double tolerance);
