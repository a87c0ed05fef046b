// walls_triangle.glsl -- triangles among the cells. No bindings.
//
// Lengths are in cell edges. Every test is closed and errs on the side of a wall by the rounding errors
// of its own arithmetic: neighbouring triangles leave no gap between them, whatever order their
// vertices have, and a link that starts within rounding of a wall is cut.
#ifndef TYN_WALLS_TRIANGLE_GLSL
#define TYN_WALLS_TRIANGLE_GLSL

const float WALLS_ROUNDING = 5e-7; // of a sum of products of three, relative to the product of lengths

struct walls_triangle {
    vec3 a, b, c;
    vec3 normal;      // (b - a) x (c - a)
    float normal_error; // bound of what rounding may do to it
};

walls_triangle walls_triangle_of(vec3 a, vec3 b, vec3 c)
{
    vec3 u = b - a, v = c - a;
    return walls_triangle(a, b, c, cross(u, v), WALLS_ROUNDING * length(u) * length(v));
}

// Height of point p over the plane, times the length of `normal`, and the bound of its error.
vec2 walls_height(const walls_triangle t, vec3 p)
{
    vec3 d = p - t.a;
    return vec2(dot(t.normal, d), t.normal_error * (length(d) + 1.0));
}

float walls_edge(vec3 d, vec3 a, vec3 b, out float error)
{
    error = WALLS_ROUNDING * length(d) * (length(a) + 1.0) * (length(b) + 1.0);
    return dot(d, cross(a, b));
}

// Does the segment from p to p + d meet the triangle? `where`: share of the way, 0 to 1.
bool walls_cuts(const walls_triangle t, vec3 p, vec3 d, out float where)
{
    vec2 start = walls_height(t, p), end = vec2(start.x + dot(t.normal, d), start.y);
    where = 0.5;
    if (min(start.x, end.x) > start.y || max(start.x, end.x) < -start.y) {
        return false;
    }
    vec3 a = t.a - p, b = t.b - p, c = t.c - p, error;
    vec3 edges = vec3(walls_edge(d, a, b, error.x), walls_edge(d, b, c, error.y),
                      walls_edge(d, c, a, error.z));
    if (!(all(greaterThanEqual(edges, -error)) || all(lessThanEqual(edges, error)))) {
        return false;
    }
    float rise = start.x - end.x;
    where = abs(rise) > 1e-20 ? clamp(start.x / rise, 0.0, 1.0) : 0.5;
    return true;
}

// Does the cube of edge 2 h around p meet the triangle? Separating axes: the cube's, the triangle's normal,
// the products of their edges.
bool walls_in_cube(const walls_triangle t, vec3 p, float h)
{
    vec3 v[3] = vec3[3](t.a - p, t.b - p, t.c - p);
    vec3 lo = min(v[0], min(v[1], v[2])), hi = max(v[0], max(v[1], v[2]));
    if (any(greaterThan(lo, vec3(h))) || any(lessThan(hi, vec3(-h)))) {
        return false;
    }
    if (abs(dot(t.normal, v[0])) > h * dot(abs(t.normal), vec3(1.0)) + t.normal_error * (length(v[0]) + 1.0)) {
        return false;
    }
    for (int e = 0; e < 3; e++) {
        vec3 edge = v[(e + 1) % 3] - v[e];
        for (int axis = 0; axis < 3; axis++) {
            vec3 unit = vec3(axis == 0, axis == 1, axis == 2), s = cross(unit, edge);
            float x = dot(s, v[e]), y = dot(s, v[(e + 2) % 3]);
            float r = h * dot(abs(s), vec3(1.0)) * 1.00001;
            if (min(x, y) > r || max(x, y) < -r) {
                return false;
            }
        }
    }
    return true;
}

#endif
