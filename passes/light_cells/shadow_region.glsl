// shadow_region.glsl -- whether a light sees all of a cube, or nothing of it.
//
// Define SHADOW_BLOCKS as the binding of least and greatest depths in blocks of the atlas, and what shadow.glsl
// needs but for the atlas. The answer is that of shadow_visibility for every point of the cube, or "mixed".
#include "shaders/light/light_cells_args.h"
#include "shaders/light/shadow_frame.glsl"

layout(set = 0, binding = SHADOW_BLOCKS) uniform sampler2D blocks_tex;

const float SHADOW_REGION_SLACK = 1e-5; // of depths and of maps: more than rounding

// What a cube covers of a map.
struct shadow_region {
    vec2 lo, hi; // u and v, [-1, 1] on the map
    vec2 depth;  // from, to
    bool before; // no part of it is behind the light
    bool beyond; // all of it is
    vec2 tile;   // the map's place in the atlas, texels
};

vec3 shadow_corner(uint i, vec3 middle, float reach)
{
    return middle + reach * (2.0 * vec3(i & 1u, i >> 1 & 1u, i >> 2) - 1.0);
}

shadow_region shadow_region_sun(shadow_light l, vec3 middle, float reach)
{
    vec3 q = shadow_frame(l, middle), r;
    for (int i = 0; i < 3; i++) {
        r[i] = reach * dot(abs(l.rows[i].xyz), vec3(1.0));
    }
    return shadow_region(q.xy - r.xy, q.xy + r.xy, vec2(q.z - r.z, q.z + r.z), true, false, l.offset);
}

shadow_region shadow_region_lamp(shadow_light l, vec3 middle, float reach)
{
    bool cube = l.kind == TYN_SHADOW_CUBE;
    vec3 q = shadow_frame(l, middle);
    uint face = cube ? shadow_face(q) : 0u;
    vec2 lo = vec2(1e30), hi = vec2(-1e30), z = vec2(1e30, -1e30);
    for (uint i = 0u; i < 8u; i++) {
        vec3 corner = shadow_frame(l, shadow_corner(i, middle, reach));
        corner = cube ? shadow_on_face(face, corner) : corner;
        vec2 uv = corner.xy * (l.scale / max(corner.z, 1e-20));
        lo = min(lo, uv);
        hi = max(hi, uv);
        z = vec2(min(z.x, corner.z), max(z.y, corner.z));
    }
    bool before = z.x > l.near * (1.0 + SHADOW_REGION_SLACK);
    // Beside a face of a cube, which maps reach beyond, is another one.
    before = before && (!cube || max(max(-lo.x, -lo.y), max(hi.x, hi.y)) < l.scale * (1.0 - SHADOW_REGION_SLACK));
    return shadow_region(lo, hi, l.near / max(z.yx, 1e-20), before, !cube && z.y <= l.near,
                         l.offset + l.texels * vec2(face % 3u, face / 3u));
}

// TYN_LIGHT_CELLS_*.
uint shadow_region_seen(shadow_light l, shadow_region region)
{
    const float margin = 1.0 + SHADOW_REGION_SLACK;
    bool beside = region.before &&
                  (any(greaterThan(region.lo, vec2(margin))) || any(lessThan(region.hi, vec2(-margin))));
    if (l.kind == TYN_SHADOW_NONE || region.beyond || beside) {
        // The map of a spot holds all of its cone.
        return l.kind == TYN_SHADOW_CONE ? TYN_LIGHT_CELLS_DARK : TYN_LIGHT_CELLS_LIT;
    }
    // Texels that places are compared with: the four around each.
    vec2 first = floor(region.tile + l.texels * (0.5 + 0.5 * clamp(region.lo, -1.0, 1.0)) - 0.52);
    vec2 last = floor(region.tile + l.texels * (0.5 + 0.5 * clamp(region.hi, -1.0, 1.0)) - 0.48) + 1.0;
    first = max(first, region.tile);
    last = min(last, region.tile + l.texels - 1.0);
    float width = max(last.x - first.x, last.y - first.y) + 1.0;
    int level = int(ceil(log2(max(width / (LIGHT_CELLS_ACROSS * float(LIGHT_CELLS_BLOCK)), 1.0))));
    level = min(level, LIGHT_CELLS_LEVELS - 1);
    if (!region.before || width > LIGHT_CELLS_MOST * float(LIGHT_CELLS_BLOCK << level)) {
        return TYN_LIGHT_CELLS_MIXED;
    }
    ivec2 lo = ivec2(first) / LIGHT_CELLS_BLOCK >> level, hi = ivec2(last) / LIGHT_CELLS_BLOCK >> level;
    vec2 stored = vec2(1.0, 0.0);
    for (int y = lo.y; y <= hi.y; y++) {
        for (int x = lo.x; x <= hi.x; x++) {
            vec2 block = texelFetch(blocks_tex, ivec2(x, y), level).rg;
            stored = vec2(min(stored.x, block.x), max(stored.y, block.y));
        }
    }
    float slack = SHADOW_REGION_SLACK * (l.kind == TYN_SHADOW_SUN ? 1.0 + abs(region.depth.y) : region.depth.y);
    vec2 depth = max(region.depth + slack * vec2(-1.0, 1.0), 0.0);
    bool inside = all(greaterThan(region.lo, vec2(SHADOW_REGION_SLACK - 1.0))) &&
                  all(lessThan(region.hi, vec2(1.0 - SHADOW_REGION_SLACK)));
    return stored.y <= depth.x ? TYN_LIGHT_CELLS_LIT
           : inside && stored.x > depth.y ? TYN_LIGHT_CELLS_DARK
                                          : TYN_LIGHT_CELLS_MIXED;
}
