// shade_sky.glsl -- the sky's light on a place of a surface: all directions, past what their maps show
// and through the medium. Include after shade.glsl and shade_part.glsl, and define
// SHADE_SKY_AT, the first of four bindings.
#ifndef SHADE_SKY_GLSL
#define SHADE_SKY_GLSL
#define SKY_MAPS_AT SHADE_SKY_AT
#define COLUMNS_AT (SHADE_SKY_AT + 2)
#define COLUMNS_STORAGE
#include "shaders/light/sky_maps.glsl"
#include "shaders/beams/columns.glsl"

// What of the picture blocks of pixels are.
vec4[SHADE_MANY] shade_parts(ivec2 block[SHADE_MANY])
{
    vec4 part[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        part[i] = float(shade_step) * vec4(block[i], block[i] + 1);
    }
    return part;
}

// What of ordinate n passes the medium on its way to q, which is in the medium's box; what was scattered forward counts as passed.
vec3 shade_sky_left(uint n, vec3 q)
{
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.sky_cells));
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

// Of directions first, first + stride, ..., on SHADE_MANY places; `part` of the picture that each stands for.
vec3[SHADE_MANY] shade_sky(shade_point p[SHADE_MANY], vec4 part[SHADE_MANY], uint first, uint stride)
{
    vec3 sum[SHADE_MANY];
    shadow_surface surface[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        sum[i] = vec3(0.0);
        surface[i] = shade_shadowed(p[i], shade_footprint_of(p[i], part[i]));
    }
    uint count = min(ordinates.count, uint(TYN_ORDINATES_MAX)); // here these are the directions
    for (uint k = first; k < count; k += stride) {
        uint n = tyn_sky_ordinate(k, ordinates.num_fixed, args.sky_fan);
        vec3 light = max(ordinates.list[k].irradiance, vec3(0.0)), towards = -ordinates.list[k].direction;
        shadow_light map = sky_map_of(k);
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            float share = shade_cosine(p[i], towards);
            if (share > 0.0) {
                share *= shadow_visibility_on_sun_map(sky_atlas, map, surface[i]);
            }
            if (share > 0.0) {
                vec3 left = vec3(1.0);
                if (shade_has(SHADE_COLUMNS)) {
                    vec2 way = shade_way(p[i].position, towards);
                    if (way.x < way.y) {
                        left = shade_sky_left(n, p[i].position + way.x * towards);
                    }
                }
                sum[i] += share * light * left;
            }
        }
    }
    return sum;
}

#endif
