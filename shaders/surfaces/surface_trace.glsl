// surface_trace.glsl -- where a ray meets the scene's triangles.
//
// No ray leaks between triangles that share an edge or a vertex: the edge functions of Woop, Benthin and Wald,
// "Watertight ray/triangle intersection" (JCGT 2(1), 2013), in single precision. Their double precision fallback
// is not needed for that: fl(ab) - fl(cd) is 0 or has the sign of ab - cd, as rounding is monotonic, and 0 counts
// as inside on both sides of an edge.
//
// A ray that starts on a surface does not meet that surface again, at any scale: the origin's side of the
// triangle's plane is told by an orientation test with its error bound, not by the distance along the ray.
// surface_offset moves origins to the side they belong to. A ray towards a point of a triangle leaves that triangle
// out.
//
// Define GEOMETRY_AT (surfaces.glsl).
#ifndef TYN_SURFACE_TRACE_GLSL
#define TYN_SURFACE_TRACE_GLSL
#include "surface_frame.glsl"
#include "surfaces.glsl"

uint surface_turns = 0u; // of the loops below, of this thread so far, at most: one that it does not enter counts

const uint SURFACE_NONE = 0xffffffffu;
const float SURFACE_EPSILON = 5.9604645e-8; // half an ulp of 1
const float SURFACE_MISSED = 3e38; // of a box: the ray does not enter it

struct surface_hit {
    float t;         // m; surface_trace finds hits nearer than the value it is given
    uint triangle;
    vec2 barycentric; // weights of v1 and v2
};

struct surface_ray { // in the world
    vec3 origin, direction, inverse;
    vec3 shear; // shear.xy turns the direction into the permuted z axis, which shear.z scales
    uint axis;  // the direction's largest component, permuted to z
    uint skip;  // a triangle that is not met: where the ray ends
};

// Turns the axes so that `axis` becomes z.
vec3 surface_permute(vec3 v, uint axis)
{
    return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v;
}

surface_ray surface_ray_make(vec3 origin, vec3 direction, uint skip)
{
    surface_ray ray;
    ray.skip = skip;
    ray.origin = origin;
    ray.direction = direction;
    vec3 size = abs(direction);
    ray.axis = size.x > size.y ? (size.x > size.z ? 0u : 2u) : (size.y > size.z ? 1u : 2u);
    vec3 d = surface_permute(direction, ray.axis);
    ray.shear = vec3(d.xy / d.z, 1.0 / d.z);
    vec3 sign_of = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(direction, vec3(0.0)));
    ray.inverse = sign_of / max(size, vec3(1e-18));
    return ray;
}

// A cross product and the sum of its terms' sizes, which bounds its rounding.
vec3 surface_cross(vec3 a, vec3 b, out vec3 sizes)
{
    vec3 p = a.yzx * b.zxy, q = a.zxy * b.yzx;
    sizes = abs(p) + abs(q);
    return p - q;
}

// Does the ray meet a triangle before `far`, and where? `edges`: barycentric weights of v1 and v2, not yet divided by
// their sum, edges.z. `normal` of any length; `rounding` bounds what rounding did to it (surface_cross).
bool surface_meets(const surface_ray ray, vec3 v0, vec3 v1, vec3 v2, vec3 normal, vec3 rounding, float far, out float t,
                   out vec3 edges)
{
    vec3 from = v0 - ray.origin;
    vec3 a = surface_permute(from, ray.axis), b = surface_permute(v1 - ray.origin, ray.axis),
         c = surface_permute(v2 - ray.origin, ray.axis);
    // `precise`: neighbours must see the same numbers at their common edge, but for the sign.
    precise vec2 pa = a.xy - ray.shear.xy * a.z;
    precise vec2 pb = b.xy - ray.shear.xy * b.z;
    precise vec2 pc = c.xy - ray.shear.xy * c.z;
    precise float u = pc.x * pb.y - pc.y * pb.x;
    precise float v = pa.x * pc.y - pa.y * pc.x;
    precise float w = pb.x * pa.y - pb.y * pa.x;
    bool inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    edges = vec3(v, w, u + v + w);
    t = max(ray.shear.z * (u * a.z + v * b.z + w * c.z) / edges.z, 0.0);
    // Not from an origin in the triangle's plane, and not if the ray leads away from it.
    float height = dot(normal, from), facing = dot(normal, ray.direction);
    bool before = abs(height) > dot(rounding, abs(from)) &&
                  ((height < 0.0 ? -facing : facing) >= 0.0 || // no product: it is of five lengths, and may be a denormal
                   abs(facing) <= dot(rounding, abs(ray.direction)));
    return inside && edges.z != 0.0 && t < far && before;
}

