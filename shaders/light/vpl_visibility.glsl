// vpl_visibility.glsl -- what surfaces leave of a VPL's view: distances of the first ones around it, and their planes.
//
// Each VPL has a square map of its half space, 16 maps in a row of the atlas. A direction d with d.z along the
// VPL's axis is at the octahedral coordinates p = d.xy / (|d.x| + |d.y| + d.z), a diamond that is turned to fill
// the square. Texels lie on its edges too, so that nothing beyond them is needed.
//
// Define VPLS_AT as the first binding of the bundle TYN_VPLS (bundles.h), VPL_DISTANCES as that of the maps alone, or
// neither.
#ifndef TYN_VPL_VISIBILITY_GLSL
#define TYN_VPL_VISIBILITY_GLSL
#extension GL_EXT_control_flow_attributes : require

#define VPL_MAPS_IN_A_ROW 16

// Directions across the axis n (Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017).
mat3 vpl_frame(vec3 n)
{
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Where a VPL's map is seen from: a little above the surface, as the middle of what the VPL stands for may be below a
// curved one.
vec3 vpl_map_origin(vec3 position, vec3 axis, float radius)
{
    vec3 reach = max(abs(position), vec3(radius));
    return position + (0.02 * radius + 1e-5 * max(max(reach.x, reach.y), reach.z)) * axis;
}

// Direction in the VPL's frame of a place in the square [0, 1]^2, not normalised.
vec3 vpl_map_direction(vec2 at)
{
    vec2 q = 2.0 * at - 1.0;
    vec2 p = 0.5 * vec2(q.x + q.y, q.x - q.y);
    return vec3(p, 1.0 - abs(p.x) - abs(p.y));
}

vec2 vpl_map_place(vec3 d)
{
    vec2 p = d.xy / max(abs(d.x) + abs(d.y) + max(d.z, 0.0), 1e-20);
    return 0.5 + 0.5 * vec2(p.x + p.y, p.x - p.y);
}

ivec2 vpl_map_corner(uint vpl, int side)
{
    return side * ivec2(vpl % VPL_MAPS_IN_A_ROW, vpl / VPL_MAPS_IN_A_ROW);
}

#ifdef VPLS_AT
#include "shaders/beams/radial_texels.glsl"
#define VPL_DISTANCES (VPLS_AT + 1)
#define VPL_PLANES (VPLS_AT + 2)
layout(set = 0, binding = VPLS_AT) uniform usamplerBuffer vpls_texels; // struct radial_vpls

uint vpl_count()
{
    return texelFetch(vpls_texels, 0).x;
}

light_block vpl_light(uint n)
{
    return light_block_at(vpls_texels, 1 + 4 * int(n));
}
#endif
#ifdef VPL_DISTANCES
layout(set = 0, binding = VPL_DISTANCES) uniform sampler2D vpl_distances;

// The map of one VPL, for many points of the medium.
struct vpl_map {
    mat3 frame;
    vec2 corner, texel; // the first texel; 1 / size of the atlas
    float last;         // texels along a side, less one; 0: no maps
};

vpl_map vpl_map_of(uint vpl, vec3 axis)
{
    ivec2 size = textureSize(vpl_distances, 0);
    int side = size.x / VPL_MAPS_IN_A_ROW;
    return vpl_map(vpl_frame(axis), vec2(vpl_map_corner(vpl, side)), 1.0 / vec2(size), float(max(side - 1, 0)));
}

// Share of a VPL's light that goes the way `away` to a point in the medium and is not stopped by surfaces, r = length(away): of
// the four rays around that way, those that reach beyond the point. `closed`: of a cell that has a wall between
// it and the VPL, which all four rays must reach: some of them may end beyond it where that is seen under a small angle.
float vpl_map_visibility(const vpl_map map, vec3 away, float r, bool closed)
{
    vec2 x = vpl_map_place(away * map.frame) * map.last, first = min(floor(x), map.last - 1.0), w = x - first;
    vec4 stored = textureGather(vpl_distances, (map.corner + first + 1.0) * map.texel).wzxy;
    vec4 shares = vec4(1.0 - w.x, w.x, 1.0 - w.x, w.x) * vec4(1.0 - w.yy, w.yy);
    vec4 lit = vec4(greaterThanEqual(stored, vec4(r)));
    float share = closed ? lit.x * lit.y * lit.z * lit.w : dot(shares, lit);
    return map.last > 0.0 ? share : 1.0;
}

#ifdef VPL_PLANES
layout(set = 0, binding = VPL_PLANES) uniform sampler2D vpl_planes;

// Share of a VPL's light that goes the way `away` to a point of a surface with the normal `normal` and is not stopped by
// others: of the four rays around that way, those that reach the surface's plane.
//
// In a corner some of them end before they do, on the other wall. That does not hide the point, which is before its plane, and
// whether anything else does such rays do not tell, if the point is not far behind their ends: they are left out, and if all
// are such, nothing does. Far behind, as in a corridor, there may be a door: it is hidden.
const float VPL_ABSTAINS = 2.0; // times as far as the ray's end
const float VPL_ROUNDING = 1e-3; // of the distance of the point: what planes of small triangles are off by

float vpl_map_visibility_surface(const vpl_map map, vec3 away, vec3 normal)
{
    vec3 d = away * map.frame, n = normal * map.frame; // multiplied from the left: into the frame
    vec2 x = vpl_map_place(d) * map.last, first = min(floor(x), map.last - 1.0), w = x - first;
    float r = length(d), plane = dot(n, d), least = 0.25 * plane * plane / max(r, 1e-20);
    vec4 reach;
    [[unroll]] for (int i = 0; i < 4; i++) {
        float facing = dot(n, normalize(vpl_map_direction((first + vec2(i & 1, i >> 1)) / max(map.last, 1.0))));
        // Beyond the plane's horizon, or far off: as far as the point is.
        reach[i] = facing * plane > least ? min(plane / facing, 4.0 * r) : r;
    }
    // One gather is cheaper than four fetches; its order is (0, 1), (1, 1), (1, 0), (0, 0).
    vec4 stored = textureGather(vpl_distances, (map.corner + first + 1.0) * map.texel).wzxy;
    vec4 shares = vec4(1.0 - w.x, w.x, 1.0 - w.x, w.x) * vec4(1.0 - w.yy, w.yy);
    bvec4 near = lessThan(vec4(r), VPL_ABSTAINS * stored);
    ivec2 place = ivec2(max(map.corner + first, vec2(0.0))); // without maps `first` is before them
    vec4 hiding, same;
    [[unroll]] for (int i = 0; i < 4; i++) {
        vec4 met = texelFetch(vpl_planes, place + ivec2(i & 1, i >> 1), 0);
        float before = dot(met.xyz, away) - met.w;
        hiding[i] = before < 0.0 || !near[i] ? 1.0 : 0.0;
        same[i] = before > -VPL_ROUNDING * r || dot(met.xyz, normal) > 0.5 ? 1.0 : 0.0;
    }
    // A surface is not in its own shadow (docs/measurements.md, "Constants"). But what is close behind another, on which
    // the ray ends, is: the inside of a closed room, along the edges of its walls.
    vec4 lit = vec4(greaterThanEqual(stored, reach)) + vec4(lessThan(stored, reach)) * same * vec4(greaterThanEqual(stored, 0.95 * reach));
    float through = dot(shares, lit), stopped = dot(shares, hiding * (1.0 - lit));
    return map.last > 0.0 && stopped > 0.0 ? clamp(2.0 * through / (through + stopped) - 0.5, 0.0, 1.0) : 1.0;
}
#endif
#endif

#endif
