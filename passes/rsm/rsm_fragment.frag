// rsm_fragment.frag -- the power that the surface in a texel reflects, and where and how large it is.
#define MATERIALS_AT 4
#include "rsm_bindings.glsl"
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/light/shadow_args.h"

#include "shaders/surfaces/surface_faces.glsl"
TYN_READ(7, suns, light_block suns[]);
TYN_READ(8, lights, light_block lights[]);
layout(location = 0) flat in uint triangle;
layout(location = 1) in vec3 weights;
layout(location = 0) out vec4 flux;
layout(location = 1) out vec4 position;
layout(location = 2) out vec4 normal;

const float LEAST_COSINE = 1e-3; // of light and surface: what is seen edge-on has no area to speak of

void main()
{
    uvec4 t = surface_triangle_at(triangle);
    vec3 a = surface_position(t.x), b = surface_position(t.y), c = surface_position(t.z);
    vec3 world = weights.x * a + weights.y * b + weights.z * c;
    vec3 facet = cross(b - a, c - a);
    vec3 p = surface_transform(surfaces.from_world, world);
    vec3 n = normalize(surface_turn(surfaces.from_world, facet));

    light_block light;
    if (args.kind == TYN_SHADOW_SUN) { // not by ?:, of which glslang 12 makes invalid code
        light = suns[args.light];
    } else {
        light = lights[args.light];
    }
    vec3 way = light.direction; // of the light here, unit
    float share = 1.0, across = 1.0; // of the texel in the middle: of its flux; of its area or solid angle
    if (args.kind != TYN_SHADOW_SUN) {
        vec3 d = p - light.position, axis = surface_turn(surfaces.from_world, args.clip[3].xyz);
        float r = max(length(d), 1e-20), z = dot(d, axis);
        way = d / r;
        float cosine = z / r;
        // Of a texel of the plane z = 1 at this angle: its solid angle against that in the middle.
        across = cosine * cosine * cosine;
        bool beside = args.kind == TYN_SHADOW_CUBE && max(max(abs(d.x), abs(d.y)), abs(d.z)) > 1.0001 * z;
        share = beside ? 0.0 : across * light_lobe(light, dot(way, light.direction));
        across *= r * r;
    }
    float cosine = dot(n, way);
    // On the side of the light: of a lamp's place by a corner of the triangle, not by a point between, which is
    // rounded.
    vec3 corner = surface_transform(surfaces.from_world, a);
    float behind = args.kind != TYN_SHADOW_SUN ? dot(n, corner - light.position) : cosine;
    n = behind > 0.0 ? -n : n;
    float area = args.texel * across / max(abs(cosine), LEAST_COSINE);

    surface_material m = surface_material_at(t.w);
    vec3 colour = surface_colour_over(t, weights.yz, area);
    rng_state rng = rng_start(uint(gl_FragCoord.x), uint(gl_FragCoord.y), 0u);
    flux = vec4(light.color * args.texel * share * surface_reflected(m, colour), 0.0);
    if (any(greaterThan(flux.rgb, vec3(0.0))) && // no rays for what is black
        !surface_faces_something(triangle, p, world, n, args.extent, rng)) {
        flux = vec4(0.0);
    }
    position = vec4(p, area);
    normal = vec4(n, 0.0);
}