// Takes the triangle as the new hit if the ray meets it before `hit.t`.
bool surface_meet(const surface_ray ray, uint index, inout surface_hit hit)
{
    uvec4 corners = surface_triangle_at(index);
    vec3 v0 = surface_position(corners.x), v1 = surface_position(corners.y), v2 = surface_position(corners.z);
    vec3 sizes, normal = surface_cross(v1 - v0, v2 - v0, sizes), edges;
    float t;
    if (!surface_meets(ray, v0, v1, v2, normal, 4.0 * SURFACE_EPSILON * sizes, hit.t, t, edges) || index == ray.skip) {
        return false;
    }
    hit = surface_hit(t, index, edges.xy / edges.z);
    return true;
}

// All triangles, which are SURFACE_FEW: all threads that run together try the same one, and read nothing.
bool surface_meet_few(const surface_ray ray, inout surface_hit hit)
{
    bool found = false;
    vec3 edges = vec3(1.0);
    [[unroll]] for (uint i = 0u; i < SURFACE_FEW; i++) {
        surface_corners c = surface_corners_of(i);
        float t;
        vec3 e;
        if (surface_meets(ray, c.v0, c.v1, c.v2, c.normal, c.rounding, hit.t, t, e) && i != ray.skip) {
            hit.t = t;
            hit.triangle = i;
            edges = e;
            found = true;
        }
    }
    hit.barycentric = found ? edges.xy / edges.z : hit.barycentric;
    return found;
}

// Where the ray enters a box; SURFACE_MISSED if it does not before `far`. Never misses a box for rounding: Ize,
// "Robust BVH ray traversal" (JCGT 2(2), 2013), with a quotient that is off by 2.5 ulps, as Vulkan allows: a difference,
// the inverse and a product are off by 1 + 5 + 1 SURFACE_EPSILON, at both ends.
float surface_enter(const surface_ray ray, vec3 lo, vec3 hi, float far)
{
    vec3 a = (lo - ray.origin) * ray.inverse, b = (hi - ray.origin) * ray.inverse;
    vec3 enter = min(a, b), leave = max(a, b);
    float near = max(max(enter.x, enter.y), max(enter.z, 0.0));
    float end = min(min(leave.x, leave.y), leave.z) * (1.0 + 16.0 * SURFACE_EPSILON);
    return near <= min(end, far) ? near : SURFACE_MISSED;
}

struct surface_entry {
    float at;          // where the ray enters the node's box, or SURFACE_MISSED
    uint first, count; // of the node
};

surface_entry surface_enter_node(const surface_ray ray, uint node, float far)
{
    uvec4 lo = surface_node_row(node, 0u), hi = surface_node_row(node, 1u);
    return surface_entry(surface_enter(ray, uintBitsToFloat(lo.xyz), uintBitsToFloat(hi.xyz), far), lo.w, hi.w);
}

