// balance.comp -- where the energy goes: sums over cells and lines, one workgroup per channel.
//
// What the environment brings in is pi times its radiance and the surface of the medium's box, an
// ordinate its irradiance times the area across it; the lines' leaks are net, so what they carry
// straight through the lattice counts on both sides. Suns and ordinates lose what collides in the
// cells: that of a sun was made to be what its beam loses.
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/surfaces/surface_table_args.h"
#include "balance_args.h"
#include "shaders/common/balance_result.h"
#include "shaders/lattice/lattice_power.h"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = BALANCE_GROUP) in;
TYN_ARGS(balance_args args);
TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, environment, env_block environment); // its `sky` enters from all sides
TYN_READ(2, lights, light_block lights[]);
layout(binding = 3) uniform sampler3D cells;
layout(binding = 4) uniform sampler3D moments;
layout(binding = 5) uniform sampler3D source;
TYN_READ(11, lamp_power, lattice_lamp_power lamp_power[]);
TYN_READ(6, power, lattice_power power[]);
TYN_READ(7, leaks, float leaks[]);
TYN_WRITE(8, balance, TYN_BALANCE_MEMBERS);

TYN_UNIFORM(9, ordinates, ordinates_block ordinates);

TYN_READ(10, wall_power, vec2 wall_power[]); // absorbed by a cell's walls, sent out by them; W
TYN_READ(12, found, balance_light found[]);
TYN_READ(13, emitters, surface_table emitters);
layout(constant_id = 0) const uint walls = 0;

shared vec2 wall_sums[BALANCE_GROUP];
shared vec4 sums[BALANCE_GROUP]; // absorbed, emitted, leak, lost by suns and ordinates

void write(uint row, uint ch, float value)
{
    if (args.channels == 1) {
        for (uint c = 0; c < 3; c++) {
            balance[row][c] = double_bits(row == 5 ? value : value * args.tint[c]);
        }
    } else {
        balance[row][ch] = double_bits(value);
    }
}

void write_all(uint ch, float entering, float emitted, float absorbed, float on_surfaces, float escaped)
{
    float given = entering + emitted;
    write(0, ch, entering);
    write(1, ch, emitted);
    write(2, ch, absorbed);
    write(3, ch, on_surfaces);
    write(4, ch, escaped);
    write(5, ch, given > 0.0 ? 1.0 - (absorbed + on_surfaces + escaped) / given : 0.0);
    write(6, ch, 0.0); // nothing is drawn at random
}

// Of factors that are in use: 0 where there is no light. A factor that is no number makes both that.
vec2 least_and_most(vec2 range, float scale)
{
    if (isnan(scale) || isnan(range.y)) {
        return vec2(isnan(scale) ? scale : range.y);
    }
    vec2 with = range.y != 0.0 ? vec2(min(range.x, scale), max(range.y, scale)) : vec2(scale);
    return scale != 0.0 ? with : range;
}

// The factors that make the cells lose what beams lose.
void write_scales()
{
    vec2 ranges[TYN_BALANCE_SCALES] = vec2[TYN_BALANCE_SCALES](vec2(0.0), vec2(0.0), vec2(0.0));
    for (uint n = 0; n < args.num_suns * args.channels; n++) {
        ranges[0] = least_and_most(ranges[0], power[n].scale);
    }
    uint num_lamps = (args.num_groups - args.vpls) * args.channels; // groups of them, of each channel
    for (uint n = 0; n < args.num_groups * args.channels; n++) {
        uint kind = n < num_lamps ? 1u : 2u;
        ranges[kind] = least_and_most(ranges[kind], lamp_power[n].scale);
    }
    for (uint k = 0; k < TYN_BALANCE_SCALES; k++) {
        scales[k] = uvec2[2](double_bits(ranges[k].x), double_bits(ranges[k].y));
    }
}

