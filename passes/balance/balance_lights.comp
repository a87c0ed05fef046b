// balance_lights.comp -- where the light of suns, the sky, lamps and virtual point lights (VPLs) ends its first flight.
// A workgroup per light, some for each sun and for the sky, in this order; rays, the depths of the beams, and of the sky's
// light those of the cells on its way.
//
// This knows nothing of shadow maps, of the cells' first collisions and of what VPLs were made from: that
// the sums agree is a check of these.
#include "shaders/common/scene_args.h"
#include "balance_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/lattice/lattice.glsl"
#define MEDIUM_BLOCK 0
#define BEAMS_AT 1
#define BEAMS_STORAGE
#define RADIALS_AT 5
#define RADIALS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/random/rng.glsl"
#define GEOMETRY_AT 9
#define MATERIALS_AT 13
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_texture.glsl"

layout(local_size_x = BALANCE_GROUP) in;
#define WORKGROUP_SIZE BALANCE_GROUP
#define WORKGROUP_SUM vec3
#include "shaders/common/workgroup.glsl"
TYN_ARGS(balance_lights_args args);
TYN_READ(16, lights, light_block lights[]);
TYN_WRITE(17, found, balance_light found[]);
TYN_READ(18, directions, ordinates_block directions);
layout(binding = 19) uniform sampler3D cells;
#include "shaders/surfaces/surface_trace.glsl"
#include "shaders/surfaces/surface_faces.glsl"

const uint SUN_RAYS = 160u, LAMP_RAYS = 96u, VPL_RAYS = 24u, SKY_RAYS = 16u; // squared: of a sun for each face
const uint SUN = 0u, SKY = 1u, LAMP = 2u, VPL = 3u;

vec3 sent = vec3(0.0), kept = vec3(0.0), escaped = vec3(0.0); // W

vec3 albedo_at(const surface_hit hit)
{
    uvec4 t = surface_triangle_at(hit.triangle);
    surface_material m = surface_material_at(t.w);
    vec3 colour = vec3(1.0);
    if (m.texture != TYN_SURFACE_NO_TEXTURE) {
        vec2 b = hit.barycentric;
        vec2 uv = (1.0 - b.x - b.y) * surface_uv(t.x) + b.x * surface_uv(t.y) + b.y * surface_uv(t.z);
        colour = surface_texture_level(surface_texture_at(m.texture), uv, 0u);
    }
    return surface_reflected(m, colour);
}

// Does light reflected at a point of a surface, to the side of `normal`, leave the scene? Along one way of many.
bool leaves(const surface_point p, vec3 normal, inout rng_state rng)
{
    vec2 u = rng_vec2(rng_next(rng).xy);
    float z = sqrt(1.0 - u.x), r = sqrt(u.x), azimuth = 2.0 * 3.14159265 * u.y;
    vec3 side = normalize(abs(normal.x) < 0.7 ? cross(normal, vec3(1.0, 0.0, 0.0)) : cross(normal, vec3(0.0, 1.0, 0.0)));
    vec3 d = z * normal + r * (cos(azimuth) * side + sin(azimuth) * cross(normal, side));
    vec3 origin = surface_offset(p, normal);
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, origin),
                                       surface_turn(surfaces.to_world, d), SURFACE_NONE);
    vec2 span = ray_box(origin, ray_inverse(d), vec3(0.0), medium.extent);
    float rounding = 1e-4 * max(max(medium.extent.x, medium.extent.y), medium.extent.z);
    return !surface_trace_world(ray, true, hit) && span.y <= max(span.x, 0.0) + rounding;
}

// What the medium leaves of light on its way from `start` to `end` along d (M): cells at steps of half their width.
vec3 cells_leave(vec3 origin, vec3 d, float start, float end)
{
    ivec3 dims = textureSize(cells, 0) / ivec3(1, 1, args.channels);
    lattice_box box = lattice_box_of(medium.extent, dims);
    uint steps = uint(clamp(ceil(2.0 * (end - start) / box.dx), 1.0, 4096.0));
    float step = (end - start) / float(steps);
    vec3 tau = vec3(0.0);
    for (uint k = 0u; k < steps; k++) {
        ivec3 c = ivec3(floor(lattice_from_m(box, origin + (start + (float(k) + 0.5) * step) * d)));
        c = clamp(c, ivec3(0), dims - 1);
        for (int ch = 0; ch < 3; ch++) {
            vec4 cell = texelFetch(cells, c + ivec3(0, 0, args.channels == 1u ? 0 : ch * dims.z), 0);
            tau[ch] += step * (cell.x + cell.y);
        }
    }
    return exp(-tau);
}

// What the medium leaves of the light of a ray between `start` and `end`, in its box; n: see follow.
vec3 left_of(uint n, uint kind, vec3 origin, vec3 d, float start, float end)
{
    if (kind == SKY) {
        return cells_leave(origin, d, start, end);
    }
    beam_tau tau;
    if (kind == SUN) {
        tau = beam_depth(n, origin + end * d);
    } else {
        vec3 away = origin + end * d - radials[n].light.position;
        tau = radial_tau(radial_place_of(n, away, length(away)));
    }
    return exp(-(tau.a + tau.p));
}

