// propagate_rect_args.h -- arguments of all kernels. Included by C and GLSL.
#include "shaders/common/shared.h"

// Edge of the workgroups of kernels with one thread a cell.
#define PROPAGATE_RECT_GROUP 4
#define PROPAGATE_RECT_LOOKS 4 // at surfaces, along each side of a column of cells

// Words of the buffer "flight": iterations that were run (the most of all batches), the bits of the largest irradiance, and
// from FIRST on for every batch those of the brightest cell after each iteration (L times irradiance), W/m^2.
#define PROPAGATE_FLIGHT_RUN 0
#define PROPAGATE_FLIGHT_BRIGHTEST 1
#define PROPAGATE_FLIGHT_FIRST 2
TYN_FUNCTION tyn_uint propagate_flight_word(tyn_uint batch,
                                            tyn_uint iteration) // the latter from 1 on
{
    return PROPAGATE_FLIGHT_FIRST + batch + iteration - 1;
}

struct propagate_launches { // buffer "launches": workgroups
    tyn_uvec3 step;         // of the next iteration; 0 where it is not needed
    tyn_uvec3 copy;         // of the copy into the output; 0 where the last iteration wrote there
};
TYN_ASSERT_SIZE(propagate_launches, 24);

struct propagate_rect_args {
    tyn_uint cells;       // across the light
    tyn_uint along;       // and along it
    tyn_uint cells_along; // as that is set: 0 = cubes
    tyn_uint channels;
    tyn_uint num_ordinates; // room for; the list may have fewer
    tyn_uint first;         // grid of this batch
    tyn_uint count;         // grids of this batch
    tyn_uint last_event;
    tyn_uint rate;
    tyn_uint prefilter;
    float beta;
    float voxel;         // of what the coefficients are read from, shortest edge, m
    tyn_uint tiles;      // a row, in images
    tyn_uint num_mapped; // grids whose lights have shadow maps, from the first on
    tyn_uint cones;
    tyn_uint iterations; // in all
    tyn_uint iteration;  // this one, from 1 on
    tyn_uint flight;     // first word of this batch in the buffer
    float threshold;     // of the largest irradiance: below, iterations end
};
TYN_ASSERT_SIZE(propagate_rect_args, 76);
