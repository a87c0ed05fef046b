// rsm_sky.comp -- what both sides of places on the surfaces reflect of the sky: one thread a place.
//
// Every place stands for as much of the surfaces as any other, so weighted as rsm_sky_places.glsl has it. Places run along the triangles in the
// hierarchy's order and lie on the maps along a Hilbert curve, as their readers take texels: neighbours there are near each
// other.
#include "rsm_sky_args.h"
#define GEOMETRY_AT 0
#define MATERIALS_AT 4
#define MEDIUM_BLOCK 7
#define SKY_MAPS_AT 8
#define COLUMNS_AT 10
#define COLUMNS_STORAGE
#include "shaders/surfaces/surface_frame.glsl"
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/surfaces/surface_faces.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/light/hilbert.glsl"
#include "shaders/light/shadow_frame.glsl"
#include "shaders/light/sky_left.glsl"
#include "shaders/light/sky_maps.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(rsm_sky_args args);
TYN_READ(12, areas, float areas[]);
TYN_READ(13, area_blocks, float area_blocks[]);
layout(binding = 14, rgba32f) uniform writeonly image2D rsm_flux_image;
layout(binding = 15, rgba32f) uniform writeonly image2D rsm_position_image;
layout(binding = 16, rgba32f) uniform writeonly image2D rsm_normal_image;
#include "rsm_sky_places.glsl"

// The last block that begins at or before `at`.
uint block_of(float at)
{
    uint lo = 0u, hi = (args.triangles + RSM_SKY_BLOCK - 1u) / RSM_SKY_BLOCK - 1u;
    while (lo < hi) {
        uint mid = (lo + hi + 1u) / 2u;
        bool before = area_blocks[mid] <= at;
        lo = before ? mid : lo;
        hi = before ? hi : mid - 1u;
    }
    return lo;
}

// The first triangle of a block with which it counts for more than `at`.
uint triangle_of(uint block, float at)
{
    uint lo = block * RSM_SKY_BLOCK, hi = min(lo + RSM_SKY_BLOCK, args.triangles) - 1u;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        bool beyond = areas[mid] > at;
        lo = beyond ? lo : mid + 1u;
        hi = beyond ? mid : hi;
    }
    return lo;
}

// Of direction k, W/m^2 across the surface; `cosine` of light and normal.
vec3 sky_from(uint k, const shadow_surface s, out float cosine)
{
    vec3 towards = -ordinates.list[k].direction; // mean cosine: of the region about it
    vec3 light = ordinates.list[k].mean_cosine * max(ordinates.list[k].irradiance, vec3(0.0));
    cosine = dot(s.n, towards);
    float share = abs(cosine);
    if (share > 0.0) {
        share *= shadow_visibility_on_sun_map(sky_atlas, sky_map_around(sky_map_of(k), s.p), s);
    }
    if (share > 0.0 && args.cells.x > 0u) {
        vec2 way = ray_box(s.p, ray_inverse(towards), vec3(0.0), medium.extent);
        way.x = max(way.x, 0.0);
        if (way.x < way.y) {
            light *= sky_left(tyn_sky_ordinate(k, ordinates.num_fixed, args.fan), s.p + way.x * towards, args.cells);
        }
    }
    return share * light;
}

bool sees(vec3 world, vec3 towards, uint triangle)
{
    surface_hit hit = surface_hit(3e38, SURFACE_NONE, vec2(0.0));
    return !surface_trace_world(surface_ray_make(world, surface_turn(surfaces.to_world, towards), triangle), true, hit);
}

const uint FEW = 16u; // directions

// Irradiance of the front and of the back of a place, W/m^2. Maps let a little light in beside the edges of walls, and what is in a closed
// room would shine on all of it: what few directions light, rays must confirm.
void sky_on(const shadow_surface s, vec3 world, uint triangle, out vec3 sides[2])
{
    uint count = min(ordinates.count, uint(TYN_ORDINATES_MAX)); // these are the directions
    uint lit[2] = uint[2](0u, 0u), by[2][FEW];
    sides[0] = sides[1] = vec3(0.0);
    for (uint k = 0u; k < count; k++) {
        float cosine;
        vec3 light = sky_from(k, s, cosine);
        uint side = cosine > 0.0 ? 0u : 1u;
        if (light.r + light.g + light.b > 0.0) {
            sides[side] += light;
            by[side][min(lit[side], FEW - 1u)] = k;
            lit[side]++;
        }
    }
    for (uint side = 0u; side < 2u; side++) {
        if (lit[side] <= FEW) {
            sides[side] = vec3(0.0);
            for (uint i = 0u; i < lit[side]; i++) {
                uint k = by[side][i];
                float cosine;
                if (sees(world, -ordinates.list[k].direction, triangle)) {
                    sides[side] += sky_from(k, s, cosine);
                }
            }
        }
    }
}

void main()
{
    uint place = gl_GlobalInvocationID.x, places = args.texels * args.texels;
    if (place >= places) {
        return;
    }
    ivec2 texel = ivec2(args.offset + hilbert_texel(args.texels, place));
    uint blocks = (args.triangles + RSM_SKY_BLOCK - 1u) / RSM_SKY_BLOCK;
    float whole = area_blocks[blocks], at = (float(place) + 0.5) / float(places) * whole;
    uint block = block_of(at), triangle = triangle_of(block, at - area_blocks[block]);
    float before = triangle % RSM_SKY_BLOCK > 0u ? areas[triangle - 1u] : 0.0, own = areas[triangle] - before;
    uvec4 t = surface_triangle_at(triangle);
    vec3 a = surface_position(t.x), b = surface_position(t.y), c = surface_position(t.z), facet = cross(b - a, c - a);
    float twice = length(facet);
    bool none = !(own > 0.0) || !(twice > 0.0);

    float density;
    vec3 from_a = surface_transform(surfaces.from_world, a), from_b = surface_transform(surfaces.from_world, b);
    vec3 from_c = surface_transform(surfaces.from_world, c);
    vec3 p = rsm_sky_place(from_a, from_b, from_c, clamp((at - area_blocks[block] - before) / max(own, 1e-30), 0.0, 0.999999), density);
    vec3 n = normalize(surface_turn(surfaces.from_world, facet)), world = surface_transform(surfaces.to_world, p);
    // Of `places` on all that counts, this triangle has places * own / whole.
    float area = 0.5 * twice * whole / (float(places) * own * density);
    vec2 weights = vec2(dot(facet, cross(world - a, c - a)), dot(facet, cross(b - a, world - a))) / max(twice * twice, 1e-37);

    surface_material m = surface_material_at(t.w);
    vec3 reflected = surface_reflected(m, surface_colour_over(t, weights, area));
    vec3 sides[2];
    sky_on(shadow_surface(p, n, 2e-6 * length(p), 0.0, 0.0), world, triangle, sides);
    rng_state rng = rng_start(uint(texel.x), uint(texel.y), 0u);
    for (int side = 0; side < 2; side++) {
        vec3 towards = side == 0 ? n : -n, flux = none ? vec3(0.0) : sides[side] * area * reflected;
        if (any(greaterThan(flux, vec3(0.0))) && // no rays for what is black
            !surface_faces_something(triangle, p, world, towards, args.extent, rng)) {
            flux = vec3(0.0);
        }
        ivec2 to = texel + ivec2(side * int(args.texels), 0);
        imageStore(rsm_flux_image, to, vec4(flux, 0.0));
        imageStore(rsm_position_image, to, vec4(none ? vec3(0.0) : p, none ? 0.0 : area));
        imageStore(rsm_normal_image, to, vec4(none ? vec3(0.0) : towards, 0.0));
    }
}
