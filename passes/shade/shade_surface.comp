// shade_surface.comp -- radiance of the surfaces towards the camera.
//
//   L = emission + albedo / pi (suns + lamps + VPLs + light of the lattice, or of the sky where that is not)
//
// One thread a pixel. Samples of a pixel on one piece of surface are shaded together.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"
#include "lattice.glsl"
#include "walls_links.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 21) uniform sampler2D indirect_tex;
layout(binding = 22) uniform sampler2D place_tex;
layout(binding = 23) uniform sampler2D part_tex;
layout(binding = 24) uniform sampler3D moments_tex;
#define WALLS_TABLE 25
#define WALLS_OTHERS TYN_BEAM_MAX_SUNS
#include "walls_irradiance.glsl"
layout(binding = 26, scalar) uniform env_uniform
{
    env_block environment;
};
layout(binding = 27) uniform sampler3D forward_tex; // shade_forward.comp
layout(binding = 28, rgba32f) uniform writeonly image2D radiance_image; // and distance, or infinity

const float PI = 3.14159265358979;
#define NOWHERE uintBitsToFloat(0x7f800000u) // infinity

// Light of the medium and of far walls, and of the sky where it comes along the lattice's lines.
// `inside` the lattice: from where sunlight comes that was scattered forward. Its places may be
// beyond a wall; where the lattice is dark, as where surfaces let no light in, it is, too.
vec3 light_of_lattice(shade_point p, out vec4 around[TYN_BEAM_MAX_SUNS], out bool inside)
{
    inside = false;
    vec3 sky = shade_has(SHADE_SKY) ? PI * environment.sky : vec3(0.0);
    if (!shade_has(SHADE_LATTICE)) {
        return sky;
    }
    ivec3 dims = textureSize(moments_tex, 0);
    if (!shade_has(SHADE_ONE_CHANNEL)) {
        dims.z /= 3;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 x = lattice_from_m(box, p.position + 0.02 * box.dx * p.facet);
    if (any(lessThan(x, vec3(-0.02))) || any(greaterThan(x, vec3(dims) + 0.02))) {
        return sky; // outside
    }
    int channels = shade_has(SHADE_ONE_CHANNEL) ? 1 : 3;
    uint num_suns = shade_has(SHADE_SPREAD) ? shade_num_suns : 0u;
    inside = true;
    vec3 irradiance = walls_irradiance_at(moments_tex, box, p.position, p.normal, channels, forward_tex, num_suns,
                                          around);
    return channels == 1 ? irradiance.r * args.tint : irradiance;
}

// The VPLs' light at a sample of a pixel whose samples lie on several surfaces: of the pixels around the one
// that is most like it.
vec3 light_of_vpls(ivec2 pixel, shade_point p)
{
    float best = -1e30;
    vec3 light = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(camera.size) - 1);
        vec4 found = texelFetch(indirect_tex, at, 0);
        vec4 place = texelFetch(place_tex, at, 0);
        vec3 normal = gbuffer_unfold(vec2(place.w, texelFetch(part_tex, at, 0).w));
        vec3 d = place.xyz - p.position;
        float like = dot(normal, p.normal) - abs(dot(d, p.normal)) * inversesqrt(dot(d, d) + 1e-20);
        if (found.a > 0.0 && like > best) {
            best = like;
            light = found.rgb;
        }
    }
    return light;
}

vec3 irradiance_at(shade_point p)
{
    vec4 around[TYN_BEAM_MAX_SUNS];
    bool inside;
    vec3 lattice = light_of_lattice(p, around, inside);
    return shade_suns(p, around, inside && shade_has(SHADE_SPREAD)) + shade_lamps(p) + lattice;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    int count = int(args.samples * args.samples);
    ivec2 corner = pixel * int(args.samples);
    uint left = 0u; // bit k: sample k shows a surface and is not shaded yet
    for (int k = 0; k < count; k++) {
        float distance = texelFetch(surface_tex, shade_texel(corner, k), 0).w;
        left |= distance > 0.0 ? 1u << k : 0u;
    }
    uint none = ~left & (1u << count) - 1u;
    for (int k = 0; none != 0u && k < count; k++) {
        if ((none >> k & 1u) != 0u) {
            imageStore(radiance_image, shade_texel(corner, k), vec4(vec3(0.0), NOWHERE));
        }
    }
    while (left != 0u) {
        int k0 = findLSB(left);
        ivec2 texel0 = shade_texel(corner, k0);
        gbuffer_point like = shade_sample(texel0);
        vec3 at0 = shade_position(texel0, like.distance);
        uint group = 0u;
        float members = 0.0;
        vec3 albedo = vec3(0.0), emission = vec3(0.0), normal = vec3(0.0), off = vec3(0.0);
        for (int k = 0; k < count; k++) {
            ivec2 texel = shade_texel(corner, k);
            gbuffer_point s = shade_sample(texel);
            vec3 at = shade_position(texel, s.distance), d = at - at0;
            bool same = (left >> k & 1u) != 0u && dot(s.facet, like.facet) > 0.9 &&
                        abs(dot(d, like.facet)) < 0.3 * length(d) + 1e-5 * s.distance;
            float share = same || k == k0 ? 1.0 : 0.0;
            group |= share > 0.0 ? 1u << k : 0u;
            members += share;
            albedo += share * s.albedo;
            emission += share * s.emission;
            normal += share * s.normal;
            off += share * d;
        }
        // In their middle, but on the plane of the one whose facet is to be in a shadow or not.
        off = (off - dot(off, like.facet) * like.facet) / members;
        shade_point p = shade_point(at0 + off, normalize(normal), like.facet);
        vec3 irradiance = irradiance_at(p);
        if (shade_has(SHADE_VPLS)) {
            vec3 indirect = texelFetch(indirect_tex, pixel, 0).rgb;
            for (bool several = members < float(count); several; several = false) {
                indirect = light_of_vpls(pixel, p);
            }
            irradiance += indirect;
        }
        vec3 radiance = (emission + albedo * irradiance / PI) / members;
        for (int k = 0; k < count; k++) {
            if ((group >> k & 1u) != 0u) {
                float distance = texelFetch(surface_tex, shade_texel(corner, k), 0).w;
                imageStore(radiance_image, shade_texel(corner, k), vec4(radiance, distance));
            }
        }
        left &= ~group;
    }
}