// With surfaces: what lights send out, and where it ends that was not scattered, was found by following it. `cells`:
// absorbed, emitted, leak, lost by the lights; `sky` enters the medium's box, if it was not followed.
void among_surfaces(uint ch, vec4 cells_sum, float on_walls, float sky)
{
    balance_light all = balance_light(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint n = 0; n < args.num_followed; n++) {
        all.entering += found[n].entering;
        all.emitted += found[n].emitted;
        all.kept += found[n].kept;
        all.escaped += found[n].escaped;
    }
    all.emitted += args.emitters == 1u ? emitters.power : vec3(0.0);
    float entering = sky + lattice_channel(all.entering, args.channels, ch, args.tint);
    float emitted = cells_sum.y + lattice_channel(all.emitted, args.channels, ch, args.tint);
    float kept = on_walls + lattice_channel(all.kept, args.channels, ch, args.tint);
    float escaped = sky + cells_sum.z + lattice_channel(all.escaped, args.channels, ch, args.tint);
    write_all(ch, entering, emitted, cells_sum.x, kept, escaped);
}

void main()
{
    uint ch = gl_WorkGroupID.x, me = gl_LocalInvocationIndex;
    ivec3 dims = textureSize(cells, 0);
    dims.z /= int(args.channels);
    float dx = lattice_box_of(medium.extent, dims).dx, volume = dx * dx * dx;
    vec4 sum = vec4(0.0);
    vec2 wall_sum = vec2(0.0);
    for (uint i = me; i < uint(dims.x * dims.y * dims.z); i += BALANCE_GROUP) {
        ivec3 c = ivec3(int(i) % dims.x, int(i) / dims.x % dims.y,
                        int(i) / (dims.x * dims.y) + int(ch) * dims.z);
        vec4 cell = texelFetch(cells, c, 0);
        float beams = lattice_fetch_source(source, cells, c).x;
        float phi = texelFetch(moments, c, 0).x + beams;
        sum += volume * vec4(cell.y * phi, LATTICE_4PI * cell.w, 0.0, (cell.x + cell.y) * beams);
    }
    for (uint i = me; i < args.num_leaks; i += BALANCE_GROUP) {
        sum.z += leaks[ch * args.num_leaks + i];
    }
    for (uint i = me, n = uint(dims.x * dims.y * dims.z); walls == 1 && i < n; i += BALANCE_GROUP) {
        wall_sum += wall_power[ch * n + i];
    }
    sums[me] = sum;
    wall_sums[me] = wall_sum;
    for (uint half_n = BALANCE_GROUP / 2; half_n > 0; half_n /= 2) {
        barrier();
        if (me < half_n) {
            sums[me] += sums[me + half_n];
            wall_sums[me] += wall_sums[me + half_n];
        }
    }
    barrier();
    if (me != 0) {
        return;
    }
    if (ch == 0) {
        write_scales();
    }
    vec3 extent = medium.extent;
    vec3 faces = vec3(extent.y * extent.z, extent.z * extent.x, extent.x * extent.y) *
                 vec3(equal(medium.repeat, uvec3(0))); // of a periodic medium: one period
    float entering = LATTICE_4PI / 4.0 * 2.0 * (faces.x + faces.y + faces.z) *
                     lattice_channel(environment.sky, args.channels, ch, args.tint);
    for (uint n = 0; n < ordinates.count; n++) {
        float e = lattice_channel(ordinates.list[n].irradiance, args.channels, ch, args.tint);
        entering += e * dot(faces, abs(ordinates.list[n].direction));
    }
    if (args.num_followed > 0) {
        among_surfaces(ch, sums[0], wall_sums[0].x, args.sky == 1u ? 0.0 : entering);
        return;
    }
    for (uint sun = 0; sun < args.num_suns; sun++) {
        lattice_power w = power[sun * args.channels + ch];
        float e = lattice_channel(lights[sun].color, args.channels, ch, args.tint);
        entering += e * w.entering;
    }
    float emitted = sums[0].y + wall_sums[0].y;
    for (uint group = 0; group < args.num_groups; group++) {
        entering += lamp_power[group * args.channels + ch].entering;
        emitted += lamp_power[group * args.channels + ch].emitted;
    }
    float lamps = emitted - sums[0].y - wall_sums[0].y; // their light that does not collide escapes
    float escaped = lamps + entering + sums[0].z - sums[0].w;
    write_all(ch, entering, emitted, sums[0].x, wall_sums[0].x, escaped);
}
