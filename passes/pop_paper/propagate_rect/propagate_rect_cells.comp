// propagate_rect_cells.comp -- the medium's mean coefficients over each cell (the paper's section 4.2
// asks for a downscaled medium), and the cosine at which the eye sees it.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(5, grids, propagate_grid grids[]);
TYN_UNIFORM(6, camera, camera_block camera);
TYN_WRITE(7, cells, vec4 cells[]);
TYN_ARGS(propagate_rect_args args);

// Samples along each edge of a cell. A trilinear fetch is a mean over two voxels, so one per two voxels
// misses nothing. A cell no larger than a voxel takes one: a grid that coincides with the voxels reads
// them as they are.
int samples_along(float cell)
{
    float voxels = cell / args.voxel - 1e-3;
    return voxels <= 1.0 ? 1 : clamp(int(ceil(0.5 * voxels)), 2, 16);
}

void main()
{
    uint groups = propagate_groups(args.along, PROPAGATE_RECT_GROUP);
    uint n = gl_WorkGroupID.z / groups; // grid of this batch
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - n * groups * PROPAGATE_RECT_GROUP);
    if (any(greaterThanEqual(uvec3(cell), uvec3(args.cells, args.cells, args.along)))) {
        return;
    }
    propagate_grid grid = grids[args.first + n];
    vec3 sigma_s = vec3(0.0), sigma_a = vec3(0.0), g = vec3(0.0);
    bool inside = propagate_inside(grid, cell);
    int across = inside ? samples_along(grid.cell) : 0, along = inside ? samples_along(grid.along) : 0;
    vec3 samples = vec3(max(ivec3(across, across, along), 1));
    // Half the extent along M's axes of the box that a sample stands for.
    float ahead = grid.along / grid.cell * (samples.x / samples.z);
    vec3 reach = 0.5 * grid.cell / samples.x *
                 (abs(grid.across_u) + abs(grid.across_v) + ahead * abs(grid.direction));
    for (int k = 0; k < along; k++) {
        for (int j = 0; j < across; j++) {
            for (int i = 0; i < across; i++) {
                vec3 p = propagate_to_m(grid, vec3(cell) + (vec3(i, j, k) + 0.5) / samples);
                vec3 part = clamp((min(p + reach, medium.extent) - max(p - reach, 0.0)) /
                                  (2.0 * reach), 0.0, 1.0);
                float covered = part.x * part.y * part.z;
                if (covered > 0.0) {
                    medium_point m = medium_sample(clamp(p, vec3(0.0), medium.extent));
                    sigma_s += covered * m.sigma_s;
                    sigma_a += covered * m.sigma_a;
                    g += covered * m.sigma_s * phase_mean_cosine(m.phase);
                }
            }
        }
    }
    g /= max(sigma_s, vec3(1e-30));
    float each = grid.along / float(max(across * across * along, 1));
    float mu = dot(grid.direction, propagate_to_eye(camera, propagate_to_m(grid, vec3(cell) + 0.5)));
    for (uint c = 0u; c < args.channels; c++) {
        cells[propagate_index(cell, n * args.channels + c, args.cells, args.along)] =
            inside ? vec4(sigma_s[c] * each, sigma_a[c] * each, g[c], mu) : propagate_no_cell;
    }
}