// Follows the power of a ray of light n (a sun; of lamps and VPLs the number in `radials`) from `origin` (M).
void follow(uint n, uint kind, vec3 origin, vec3 d, vec3 power, inout rng_state rng)
{
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, origin),
                                       surface_turn(surfaces.to_world, d), SURFACE_NONE);
    bool met = surface_trace_world(ray, false, hit);
    vec2 span = ray_box(origin, ray_inverse(d), vec3(0.0), medium.extent);
    float start = max(span.x, 0.0), end = min(hit.t, span.y);
    sent += power;
    if (end > start) { // through the medium's box
        power *= left_of(n, kind, origin, d, start, end);
    }
    if (!met) {
        escaped += power;
        return;
    }
    vec3 albedo = albedo_at(hit);
    kept += power * (1.0 - albedo);
    if (kind != VPL) { // what VPLs do not carry: it leaves, or it is missing from the sum
        surface_point p = surface_point_at(hit.triangle, hit.barycentric);
        vec3 normal = dot(p.normal, d) > 0.0 ? -p.normal : p.normal;
        vec3 world = ray.origin + hit.t * ray.direction;
        if (!surface_faces_something(hit.triangle, p.at, world, normal, medium.extent, rng) && leaves(p, normal, rng)) {
            escaped += power * albedo;
        }
    }
}

// A place in the k-th of n x n cells of a square.
vec2 place_in(uint k, uint n, inout rng_state rng)
{
    return (vec2(k % n, k / n) + rng_vec2(rng_next(rng).xy)) / float(n);
}

// Parallel light `irradiance` along d that enters the box around everything: the rays first, first + stride, ... of `rays`
// squared for each face. A CPU device ends all loops of a thread after 65535 turns in total, without a word.
void follow_parallel(uint n, uint kind, vec3 irradiance, vec3 d, uint rays, uint first, uint stride)
{
    vec3 size = args.hi - args.lo;
    for (uint axis = 0u; axis < 3u; axis++) {
        uint u = (axis + 1u) % 3u, v = (axis + 2u) % 3u;
        float across = size[u] * size[v] * abs(d[axis]) / float(rays * rays);
        for (uint k = first; across > 0.0 && k < rays * rays; k += stride) {
            rng_state rng = rng_start(n, k, axis + 4u * kind);
            vec2 at = place_in(k, rays, rng);
            vec3 p = args.lo;
            p[axis] = d[axis] > 0.0 ? args.lo[axis] : args.hi[axis];
            p[u] += at.x * size[u];
            p[v] += at.y * size[v];
            follow(n, kind, p, d, across * irradiance, rng);
        }
    }
}

void follow_sun(uint n, uint part)
{
    follow_parallel(n, SUN, lights[n].color, lights[n].direction, SUN_RAYS,
                    part * BALANCE_GROUP + gl_LocalInvocationIndex, BALANCE_SUN_PARTS * BALANCE_GROUP);
}

// Every so many directions, a ray of a face each thread. Mean cosine: of a region about its direction.
void follow_sky(uint part)
{
    uint count = min(directions.count, uint(TYN_ORDINATES_MAX));
    for (uint n = part; n < count; n += args.sky_parts) {
        vec3 irradiance = directions.list[n].mean_cosine * max(directions.list[n].irradiance, vec3(0.0));
        follow_parallel(n, SKY, irradiance, directions.list[n].direction, SKY_RAYS, gl_LocalInvocationIndex,
                        BALANCE_GROUP);
    }
}

void follow_local(uint n)
{
    light_block light = radials[n].light;
    bool lamp = n < radial_num_lamps;
    uint rays = lamp ? LAMP_RAYS : VPL_RAYS;
    vec3 axis = light.direction;
    vec3 side = normalize(abs(axis.x) < 0.7 ? cross(axis, vec3(1.0, 0.0, 0.0)) : cross(axis, vec3(0.0, 1.0, 0.0)));
    // A VPL is a little above its surface, as its own map of distances is.
    vec3 reach = max(abs(light.position), vec3(light.radius));
    float lift = lamp ? 0.0 : 0.02 * light.radius + 1e-5 * max(max(reach.x, reach.y), reach.z);
    for (uint k = gl_LocalInvocationIndex; k < rays * rays; k += BALANCE_GROUP) {
        rng_state rng = rng_start(n, k, 3u);
        vec2 at = place_in(k, rays, rng);
        // Uniform in the solid angle; of a cosine lobe in its power.
        float z = lamp ? 1.0 - at.x * (1.0 - light.cos_outer) : sqrt(1.0 - at.x);
        float solid_angle = 2.0 * 3.14159265 * (1.0 - light.cos_outer) / float(rays * rays);
        float r = sqrt(max(1.0 - z * z, 0.0)), azimuth = 2.0 * 3.14159265 * at.y;
        vec3 d = z * axis + r * (cos(azimuth) * side + sin(azimuth) * cross(axis, side));
        vec3 power = light.color * (lamp ? solid_angle * light_lobe(light, dot(d, axis))
                                             : 3.14159265 / float(rays * rays));
        follow(n, lamp ? LAMP : VPL, light.position + lift * axis, d, power, rng);
    }
}

void main()
{
    uint suns = args.num_suns * BALANCE_SUN_PARTS, group = gl_WorkGroupID.x, n = group - suns - args.sky_parts;
    vec3 entering = vec3(0.0), emitted = vec3(0.0);
    if (group < suns) {
        follow_sun(group / BALANCE_SUN_PARTS, group % BALANCE_SUN_PARTS);
        entering = workgroup_total(sent);
    } else if (group < suns + args.sky_parts) {
        follow_sky(group - suns);
        entering = workgroup_total(sent);
    } else if (args.locals != 0u && n < radial_count) {
        follow_local(n);
        light_block l = radials[n].light;
        emitted = n < radial_num_lamps ? l.color * light_lobe_integral(l) : vec3(0.0);
    }
    vec3 all_kept = workgroup_total(kept), all_escaped = workgroup_total(escaped);
    if (gl_LocalInvocationIndex == 0u) {
        found[group] = balance_light(entering, emitted, all_kept, all_escaped);
    }
}
