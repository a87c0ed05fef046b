// shade_several.glsl -- the pieces of surface in a pixel that shows several.
#include "shade.glsl"
#define GEOMETRY_AT (SHADE_PIECE_AT + 3) // after the binding of the picture and those of shade_alone.glsl
#define MATERIALS_AT (GEOMETRY_AT + 4)
#define GBUFFER_TEXTURED shade_has(SHADE_TEXTURED)
#define GBUFFER_SAMPLES shade_samples
#include "shaders/surfaces/gbuffer_triangle.glsl"

// What sample k of a pixel shows, a surface, and where (M).
gbuffer_point sample_of(ivec2 pixel, int k, out vec3 at)
{
    vec2 place = vec2(shade_texel(pixel * shade_samples, k)) + 0.5;
    camera_ray ray = gbuffer_ray(place);
    gbuffer_point s = gbuffer_point_of(gbuffer_triangle_of(shade_colours(pixel, k / 4)[k % 4] - 1u), place, ray);
    at = ray.origin + s.distance * ray.direction;
    return s;
}

// The piece of surface that the first of the samples `left` of a pixel shows, and those that show it: bits.
shade_point piece_of(ivec2 pixel, uint left, out gbuffer_colours colours, out uint members)
{
    gbuffer_point first;
    vec3 at0 = vec3(0.0), normal = vec3(0.0), off = vec3(0.0);
    colours = GBUFFER_BLACK;
    members = 0u;
    for (uint some = left; some != 0u; some &= some - 1u) {
        vec3 at;
        gbuffer_point s = sample_of(pixel, findLSB(some), at);
        if (members == 0u) {
            first = s;
            at0 = at;
        }
        bool same = members == 0u || gbuffer_same(first, at0, s.facet, at, s.distance);
        float share = same ? 1.0 : 0.0;
        members |= same ? some & -some : 0u;
        colours = gbuffer_add(colours, share, s.colours);
        normal += share * s.normal;
        off += share * (at - at0);
    }
    // In their middle, but on the plane of the one whose facet is to be in a shadow or not.
    float share = 1.0 / float(bitCount(members));
    colours = gbuffer_add(GBUFFER_BLACK, share, colours);
    off = (off - dot(off, first.facet) * first.facet) * share;
    return shade_point(at0 + off, normalize(normal), first.facet);
}

// The part of the picture that the samples `members` of a pixel fill, or the rectangle around them.
vec4 part_of(ivec2 corner, uint members)
{
    vec4 part = vec4(1e9, 1e9, -1e9, -1e9);
    for (uint some = members; some != 0u; some &= some - 1u) {
        vec2 texel = vec2(shade_texel(corner, findLSB(some)));
        part = vec4(min(part.xy, texel), max(part.zw, texel + 1.0));
    }
    return part / float(shade_samples);
}
