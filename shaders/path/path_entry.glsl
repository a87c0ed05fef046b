// path_entry.glsl -- where light from afar enters the box [args.box_lo, args.box_hi]. Included after path.glsl.
#ifndef TYN_PATH_ENTRY_GLSL
#define TYN_PATH_ENTRY_GLSL

// Area of the box across light along `way`, by axis of the faces, m^2.
vec3 faces_across(vec3 way)
{
    vec3 size = args.box_hi - args.box_lo;
    return size.yzx * size.zxy * abs(way) * (1.0 - vec3(medium.repeat));
}

float sum3(vec3 v)
{
    return v.x + v.y + v.z;
}

// A point of the faces that the light shines on, uniform across it, from numbers in [0, 1).
vec3 draw_entry(vec3 way, vec3 random)
{
    vec3 across = faces_across(way);
    float at = random.z * sum3(across);
    vec3 along = at < across.x ? vec3(1.0, 0.0, 0.0) : at < across.x + across.y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    vec3 share = along.x > 0.0 ? vec3(0.0, random.xy) : along.y > 0.0 ? vec3(random.x, 0.0, random.y) : vec3(random.xy, 0.0);
    vec3 side = step(way, vec3(0.0)); // 1: comes down this axis
    return args.box_lo + mix(share, side, along) * (args.box_hi - args.box_lo);
}

#endif
