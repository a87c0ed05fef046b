// vpl_elements.glsl -- what may become a VPL: texels of reflective shadow maps, sides of triangles.
//
// Bindings 0 to 10.
#include "vpl_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/light/hilbert.glsl"
#include "shaders/light/near_box.glsl"

#define GEOMETRY_AT 4
#define MATERIALS_AT 8
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_frame.glsl"
TYN_READ(0, plan, vpl_plan plan);
layout(binding = 1) uniform sampler2D rsm_flux_tex;
layout(binding = 2) uniform sampler2D rsm_position_tex;
layout(binding = 3) uniform sampler2D rsm_normal_tex;

const float VPL_PI = 3.14159265358979;
const uint VPL_NO_TRIANGLE = 0xffffffffu;

// A block of elements, and the map that it is part of.
struct vpl_block {
    uint index;
    uint before; // blocks of the map before this one
    rsm_tile map; // not of triangles
};

// Blocks of maps come before those of triangles.
vpl_block vpl_block_at(uint index)
{
    vpl_block block;
    block.index = index;
    if (index >= plan.front) {
        return block;
    }
    uint lo = 0u, hi = plan.num_tiles - 1u;
    while (lo < hi) {
        uint mid = (lo + hi + 1u) / 2u;
        bool before = plan.tiles[mid].first <= index;
        lo = before ? mid : lo;
        hi = before ? hi : mid - 1u;
    }
    block.before = index - plan.tiles[lo].first;
    block.map = plan.tiles[lo].map;
    return block;
}

ivec2 vpl_texel(const vpl_block block, uint element)
{
    return ivec2(block.map.offset + hilbert_texel(block.map.texels, block.before * VPL_BLOCK + element));
}

uint vpl_triangle(uint block, uint element)
{
    uint i = (block - (block >= plan.back ? plan.back : plan.front)) * VPL_BLOCK + element;
    return i < plan.num_triangles ? i : VPL_NO_TRIANGLE;
}

vec3 vpl_corner(uint vertex)
{
    return surface_transform(surfaces.from_world, surface_position(vertex));
}

// Power that leaves an element, W.
vec3 vpl_flux(const vpl_block block, uint element)
{
    if (block.index < plan.front) {
        return texelFetch(rsm_flux_tex, vpl_texel(block, element), 0).rgb;
    }
    uint i = vpl_triangle(block.index, element);
    if (i == VPL_NO_TRIANGLE) {
        return vec3(0.0);
    }
    uvec4 t = surface_triangle_at(i);
    vec3 emission = surface_emitted(surface_material_at(t.w), block.index < plan.back);
    if (emission.r + emission.g + emission.b <= 0.0) {
        return vec3(0.0);
    }
    vec3 a = vpl_corner(t.x), b = vpl_corner(t.y), c = vpl_corner(t.z);
    return emission * (VPL_PI * 0.5 * length(cross(b - a, c - a)));
}

bool vpl_of_sky(const vpl_block block)
{
    return block.index < plan.front && block.map.light >= TYN_RSM_SKY;
}

float vpl_power(vec3 flux)
{
    float w = flux.r + flux.g + flux.b;
    return w > 0.0 && !isinf(w) ? w : 0.0; // also where it is no number
}

const float VPL_GREY = 0.3; // albedo: docs/measurements.md, "Constants"

// What an element is chosen by, W: its power. Under the sky the geometric mean of that and of the power that its area would send on
// in grey and open: dark corners have places, too. It falls with the third power of the distance to the box that pictures are of, as
// what a ground sends to a wall of the box's size does. Else a ground of a kilometre had all VPLs and the box one below it.
float vpl_weight(const vpl_block block, uint element, float power, const vpl_args args)
{
    if (power <= 0.0 || !vpl_of_sky(block)) {
        return power;
    }
    vec4 place = texelFetch(rsm_position_tex, vpl_texel(block, element), 0);
    float away = near_box_away(place.xyz, args.near_lo, args.near_hi), b = 1.0 + away * away;
    float weight = sqrt(power) * sqrt(VPL_GREY * place.w) * sqrt(args.sky_irradiance) / (b * sqrt(b));
    return weight < 1e38 ? weight : 0.0; // also where it is no number
}

// A piece of a surface: part of a triangle, or what a texel sees.
struct vpl_piece {
    vec3 position; // M, of its middle
    vec3 normal;   // on the side that shines
    float area;    // m^2
};

// A point at parameter t in [0, 1) of a curve that fills a triangle evenly (Sierpinski's): neighbours on
// it are neighbours on the triangle. It runs along the longest side, halving triangles.
vec3 vpl_on_triangle(vec3 a, vec3 b, vec3 c, float t)
{
    vec3 l = vec3(dot(c - b, c - b), dot(a - c, a - c), dot(b - a, b - a));
    vec3 apex = l.x >= l.y && l.x >= l.z ? a : l.y >= l.z ? b : c;
    vec3 from = l.x >= l.y && l.x >= l.z ? b : l.y >= l.z ? c : a;
    vec3 to = l.x >= l.y && l.x >= l.z ? c : l.y >= l.z ? a : b;
    for (int i = 0; i < 14; i++) {
        vec3 middle = 0.5 * (from + to);
        t *= 2.0;
        bool second = t >= 1.0;
        t -= second ? 1.0 : 0.0;
        from = second ? apex : from;
        to = second ? to : apex;
        apex = middle;
    }
    return (apex + from + to) * (1.0 / 3.0);
}

// Piece k of `pieces` of the part [from, to) of an element.
vpl_piece vpl_piece_of(const vpl_block block, uint element, vec2 part, uint k, uint pieces)
{
    vpl_piece piece;
    if (block.index < plan.front) {
        ivec2 texel = vpl_texel(block, element);
        vec4 position = texelFetch(rsm_position_tex, texel, 0);
        piece.position = position.xyz;
        piece.area = position.w * (part.y - part.x);
        piece.normal = texelFetch(rsm_normal_tex, texel, 0).xyz;
        return piece;
    }
    uvec4 t = surface_triangle_at(vpl_triangle(block.index, element));
    vec3 a = vpl_corner(t.x), b = vpl_corner(t.y), c = vpl_corner(t.z);
    vec3 n = cross(b - a, c - a);
    float twice = length(n), share = (part.y - part.x) / float(pieces);
    piece.position = vpl_on_triangle(a, b, c, part.x + (float(k) + 0.5) * share);
    piece.area = 0.5 * twice * share;
    piece.normal = n / max(twice, 1e-30);
    if (block.index >= plan.back) {
        piece.normal = -piece.normal;
    }
    return piece;
}

uint vpl_pieces(const vpl_block block)
{
    return block.index < plan.front ? 1u : 8u;
}
