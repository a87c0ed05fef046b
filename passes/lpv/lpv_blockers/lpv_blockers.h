// lpv_blockers.h -- how much surfaces block light between cells, fuzzily, from maps along the axes.
//
// Six maps look from the middle of the lattice outwards (tyn_lpv_blockers_view), half a cell beyond it. Every texel adds its area, with a
// cosine lobe about its normal, to one of the cells of a lattice that is shifted by half an edge; of the shifted cells in the
// middle of a link the mean blocks what goes along it (Kaplanyan and Dachsbacher 2010, Sec 4.4).
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>
#include "shaders/common/bundles.h"

typedef struct tyn_lpv_blockers_params {
    tyn_lattice_shape shape;
    int32_t texels; // "lpv_blockers.texels": of a map's side
} tyn_lpv_blockers_params;

// clang-format off
#define LPV_BLOCKERS_PORTS(X) \
    TYN_RSM(X, LPV_BLOCKERS), \
    X(LPV_BLOCKERS, BLOCKING, blocking, OUT, BUFFER, \
        "uint[cell][7]: of 26 links (walls_step), 255 times the share of light along it that does not arrive"), \
    X(LPV_BLOCKERS, POTENTIAL, potential, SCRATCH, BUFFER, \
        "ivec4[shifted cell]: its lobes, constant and linear, in units of dx^2 / 2^24")
// clang-format on
TYN_PASS(LPV_BLOCKERS, lpv_blockers);

enum { TYN_LPV_BLOCKERS_MAPS = 6 };
// Where map `i` lies in its atlas of three by two, and its rows M -> clip; the area of its texels, m^2, is returned.
float tyn_lpv_blockers_view(const tyn_lpv_blockers_params *params, uint32_t i, uint32_t offset[2],
                            float rows[4][4]);
