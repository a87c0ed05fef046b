// vpl_distances.comp -- what each VPL sees: the distance of the first surface in every direction of its map, and its plane;
// and what that reflects of its light.
#include "shaders/surfaces/surface_args.h"
#include "shaders/beams/radial_args.h"
#include "shaders/light/vpl_visibility.glsl"
#include "vpl_bounce_args.h"

layout(local_size_x = 8, local_size_y = 8) in;

#define GEOMETRY_AT 0
TYN_READ(4, vpls, uint vpl_count; uint vpl_before; uvec2 vpl_pad; light_block vpls[]);
layout(binding = 5, r32f) uniform writeonly image2D vpl_distances_image;
layout(binding = 6, rgba32f) uniform writeonly image2D vpl_planes_image;
TYN_UPDATE(7, bins, vpl_bins bins);
#define MATERIALS_AT 8
#include "shaders/surfaces/reflectance.glsl"
#define MEDIUM_AT 11
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/surfaces/surface_trace.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/common/camera.glsl"
TYN_ARGS(vpl_distances_args args);

const int MEDIUM_STEPS = 16;

// What the medium leaves of light from `from` (M) after a distance; forward scattering takes nothing.
vec3 through_medium(vec3 from, vec3 d, float distance)
{
    vec2 span = ray_box(from, ray_inverse(d), vec3(0.0), medium.extent);
    span = vec2(max(span.x, 0.0), min(span.y, distance));
    float ds = max(span.y - span.x, 0.0) / float(MEDIUM_STEPS);
    vec3 depth = vec3(0.0);
    for (int i = 0; i < MEDIUM_STEPS && ds > 0.0; i++) {
        medium_point m = medium_sample(from + (span.x + (float(i) + 0.5) * ds) * d);
        depth += ds * (m.sigma_a + delta_scaled(m.sigma_s, m.phase));
    }
    return exp(-depth);
}

// Bits of a coordinate of the grid, two apart.
uint spread(uint x)
{
    return (x & 1u) | (x & 2u) << 2 | (x & 4u) << 4;
}

void put_into_bin(vec3 world, vec3 normal, vec3 flux, uint texel)
{
    vec3 share = flux / max(bins.power, vec3(1e-30));
    vec3 size = max(surfaces.hi - surfaces.lo, vec3(1e-20));
    uvec3 cell = uvec3(clamp((world - surfaces.lo) / size, 0.0, 0.999) * float(VPL_BIN_CELLS));
    vec3 a = abs(normal);
    uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
    uint facing = 2u * axis + (normal[axis] < 0.0 ? 1u : 0u);
    uint bin = facing * 512u + (spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2);
    for (int c = 0; c < 3; c++) {
        atomicAdd(bins.list[bin].flux[c], uint(clamp(share[c], 0.0, 1.0) * VPL_BIN_UNIT + 0.5));
    }
    float bright = max(share.r, max(share.g, share.b));
    uint rank = uint(clamp(log2(max(bright, 1e-12)) * 100.0 + 4000.0, 1.0, 4095.0));
    atomicMax(bins.list[bin].best, rank << 20 | texel);
}

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(vpl_distances_image);
    int side = size.x / VPL_MAPS_IN_A_ROW;
    uint vpl = uint(texel.y / side * VPL_MAPS_IN_A_ROW + texel.x / side);
    bool wanted = vpl < vpl_count && (args.later == 0u || vpl >= vpl_before);
    if (any(greaterThanEqual(texel, size)) || !wanted) {
        return;
    }
    light_block light = vpls[vpl];
    ivec2 at = texel % side;
    vec3 on_map = vpl_map_direction(vec2(at) / float(side - 1));
    float away = length(on_map);
    vec3 d = vpl_frame(light.direction) * (on_map / away);
    vec3 from = vpl_map_origin(light.position, light.direction, light.radius);
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, from),
                                       surface_turn(surfaces.to_world, d), SURFACE_NONE);
    bool met = surface_trace_world(ray, false, hit);
    imageStore(vpl_distances_image, texel, vec4(hit.t));
    if (!met) {
        imageStore(vpl_planes_image, texel, vec4(0.0)); // all is before it
        return;
    }
    surface_point p = surface_point_at(hit.triangle, hit.barycentric);
    vec3 normal = dot(p.normal, d) > 0.0 ? -p.normal : p.normal;
    imageStore(vpl_planes_image, texel, vec4(normal, dot(normal, from + hit.t * d - light.position)));
    if (args.bounce == 0u) {
        return;
    }
    // Texels at the edges of a map are halves.
    vec2 whole = mix(vec2(1.0), vec2(0.5), lessThan(min(at, side - 1 - at), ivec2(1)));
    float solid_angle = args.solid_angle * whole.x * whole.y / (away * away * away);
    surface_material m = surface_material_at(surface_triangle_at(hit.triangle).w);
    vec3 colour = vec3(1.0);
    if (m.texture != TYN_SURFACE_NO_TEXTURE) { // its mean
        surface_texture map = surface_texture_at(m.texture);
        colour = surface_texture_level(map, vec2(0.5), map.levels - 1u);
    }
    vec3 flux = light.color * surface_reflected(m, colour) * (solid_angle * on_map.z / away);
    if (args.media != 0u) {
        flux *= through_medium(from, d, hit.t);
    }
    vec3 world = ray.origin + hit.t * ray.direction;
    put_into_bin(world, normal, flux, uint(texel.y * size.x + texel.x));
}
