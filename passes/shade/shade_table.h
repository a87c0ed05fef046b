// shade_table.h -- the lights of the surfaces' shading as an image: per lane, a CPU device fetches texels much
// faster than it reads buffers. Included by C and GLSL.
//
// RGBA32F, a row a light: the lamps, the VPLs, the shadow maps of the suns.
#ifndef SHADE_TABLE_H
#define SHADE_TABLE_H
#include "shaders/beams/radial_args.h"
#include "shaders/light/shadow_args.h"

#define SHADE_ROW_VPLS TYN_RADIAL_LAMPS_MAX
#define SHADE_ROW_SUNS (TYN_RADIAL_LAMPS_MAX + TYN_RADIAL_VPLS_MAX)
#define SHADE_ROWS (TYN_RADIAL_LAMPS_MAX + TYN_RADIAL_VPLS_MAX + TYN_SHADOW_SUNS)

// Entries of a row: three numbers and a fourth.
#define SHADE_POSITION 0  // radius
#define SHADE_AXIS 1      // kind
#define SHADE_INTENSITY 2 // cos_inner
#define SHADE_CONE 3      // nothing; cos_outer
#define SHADE_TO_MAP 4    // three of the grid; begin, inverse_near, inside
#define SHADE_BASE 7
#define SHADE_SCALE 8
#define SHADE_SHADOW_ROWS 9   // three
#define SHADE_SHADOW_PLACE 12 // offset, texels; scale
#define SHADE_SHADOW_KIND 13  // near, kind
#define SHADE_COUNT 14        // of the first row: how many VPLs there are
#define SHADE_ENTRIES 15

#endif
