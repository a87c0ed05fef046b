// lpv_args.h -- light propagation volumes: transfer functions, push constants. Included by C and GLSL.
//
// Two bands of spherical harmonics are four numbers: of the power in a cell, (P + 3 F.O) / (4 pi) goes into the directions
// O, P its integral and F its first moment, both in W. Transfer function T_j of neighbour j is the projection of the
// directions that are closer to it than to any other of the 26. It extracts <L|T_j> = gamma_j (P + 3 m_j.F), with gamma_j
// its share of the sphere and m_j its mean direction, and deposits T_j / <T_j|1>, which is (1, m_j) for a watt. The
// gamma_j sum to 1, so that no power is lost. By symmetry m_j lies along the link, and three pairs of numbers are all: those of
// neighbours across faces, corners and edges. passes/lpv/tests/gpu/lpv.c integrates them anew.
#include "shaders/common/shared.h"

#define LPV_LINKS 26 // numbered as walls_step does
#define LPV_SHELLS 3 // across faces, corners, edges
#define LPV_GAMMA_FACE 0.0457778912
#define LPV_GAMMA_CORNER 0.0351956398
#define LPV_GAMMA_EDGE 0.0369806279
#define LPV_COSINE_FACE 0.9532187324 // length of m_j
#define LPV_COSINE_CORNER 0.9609674044
#define LPV_COSINE_EDGE 0.9605306704
// From centre to centre on average, edges of a cell: (6 + 12 sqrt 2 + 8 sqrt 3) / 26.
#define LPV_DISTANCE 1.416422

#define LPV_EXTINCTION_PAPER 0
#define LPV_EXTINCTION_EXACT 1

#define LPV_BLOCKERS_NONE 0
#define LPV_BLOCKERS_EXACT 1
#define LPV_BLOCKERS_FUZZY 2

struct lpv_args {
    tyn_uvec3 dims;
    tyn_uint channels;
    tyn_vec3 tint;
    float dx;  // m
    float own; // start: share of light scattered or emitted in a cell that counts there at once
};
TYN_ASSERT_SIZE(lpv_args, 36);
