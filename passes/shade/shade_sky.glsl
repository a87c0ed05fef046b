// shade_sky.glsl -- the sky's light on a place of a surface: all directions, past what their maps show
// and through the medium. Include after shade.glsl and shade_part.glsl, and define
// SHADE_SKY_AT, the first of four bindings.
#define SKY_MAPS_AT SHADE_SKY_AT
#define COLUMNS_AT (SHADE_SKY_AT + 2)
#define COLUMNS_STORAGE
#include "shaders/light/sky_maps.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/light/sky_left.glsl"

// What of the picture blocks of pixels are.
vec4[SHADE_MANY] shade_parts(ivec2 block[SHADE_MANY])
{
    vec4 part[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        part[i] = float(shade_step) * vec4(block[i], block[i] + 1);
    }
    return part;
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
        vec3 towards = -ordinates.list[k].direction; // mean cosine: of the region about it
        vec3 light = ordinates.list[k].mean_cosine * max(ordinates.list[k].irradiance, vec3(0.0));
        shadow_light map = sky_map_of(k);
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            float share = shade_cosine(p[i], towards);
            if (share > 0.0) {
                share *= shadow_visibility_on_sun_map(sky_atlas, sky_map_around(map, surface[i].p), surface[i]);
            }
            if (share > 0.0) {
                vec3 left = vec3(1.0);
                if (shade_has(SHADE_COLUMNS)) {
                    vec2 way = shade_way(p[i].position, towards);
                    if (way.x < way.y) {
                        left = sky_left(n, p[i].position + way.x * towards, args.sky_cells);
                    }
                }
                sum[i] += share * light * left;
            }
        }
    }
    return sum;
}
