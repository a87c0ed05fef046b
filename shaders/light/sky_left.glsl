// sky_left.glsl -- what the medium leaves of the sky's ordinates at a place. Include after medium.glsl, columns.glsl and
// lattice.glsl.
#ifndef TYN_SKY_LEFT_GLSL
#define TYN_SKY_LEFT_GLSL

// Of ordinate n on its way to q, a place in the medium's box; what was scattered forward counts as passed. `cells`: of the
// lattice, which has columns.
vec3 sky_left(uint n, vec3 q, uvec3 cells)
{
    lattice_box box = lattice_box_of(medium.extent, ivec3(cells));
    vec3 x = clamp(lattice_from_m(box, q) - 0.5, vec3(0.0), vec3(box.dims - 1));
    ivec3 first = min(ivec3(x), max(box.dims - 2, ivec3(0)));
    vec3 f = x - vec3(first), tau = vec3(0.0);
    float column = 0.0;
    for (int i = 0; i < 8; i++) {
        ivec3 step = ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 t = mix(1.0 - f, f, vec3(step));
        uvec3 cell = uvec3(min(first + step, box.dims - 1)), dims = uvec3(box.dims);
        if (medium_mode == TYN_MEDIUM_DENSITY) {
            column += t.x * t.y * t.z * columns_density(n, cell, dims);
        } else {
            beam_tau depth = columns_tau(n, cell, dims);
            tau += t.x * t.y * t.z * (depth.a + depth.p);
        }
    }
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        beam_tau depth = beam_of_column(column);
        tau = depth.a + depth.p;
    }
    return exp(-tau);
}

#endif
