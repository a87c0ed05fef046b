// sky_shadows_frames.comp -- the frames of the maps: one thread a map.
//
// A map is fitted around what of the surfaces is near the box that pictures are of, as its direction sees it, or, a second one, around all. Depths reach over all
// surfaces. Maps are two texels wider than need be on all sides, so that the texels around any place inside belong to the map.
#include "shaders/common/scene_args.h"
#include "shaders/light/sky_map_args.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/near_box.glsl"
#include "shaders/surfaces/surface_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(sky_frames_args args);
TYN_UNIFORM(0, surfaces, surface_block surfaces);
TYN_UNIFORM(1, ordinates, ordinates_block ordinates);
TYN_WRITE(2, sky_maps, shadow_light maps[]);

// A direction of M along the axes of the world.
vec3 in_world(vec3 r)
{
    return r.x * surfaces.from_world[0].xyz + r.y * surfaces.from_world[1].xyz + r.z * surfaces.from_world[2].xyz;
}

vec3 origin()
{
    return vec3(surfaces.from_world[0].w, surfaces.from_world[1].w, surfaces.from_world[2].w);
}

// From where to where all surfaces reach along a direction.
vec2 range_of_all(vec3 r)
{
    vec3 w = in_world(r);
    return dot(r, origin()) + vec2(dot(min(w * surfaces.lo, w * surfaces.hi), vec3(1.0)),
                                   dot(max(w * surfaces.lo, w * surfaces.hi), vec3(1.0)));
}

// The box in M of the surfaces that are within `sides` of its longest side of the near box: from, to. 0: of all.
void near_box(float sides, out vec3 from, out vec3 to)
{
    for (int a = 0; a < 3; a++) {
        vec2 range = range_of_all(vec3(equal(ivec3(a), ivec3(0, 1, 2))));
        from[a] = range.x;
        to[a] = range.y;
    }
    float reach = sides * near_box_size(args.near_lo, args.near_hi);
    vec3 lo = min(max(from, args.near_lo - reach), to), hi = max(min(to, args.near_hi + reach), from);
    if (reach > 0.0) {
        from = lo;
        to = hi;
    }
}

vec2 range_of(vec3 r, vec3 from, vec3 to)
{
    return vec2(dot(min(r * from, r * to), vec3(1.0)), dot(max(r * from, r * to), vec3(1.0)));
}

shadow_light frame_of(vec3 d, bool of_all)
{
    shadow_light map;
    vec3 from, to;
    near_box(of_all ? 0.0 : args.reach, from, to);
    float margin = args.texels / (args.texels - 4.0), least = 1e38;
    // Of three maps, each with a side along an axis of the world's box, the one with the least area.
    for (int a = 0; a < 3; a++) {
        vec3 hint = vec3(surfaces.from_world[0][a], surfaces.from_world[1][a], surfaces.from_world[2][a]);
        vec3 u = hint - dot(hint, d) * d;
        float size = length(u);
        if (size < 1e-3) {
            continue;
        }
        u /= size;
        vec3 v = cross(d, u);
        vec2 ru = range_of(u, from, to), rv = range_of(v, from, to);
        vec2 side = vec2(ru.y - ru.x, rv.y - rv.x);
        float area = side.x * side.y;
        if (area < least) {
            least = area;
            vec2 halves = max(0.5 * side, 1e-6 * max(side.x, side.y) + 1e-30) * margin;
            map.rows[0] = vec4(u, -0.5 * (ru.x + ru.y)) / halves.x;
            map.rows[1] = vec4(v, -0.5 * (rv.x + rv.y)) / halves.y;
        }
    }
    vec2 depth = range_of_all(d);
    float reach = dot(max(abs(surfaces.lo), abs(surfaces.hi)) + abs(origin()), vec3(1.0));
    float slack = 1e-3 * (depth.y - depth.x) + 1e-3 * reach + 1e-30;
    depth += vec2(-slack, slack);
    map.rows[2] = vec4(-d, depth.y) / (depth.y - depth.x);
    return map;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(maps.length())) {
        return;
    }
    bool wide = i >= args.count;
    vec3 d = ordinates.list[wide ? i - args.count : i].direction; // 0: not in use
    d = dot(d, d) > 0.25 ? normalize(d) : vec3(0.0, -1.0, 0.0);
    shadow_light map = frame_of(d, wide);
    map.offset = args.texels * vec2(i % args.across, i / args.across);
    map.texels = args.texels;
    map.scale = 0.0;
    map.near = 0.0;
    map.kind = TYN_SHADOW_SUN;
    map.wider = !wide && args.count < uint(maps.length()) ? args.count + i : 0u;
    map.pad = 0u;
    if ((wide ? i - args.count : i) >= ordinates.count) {
        for (int r = 0; r < 3; r++) {
            map.rows[r] = vec4(0.0, 0.0, 0.0, 2.0); // nowhere: nothing is drawn
        }
    }
    maps[i] = map;
}
