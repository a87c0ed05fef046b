// shade_outside.glsl -- light that the medium's box sends to a surface outside it.
//
// The patches of the box's faces (shade_faces.h) are emitters of uniform radiance. Their irradiance is Lambert's integral
// around the contour: half the angle of every edge times the cosine between the normals of its plane and of the surface.
// Where a patch goes below the surface's plane its contour goes along the horizon, above which that is half the angle.
#ifndef TYN_SHADE_OUTSIDE_GLSL
#define TYN_SHADE_OUTSIDE_GLSL
#include "shade_faces.h"

// Of an edge between unit vectors in front of the surface. The angle over its sine is a rational fit within 4e-5 of it
// (Heitz, Dupuy, Hill and Neubelt, "Real-time polygonal-light shading with linearly transformed cosines", 2016).
float shade_edge(vec3 a, vec3 b, vec3 n)
{
    float c = dot(a, b), s = abs(c);
    float fit = (0.8543985 + (0.4965155 + 0.0145206 * s) * s) / (3.4175940 + (4.1616724 + s) * s);
    fit = c > 0.0 ? fit : 0.5 * inversesqrt(max(1.0 - c * c, 1e-7)) - fit;
    return 3.14159265 * fit * dot(cross(a, b), n);
}

// Of any edge.
float shade_edge_horizon(vec3 a, vec3 b, vec3 n)
{
    float za = dot(a, n), zb = dot(b, n);
    vec3 horizon = za * zb < 0.0 ? normalize(mix(a, b, za / (za - zb))) : a;
    float before = za >= 0.0 && zb >= 0.0 ? shade_edge(a, b, n) :
        za > 0.0 ? shade_edge(a, horizon, n) : zb > 0.0 ? shade_edge(horizon, b, n) : 0.0;
    vec3 from = za < 0.0 ? a : horizon, to = zb < 0.0 ? b : horizon;
    from -= dot(from, n) * n;
    to -= dot(to, n) * n;
    return before + (za < 0.0 || zb < 0.0 ? 0.5 * atan(dot(cross(from, to), n), dot(from, to)) : 0.0);
}

// Irradiance at p on a surface with the normal n, of uniform radiance 1 of the rectangle `rect` (from, to) on the plane
// where coordinate `axis` is `plane`.
float shade_rectangle(vec3 p, vec3 n, int axis, float plane, vec4 rect)
{
    vec3 corners[4];
    vec4 heights;
    [[unroll]] for (int k = 0; k < 4; k++) {
        float s = k == 1 || k == 2 ? rect.z : rect.x, t = k >= 2 ? rect.w : rect.y;
        vec3 corner = (axis == 0 ? vec3(plane, s, t) : axis == 1 ? vec3(s, plane, t) : vec3(s, t, plane)) - p;
        corners[k] = corner * inversesqrt(max(dot(corner, corner), 1e-30));
        heights[k] = dot(corners[k], n);
    }
    float lowest = min(min(heights.x, heights.y), min(heights.z, heights.w));
    float highest = max(max(heights.x, heights.y), max(heights.z, heights.w));
    float sum = 0.0;
    for (bool whole = lowest >= -1e-5; whole; whole = false) {
        [[unroll]] for (int k = 0; k < 4; k++) {
            sum += shade_edge(corners[k], corners[(k + 1) % 4], n);
        }
    }
    for (bool cut = lowest < -1e-5 && highest > 0.0; cut; cut = false) {
        for (int k = 0; k < 4; k++) {
            sum += shade_edge_horizon(corners[k], corners[(k + 1) % 4], n);
        }
    }
    return abs(sum);
}

// How far from the box the patches show.
float shade_reach(vec3 lo, vec3 hi)
{
    vec3 size = hi - lo;
    return max(size.x, max(size.y, size.z)) / float(SHADE_FACE_SIDE);
}

// `lo`, `hi`: the lattice's box.
vec3 shade_outside(vec3 p, vec3 n, vec3 lo, vec3 hi)
{
    vec3 sum = vec3(0.0);
    float far = length(p - clamp(p, lo, hi)) / shade_reach(lo, hi);
    int first = far > 8.0 ? 0 : far > 2.0 ? 1 : 5, count = far > 8.0 ? 1 : far > 2.0 ? 4 : 16;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        bool upper = (face & 1) != 0;
        float plane = upper ? hi[axis] : lo[axis], before = upper ? p[axis] - plane : plane - p[axis];
        for (int k = before > 0.0 ? first : first + count; k < first + count; k++) {
            ivec2 texel = ivec2(k * SHADE_FACE_ENTRIES, face);
            vec4 light = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_LIGHT, 0), 0);
            vec4 rect = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_RECT, 0), 0);
            vec4 shape = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_SHAPE, 0), 0);
            vec2 middle = 0.5 * (rect.xy + rect.zw);
            vec3 from = axis == 0 ? vec3(plane, middle) : axis == 1 ? vec3(middle.x, plane, middle.y) :
                                                                      vec3(middle, plane);
            float directed = max(shape.x + dot(shape.yzw, normalize(p - from)), 0.0);
            sum += light.rgb * (light.a * directed * shade_rectangle(p, n, axis, plane, rect));
        }
    }
    return sum;
}

#endif
