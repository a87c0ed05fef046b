// shade_outside.glsl -- light that the medium's box sends to a surface outside it.
//
// The box's faces (shade_faces.h) are emitters. Their irradiance is Lambert's integral around the contour: half the angle
// of every edge times the cosine between the normals of its plane and of the surface, with the mean of their radiance
// as it is from there. Where a face goes below the surface's plane its contour goes along the horizon, above which
// that is half the angle.
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
    if (lowest >= -1e-5) {
        [[unroll]] for (int k = 0; k < 4; k++) {
            sum += shade_edge(corners[k], corners[(k + 1) % 4], n);
        }
    }
    if (lowest < -1e-5 && highest > 0.0) {
        for (int k = 0; k < 4; k++) {
            sum += shade_edge_horizon(corners[k], corners[(k + 1) % 4], n);
        }
    }
    return abs(sum);
}

// The side of a part of 4 x 4 of a face, about.
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

// `lo`, `hi`: the lattice's box. `facet`: the triangle's normal. A face is one emitter. How bright it is: as its 2 x 2
// patches weigh at p by their middles, what is hidden dark, but close to it as it is there.
vec3 shade_outside(vec3 p, vec3 n, vec3 facet, vec3 lo, vec3 hi)
{
    vec3 sum = vec3(0.0);
    float patch_side = shade_reach(lo, hi), near = max(1.0 - length(p - clamp(p, lo, hi)) / patch_side, 0.0);
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
        vec4 whole = texelFetch(faces_tex, ivec2(SHADE_FACE_LIGHT, face), 0);
        if (before > 0.0 && whole.a > 0.0) {
            vec4 seen = hidden ? min(share * shade_sight_field(place, face), 1.0) : vec4(1.0);
            vec3 light = vec3(0.0);
            float all = 0.0, open = 0.0;
            [[unroll]] for (int k = 0; k < 4; k++) {
                ivec2 texel = ivec2((1 + k) * SHADE_FACE_ENTRIES, face);
                vec3 d = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_AIM, 0), 0).xyz - p;
                float rr = dot(d, d) + 0.25 * patch_side * patch_side;
                float weight = max(dot(d, n), 1e-4 * patch_side) / (rr * rr);
                vec4 patch_light = texelFetch(faces_tex, texel + ivec2(SHADE_FACE_LIGHT, 0), 0);
                light += weight * seen[k] * patch_light.a * patch_light.rgb;
                open += weight * seen[k];
                all += weight;
            }
            // Where the surface looks to: between its normal and the face's.
            vec3 towards = n, at = p;
            towards[axis] += upper ? -1.0 : 1.0;
            at += towards * before / max(abs(towards[axis]), 0.1);
            at = clamp((at - lo) / (hi - lo) * float(SHADE_FACE_SIDE), 0.5, float(SHADE_FACE_SIDE) - 0.5);
            vec2 tile = axis == 0 ? at.yz : axis == 1 ? at.xz : at.xy;
            tile += vec2(float(face * SHADE_FACE_SIDE), 6.0);
            vec3 local = textureLod(faces_tex, tile / vec2(textureSize(faces_tex, 0)), 0.0).rgb;
            light = mix(light, local * open, near) / all;
            vec4 rect = texelFetch(faces_tex, ivec2(SHADE_FACE_RECT, face), 0);
            vec4 shape = texelFetch(faces_tex, ivec2(SHADE_FACE_SHAPE, face), 0);
            float directed = max(shape.x + dot(shape.yzw, normalize(p - shade_middle(axis, plane, rect))), 0.0);
            sum += light * (directed * shade_rectangle(p, n, axis, plane, rect));
        }
    }
    return sum;
}
