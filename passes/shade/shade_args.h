// shade_args.h -- features and push constants of the surfaces' shading. Included by C and GLSL.
#include "shaders/common/shared.h"

// Numbers of specialisation constants.
#define SHADE_SPEC_FEATURES 1

// Bits of the specialisation constant "features".
#define SHADE_MEDIUM (1u << 0)  // light is attenuated on its way
#define SHADE_SHADOWS (1u << 1) // there are shadow maps
#define SHADE_VPLS (1u << 2)
#define SHADE_LATTICE (1u << 3)     // there is light in the lattice
#define SHADE_ONE_CHANNEL (1u << 4) // ... of one channel, to be multiplied with `tint`
#define SHADE_SKY                                                                                  \
    (1u << 5) // the mean of the environment lights what is outside the lattice, without shadows
#define SHADE_SPREAD (1u << 6)   // sunlight scattered forward comes from around its sun
#define SHADE_OUTSIDE (1u << 7)  // surfaces outside the box get light that leaves it: shade_faces.h
#define SHADE_TEXTURED (1u << 8) // materials may have textures

// There are lamps: a loop of no turns costs a CPU device as much as one of one turn.
#define SHADE_LAMPS (1u << 9)

#define SHADE_ROOMS (1u << 10) // VPLs shine in rooms of the lattice

#define SHADE_SKY_MAPS                                                                             \
    (1u << 11)                   // the sky's light comes along ordinates, past what their maps show
#define SHADE_COLUMNS (1u << 12) // ... and through the medium

// shade_surface.comp: every pixel, or those that are listed; with both bits args.listed tells which.
#define SHADE_PIXELS (1u << 13)
#define SHADE_EDGES (1u << 14)
#define SHADE_SLICED (1u << 15) // threads share the light of a listed place

// Light of which the pixels of a pattern each take a part.
#define SHADE_SHARED (SHADE_VPLS | SHADE_SKY_MAPS)

#define SHADE_PLACES 64 // that light which was scattered forward may come from
// Pixels of a pattern along each side; each takes a part of the VPLs. Of small pictures five pixels are much.
#define SHADE_SIDE 5
#define SHADE_SIDE_SMALL 4
#define SHADE_SMALL 64 // pixels along the shorter side
// Pixels along each side of a block that has one place where light of VPLs and of the lattice is taken.
#define SHADE_STEP 2
// Pixels along the picture's shorter side; of smaller ones two pixels are much.
#define SHADE_STEP_FROM 384
// Widths w of a pixel: VPLs nearer than that, and smaller, are near. What a VPL at the height h sends to a plane,
// h^2 / (h^2 + x^2)^2, is linear between pixels of the pattern that are 5 w apart but for 5^2 / 8 x 4 w^2 / h^2 of it: 3 %.
#define SHADE_VPL_NEAR 20.0
#define SHADE_MOST 8   // VPLs that a pixel takes in any case
#define SHADE_MANY 4   // pixels that a thread takes VPLs at
#define SHADE_SLICES 8 // threads that share the light of a listed place: rows of a workgroup

struct shade_args {
    tyn_uint num_directional; // lights before the lamps in "lights"
    tyn_uint num_lamps;
    tyn_vec3 tint;
    tyn_vec3 sight_lo; // corner of the places of shade_sight.comp, and their distance (M, m)
    float sight_edge;
    tyn_uint sky_fan;    // directions of an ordinate
    tyn_uvec3 sky_cells; // that have columns along them
    tyn_uint listed;     // 1: a thread takes an element of a list
};
TYN_ASSERT_SIZE(shade_args, 56);
