// shadow_look.glsl -- what depth maps show of the surfaces before a place. Include after shadow_frame.glsl; no bindings: the
// maps are an argument.
#ifndef TYN_SHADOW_LOOK_GLSL
#define TYN_SHADOW_LOOK_GLSL

const float SHADOW_EPSILON = 4e-6; // of depths: rounding in maps and projections

// A point on a map.
struct shadow_place {
    vec2 texel; // in the atlas
    float depth;
    bool inside; // of the map
};

shadow_place shadow_place_sun(const shadow_light l, vec3 q)
{
    // What is behind all casters is at their far side; what is before them is nearer than all.
    return shadow_place(l.offset + l.texels * (0.5 + 0.5 * q.xy), max(q.z, 0.0),
                        all(lessThan(abs(q.xy), vec2(1.0))));
}

// `q` is on the face.
shadow_place shadow_place_lamp(const shadow_light l, uint face, vec3 q)
{
    vec2 uv = q.xy * (l.scale / max(q.z, 1e-20));
    vec2 tile = vec2(face % 3u, face / 3u);
    bool inside = l.kind != TYN_SHADOW_NONE && q.z > l.near && all(lessThan(abs(uv), vec2(1.0)));
    return shadow_place(l.offset + l.texels * (tile + 0.5 + 0.5 * uv), l.near / max(q.z, 1e-20),
                        inside);
}

// The depths of the four texels around a place: at (0, 1), (1, 1), (1, 0), (0, 0) from `first`.
vec4 shadow_gather(sampler2D maps, const shadow_place place, out vec2 first)
{
    // The last texels of a map are never covered, so that no place inside is blended with a neighbour map.
    first = floor(place.texel - 0.5);
    return textureGather(maps, (first + 1.0) / vec2(textureSize(maps, 0)));
}

// Only what all four texels see is lit for sure: a place behind the straight edge of a surface has one of the four
// behind it, so that nothing leaks around edges into closed rooms. Such shadows are larger by half a texel.
const uint SHADOW_LIT_BY_HALF = 1u, SHADOW_LIT_BY_ALL = 2u;

// By half of the texels, the nearer counting more: shadows are as large as they should be. Where no wall is between a place
// and one that all four light, that is what lights it. 0: dark.
uint shadow_lit_by(sampler2D maps, const shadow_place place)
{
    vec2 first;
    vec4 lit = vec4(lessThanEqual(shadow_gather(maps, place, first), vec4(place.depth)));
    vec2 w = place.texel - 0.5 - first, along_x = mix(lit.wx, lit.zy, w.x);
    uint by = (mix(along_x.x, along_x.y, w.y) >= 0.5 ? SHADOW_LIT_BY_HALF : 0u) |
              (lit.x * lit.y * lit.z * lit.w > 0.0 ? SHADOW_LIT_BY_ALL : 0u);
    return place.inside ? by : SHADOW_LIT_BY_HALF | SHADOW_LIT_BY_ALL;
}

// What is in front of a surface by less than this many times a texel's size may be the foot of a wall.
const float SHADOW_FOOT = 16.0;

// A plane whose depth changes by more than this part of itself within a texel is seen edge-on, and little light arrives.
const float SHADOW_EDGE_ON = 0.5;

// A place on a surface.
struct shadow_surface {
    vec3 p;     // M
    vec3 n;     // of its plane, either side
    float off;  // m: what rounding puts p off the plane by
    float bent; // m: what a curved surface may be off the plane by there
    float bend; // and how much more with each metre beside it: the slope of what it goes on as
};

