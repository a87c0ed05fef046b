// propagate_radial_lit.comp -- how far surfaces let the light of a local light come along each direction: one thread a
// direction. Built for lamps, whose shadow maps are looked at, and for VPLs (OF_VPLS), which have maps of what they see.
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = 8, local_size_y = 8) in;
TYN_READ(0, grids, propagate_radial_grid grids[]);
TYN_WRITE(1, lit, float lit[]);
#ifdef OF_VPLS
#define VPL_DISTANCES 2
#include "shaders/light/vpl_visibility.glsl"
#else
#define SHADOWS_AT 2
#include "shaders/light/shadow.glsl"
#endif
TYN_ARGS(propagate_radial_args args);

const int LOOKS = PROPAGATE_RADIAL_LOOKS; // along each side of a texel of the map
const float FOR_EVER = 3e38;

// Distance from the light of the first surface in the direction d (M, unit), m.
#ifdef OF_VPLS
float reach(uint n, const propagate_radial_grid grid, vec3 d)
{
    vpl_map map = vpl_map_of(n - args.num_lamps, grid.light.direction);
    vec2 at = floor(vpl_map_place(d * map.frame) * map.last + 0.5); // of the rays around, the nearest
    return map.last > 0.0 ? texelFetch(vpl_distances, ivec2(map.corner + at), 0).r : FOR_EVER;
}
#else
float reach(uint n, const propagate_radial_grid grid, vec3 d)
{
    if (n >= TYN_SHADOW_LAMPS) {
        return FOR_EVER;
    }
    shadow_light l = shadow_light_of(TYN_SHADOW_LAMP(n));
    vec3 q = shadow_frame_direction(l, d);
    uint face = 0u;
    if (l.kind == TYN_SHADOW_CUBE) {
        face = shadow_face(q);
        q = shadow_on_face(face, q);
    }
    // Any place beyond `near` will do: what a map shows of a direction is the same along it.
    shadow_place place = shadow_place_lamp(l, face, q * (2.0 * l.near / max(q.z, 1e-6)));
    vec2 first;
    vec4 stored = shadow_gather(shadow_atlas, place, first);
    // As everywhere in the medium: lit is what all four texels around see (shadow.glsl).
    float nearest = max(max(stored.x, stored.y), max(stored.z, stored.w));
    bool met = place.inside && q.z > 1e-6 && nearest > 0.0;
    return met ? l.near / (nearest * q.z) : FOR_EVER;
}
#endif

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    uint n = args.first + gl_WorkGroupID.z;
#ifdef OF_VPLS
    bool mine = n >= args.num_lamps;
#else
    bool mine = n < args.num_lamps;
#endif
    if (any(greaterThanEqual(uvec2(texel), uvec2(args.cells))) || !mine) {
        return;
    }
    propagate_radial_grid grid = grids[n];
    float found[LOOKS * LOOKS];
    for (int i = 0; i < LOOKS * LOOKS; i++) {
        vec2 part = (vec2(i % LOOKS, i / LOOKS) + 0.5) / float(LOOKS);
        vec2 e = 2.0 * (vec2(texel) + part) / float(args.cells) - 1.0;
        found[i] = grid.layers > 0u ? reach(n, grid, normalize(propagate_radial_heading(grid, e))) : FOR_EVER;
    }
    // Of the light that goes straight on, what comes from the middle of a cell to that of the next; that of the ball is
    // the light itself.
    float before = 1.0;
    for (int k = 0; k < int(args.layers); k++) {
        vec2 span = propagate_radial_span(grid, k);
        float r = k == 0 ? 0.0 : 0.5 * (span.x + span.y), share = 0.0;
        for (int i = 0; i < LOOKS * LOOKS; i++) {
            share += found[i] > r ? 1.0 / float(LOOKS * LOOKS) : 0.0;
        }
        lit[propagate_radial_index(ivec3(texel, k), gl_WorkGroupID.z, args.cells, args.layers)] =
            before > 0.0 ? share / before : 1.0;
        before = share;
    }
}
