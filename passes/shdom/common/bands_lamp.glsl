// bands_lamp.glsl -- a lamp as a cell of the lattice sees it. Include after radial.glsl, lattice.glsl and delta_bands.glsl.

struct bands_lamp {
    vec3 direction;    // of its light
    float mean_cosine; // about that: seen from close by a cell is not in one direction
    float share;       // of its intensity, over the square of the distance, 1/m^2
    beam_tau tau;
};

bands_lamp bands_lamp_at(uint n, const lattice_box box, ivec3 cell)
{
    vec3 away = lattice_to_m(box, vec3(cell) + 0.5) - radials[n].light.position;
    float r2 = dot(away, away), r = sqrt(r2), d2 = box.dx * box.dx;
    bands_lamp lamp;
    lamp.direction = r > 0.0 ? away / r : vec3(0.0, 0.0, 1.0);
    lamp.mean_cosine = r2 / (r2 + 0.125 * d2);
    lamp.share = radial_share(n, away, r) * radial_mean_inverse_square(r2, d2);
    lamp.tau = radial_tau(radial_place_of(n, away, r));
    return lamp;
}