// What parallel and perspective maps share: `slope` is that of depth by u and v, `rounding` of depth, and
// `texel` what one texel's size towards the light is of depth.
//
// A place is lit by those of the four texels around it that see its surface, the nearer counting more, so that shadows are as large as
// they should be. That would let light in beneath the edges of closed rooms. So where a texel shows the foot of a wall,
// which meets the surface, only what all four light is lit; and what sees past the surface does not count beside what is dark: of a room
// whose walls are seen edge-on no foot is seen, but past its roof there is no more of its floor.
float shadow_visibility_on_plane(sampler2D maps, const shadow_light l, const shadow_place place, vec2 slope, float rounding,
                                 float texel)
{
    slope *= 2.0 / l.texels; // by texels
    float steepest = place.depth + rounding; // followed no farther: there the depth doubles within a texel
    vec2 plane = slope;
    bool edge_on = any(greaterThan(abs(slope), vec2(SHADOW_EDGE_ON * steepest)));
    slope = clamp(slope, vec2(-steepest), vec2(steepest));
    float steep = abs(slope.x) + abs(slope.y);
    vec2 first;
    vec4 stored = shadow_gather(maps, place, first);
    vec2 w = place.texel - 0.5 - first;
    vec4 x = vec4(0.0, 1.0, 1.0, 0.0) - w.x, y = vec4(1.0, 1.0, 0.0, 0.0) - w.y;
    // What is in front of the plane by no more than this is the surface itself: vertices are drawn to 1/256 of a texel.
    vec4 before = stored - max(place.depth + slope.x * x + slope.y * y, 0.0) - (0.03 * steep + rounding);
    bvec4 dark = greaterThan(before, vec4(0.0));
    vec4 of_foot = vec4(dark) * vec4(lessThan(before, vec4(steep + SHADOW_FOOT * texel)));
    vec4 own = (1.0 - vec4(dark)) * vec4(greaterThan(before, vec4(-(steep + texel))));
    // Where a texel sees past a plane that is seen edge-on, the edge of a room may be beside it.
    bool past = any(lessThan(stored + (0.03 * (abs(plane.x) + abs(plane.y)) + rounding + texel),
                             place.depth + plane.x * x + plane.y * y));
    float share = any(greaterThan(of_foot, vec4(0.0))) ? 0.0 : dot(own, (1.0 - abs(x)) * (1.0 - abs(y)));
    share = any(dark) ? share : edge_on && past ? 0.0 : 1.0;
    return place.inside ? share : 1.0;
}

// How far beside a place a texel may be that counts for it, texels.
const float SHADOW_BESIDE = 1.5;

// Along the light what a curved surface is off its plane by is longer: by 1 over this cosine at most, or where light grazes it, and
// little arrives, a roof above would be taken for it.
const float SHADOW_SLANT = 0.25;

// The same for a place on a surface, in [0, 1]. Depths that do not change with u and v except linearly (parallel maps
// as they are, perspective ones because they are reciprocal) are those of the surface's own plane at the texels: so a
// flat one does not shadow itself, whatever its slope, and what is in front of it by more than a thirtieth of a texel does.
float shadow_visibility_on_sun_map(sampler2D maps, const shadow_light l, const shadow_surface s)
{
    vec3 q = shadow_frame(l, s.p), m = shadow_frame_direction(l, s.n);
    float slant = abs(m.z); // cosine of light and normal, in depths by metre
    shadow_place place = shadow_place_sun(l, q);
    place.inside = place.inside && l.kind == TYN_SHADOW_SUN;
    // Rows are orthogonal but not of unit length: normals divide by its square.
    vec3 square = vec3(dot(l.rows[0].xyz, l.rows[0].xyz), dot(l.rows[1].xyz, l.rows[1].xyz),
                       dot(l.rows[2].xyz, l.rows[2].xyz)) + 1e-30;
    m /= square;
    float texel = 2.0 / l.texels * sqrt(square.z / min(square.x, square.y));
    vec2 slope = -m.xy / (abs(m.z) > 1e-20 ? m.z : 1e-20);
    float per_metre = sqrt(square.z), bent = s.bent * per_metre + SHADOW_BESIDE * s.bend * texel;
    float rounding = SHADOW_EPSILON * (1.0 + place.depth) + min(s.off * square.z / max(slant, 1e-20), 0.25) +
                     bent * per_metre / max(slant, SHADOW_SLANT * per_metre);
    return shadow_visibility_on_plane(maps, l, place, slope, rounding, texel);
}

#endif
