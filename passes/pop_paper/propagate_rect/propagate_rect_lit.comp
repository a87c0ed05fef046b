// propagate_rect_lit.comp -- how far surfaces let the light of a grid come along its direction: one thread a column of
// cells. Built for suns, whose shadow maps are looked at, and for other ordinates (TRACED), which have none: rays.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
#ifdef TRACED
#define GEOMETRY_AT 0
#include "shaders/surfaces/surface_trace.glsl"
TYN_READ(4, grids, propagate_grid grids[]);
TYN_WRITE(5, lit, float lit[]);
#else
#define SHADOWS_AT 0
#include "shaders/light/shadow.glsl"
TYN_READ(2, grids, propagate_grid grids[]);
TYN_WRITE(3, lit, float lit[]);
#endif
TYN_ARGS(propagate_rect_args args);

const int LOOKS = PROPAGATE_RECT_LOOKS; // along each side of a column
const float FOR_EVER = 3e38;

// Distance from a point of the medium (M) along the light to the first surface that it meets, m; below 0: before the point.
#ifdef TRACED
float reach(uint n, const propagate_grid grid, vec3 p)
{
    vec3 o = surface_transform(surfaces.to_world, p), d = surface_turn(surfaces.to_world, grid.direction);
    float before = length(max(abs(o - surfaces.lo), abs(o - surfaces.hi))); // there is no surface farther back
    surface_hit hit = surface_hit(FOR_EVER, SURFACE_NONE, vec2(0.0));
    return surface_trace_world(surface_ray_make(o - before * d, d, SURFACE_NONE), false, hit) ? hit.t - before
                                                                                             : FOR_EVER;
}
#else
float reach(uint n, const propagate_grid grid, vec3 p)
{
    shadow_light l = shadow_light_of(n);
    vec3 q = shadow_frame(l, p), along = shadow_frame_direction(l, grid.direction);
    shadow_place place = shadow_place_sun(l, q);
    vec2 first;
    vec4 stored = shadow_gather(shadow_atlas, place, first);
    // As everywhere in the medium: lit is what all four texels around see (shadow.glsl).
    float nearest = max(max(stored.x, stored.y), max(stored.z, stored.w));
    bool met = l.kind == TYN_SHADOW_SUN && place.inside && nearest > 0.0 && along.z < 0.0;
    return met ? (nearest - q.z) / along.z : FOR_EVER;
}
#endif

void main()
{
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    uint n = gl_WorkGroupID.z; // grid of this batch
#ifdef TRACED
    bool mine = args.first + n >= args.num_mapped;
#else
    bool mine = args.first + n < args.num_mapped;
#endif
    if (any(greaterThanEqual(uvec2(column), uvec2(args.cells))) || !mine) {
        return;
    }
    propagate_grid grid = grids[args.first + n];
    bool used = all(lessThan(uvec2(column), grid.size.xy));
    float found[LOOKS * LOOKS];
    for (int i = 0; i < LOOKS * LOOKS; i++) {
        vec2 part = (vec2(i % LOOKS, i / LOOKS) + 0.5) / float(LOOKS);
        found[i] = used ? reach(args.first + n, grid, propagate_to_m(grid, vec3(vec2(column) + part, 0.0))) : FOR_EVER;
    }
    // Of the light that goes straight on, what comes from the middle of a cell to that of the next.
    float before = 1.0;
    for (int z = 0; z < int(args.along); z++) {
        float h = (float(z) + 0.5) * grid.along, share = 0.0;
        for (int i = 0; i < LOOKS * LOOKS; i++) {
            share += found[i] > h ? 1.0 / float(LOOKS * LOOKS) : 0.0;
        }
        lit[propagate_index(ivec3(column, z), n, args.cells, args.along)] = before > 0.0 ? share / before : 1.0;
        before = share;
    }
}
