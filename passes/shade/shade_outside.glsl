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

vec3 shade_middle(int axis, float plane, vec4 rect)
{
    vec2 m = 0.5 * (rect.xy + rect.zw);
    return axis == 0 ? vec3(plane, m) : axis == 1 ? vec3(m.x, plane, m.y) : vec3(m, plane);
}

vec4 shade_sight_field(vec3 place, int field)
{
    vec3 size = vec3(textureSize(sight_tex, 0));
    return textureLod(sight_tex, (place + vec3(0.0, 0.0, float(field) * size.z / float(SHADE_SIGHT_FIELDS))) / size, 0.0);
}

// `lo`, `hi`: the lattice's box. `facet`: the triangle's normal.
vec3 shade_outside(vec3 p, vec3 n, vec3 facet, vec3 lo, vec3 hi)
{
    vec3 sum = vec3(0.0);
    float far = length(p - clamp(p, lo, hi)) / shade_reach(lo, hi);
    int first = far > 8.0 ? 0 : far > 2.0 ? 1 : 5, count = far > 8.0 ? 1 : far > 2.0 ? 4 : 16;
    // So far off that no place behind the surface's plane counts.
    vec3 places = vec3(textureSize(sight_tex, 0)) / vec3(1.0, 1.0, float(SHADE_SIGHT_FIELDS));
    bool hidden = places.z >= 1.0; // may be
    vec3 place = (p - args.sight_lo) / args.sight_edge + dot(abs(facet), vec3(1.0)) * facet;
    place = clamp(place, vec3(0.5), places - 0.5);
    float share = hidden ? 1.0 / max(shade_sight_field(place, SHADE_SIGHT_SHARE).r, 0.25) : 1.0;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        bool upper = (face & 1) != 0;
        float plane = upper ? hi[axis] : lo[axis], before = upper ? p[axis] - plane : plane - p[axis];
        vec4 seen = vec4(1.0);
        for (bool once = hidden && before > 0.0; once; once = false) {
            seen = min(share * shade_sight_field(place, face), 1.0);
            // What the surface hides itself is below its horizon: patches that end there are as the others.
            vec4 above = vec4(0.0);
            for (int k = 0; k < 4; k++) {
                vec3 aim = texelFetch(faces_tex, ivec2((1 + k) * SHADE_FACE_ENTRIES + SHADE_FACE_AIM, face), 0).xyz;
                above[k] = dot(aim - p, facet) > 0.0 ? 1.0 : 0.0;
            }
            float some = dot(above, vec4(1.0)), others = some > 0.0 ? dot(above, seen) / some : 1.0;
            seen = mix(vec4(others), seen, above);
        }
        // Patches are not to be told from each other close to the box: there they shine as it is interpolated.
        vec3 local = vec3(0.0);
        for (bool once = before > 0.0 && far < 1.0; once; once = false) {
            vec3 x = clamp((p - lo) / (hi - lo) * float(SHADE_FACE_SIDE) - 0.5, 0.0, float(SHADE_FACE_SIDE - 1));
            vec2 at = axis == 0 ? x.yz : axis == 1 ? x.xz : x.xy, corner = min(floor(at), float(SHADE_FACE_SIDE - 2));
            at -= corner;
            for (int i = 0; i < 4; i++) {
                ivec2 q = ivec2(corner) + ivec2(i & 1, i >> 1);
                vec4 light = texelFetch(faces_tex, ivec2((5 + q.y * SHADE_FACE_SIDE + q.x) * SHADE_FACE_ENTRIES + SHADE_FACE_LIGHT, face), 0);
                vec2 t = vec2((i & 1) != 0 ? at.x : 1.0 - at.x, i >= 2 ? at.y : 1.0 - at.y);
                local += t.x * t.y * light.a * light.rgb;
            }
        }
        for (int k = before > 0.0 ? first : first + count; k < first + count; k++) {
            ivec2 texel = ivec2(k * SHADE_FACE_ENTRIES, face);
            vec4 light = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_LIGHT, 0), 0);
            vec4 rect = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_RECT, 0), 0);
            vec4 shape = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_SHAPE, 0), 0);
            vec3 from = shade_middle(axis, plane, rect);
            int quarter = k < 5 ? k - 1 : ((k - 5) / 8) * 2 + ((k - 5) % 4) / 2;
            float open = k == 0 ? dot(seen, vec4(0.25)) : seen[max(quarter, 0)];
            float directed = max(shape.x + dot(shape.yzw, normalize(p - from)), 0.0);
            light.rgb = mix(light.rgb, local, max(1.0 - far, 0.0));
            sum += light.rgb * (light.a * open * directed * shade_rectangle(p, n, axis, plane, rect));
        }
    }
    return sum;
}

#endif
