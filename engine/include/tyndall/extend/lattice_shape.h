// lattice_shape.h -- the lattice of cubic cells on which all light that has scattered is solved for. Tier 3.
#pragma once
#include "../pass.h"

#ifdef __cplusplus
extern "C" {
#endif

// Cells along the longest side, and of all: long and flat media may have more along it than others.
enum { TYN_LATTICE_MAX_CELLS = 256, TYN_LATTICE_MAX_ALL = 64 * 64 * 64, TYN_LATTICE_MAX_SUNS = 4 };

// What all passes of a lattice have in common; a method fills it once.
typedef struct tyn_lattice_shape {
    float extent[3];    // medium_block.extent, m
    int32_t cells;      // along the longest side: the param "lattice.cells"
    uint32_t channels;  // 1 or 3 that are solved
    float tint[3];      // of the one channel (see tyn_lattice_tint), else 1, 1, 1
    uint32_t repeat[3]; // medium_block.repeat; not all three. Such sides are whole numbers of cells
} tyn_lattice_shape;

// Cells along each axis: cubes of longest side / cells; the box they fill holds the medium's.
TYN_API tyn_extent tyn_lattice_dims(const float extent[3], int32_t cells);

// The most cells along the longest side, up to `cells`, with which the sides that repeat are whole numbers of
// cells and there are not more than TYN_LATTICE_MAX_ALL; 0: none.
TYN_API int32_t tyn_lattice_fit(const float extent[3], const uint32_t repeat[3], int32_t cells);

// True if `n` colours (lights, emission, mean of the environment) are multiples of one colour, its
// `tint` with a largest component of 1. With a grey medium one channel is then enough: shaders
// solve for dot(color, tint) / dot(tint, tint), and merge and probe multiply by the tint. Else (1,
// 1, 1).
TYN_API bool tyn_lattice_tint(const float (*colors)[3], uint32_t n, float tint[3]);

#ifdef __cplusplus
}
#endif
