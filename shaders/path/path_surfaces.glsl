// path_surfaces.glsl -- Lambertian surfaces and emissive triangles, for the path tracer. Along the axes on which
// the medium repeats the surfaces repeat with it.
//
// The includer declares the resources of path_resources.glsl.
#ifndef TYN_PATH_SURFACES_GLSL
#define TYN_PATH_SURFACES_GLSL
#include "shaders/common/camera.glsl"
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/surfaces/surface_trace.glsl"

const bool SURFACES = (FLAGS & TYN_PATH_SURFACES) != 0u;
const bool EMITTERS = (FLAGS & TYN_PATH_EMITTERS) != 0u;
const uint SURFACE_PERIODS = 4096u; // a ray is followed through at most so many

// The world box of all surfaces, in M: bounds.
void surface_box(out vec3 lo, out vec3 hi)
{
    vec3 half_size = 0.5 * (surfaces.hi - surfaces.lo);
    vec3 centre = surface_transform(surfaces.from_world, surfaces.lo + half_size);
    vec3 reach = surface_turn_sizes(surfaces.from_world, half_size) + 1e-6 * abs(centre);
    lo = centre - reach;
    hi = centre + reach;
}

// The nearest surface before `hit.t`, or with `any` the first that is found; but for the triangle that `hit` has.
// `period`: where its copy stands, m.
bool surface_trace(vec3 origin, vec3 direction, bool any, inout surface_hit hit, out vec3 period)
{
    period = vec3(0.0);
    vec3 way = surface_turn(surfaces.to_world, direction);
    uint skip = hit.triangle;
    if ((FLAGS & TYN_PATH_REPEAT) == 0u) {
        return surface_trace_world(surface_ray_make(surface_transform(surfaces.to_world, origin), way, skip), any,
                                   hit);
    }
    // Each copy is in a cell of its own, which begins where the surfaces do.
    vec3 lo, hi, repeats = vec3(medium.repeat), inverse = ray_inverse(direction);
    surface_box(lo, hi);
    vec2 span = ray_box(origin, inverse, lo - 1e30 * repeats, hi + 1e30 * repeats);
    span.x = max(span.x, 0.0);
    if (span.x > min(span.y, hit.t)) {
        return false;
    }
    vec3 cell = floor((origin + span.x * direction - lo) / medium.extent) * repeats;
    bool found = false;
    for (uint i = 0u; i < SURFACE_PERIODS; i++) {
        surface_turns++;
        vec3 at = surface_transform(surfaces.to_world, origin - cell * medium.extent);
        if (surface_trace_world(surface_ray_make(at, way, skip), any, hit)) {
            found = true;
            period = cell * medium.extent;
        }
        vec3 side = step(vec3(0.0), direction);
        vec3 ahead = mix(vec3(3e38), ((cell + side) * medium.extent + lo - origin) * inverse,
                         greaterThan(repeats, vec3(0.0)));
        float leave = min(ahead.x, min(ahead.y, ahead.z));
        if (leave >= min(span.y, hit.t) || (any && found)) {
            break;
        }
        cell += mix(vec3(0.0), 2.0 * side - 1.0, lessThanEqual(ahead, vec3(leave)));
    }
    return found;
}

// Whether something stands between two points; `target`: the triangle that holds the other end, or SURFACE_NONE.
bool surface_hides(vec3 origin, vec3 direction, float distance, uint target)
{
    surface_hit hit = surface_hit(distance, target, vec2(0.0));
    vec3 period;
    return SURFACES && surface_trace(origin, direction, true, hit, period);
}

// ---- materials --------------------------------------------------------------------------------

