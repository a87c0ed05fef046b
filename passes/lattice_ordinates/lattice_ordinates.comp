// lattice_ordinates.comp -- unscattered light of the principal ordinates in the cells: sum of E T' and of
// a E T' direction, a the mean cosine of an ordinate's region. x: two cells.
//
// T' is the mean over the cell of e^-tau, tau taken for linear in it: e^-tau(centre) times sinh(x_i) / x_i
// for each axis, x_i being half of what tau changes by along it. To second order, and to all where one
// axis prevails, that is the same of the length of (x_i). Where light comes in through a side tau changes
// much faster across the light than along it; without that the cells would lose less than the light does
// (0.7 % in a cube of depth 4 on 24 cells, with it 0.05 %). E may be negative: ordinates carry what
// the sky has more or less than its mean.
#include "shaders/light/ordinate_args.h"
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_BLOCK 0
#define COLUMNS_AT 1
#include "shaders/medium/medium.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lattice_ordinates_args args);
layout(binding = 3) uniform sampler3D cells;
layout(binding = 4) uniform sampler3D sunlight;
layout(binding = 5, rgba32f) uniform writeonly image3D source;
#define SKY_SEEN_AT 6
#include "shaders/light/sky_seen.glsl"
layout(binding = 8, rgba32f) uniform writeonly image3D even;
TYN_READ(9, mean_psi, float mean_psi[]); // lattice_ordinates_lines.comp
TYN_WRITE(10, guess, vec4 guess[]);

layout(constant_id = 1) const uint num_transmittances = 3; // 1: all channels have the same
layout(constant_id = 2) const uint seen = 0;               // 1: surfaces hide some of the light
layout(constant_id = 3) const uint mean = 0;               // 1: and the sky's mean is added here

// Fluence and flux of the mean along the lattice's lines.
vec4 mean_light(ivec3 cell, int ch)
{
    vec4 sum = vec4(0.0);
    ivec3 dims = ivec3(args.dims);
    for (uint d = 0u; d < LATTICE_DIRECTIONS; d++) {
        int at = ((int(d * args.channels) + ch) * dims.z + cell.z) * dims.y + cell.y;
        float psi = LATTICE_4PI * lattice_weight(d) * mean_psi[at * dims.x + cell.x];
        sum += psi * vec4(1.0, vec3(lattice_step(d)) * (d < 6u ? 1.0 : inversesqrt(3.0)));
    }
    return sum;
}

// What of the columns makes up the depth tau_a + tau'_s of a channel, at the two cells of a word.
vec2 depth_at(uint word, uint stride, uint ch)
{
    return medium_mode == TYN_MEDIUM_DENSITY
               ? columns_pair(word)
               : columns_pair(word + (3u + ch) * stride) + columns_pair(word + (6u + ch) * stride);
}

// The depths at the two cells' centres, and half of how much they change across the cells.
void depths_at(bool pair, uint word, uvec2 aside, uint stride, uint ch, out vec2 centre, out vec2 change)
{
    centre = depth_at(word, stride, ch);
    vec2 y = depth_at(word + aside.x, stride, ch) - centre;
    vec2 z = depth_at(word + aside.y, stride, ch) - centre;
    float x = pair ? centre.y - centre.x : 0.0;
    change = 0.5 * sqrt(x * x + y * y + z * z);
}

// Does the light enter through the outer face of this cell? Then tau goes from 0 there to twice that at
// the centre.
bool enters_here(uvec3 cell, vec3 direction)
{
    vec3 layers = vec3(mix(cell, args.dims - 1u - cell, lessThan(direction, vec3(0.0))));
    vec3 way = (layers + 0.5) / max(abs(direction), vec3(1e-6));
    float least = min(way.x, min(way.y, way.z));
    return any(lessThan(layers + max(way - least, vec3(0.0)), vec3(1e-5)));
}

