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
    uint32_t mode;    // TYN_MEDIUM_*
    uint32_t size[2]; // of the picture, pixels
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
    uint32_t sky;      // 1: the mean of the environment lights what is outside the lattice
} tyn_shade_params;

enum {
    SHADE_PORT_MEDIUM,      // IN buffer struct medium_block
    SHADE_PORT_CAMERA,      // IN buffer struct camera_block
    SHADE_PORT_ENVIRONMENT, // IN buffer struct env_block
    SHADE_PORT_SUNS,        // IN buffer struct light_block[]
    SHADE_PORT_LIGHTS,      // IN buffer struct light_block[]: directional lights, then lamps
    SHADE_PORT_DISTANCES,   // IN 2D: gbuffer.glsl, as the two below
    SHADE_PORT_FACING,
    SHADE_PORT_COLOURS,
    // IN buffers, gbuffer_edge_args.h: pixels that show several pieces of surface.
    SHADE_PORT_EDGE_COUNT,
    SHADE_PORT_EDGES,
    TYN_BEAMS(TYN_BUNDLE_ENUM, SHADE),     // IN optional: with a medium and suns
    TYN_RADIALS(TYN_BUNDLE_ENUM, SHADE),   // IN optional: with a medium and lamps or VPLs
    TYN_SHADOWS(TYN_BUNDLE_ENUM, SHADE),   // IN optional
    TYN_VPLS(TYN_BUNDLE_ENUM, SHADE),      // IN optional
    SHADE_PORT_MOMENTS,                    // IN optional 3D: light of the lattice
    TYN_WALLS(TYN_BUNDLE_ENUM, SHADE),     // IN optional: with surfaces within it
    SHADE_PORT_ROOMS,                      // IN optional buffer, rooms.h: with walls and VPLs
    TYN_GEOMETRY(TYN_BUNDLE_ENUM, SHADE),  // IN
    TYN_MATERIALS(TYN_BUNDLE_ENUM, SHADE), // IN
    // OUT 2D RG32UI, packed_colour.glsl, as large as "distances": radiance to the camera, W/(m^2
    // sr).
    SHADE_PORT_SURFACE_RADIANCE,
    // SCRATCH 3D RGBA32F, shade_forward.comp: exists with a lattice, suns and shadows.
    SHADE_PORT_FORWARD,
    SHADE_PORT_FACES, // SCRATCH 2D RGBA32F, shade_faces.h
    SHADE_PORT_SIGHT, // SCRATCH 3D RGBA32F, the same
    SHADE_PORT_PART,  // SCRATCH 2D RGBA32UI, shade_part.glsl: exist with VPLs
    SHADE_PORT_PART_ROWS,
    SHADE_PORT_ALONE_COUNT, // SCRATCH buffers, shade_alone.glsl
    SHADE_PORT_ALONE,
    SHADE_NUM_PORTS,
};
extern const tyn_pass_desc tyn_pass_shade;
