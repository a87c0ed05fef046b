// lattice_lamps_pieces.glsl -- light of a local light in a cell that is near it: the cell cut into pieces.
//
// Include after what lattice_lamps_cells.comp includes; define LATTICE_LAMPS_VISIBILITY(n, p, away), the share
// of light n that surfaces let through to p. The kernel has the constants num_channels, walls and shadowed.
#include "shaders/common/quotient.glsl"

// Adds light n to the moments of the channels, the cell cut into count^3 pieces.
void lattice_lamps_add_pieces(uint n, uint count, const lattice_box box, ivec3 c, inout vec4 sums[3], inout vec3 all)
{
    vec3 corner = lattice_to_m(box, vec3(c)), position = radials[n].light.position;
    float d = box.dx / float(count);
    vec4 weighted[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    vec3 weight = vec3(0.0), open = vec3(0.0);
    walls_planes planes;
    if (walls == 1) {
        planes = walls_planes_of(lattice_index(box, c));
    }
    for (uint i = 0u; i < count * count * count; i++) {
        vec3 p = corner + (vec3(quotient_place(i, ivec3(count))) + 0.5) * d;
        if (walls == 1 && walls_behind(planes, p) != 0u) {
            continue;
        }
        medium_point m = medium_sample(p);
        m.sigma_a = medium_mode == TYN_MEDIUM_DENSITY ? m.sigma_a : vec3(0.0); // left out of unequal media
        vec3 scaled = delta_scaled(m.sigma_s, m.phase);
        vec3 w = scaled + 1e-6 * m.sigma_a;
        weight += w;
        if (w.r + w.g + w.b <= 0.0) {
            continue;
        }
        vec3 away = p - position;
        disc_light light = lattice_lamps_light(radials[n].light, away, d);
        if (light.fluence <= 0.0) {
            continue;
        }
        float r = length(away);
        beam_tau tau = radial_tau(radial_place_of(n, away, r));
        vec3 a = abs(away / max(r, 1e-20));
        // Half the depth of a piece along the light.
        float half_way = 0.5 * d / max(max(a.x, max(a.y, a.z)), 0.57);
        float visible = shadowed == 1 ? LATTICE_LAMPS_VISIBILITY(n, p, away) : 1.0;
        for (uint ch = 0u; ch < num_channels; ch++) {
            float t = mean_transmittance(tau.a[ch] + tau.p[ch], half_way * (scaled[ch] + m.sigma_a[ch]));
            open[ch] += w[ch] * t * light.fluence;
            weighted[ch] += (visible * w[ch] * t * light.fluence) * vec4(1.0, light.mean);
        }
    }
    for (uint ch = 0u; ch < num_channels; ch++) {
        float e = lattice_channel(radials[n].light.color, num_channels, ch, args.tint);
        float scale = weight[ch] > 0.0 ? e / weight[ch] : 0.0;
        sums[ch] += scale * weighted[ch];
        all[ch] += scale * open[ch];
    }
}
