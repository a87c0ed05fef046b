// lattice_lamps_disc.glsl -- light that a local light sends to a piece of a medium: a lamp from its point, a virtual point
// light (VPL) from the disc that it stands for. Include after radial.glsl.
#include "disc.glsl"

// Mean over a cube of edge d whose middle is at `away`.
disc_light lattice_lamps_light(const light_block light, vec3 away, float d)
{
    float r2 = dot(away, away), d2 = d * d, point = radial_mean_inverse_square(r2, d2);
    if (light.kind != TYN_LIGHT_KIND_COSINE || light.radius <= 0.0) {
        float r = sqrt(r2);
        return disc_light(radial_share_of(light, away, r) * point, away / max(r, 1e-20));
    }
    disc_light disc = disc_light_at(away, light.direction, light.radius);
    disc.fluence = r2 > d2 ? disc.fluence * r2 * point : min(disc.fluence, point);
    return disc;
}
