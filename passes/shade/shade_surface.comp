// shade_surface.comp -- radiance of the surfaces towards the camera.
//
//   L = emission + albedo / pi (suns + lamps + VPLs + light of the lattice, or of the sky where that is not)
//
// One thread a pixel. Samples of a pixel that lie on one plane are shaded once.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade.glsl"
#include "lattice.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 20) uniform sampler2D indirect_tex;
layout(binding = 21) uniform sampler2D place_tex;
layout(binding = 22) uniform sampler2D part_tex;
layout(binding = 23) uniform sampler3D moments_tex;
#define WALLS_LINKS 24
#define WALLS_CELLS 25
#include "lattice_walls.glsl"
#include "walls_irradiance.glsl"
layout(binding = 26, scalar) uniform env_uniform
{
    env_block environment;
};
layout(binding = 27, rgba32f) uniform writeonly image2D radiance_image; // and distance, or infinity

const float PI = 3.14159265358979;
#define NOWHERE uintBitsToFloat(0x7f800000u) // infinity

// Light of the medium and of far walls, and of the sky where it comes along the lattice's lines.
vec3 light_of_lattice(shade_point p)
{
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
    vec3 irradiance = walls_irradiance_at(moments_tex, box, p.position, p.normal, channels);
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
    return shade_suns(p) + shade_lamps(p) + light_of_lattice(p);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) {
        return;
    }
    int side = int(args.samples), count = side * side;
    ivec2 corner = pixel * side;
    gbuffer_point first = shade_sample(corner);
    vec3 at_first = shade_position(corner, first.distance);
    vec3 albedo = first.albedo, emission = first.emission, normal = first.normal, middle = at_first;
    bool one_plane = first.distance > 0.0;
    for (int k = 1; k < count && one_plane; k++) {
        ivec2 texel = corner + ivec2(k % side, k / side);
        gbuffer_point s = shade_sample(texel);
        vec3 at = shade_position(texel, s.distance), d = at - at_first;
        one_plane = s.distance > 0.0 && dot(s.facet, first.facet) > 0.99 &&
                    abs(dot(d, first.facet)) < 0.05 * length(d) + 1e-5 * s.distance;
        albedo += s.albedo;
        emission += s.emission;
        normal += s.normal;
        middle += at;
    }
    vec3 radiance = vec3(0.0);
    if (one_plane) {
        float share = 1.0 / float(count);
        shade_point p = shade_point(middle * share, normalize(normal), first.facet);
        vec3 irradiance = irradiance_at(p);
        if (shade_has(SHADE_VPLS)) {
            irradiance = max(irradiance + texelFetch(indirect_tex, pixel, 0).rgb, vec3(0.0));
        }
        radiance = share * (emission + albedo * irradiance / PI);
    }
    for (int k = 0; k < count; k++) {
        ivec2 texel = corner + ivec2(k % side, k / side);
        float distance = one_plane ? texelFetch(surface_tex, texel, 0).w : 0.0;
        if (!one_plane) {
            gbuffer_point s = shade_sample(texel);
            distance = s.distance;
            radiance = vec3(0.0);
            if (distance > 0.0) {
                shade_point p = shade_point(shade_position(texel, distance), s.normal, s.facet);
                vec3 irradiance = irradiance_at(p);
                if (shade_has(SHADE_VPLS)) {
                    irradiance = max(irradiance + light_of_vpls(pixel, p), vec3(0.0));
                }
                radiance = s.emission + s.albedo * irradiance / PI;
            }
        }
        imageStore(radiance_image, texel, vec4(radiance, distance > 0.0 ? distance : NOWHERE));
    }
}
