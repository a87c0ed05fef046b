// merge_radials.comp -- adds what a cell scatters towards the eye of the unscattered light of lamps that are not
// marched.
//
// Per sigma_s' and seen through e^-tau', as the march takes it: I / r^2 e^-tau_a (K_tms + K_lobe e^-(tau - tau'))
// / (1 - f); what is scattered forward goes to the eye through e^-tau, and the difference of the depths of the
// way there is summed over the cells that it passes. Of 1 / r^2 there is what the march leaves (radial_rest), which
// is smooth, or the mean over the cell.
#define MEDIUM_BLOCK 0
#define PHASE_TABLES 12
#define PHASE_TABLED (tabled != 0u)
layout(constant_id = 4) const uint tabled = 0; // 1: some phase function of the medium is a table
#include "shaders/medium/medium.glsl"
#define RADIALS_AT 4
#define RADIALS_STORAGE
#define SCATTER_LUT 8
#define SCATTER_LUT_BLOCK 9
#define SCATTER_LUT_SOFT false
#include "shaders/phase/scatter_lut.glsl"
#define SHADOWS_AT 10
#define SHADOWS_STORAGE
#include "shaders/light/shadow.glsl"
#include "shaders/beams/radial.glsl"
#include "merge_args.h"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 1) const bool grey = false; // all channels of the medium are equal
layout(constant_id = 2) const uint channels = 3;
layout(constant_id = 3) const uint shadowed = 0;
TYN_ARGS(merge_args args);
TYN_UNIFORM(1, camera, camera_block camera);
layout(binding = 2) uniform sampler3D cells;
TYN_UPDATE(3, field, float field[]);
#include "merge.glsl"
#include "merge_read.glsl"

const uint DEPTH_STEPS = 12u;

vec4 cell_of(ivec3 c, uint ch)
{
    return texelFetch(cells, c + ivec3(0, 0, int(min(ch, channels - 1u) * args.dims.z)), 0);
}

// e^-(tau - tau') between the middle of a cell and the eye.
vec3 forward_part(const lattice_box box, ivec3 c, vec3 v)
{
    vec3 p = lattice_to_m(box, vec3(c) + 0.5);
    vec3 way = mix(medium.extent - p, -p, lessThan(v, vec3(0.0))) /
               mix(v, vec3(1e-12), lessThan(abs(v), vec3(1e-12)));
    float far = max(min(way.x, min(way.y, way.z)), 0.0);
    far = camera_select(camera, far, min(far, length(camera.origin - p)));
    float ds = far / float(DEPTH_STEPS);
    vec3 depth = vec3(0.0);
    for (uint i = 0u; i < DEPTH_STEPS; i++) {
        vec3 at = lattice_from_m(box, p + (float(i) + 0.5) * ds * v);
        ivec3 q = clamp(ivec3(at), ivec3(0), box.dims - 1);
        for (uint ch = 0u; ch < 3u; ch++) {
            vec4 cell = cell_of(q, ch);
            phase p = phase_of_delta_cosine(cell.z);
            if (PHASE_TABLED && medium.phase[ch].table != 0u) {
                p = medium.phase[ch];
            }
            float f = delta_fraction(p);
            depth[ch] += ds * cell.x * f / (1.0 - f);
        }
    }
    return exp(-depth);
}

// (K_tms + K_lobe `forward`) / (1 - f) of a channel.
float kernel(uint ch, const phase last, float one_minus_mu, float tau_s, float tau_p, float forward)
{
    if (medium_mode != TYN_MEDIUM_COEFFICIENTS) {
        scatter_angle angle = scatter_angle_of_point(ch, one_minus_mu);
        vec2 k = scatter_kernels(angle, tau_s);
        return (k.x + forward * k.y) / angle.loss;
    }
    vec2 k = scatter_kernels_mixed(0u, 1.0, one_minus_mu, last, tau_s, tau_p);
    return (k.x + forward * k.y) / (1.0 - delta_fraction(last));
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    uint count = merge_is_read(c, dims, channels) ? radial_num_lamps : 0u;
    if (count <= args.first_radial) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 v = merge_towards_eye(camera, box, c), p = clamp(lattice_to_m(box, vec3(c) + 0.5), vec3(0.0), medium.extent);
    vec3 forward = forward_part(box, c, v), sum = vec3(0.0);
    phase last[3];
    for (uint ch = 0u; ch < 3u; ch++) {
        last[ch] = phase_of_delta_cosine(cell_of(c, ch).z);
    }
    bool same = grey || (medium_mode == TYN_MEDIUM_DENSITY && channels == 1u);
    for (uint n = args.first_radial; n < count; n++) {
        vec3 away = p - radials[n].light.position;
        float r = length(away), share = radial_share(n, away, r);
        if (share > 0.0 && shadowed == 1u) {
            share *= shadow_visibility_lamp(radials[n].light.shadow, p);
        }
        if (share <= 0.0) {
            continue;
        }
        vec3 turn = away / max(r, 1e-20) - v;
        float one_minus_mu = 0.5 * dot(turn, turn);
        beam_tau tau = radial_tau(radial_place_of(n, away, r));
        vec3 k = vec3(kernel(0u, last[0], one_minus_mu, tau.s.r, tau.p.r, forward.r));
        if (!same) {
            k.g = kernel(1u, last[1], one_minus_mu, tau.s.g, tau.p.g, forward.g);
            k.b = kernel(2u, last[2], one_minus_mu, tau.s.b, tau.p.b, forward.b);
        }
        float per_intensity = args.reach > 0.0 ? radial_rest(r * r, radial_reach(radials[n].light, args.reach))
                                               : radial_mean_inverse_square(r * r, box.dx * box.dx);
        sum += radials[n].light.color * (share * per_intensity) * exp(-tau.a) * k;
    }
    if (channels == 1u) {
        field[merge_index(c, 0u)] += dot(sum, args.tint) / dot(args.tint, args.tint);
    } else {
        for (uint ch = 0u; ch < 3u; ch++) {
            field[merge_index(c, ch)] += sum[ch];
        }
    }
}
