// shdom_view_cells.comp -- what a cell sends towards the eye.
//
// Of the light that arrives unscattered the bands' part of the phase function, which the solver has, is replaced by all of it.
#include "shdom_view_args.h"
#define MEDIUM_BLOCK 0
#define COLUMNS_AT 6
#include "shaders/medium/medium.glsl"
#include "shaders/beams/columns.glsl"
#define RADIALS_AT 11
#define RADIALS_STORAGE
#include "shaders/beams/radial.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "../common/delta_bands.glsl"
#include "../common/bands_lamp.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(shdom_view_args args);
TYN_UNIFORM(1, camera, camera_block camera);
layout(binding = 2) uniform sampler3D cells;
layout(binding = 3) uniform samplerBuffer sent_0_words; // [coefficient][cell]
layout(binding = 4) uniform samplerBuffer sent_1_words;
layout(binding = 5) uniform samplerBuffer sent_2_words;
layout(binding = 8, rgba32f) uniform writeonly image3D towards;
layout(binding = 9, rgba32f) uniform writeonly image3D extinction;
layout(binding = 10, rgba32f) uniform writeonly image3D scattered;
layout(constant_id = 1) const uint channels = 3;
layout(constant_id = 2) const uint grey = 0; // 1: the medium is the same in all channels
layout(constant_id = 3) const uint lit = 1;  // are there ordinates?

int here, all; // the cell, and how many there are
vec3 source;   // its source function towards the eye

void visit(int l, int k, float y)
{
    int at = k * all + here;
    source.r += y * texelFetch(sent_0_words, at).x;
    if (channels == 3u) {
        source.g += y * texelFetch(sent_1_words, at).x;
        source.b += y * texelFetch(sent_2_words, at).x;
    }
}
#define HARMONICS_VISIT visit
#include "../common/harmonics.glsl"

// The phase function over a cone of light: its middle and six places around (a rule of degree 5 for discs).
float cone_phase(const phase p, vec3 direction, float mean_cosine, vec3 v)
{
    vec3 gap = v - direction;
    if (mean_cosine > 0.9999) {
        return phase_near(p, mean_cosine, 0.5 * dot(gap, gap));
    }
    vec3 a = normalize(cross(direction, abs(direction.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    vec3 b = cross(direction, a);
    float sum = 0.25 * phase_near(p, 1.0, 0.5 * dot(gap, gap));
    float cosine = 1.0 - (2.0 / 3.0) * 2.0 * (1.0 - mean_cosine), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    for (int i = 0; i < 6; i++) {
        float turn = 1.04719755 * float(i);
        vec3 d = cosine * direction + sine * (cos(turn) * a + sin(turn) * b) - v;
        sum += 0.125 * phase_near(p, 1.0, 0.5 * dot(d, d));
    }
    return sum;
}

// What the solver has for it: (1 - f) times the phase function that is left, in its bands.
float bands_phase(const bands_medium m, float mean_cosine, float mu)
{
    float before = 0.0, p = 1.0, sum = 0.0;
    for (int l = 0; l < int(args.bands); l++) {
        sum += float(2 * l + 1) / LATTICE_4PI * (bands_power(m.g, l) - m.f) * bands_cone(mean_cosine, l) * p;
        float next = (float(2 * l + 1) * mu * p - float(l) * before) / float(l + 1);
        before = p;
        p = next;
    }
    return sum;
}

// What is to be added to the source function of the bands for light of irradiance 1, 1/m: of `marched` lights less what the march draws. `once`: what scatters
// once.
vec3 beyond_bands(bands_medium m[3], vec3 direction, float mean_cosine, vec3 v, const beam_tau tau, bool marched, float dx, out vec3 once)
{
    float mu = dot(direction, v), whole = 0.0, banded = 0.0;
    vec3 sum = vec3(0.0);
    once = vec3(0.0);
    for (uint ch = 0u; ch < channels; ch++) {
        if (ch == 0u || grey == 0u) {
            whole = cone_phase(phase_of_mean_cosine(m[ch].g), direction, mean_cosine, v);
            banded = bands_phase(m[ch], mean_cosine, mu);
        }
        float share = (whole - banded) * bands_transmittance(tau, int(ch), m[ch], args.bands, dx);
        float unscaled = whole * exp(-(tau.a[ch] + tau.s[ch]));
        share -= marched ? unscaled : 0.0;
        once[ch] = m[ch].sigma_s * unscaled;
        sum[ch] = m[ch].sigma_s * share;
    }
    return sum;
}

vec3 colour_of(vec3 light)
{
    return channels == 1u ? vec3(lattice_channel(light, 1u, 0u, args.tint)) : light;
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 v = camera.origin - lattice_to_m(box, vec3(c) + 0.5);
    v = camera_select(camera, -camera.forward, v / max(length(v), 1e-20));
    here = int(lattice_index(box, c));
    all = dims.x * dims.y * dims.z;
    source = vec3(0.0);
    harmonics_visit(v, int(args.bands));
    bands_medium m[3];
    vec3 scaled = vec3(0.0), seen = source, largest = abs(source); // largest: sum of what is added and subtracted
    for (uint ch = 0u; ch < channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0);
        m[ch] = bands_medium_of(cell, args.bands);
        scaled[ch] = m[ch].extinction;
        seen[ch] -= cell.w;
    }
    vec3 most = vec3(m[0].sigma_s, channels == 3u ? vec2(m[1].sigma_s, m[2].sigma_s) : vec2(0.0));
    vec3 once;
    bool any_medium = most.x + most.y + most.z > 0.0;
    uint count = lit != 0u && any_medium ? min(ordinates.count, uint(TYN_ORDINATES_MAX)) : 0u;
    for (uint n = 0u; n < count; n++) {
        ordinate o = ordinates.list[n];
        beam_tau tau = columns_tau(n, uvec3(c), args.dims);
        vec3 more = colour_of(o.irradiance) * beyond_bands(m, o.direction, o.mean_cosine, v, tau, n < args.num_suns, box.dx, once);
        seen += more;
        largest += abs(more) + colour_of(o.irradiance) * once;
    }
    for (uint n = 0u; n < (any_medium ? args.lamps : 0u); n++) {
        bands_lamp lamp = bands_lamp_at(n, box, c);
        vec3 light = colour_of(radials[n].light.color) * lamp.share;
        vec3 more = light * beyond_bands(m, lamp.direction, lamp.mean_cosine, v, lamp.tau, true, box.dx, once);
        seen += more;
        largest += abs(more) + light * once;
    }
    // Differences of what is equal are rounding: in thin media nothing has scattered twice.
    seen = mix(seen, vec3(0.0), lessThan(abs(seen), 4e-6 * largest));
    imageStore(towards, c, vec4(source, 0.0));
    imageStore(extinction, c, vec4(scaled, 0.0));
    imageStore(scattered, c, vec4(seen, 0.0));
}
