// propagate_rect_setup.comp -- places the grid of each ordinate, and prefilters.
#include "../common/propagate.glsl"
#include "shaders/light/ordinate_args.h"
#include "propagate_rect_args.h"

layout(local_size_x = 64) in;
TYN_UNIFORM(0, medium, medium_block medium);
TYN_READ(1, ordinates, ordinates_block ordinates);
TYN_WRITE(2, grids, propagate_grid grids[]);
TYN_WRITE(3, places, propagate_place places[]);
TYN_UPDATE(4, flight, uint flight[]);
TYN_ARGS(propagate_rect_args args);

// Mean cosine of an ordinate's light as it enters (section 5.1). The heuristic's w, the importance in
// (0, 1) that the text calls proportional and very similar to the solid angle of the ordinate's region,
// is read as the region's share of the sphere in units of the mean share 1 / N: with beta = 1 regions of
// the mean size have their exact mean cosine, 1 - 1 / N.
float prefiltered(const ordinate o, uint count)
{
    if (args.prefilter == TYN_PROPAGATE_PREFILTER_HEURISTIC) {
        float share = min(o.solid_angle / (4.0 * HG_PI) * float(count), 1.0);
        return pow(1.0 - share / float(count), args.beta);
    }
    return args.prefilter == TYN_PROPAGATE_PREFILTER_EXACT ? o.mean_cosine : 1.0;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.num_ordinates) {
        return;
    }
    uint count = min(ordinates.count, uint(TYN_ORDINATES_MAX));
    bool used = i < count;
    ordinate o = ordinates.list[i];
    propagate_grid grid =
        propagate_grid_of(medium.extent, used ? o.direction : vec3(0.0, 0.0, 1.0), args.cells,
                          args.cells_along);
    grid.size *= used ? 1u : 0u;
    grid.irradiance = used ? o.irradiance : vec3(0.0);
    grid.mean_cosine = used ? clamp(prefiltered(o, count), 0.0, 1.0) : 1.0;
    grid.channels = args.channels;
    float stretch = propagate_stretch(grid);
    if (args.cones == TYN_PROPAGATE_CONES_CELL && stretch != 1.0) {
        grid.cone = inversesqrt(1.0 + stretch * stretch);
    }
    if (args.threshold > 0.0) {
        float brightest = max(grid.irradiance.r, max(grid.irradiance.g, grid.irradiance.b));
        atomicMax(flight[PROPAGATE_FLIGHT_BRIGHTEST], floatBitsToUint(max(brightest, 0.0)));
    }
    grids[i] = grid;
    places[i] = propagate_place_of(grid);
}
