// regime.h -- the regime of a scene: the figures that decide which method suits it and what it costs.
//
// Read from the scene's media, lights and surfaces alone, without a device. Media are sampled at 64 places
// along the longest side of their box, always the same ones, so that large grids cost no more than small
// ones.
#pragma once
#include <cjson/cJSON.h>
#include <tyndall/scene.h>

typedef enum regime_light {
    REGIME_SUN = 0,  // directional lights, and the suns of a map
    REGIME_SKY,      // a constant environment
    REGIME_MAP,      // an environment map without its suns
    REGIME_LAMPS,    // point and spot lights
    REGIME_EMISSION, // media that emit
    REGIME_SURFACES, // surfaces that emit
    REGIME_NUM_LIGHTS,
} regime_light;

// Cells of the lattice of `pop` along the longest side, as it is without settings.
enum { REGIME_LATTICE_CELLS = 32 };

// Depths and paths are 0 where the scene has no medium.
typedef struct regime {
    // Optical depth of straight ways through the medium, along the axes of its box (a lone shape's own, else
    // the world's); those that miss it do not count, nor do axes along which it repeats.
    double optical_depth; // mean over all of them, by cross-section, and over R, G, B
    double depth_rgb[3];  // the same by channel
    double depth_axis[3]; // mean over those along each axis
    double depth_densest; // the greatest of depth_axis
    double depth_deepest; // of any single one
    double albedo;        // of what is met: scattering / extinction, over the whole medium
    double albedo_rgb[3];
    double g, g_rgb[3]; // mean cosine, weighted by scattering
    // Of any channel of any medium that scatters; the least also by the height straight back.
    double least_g, most_g;
    // Weighted by extinction: at the places where light meets the medium.
    double mean_free_path;           // 1 / sigma_t, m
    double transport_mean_free_path; // 1 / (sigma_a + (1 - g) sigma_s), m
    // 1 / (sigma_a + (1 - f) sigma_s), m (delta scaling), of the densest channel
    double scaled_mean_free_path;

    double sides[3];  // of the box, m
    double thickness; // of the box: its shortest side along which it does not repeat, m
    double cell;      // side of a lattice cell, m
    // Transport mean free paths across a cell: where light meets the medium, and in the densest cell.
    double cell_depth, cell_depth_max;
    double contrast; // densest place over the mean of where there is medium; 1: homogeneous
    double fill;     // share of the box that holds medium
    // Volume of the box over that of a cube as long: so much of a lattice there is.
    double box_share;
    // 1: media are grey and all light is of one colour, so one solve is enough; else 3.
    uint32_t channels;
    uint64_t voxels; // of all grids
    bool periodic;   // a shape repeats

    // Light. Shares of the power that comes into the box (or leaves emitters within it), about.
    double share[REGIME_NUM_LIGHTS];
    uint32_t num_suns, num_lamps;

    uint32_t num_triangles;

    // The picture, as if there were no surfaces.
    double view_fill;   // share of it whose rays lose 1 % of their light or more in the medium
    double view_depth;  // mean optical depth of those
    bool camera_inside; // a perspective camera stands in the medium
} regime;

extern const char *const regime_light_names[REGIME_NUM_LIGHTS]; // "sun", "sky", "map", "lamps", ...

// Of a scene that has passed tyn_scene_check. `camera` NULL: the scene's first, else the one it is framed
// with; its aspect is that of the picture (0: 16:9). False: out of memory.
bool regime_of(const tyn_scene *scene, const tyn_camera *camera, regime *r);

// Of the light that has scattered, about which part has done so more than once, and `single` misses: albedo
// x the chance of meeting the medium again, (D/2) / (1 + D/2) with the mean depth D, as half of it is still
// to come on average. Measured: docs/choosing.md.
double regime_multiple(const regime *r);

double regime_longest(const regime *r); // side of the box, m

// As many lattice cells along the longest side as `pop` takes where `cells` are asked for: 256, and no more than
// 64 x 64 x 64 in all.
double regime_cells(const regime *r, double cells);

// The "regime" of report.json.
cJSON *regime_json(const regime *r);
bool regime_read(const cJSON *json, regime *r); // and back; what is missing is 0. False: no regime
