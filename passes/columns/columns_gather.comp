// columns_gather.comp -- from the columns to the cells; x: two cells of a row, and rows, across the axis v
// of the ordinate's grid, along which a thread goes; z: components of the ordinates of the batch.
//
// A cell's ray lies between four columns, so the depth is interpolated between theirs. Where neighbouring
// rays enter the box through different faces the depth has a kink: there the columns have, together, not
// gone as far through the box as the rays to the cell. What they lack is the medium at the ray's entry
// times that distance; without it the edges of a box of medium would show.
#include "shaders/light/ordinate_args.h"
#include "shaders/beams/columns_args.h"
#include "shaders/common/counters.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "columns_grid.glsl"

layout(local_size_x = COLUMNS_GROUP) in;
TYN_ARGS(columns_args args);
TYN_UNIFORM(5, ordinates, ordinates_block ordinates);
TYN_READ(6, nodes, float nodes[]); // [ordinate][component][slice][v][u]
TYN_WRITE(7, columns, uint columns_words[]); // columns.glsl
TYN_UPDATE(8, counters, counters_block counters);

uint non_finite = 0u; // of the thread

const uint num_components = medium_mode == TYN_MEDIUM_DENSITY ? 1u : COLUMNS_COMPONENTS;

float component_at(uint component, vec3 uvw)
{
    vec3 sigma_s = textureLod(density_tex, uvw, 0.0).rgb;
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return sigma_s.r;
    }
    vec3 sigma_a = textureLod(sigma_a_tex, uvw, 0.0).rgb;
    phase p[3] = medium_phase(uvw);
    similarity_clamp(sigma_s, p);
    vec3 value = component < 3u ? sigma_s
                                : component < 6u ? sigma_a : sigma_s * (1.0 - delta_fraction(p));
    return value[component % 3u];
}

// x mod n for whole numbers -8192 < x < 8192.
ivec2 wrapped(ivec2 x, int n)
{
    return x - n * ivec2(floor((vec2(x) + 0.5) / float(n)));
}

// The part of a cell that is in the box, along an axis: its middle, and a quarter of its width.
void part_of_cell(vec2 cell, float low, int size, out vec2 middle, out vec2 quarter)
{
    vec2 from = max(cell, low), to = min(cell + 1.0, float(size) - low);
    middle = 0.5 * (from + to);
    quarter = 0.25 * (to - from);
}

// Square roots, for the range of halves; rounded here to what a half holds, as packing may truncate.
vec2 encoded(vec2 x)
{
    const bvec2 broken = isnan(x);
    non_finite += uint(any(broken) || any(isinf(x)));
    vec2 root = mix(sqrt(clamp(x, 0.0, 4.29e9)), vec2(0.0), broken);
    return uintBitsToFloat((floatBitsToUint(root) + 0x1000u) & 0xFFFFE000u);
}

