// propagate_radial_cells.comp -- the medium's mean coefficients over each cell and the cosine at which the eye
// sees it.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(5, grids, propagate_radial_grid grids[]);
TYN_UNIFORM(6, camera, camera_block camera);
TYN_READ(7, map, vec2 map[]);
TYN_WRITE(8, cells, vec4 cells[]);
TYN_ARGS(propagate_radial_args args);

// Samples along an edge: one to two voxels (a trilinear fetch is a mean over as many), and some to tell how
// much of the cell is in the box.
int samples_along(float edge)
{
    return clamp(int(ceil(0.5 * edge / args.voxel)), 3, 8);
}

void main()
{
    uint groups = propagate_groups(args.layers, PROPAGATE_RADIAL_GROUP);
    uint n = gl_WorkGroupID.z / groups; // grid of this batch
    ivec3 cell = ivec3(gl_GlobalInvocationID.xy,
                       gl_GlobalInvocationID.z - n * groups * PROPAGATE_RADIAL_GROUP);
    if (any(greaterThanEqual(uvec3(cell), uvec3(args.cells, args.cells, args.layers)))) {
        return;
    }
    propagate_radial_grid grid = grids[args.first + n];
    vec2 span = propagate_radial_span(grid, cell.z);
    float edge = span.y - span.x, area = 0.0;
    uint texel = (args.first + n) * args.cells * args.cells + uint(cell.y) * args.cells + uint(cell.x);
    vec3 o = grid.light.position, sigma_s = vec3(0.0), sigma_a = vec3(0.0), g = vec3(0.0);
    bool inside = cell.z < int(grid.layers);
    int deep = inside ? samples_along(edge) : 0;
    int wide = inside ? samples_along(sqrt(map[texel].y) * span.y) : 0;
    for (int j = 0; j < wide; j++) {
        for (int i = 0; i < wide; i++) {
            vec2 e = 2.0 * (vec2(cell.xy) + (vec2(i, j) + 0.5) / float(wide)) / float(args.cells) - 1.0;
            vec3 x = propagate_radial_heading(grid, e), d = normalize(x);
            float part = propagate_radial_solid_angle(grid, x);
            area += part;
            // Along a ray each length counts the same: the depth is that which light going straight sees.
            for (int k = 0; k < deep; k++) {
                vec3 p = o + (span.x + (float(k) + 0.5) / float(deep) * edge) * d;
                if (all(greaterThanEqual(p, vec3(0.0))) && all(lessThanEqual(p, medium.extent))) {
                    medium_point m = medium_sample(p);
                    sigma_s += part * m.sigma_s;
                    sigma_a += part * m.sigma_a;
                    g += part * m.sigma_s * phase_mean_cosine(m.phase);
                }
            }
        }
    }
    g /= max(sigma_s, vec3(1e-30));
    float each = (cell.z == 0 ? 2.0 : 1.0) * edge / max(area * float(deep), 1e-30);
    vec3 d = normalize(propagate_radial_heading(grid, octahedral_texel(cell.xy, int(args.cells))));
    float mu = dot(d, propagate_to_eye(camera, o + 0.5 * (span.x + span.y) * d));
    for (uint c = 0u; c < args.channels; c++) {
        cells[propagate_radial_index(cell, n * args.channels + c, args.cells, args.layers)] =
            inside ? vec4(sigma_s[c] * each, sigma_a[c] * each, g[c], mu) : propagate_no_cell;
    }
}
