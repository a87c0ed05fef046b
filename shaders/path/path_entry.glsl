// path_entry.glsl -- where light starts: from afar as it enters the box [args.box_lo, args.box_hi], and of lamps. Included
// after path.glsl.
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

// Solid angle into which a lamp shines, sr; of a sun the area across its light, m^2.
float light_measure(const light_block light)
{
    return light.kind == TYN_LIGHT_KIND_DIRECTIONAL ? sum3(faces_across(light.direction))
                                                    : 2.0 * HG_PI * (1.0 - light.cos_outer);
}

// What lights are drawn by, W.
float light_drawn_by(const light_block light)
{
    return max3(light.color) * light_measure(light);
}

float sky_drawn_by()
{
    return ENVIRONMENT == TYN_PATH_ENV_NONE ? 0.0 : max3(env.mean) * HG_PI * sum3(faces_across(vec3(1.0)));
}

// Into a lamp's cone, uniform.
vec3 lamp_way(const light_block lamp, vec2 random)
{
    float z = 1.0 - random.x * (1.0 - lamp.cos_outer);
    float across = sqrt(max(1.0 - z * z, 0.0)), azimuth = 2.0 * HG_PI * random.y;
    vec3 axis = lamp.direction;
    vec3 side = normalize(abs(axis.x) < 0.7 ? cross(axis, vec3(1.0, 0.0, 0.0)) : cross(axis, vec3(0.0, 1.0, 0.0)));
    return z * axis + across * (cos(azimuth) * side + sin(azimuth) * cross(axis, side));
}

#endif
