// octahedral.glsl -- the sphere of directions as a square: an octahedron, its lower faces folded out.
//
// Octahedral coordinates are in [-1, 1]^2; (0, 0) is +z, the corners are -z, the upper half is |u| + |v| <= 1.
// A direction p of the octahedron |x| + |y| + |z| = 1 covers dOmega = du dv / |p|^3, which sums to 4 pi.
// Across an edge the map goes on at the mirrored place of the same edge: (1, v) is (1, -v).
#ifndef TYN_OCTAHEDRAL_GLSL
#define TYN_OCTAHEDRAL_GLSL

// Of a direction of any length but 0.
vec2 octahedral_of(vec3 d)
{
    vec2 e = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(1.0), vec2(-1.0), lessThan(e, vec2(0.0)));
    return d.z >= 0.0 ? e : folded;
}

// The point of the octahedron, not normalised.
vec3 octahedral_point(vec2 e)
{
    float z = 1.0 - abs(e.x) - abs(e.y);
    vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(1.0), vec2(-1.0), lessThan(e, vec2(0.0)));
    return vec3(z >= 0.0 ? e : folded, z);
}

// The texel of a map of n x n that is meant by one up to n beyond its edges.
ivec2 octahedral_fold(ivec2 t, int n)
{
    if (t.x < 0 || t.x >= n) {
        t = ivec2(t.x < 0 ? -1 - t.x : 2 * n - 1 - t.x, n - 1 - t.y);
    }
    if (t.y < 0 || t.y >= n) {
        t = ivec2(n - 1 - t.x, t.y < 0 ? -1 - t.y : 2 * n - 1 - t.y);
    }
    return t;
}

// Centre of a texel.
vec2 octahedral_texel(ivec2 t, int n)
{
    return (2.0 * vec2(t) + 1.0) / float(n) - 1.0;
}

#endif