vec3 texel_color(const surface_texture map, ivec2 at)
{
    vec3 c = surface_texel_srgb(map.first, ivec2(map.size), map.wrap, at); // IEC 61966-2-1
    return mix(c * (1.0 / 12.92), pow((c + 0.055) * (1.0 / 1.055), vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// Level 0, bilinear: a path is one of many through its pixel, which average what it covers.
vec3 texture_color(uint index, vec2 uv)
{
    surface_texture map = surface_texture_at(index);
    vec2 at = clamp(uv * vec2(map.size) - 0.5, vec2(-1e9), vec2(1e9));
    vec2 texel = floor(at), part = at - texel;
    ivec2 t = ivec2(texel);
    return mix(mix(texel_color(map, t), texel_color(map, t + ivec2(1, 0)), part.x),
               mix(texel_color(map, t + ivec2(0, 1)), texel_color(map, t + ivec2(1, 1)), part.x), part.y);
}

// What a path that arrives along `way` finds.
struct surface_finding {
    surface_point point; // its normal is on the side of arrival
    vec3 albedo, emission;
    float density; // probability per m^2 with which an emitter is drawn there; 0 if it does not emit to this side
};

// Tells whether a surface emits to its front or its back, and the density of drawing its points.
vec3 surface_emission(const surface_material material, bool front, out float density)
{
    vec3 emission = surface_emitted(material, front);
    density = EMITTERS ? max3(emission) / max(emitters.weight, 1e-37) : 0.0;
    return emission;
}

vec3 surface_albedo(const surface_material material, uint index, vec2 barycentric)
{
    vec3 colour = vec3(1.0);
    if ((FLAGS & TYN_PATH_TEXTURES) != 0u && material.texture != TYN_SURFACE_NO_TEXTURE) {
        mat3x2 uv = surface_uvs(surface_triangle_at(index));
        colour = texture_color(material.texture, uv[0] + barycentric.x * uv[1] + barycentric.y * uv[2]);
    }
    return surface_reflected(material, colour);
}

surface_finding surface_find(const surface_hit hit, vec3 period, vec3 way)
{
    surface_finding f;
    f.point = surface_point_at(hit.triangle, hit.barycentric);
    if ((FLAGS & TYN_PATH_REPEAT) != 0u) {
        f.point.at += period;
        f.point.error += 4.0 * SURFACE_EPSILON * (abs(f.point.at) + abs(period));
    }
    bool front = dot(f.point.normal, way) < 0.0;
    surface_material material = surface_material_at(surface_triangle_at(hit.triangle).w);
    f.emission = surface_emission(material, front, f.density);
    f.albedo = surface_albedo(material, hit.triangle, hit.barycentric);
    f.point.normal = front ? f.point.normal : -f.point.normal;
    return f;
}

// Unit vector about `normal`, distributed as the cosine to it.
vec3 cosine_sample(vec3 normal, vec2 u)
{
    // A point of the sphere on top of the normal; rounding must not turn it below the plane.
    float z = 1.0 - 2.0 * u.x, r = sqrt(max(1.0 - z * z, 0.0)), azimuth = 2.0 * HG_PI * u.y;
    vec3 d = normal + vec3(r * cos(azimuth), r * sin(azimuth), z);
    float size = dot(d, d);
    return size > 1e-12 ? d * inversesqrt(size) : normal;
}

// ---- emitters ---------------------------------------------------------------------------------

struct emitter_sample {
    vec3 direction; // from the point to the emitter, unit
    float distance; // m
    vec3 radiance;  // towards the point, W/(m^2 sr)
    float pdf;      // 1/sr
    uint triangle;
};

uint surface_cell_pick(const surface_cell cell, uint bits)
{
    return float(bits) * (1.0 / 4294967296.0) < cell.keep ? cell.triangle : cell.alias;
}

// Uniform in a triangle, from two uniform numbers.
vec2 triangle_sample(vec2 u)
{
    float root = sqrt(u.x);
    return vec2(root * (1.0 - u.y), root * u.y);
}

emitter_sample emitter_draw(vec3 p, inout rng_state rng)
{
    uvec4 bits = rng_next(rng);
    uint high, low;
    umulExtended(bits.x, emitters.count, high, low);
    uint index = surface_cell_pick(emitter_cells[high], bits.y);
    surface_point point = surface_point_at(index, triangle_sample(rng_vec2(bits.zw)));
    vec3 target = surface_offset(point, p - point.at), to = target - p;
    float distance = length(to), density;
    vec3 direction = to / max(distance, 1e-37);
    float slope = dot(point.normal, direction);
    surface_material material = surface_material_at(surface_triangle_at(index).w);
    vec3 radiance = surface_emission(material, slope < 0.0, density);
    float pdf = density * distance * distance / max(abs(slope), 1e-12);
    return emitter_sample(direction, distance, radiance, pdf, index);
}

#endif
