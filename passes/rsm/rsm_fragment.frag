// rsm_fragment.frag -- the power that the surface in a texel reflects, and where and how large it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#define MATERIALS_AT 4
#include "rsm_bindings.glsl"
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/light/shadow_args.h"

#include "shaders/surfaces/surface_faces.glsl"
layout(location = 0) flat in uint triangle;
layout(location = 1) in vec3 weights;
layout(location = 0) out vec4 flux;
layout(location = 1) out vec4 position;
layout(location = 2) out vec4 normal;

const float LEAST_COSINE = 1e-3; // of light and surface: what is seen edge-on has no area to speak of

vec3 to_m(vec3 v)
{
    return vec3(dot(surfaces.from_world[0].xyz, v), dot(surfaces.from_world[1].xyz, v),
                dot(surfaces.from_world[2].xyz, v));
}

// Share of a spot's intensity at an angle to its axis (KHR_lights_punctual).
float falloff(float cosine)
{
    float width = args.cos_inner - args.cos_outer;
    if (width < 1e-6) {
        return cosine >= args.cos_outer ? 1.0 : 0.0;
    }
    float a = clamp((cosine - args.cos_outer) / width, 0.0, 1.0);
    return a * a;
}

void main()
{
    surface_triangle t = triangles[triangle];
    surface_vertex a = vertices[t.v0], b = vertices[t.v1], c = vertices[t.v2];
    vec3 world = weights.x * a.position + weights.y * b.position + weights.z * c.position;
    vec3 facet = cross(b.position - a.position, c.position - a.position);
    vec3 p = to_m(world) + vec3(surfaces.from_world[0].w, surfaces.from_world[1].w,
                                surfaces.from_world[2].w);
    vec3 n = normalize(to_m(facet));

    vec3 way = args.origin; // direction of the light, unit
    float share = 1.0, across = 1.0; // of args.flux; of its area or solid angle, m^2 or sr
    if (args.kind != TYN_SHADOW_SUN) {
        vec3 d = p - args.origin, axis = to_m(args.clip[3].xyz);
        float r = max(length(d), 1e-20), z = dot(d, axis);
        way = d / r;
        float cosine = z / r;
        // Of a texel of the plane z = 1 at this angle: its solid angle against that in the middle.
        across = cosine * cosine * cosine;
        bool beside = args.kind == TYN_SHADOW_CUBE && max(max(abs(d.x), abs(d.y)), abs(d.z)) > 1.0001 * z;
        share = beside ? 0.0 : across * falloff(dot(way, args.axis));
        across *= r * r;
    }
    float cosine = dot(n, way);
    // On the side of the light: of a lamp's place by a corner of the triangle, not by a point between, which is
    // rounded.
    vec3 corner = to_m(a.position) + vec3(surfaces.from_world[0].w, surfaces.from_world[1].w, surfaces.from_world[2].w);
    float behind = args.kind != TYN_SHADOW_SUN ? dot(n, corner - args.origin) : cosine;
    n = behind > 0.0 ? -n : n;
    float area = args.texel * across / max(abs(cosine), LEAST_COSINE);

    surface_material m = materials[t.material];
    vec3 albedo = m.albedo;
    if (m.texture != TYN_SURFACE_NO_TEXTURE) {
        // The mean of the texture over the texel, taken as a square on the surface.
        vec2 ua = vec2(a.u, a.v), u1 = vec2(b.u, b.v) - ua, u2 = vec2(c.u, c.v) - ua;
        float scale = sqrt(abs(u1.x * u2.y - u1.y * u2.x) / max(length(facet), 1e-30) * area);
        albedo *= surface_texture_around(m.texture, ua + weights.y * u1 + weights.z * u2,
                                         vec2(scale, 0.0), vec2(0.0, scale));
    }
    rng_state rng = rng_start(uint(gl_FragCoord.x), uint(gl_FragCoord.y), 0u);
    flux = vec4(args.flux * share * albedo, 0.0);
    if (any(greaterThan(flux.rgb, vec3(0.0))) && // no rays for what is black
        !surface_faces_something(triangle, p, world, n, args.extent, rng)) {
        flux = vec4(0.0);
    }
    position = vec4(p, area);
    normal = vec4(n, 0.0);
}
