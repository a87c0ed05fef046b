// shade.h -- radiance of the surfaces that the camera sees.
#pragma once
#include <tyndall/pass.h>
#include "shaders/common/bundles.h"

// Along the longest side, of the places from where it is asked what hides the box.
enum { SHADE_SIGHT_PLACES = 10 };

typedef struct tyn_shade_params {
    // Pixels along each side that share VPLs; 0: as many as the picture's size asks for.
    int32_t pattern;
    // Pixels along each side of a block that has one place for smooth light; 0: as the picture's
    // size asks.
    int32_t step;
    // Set by the method:
    uint32_t mode;     // TYN_MEDIUM_*
    uint32_t size[2];  // of the picture, pixels
    uint32_t whole[2]; // not {0}: of the picture that this is a part of; it decides instead
    // That shine on surfaces: of "beams", or the first of "suns" without a medium.
    uint32_t num_suns;
    uint32_t num_directional; // lights before the lamps in "lights"
    uint32_t num_lamps;
    uint32_t one_channel; // 1: "moments" has one channel, to be multiplied with `tint`
    float tint[3];
    // 1: surfaces outside the lattice get the light that leaves it, if there are "moments".
    uint32_t outside;
    // Places from where it is asked what hides the box: corner, distance (M, m).
    float sight_lo[3], sight_edge;
    uint32_t sight_places[3];
    uint32_t hidden;   // 1: surfaces may hide that light: can rays be traced?
    uint32_t textured; // 1: materials may have textures
    uint32_t samples;  // of the G-buffer, along each side of a pixel
    uint32_t parted;   // 1: a kernel for pixels, one for listed ones; 0: one, and SHADE_SLICED
    uint32_t sky_fan;  // directions of an ordinate
    uint32_t sky_cells
        [3]; // that have columns along ordinates (tyn_lattice_dims); 0: nothing dims their light
    uint32_t
        sky; // 1: without maps of ordinates the mean of the environment lights what is outside the lattice
} tyn_shade_params;

// clang-format off
#define SHADE_PORTS(X) \
    X(SHADE, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(SHADE, CAMERA, camera, IN, BUFFER, "struct camera_block"), \
    X(SHADE, ENVIRONMENT, environment, IN, BUFFER, "struct env_block"), \
    X(SHADE, SUNS, suns, IN, BUFFER, "struct light_block[]"), \
    X(SHADE, LIGHTS, lights, IN, BUFFER, "struct light_block[]: directional lights, then lamps"), \
    TYN_GBUFFER(X, SHADE), \
    TYN_BEAMS(X##_OPTIONAL, SHADE), \
    TYN_RADIALS(X##_OPTIONAL, SHADE), \
    TYN_SHADOWS(X##_OPTIONAL, SHADE), \
    TYN_VPLS(X##_OPTIONAL, SHADE), \
    X(SHADE, MOMENTS, moments, OPTIONAL, IMAGE_3D, "fluence and flux on the lattice, W/m^2"), \
    TYN_WALLS(X##_OPTIONAL, SHADE), \
    X(SHADE, ROOMS, rooms, OPTIONAL, BUFFER, "rooms.h: with walls and VPLs"), \
    TYN_GEOMETRY(X, SHADE), \
    TYN_MATERIALS(X, SHADE), \
    TYN_SKY_MAPS(X##_OPTIONAL, SHADE), \
    TYN_COLUMNS(X##_OPTIONAL, SHADE), \
    X(SHADE, SURFACE_RADIANCE, surface_radiance, OUT, IMAGE_2D, \
        "piece_light.glsl: radiance to the camera, W/(m^2 sr), and distance, m", \
        .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(SHADE, COUNTERS, counters, OUT, BUFFER, \
        "struct counters_block: places where the lattice's light on a surface was clamped"), \
    X(SHADE, FORWARD, forward, SCRATCH, RGBA_3D, "shade_forward.comp: exists with a lattice, suns and shadows"), \
    X(SHADE, FACES, faces, SCRATCH, RGBA_2D, "shade_faces.h: light that leaves the medium's box"), \
    X(SHADE, SIGHT, sight, SCRATCH, RGBA_3D, "from where faces of the medium's box are seen"), \
    X(SHADE, PART, part, SCRATCH, IMAGE_2D, \
        "a block's part of the VPLs' light, then all", .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(SHADE, PART_ROWS, part_rows, SCRATCH, IMAGE_2D, \
        "summed along rows, then all smooth light", .format = VK_FORMAT_R32G32B32A32_UINT), \
    X(SHADE, EDGE_COUNT, edge_count, SCRATCH, BUFFER, "struct gbuffer_edge_count"), \
    X(SHADE, EDGES, edges, SCRATCH, BUFFER, "uint[]: pixels whose samples see several triangles"), \
    X(SHADE, ALONE_COUNT, alone_count, SCRATCH, BUFFER, "shade_alone.glsl: struct gbuffer_edge_count"), \
    X(SHADE, ALONE, alone, SCRATCH, BUFFER, "pixels with pieces that have smooth light of their own")
// clang-format on
TYN_PASS(SHADE, shade);