// The nearest hit before `hit.t`, or with `any` the first that is found. False if there is none.
bool surface_trace_world(const surface_ray ray, bool any, inout surface_hit hit)
{
    if (SURFACE_FEW > 0u) {
        return surface_meet_few(ray, hit);
    }
    bool found = false;
    uint stack[TYN_SURFACE_STACK];
    int depth = 0;
    surface_entry root = surface_enter_node(ray, 0u, hit.t);
    if (root.at == SURFACE_MISSED || root.first + root.count == 0u) { // without surfaces all is 0
        return false;
    }
    uint first = root.first, count = root.count;
    // Lanes that run together look for leaves together, then try their triangles together.
    for (bool more = true; more;) {
        surface_turns += 3u;
        while (count == 0u && more) {
            surface_turns++;
            surface_entry left = surface_enter_node(ray, first, hit.t);
            surface_entry right = surface_enter_node(ray, first + 1u, hit.t);
            bool turned = right.at < left.at;
            if (max(left.at, right.at) < SURFACE_MISSED) { // the ray may reach as far as infinity
                stack[depth++] = turned ? first : first + 1u;
            }
            bool goes_on = min(left.at, right.at) < SURFACE_MISSED;
            first = turned ? right.first : left.first;
            count = turned ? right.count : left.count;
            more = goes_on || depth > 0;
            if (!goes_on && more) { // no loop of one turn: turns are counted (docs/writing-a-pass.md, "Shaders")
                uint at = stack[--depth];
                first = surface_node_row(at, 0u).w;
                count = surface_node_row(at, 1u).w;
            }
        }
        for (uint i = first; more && i < first + count; i++) {
            surface_turns++;
            found = surface_meet(ray, i, hit) || found;
        }
        more = more && depth > 0 && !(any && found);
        if (more) {
            uint at = stack[--depth];
            first = surface_node_row(at, 0u).w;
            count = surface_node_row(at, 1u).w;
        }
    }
    return found;
}

// ---- frames -----------------------------------------------------------------------------------

// Bounds of a vector's components, turned.
vec3 surface_turn_sizes(tyn_vec4 rows[3], vec3 sizes)
{
    return vec3(dot(abs(rows[0].xyz), sizes), dot(abs(rows[1].xyz), sizes), dot(abs(rows[2].xyz), sizes));
}

// What rounding may have done to a transformed point whose own error is `error`.
vec3 surface_transform_error(tyn_vec4 rows[3], vec3 p, vec3 error)
{
    return surface_turn_sizes(rows, 4.0 * SURFACE_EPSILON * abs(p) + error) +
           4.0 * SURFACE_EPSILON * abs(vec3(rows[0].w, rows[1].w, rows[2].w));
}

// A point of a triangle in M, from which rays into the half space of `normal_M` or its opposite may start.
struct surface_point {
    vec3 at;     // M, m
    vec3 normal; // M, unit: of the plane, towards the front
    vec3 error;  // bounds what rounding did to `at`, there and back
};

surface_point surface_point_at(uint index, vec2 barycentric)
{
    uvec4 corners = surface_triangle_at(index);
    vec3 v0 = surface_position(corners.x), v1 = surface_position(corners.y), v2 = surface_position(corners.z);
    vec3 e1 = v1 - v0, e2 = v2 - v0;
    vec3 longest = max(abs(e1), abs(e2));
    float scale = 1.0 / max(max(longest.x, max(longest.y, longest.z)), 1e-37); // squares stay in range
    vec3 normal = cross(scale * e1, scale * e2);
    vec3 b = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    vec3 world = b.x * v0 + b.y * v1 + b.z * v2;
    vec3 error = 6.0 * SURFACE_EPSILON * (b.x * abs(v0) + b.y * abs(v1) + b.z * abs(v2));
    surface_point p;
    p.at = surface_transform(surfaces.from_world, world);
    p.normal = surface_turn(surfaces.from_world, normal * inversesqrt(max(dot(normal, normal), 1e-37)));
    // Back in the world the point must still be on its side.
    error = surface_transform_error(surfaces.from_world, world, error);
    error = surface_transform_error(surfaces.to_world, p.at, error);
    p.error = surface_turn_sizes(surfaces.from_world, error);
    return p;
}

// Moves the point off its triangle, to the side of `towards` (a direction or a vector, M), by what rounding may
// have done to it: as in Pharr, Jakob and Humphreys, "Physically based rendering", 3.9.
vec3 surface_offset(const surface_point p, vec3 towards)
{
    float away = 2.0 * dot(abs(p.normal), p.error);
    return p.at + (dot(towards, p.normal) < 0.0 ? -away : away) * p.normal;
}

#endif