void main()
{
    uint row = (args.dims.x + 1u) / 2u;
    uvec3 cell = gl_GlobalInvocationID * uvec3(2, 1, 1);
    if (any(greaterThanEqual(cell, args.dims))) {
        return;
    }
    ivec3 dims = ivec3(args.dims);
    float dx = lattice_box_of(medium.extent, dims).dx;
    bool pair = cell.x + 1u < args.dims.x;
    // tau changes along the light by the cell's own depth at least.
    vec3 least[2] = vec3[2](vec3(0.0), vec3(0.0));
    for (int ch = 0; ch < int(args.channels); ch++) {
        for (int i = 0; i < 2; i++) {
            int x = min(int(cell.x) + i, dims.x - 1);
            vec4 c = texelFetch(cells, ivec3(x, cell.y, int(cell.z) + ch * dims.z), 0);
            least[i][ch] = 0.5 * dx * (c.x + c.y);
        }
    }
    // Neighbours along y and z, in words.
    uvec2 next = (cell.yz ^ 1u), ends = args.dims.yz;
    next = mix(next, cell.yz - min(cell.yz, uvec2(1)), greaterThanEqual(next, ends));
    uvec2 aside = (next - cell.yz) * uvec2(row, row * args.dims.y);
    beam_tau unit = beam_of_column(1.0);
    vec3 extinction = medium_mode == TYN_MEDIUM_DENSITY ? unit.a + unit.p : vec3(1.0);

    vec3 tint = args.tint / dot(args.tint, args.tint);
    vec3 most = max(least[0], least[1]);
    bool any_medium = most.x + most.y + most.z > 0.0; // where there is none light does nothing
    uint count = any_medium ? min(ordinates.count, args.count) : 0u;
    uint stride = columns_stride(args.dims);
    vec2 open = seen == 1u ? sky_seen_pair(sky_seen_word(0u, cell, args.dims)) : vec2(1.0);
    vec3 lbar = vec3(0.0); // the mean, where some of it may be hidden
    if (seen == 1u && mean == 1u) {
        lbar = args.channels == 1 ? vec3(dot(environment.sky, tint)) : environment.sky;
    }
    vec4 sums[2][3];
    for (int i = 0; i < 6; i++) {
        sums[i / 3][i % 3] = vec4(0.0);
    }
    for (uint n = 0; n < count; n++) {
        vec3 e = ordinates.list[n].irradiance;
        e = args.channels == 1 ? vec3(dot(e, tint)) : e;
        vec4 moments = vec4(1.0, ordinates.list[n].mean_cosine * ordinates.list[n].direction);
        uint word = columns_word(n, cell, args.dims);
        vec2 centre, change, t;
        vec3 direction = ordinates.list[n].direction;
        vec2 share = seen == 1u ? sky_seen_pair(sky_seen_word(n + 1u, cell, args.dims)) : vec2(1.0);
        vec4 rest = vec4(ordinates.list[n].even, ordinates.list[n].even_flux);
        bvec2 enters = bvec2(enters_here(cell, direction), enters_here(cell + uvec3(1, 0, 0), direction));
        depths_at(pair, word, aside, stride, 0u, centre, change);
        for (uint ch = 0; ch < 3; ch++) {
            if (medium_mode != TYN_MEDIUM_DENSITY && ch > 0) {
                depths_at(pair, word, aside, stride, ch, centre, change);
            }
            if (ch < num_transmittances) {
                for (int i = 0; i < 2; i++) {
                    // Where the centre of a thick cell happens to be in the open, light still loses no
                    // more in it than there is.
                    float tau = max(extinction[ch] * centre[i], least[i][ch]);
                    float x = min(max(extinction[ch] * change[i], least[i][ch]), tau);
                    x = enters[i] ? tau : x;
                    t[i] = mean_transmittance(tau, x);
                }
            }
            if (seen == 1u) {
                sums[0][ch] += t.x * (e[ch] * share.x * moments + lbar[ch] * (share.x - open.x) * rest);
                sums[1][ch] += t.y * (e[ch] * share.y * moments + lbar[ch] * (share.y - open.y) * rest);
            } else {
                sums[0][ch] += e[ch] * t.x * moments;
                sums[1][ch] += e[ch] * t.y * moments;
            }
        }
    }
    for (int i = 0; i < (pair ? 2 : 1); i++) {
        for (int ch = 0; ch < int(args.channels); ch++) {
            ivec3 texel = ivec3(cell) + ivec3(i, 0, ch * dims.z);
            vec4 light = lattice_fetch_source(sunlight, cells, texel) + sums[i][ch];
            if (mean == 1u) {
                vec4 all_around = open[i] * mean_light(ivec3(cell) + ivec3(i, 0, 0), ch);
                imageStore(even, texel, all_around);
                // All of the mean that passes the surfaces, less what has not scattered; of a furnace that is the solution.
                int at = (texel.z * dims.y + texel.y) * dims.x + texel.x;
                guess[at] = vec4(open[i] * LATTICE_4PI * lbar[ch], vec3(0.0)) - all_around;
                light += all_around;
            }
            imageStore(source, texel, light);
        }
    }
}