void main()
{
    uint local = gl_WorkGroupID.z / num_components, component = gl_WorkGroupID.z % num_components;
    uint n = args.first + local;
    if (n >= ordinates.count) {
        return;
    }
    ivec3 dims = ivec3(args.dims);
    columns_grid grid = columns_grid_of(ordinates.list[n].direction, lattice_box_of(medium.extent, dims));
    int row = (dims.x + 1) / 2, thread = int(gl_GlobalInvocationID.x);
    int across = thread / row, word_x = thread - across * row;
    if (across >= dims[grid.v == 1 ? 2 : 1]) {
        return;
    }
    // In each pair of numbers that follow is one for each of the two cells.
    ivec3 cell_x = ivec3(2 * word_x, across, across);
    ivec3 cell_y = ivec3(min(2 * word_x + 1, dims.x - 1), across, across);
    cell_x = mix(cell_x, dims - 1 - cell_x, grid.reverse);
    cell_y = mix(cell_y, dims - 1 - cell_y, grid.reverse);
    ivec2 u = ivec2(cell_x[grid.u], cell_y[grid.u]), slice = ivec2(cell_x[grid.w], cell_y[grid.w]);
    vec2 offset_u = grid.shear.x * vec2(slice), offset_v = grid.shear.y * vec2(slice);
    vec2 u0 = vec2(u) - 0.5 + fract(offset_u), v0 = fract(offset_v) - 0.5; // lower columns
    vec2 t_u = 1.0 - fract(offset_u), t_v = 1.0 - fract(offset_v);         // weights of the upper ones
    ivec2 lo = wrapped(u - ivec2(offset_u), grid.count.x);
    ivec2 hi = mix(lo + 1, ivec2(0), equal(lo + 1, ivec2(grid.count.x)));
    ivec2 m = wrapped(-ivec2(offset_v), grid.count.y);
    vec2 u0_inside = (u0 - grid.low.x) * grid.per_cell.x;
    vec2 u1_inside = u0_inside + grid.per_cell.x;
    vec2 middle_u, middle_w, quarter_u, quarter_w, middle_v, quarter_v;
    part_of_cell(vec2(u), grid.low.x, grid.size.x, middle_u, quarter_u);
    part_of_cell(vec2(slice), grid.front + 0.5, grid.size.z, middle_w, quarter_w);

    uint base = local * args.stride + component * (args.stride / num_components);
    ivec2 first = int(base) + slice * (grid.count.x * grid.count.y);
    int v_stride = grid.v == 1 ? row : row * dims.y; // words
    int cell_v = grid.reverse[grid.v] ? grid.size.y - 1 : 0;
    uint plane = (n * num_components + component) * args.dims.z;
    uint word = (grid.v == 1 ? (plane + across) * args.dims.y : plane * args.dims.y + across) * row +
                uint(word_x + cell_v * v_stride);
    v_stride = grid.reverse[grid.v] ? -v_stride : v_stride;

    // A box that is one cell thin has no columns in it to look between: its rays are marched.
    bool thin = grid.size.x == 1 || grid.size.y == 1;
    int samples = columns_samples(grid);
    vec2 before = vec2(0.0), before_inside = vec2(0.0);
    for (int v = 0; v <= grid.size.y; v++) { // columns, and the cell after the first of two
        ivec2 at = first + m * grid.count.x;
        vec2 here = vec2(mix(nodes[at.x + lo.x], nodes[at.x + hi.x], t_u.x),
                         mix(nodes[at.y + lo.y], nodes[at.y + hi.y], t_u.y));
        m = mix(m + 1, ivec2(0), equal(m + 1, ivec2(grid.count.y)));
        vec2 along_v = (float(v) + v0 - grid.low.y) * grid.per_cell.y;
        vec2 here_inside = mix(columns_inside(grid, u0_inside, along_v, vec2(slice)),
                               columns_inside(grid, u1_inside, along_v, vec2(slice)), t_u);
        if (v > 0) {
            part_of_cell(vec2(v - 1), grid.low.y, grid.size.y, middle_v, quarter_v);
            vec2 inside = vec2(0.0);
            for (int i = 0; i < 8; i++) { // octants of the cell
                vec3 at = mix(vec3(-1.0), vec3(1.0), notEqual(ivec3(i) & ivec3(1, 2, 4), ivec3(0)));
                vec2 along_u = (middle_u + at.x * quarter_u - grid.low.x) * grid.per_cell.x;
                vec2 along_v = (middle_v + at.y * quarter_v - grid.low.y) * grid.per_cell.y;
                inside += 0.125 * columns_inside(grid, along_u, along_v,
                                                 middle_w + at.z * quarter_w - 0.5);
            }
            vec2 lacking = inside - mix(before_inside, here_inside, t_v);
            vec2 sum = mix(before, here, t_v);
            int steps = any(greaterThan(abs(lacking), 1e-4 * inside)) ? 1 : 0;
            if (thin) {
                lacking = inside;
                sum = vec2(0.0);
                steps = int(ceil(max(inside.x, inside.y) * float(samples)));
            }
            for (int i = 0; i < steps; i++) {
                vec2 back = inside - lacking * (float(i) + 0.5) / float(steps);
                vec3 uvw_x = columns_uvw(grid, vec2(u.x + 0.5, v - 0.5), float(slice.x));
                vec3 uvw_y = columns_uvw(grid, vec2(u.y + 0.5, v - 0.5), float(slice.y));
                sum += grid.spacing * lacking / float(steps) *
                       vec2(component_at(component, uvw_x - back.x * grid.per_slice),
                            component_at(component, uvw_y - back.y * grid.per_slice));
            }
            columns_words[word] = packHalf2x16(encoded(sum));
            word += v_stride;
        }
        before = here;
        before_inside = here_inside;
    }
    if (non_finite > 0u) {
        atomicAdd(counters.non_finite, non_finite);
    }
}
