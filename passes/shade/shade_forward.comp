// shade_forward.comp -- from where sunlight that the medium has scattered forward comes, at the lattice's cells.
//
// Such light comes from around its sun, so that a shadow's edge is as soft as the medium is deep. SHADE_PLACES places
// on the way to the sun, in directions of the forward lobe, are looked up in its shadow map. That is soft
// enough for a lattice to hold; per pixel so few places would show as copies of the shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade_args.h"
#include "scene_args.h"
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 1
#define BEAM_BLOCKS 2
#define BEAM_UNIFORM
#define BEAM_COLUMN 3
#define BEAM_TAU_A 4
#define BEAM_TAU_P 5
#define SHADOW_ATLAS 6
#define SHADOW_LIGHTS 7
#include "camera.glsl"
#include "medium.glsl"
#include "beam.glsl"
#include "shadow.glsl"
#include "lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 2) const uint shade_num_suns = 0u;

layout(binding = 8, scalar) uniform sun_uniform
{
    light_block suns[TYN_LIGHTS_MAX];
};
// [sun][z][y][x]: mean direction that the light comes from, not of unit length; share of the places that are lit
layout(binding = 9, rgba32f) uniform writeonly image3D forward_image;

// Any two directions across the unit vector n (Duff et al., "Building an orthonormal basis, revisited", JCGT 2017).
mat3 frame_of(vec3 n)
{
    float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Henyey and Greenstein's g of what scatters on the way: f = g^2 is what the scaled depth leaves out.
float lobe_of(beam_tau tau)
{
    vec3 kept = tau.p / max(tau.s, vec3(1e-20));
    return sqrt(clamp(1.0 - (kept.r + kept.g + kept.b) / 3.0, 0.0, 0.98));
}

// The cosine below which the lobe's most forward part, f of it, has the share u.
float forward_cosine(float g, float u)
{
    float f = g * g, h = (1.0 - f) / (1.0 + g - 2.0 * g * f * u);
    return g > 1e-3 ? clamp((1.0 + f - h * h) / (2.0 * g), -1.0, 1.0) : 1.0;
}

vec4 forward_light(uint n, vec3 p)
{
    uint sun = beams[n].light;
    vec3 towards = -suns[sun].direction;
    vec2 way = ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent);
    way.x = max(way.x, 0.0);
    shadow_light map = shadows[sun]; // once: buffers are slow to read
    vec3 at = shadow_frame(map, p);
    if (way.x >= way.y) {
        return vec4(towards, 1.0) * shadow_all_lit(shadow_place_sun(map, at));
    }
    float g = lobe_of(beam_depth(n, p + way.x * towards));
    mat3 frame = frame_of(towards);
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < SHADE_PLACES; k++) {
        float along = (float(k) + 0.5) / float(SHADE_PLACES);
        float turn = 2.399963 * float(k); // the golden angle
        float c = forward_cosine(g, fract(0.5 + 0.618034 * float(k))), s = sqrt(1.0 - c * c);
        vec3 from = frame * vec3(s * cos(turn), s * sin(turn), c);
        vec3 there = at + mix(way.x, way.y, along) * shadow_frame_direction(map, from);
        sum += vec4(from, 1.0) * shadow_all_lit(shadow_place_sun(map, there));
    }
    return sum / float(SHADE_PLACES);
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = imageSize(forward_image);
    dims.z /= int(shade_num_suns);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    for (uint n = 0u; n < shade_num_suns; n++) {
        imageStore(forward_image, c + ivec3(0, 0, int(n) * dims.z),
                   forward_light(n, lattice_to_m(box, vec3(c) + 0.5)));
    }
}
