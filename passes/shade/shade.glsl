// shade.glsl -- the light that arrives at a point of a surface.
//
// Light that has not scattered, or scattered forward only, comes straight from suns, lamps and VPLs: e^-tau' of
// it is left (tau' counts forward scattering as none). All else is in the lattice, and so is what VPLs'
// light becomes after it has met a surface.
#ifndef TYN_SHADE_GLSL
#define TYN_SHADE_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "shade_args.h"

layout(constant_id = 1) const uint shade_features = 0u;
layout(constant_id = 2) const uint shade_num_suns = 0u;
layout(constant_id = 3) const int shade_side = SHADE_SIDE; // of the pattern
layout(constant_id = 4) const int shade_step = 1; // pixels along each side of a block: shade_part.glsl
layout(constant_id = 5) const int shade_samples = 2; // of the G-buffer along each side of a pixel
#define GBUFFER_SIDE shade_samples
TYN_ARGS(shade_args args);

#define MEDIUM_BLOCK 0
#define BEAMS_AT 1
#define RADIALS_AT 5
#define RADIALS_TEXELS
#define SHADOWS_AT 9
#define SHADOWS_TEXELS
#define GBUFFER_AT 21
#include "shaders/common/camera.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/light/shadow.glsl"
#include "shaders/surfaces/gbuffer.glsl"
#include "vpl.glsl"

TYN_UNIFORM(14, suns, light_block suns[TYN_LIGHTS_MAX]);
TYN_UNIFORM(15, lights, light_block lights[TYN_LIGHTS_MAX]);
TYN_UNIFORM(16, camera, camera_block camera);
#define VPLS_AT 11
layout(binding = 17) uniform sampler3D moments_tex;
#define WALLS_AT 18
#define LATTICE_ROOMS 20
#define GEOMETRY_AT (GBUFFER_END + 1)
#ifdef SHADE_COLOURS // the kernel asks what surfaces reflect and emit
#define MATERIALS_AT (GEOMETRY_AT + 4)
#define GBUFFER_TEXTURED shade_has(SHADE_TEXTURED)
#define SHADE_AT (MATERIALS_AT + 3) // the first binding of each kernel's own
#else
#define SHADE_AT (GEOMETRY_AT + 4)
#endif
#include "shaders/lattice/lattice.glsl"
TYN_UNIFORM(GBUFFER_END, environment, env_block environment);
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/light/vpl_visibility.glsl"

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define shade_has(feature) ((shade_features & (feature)) != 0u)
#include "shaders/surfaces/gbuffer_triangle.glsl"

// The lattice whose light there is: call it with SHADE_LATTICE or SHADE_OUTSIDE.
lattice_box shade_lattice()
{
    ivec3 dims = textureSize(moments_tex, 0);
    dims.z /= shade_has(SHADE_ONE_CHANNEL) ? 1 : 3;
    return lattice_box_of(medium.extent, dims);
}

struct shade_point {
    vec3 position; // M
    vec3 normal;   // for shading
    vec3 facet;    // of the triangle: for shadows
};

gbuffer_pixel shade_pixel(ivec2 pixel)
{
    return gbuffer_pixel_at(pixel, camera.size.x);
}

shade_point shade_point_of(const gbuffer_point p)
{
    return shade_point(p.at, p.normal, p.facet);
}

vec3 shade_left(const beam_tau tau)
{
    return exp(-(tau.a + tau.p));
}

// Cosine at which light from `towards` (unit) arrives; none where it comes from behind the facet.
float shade_cosine(const shade_point p, vec3 towards)
{
    return dot(p.facet, towards) > 0.0 ? max(dot(p.normal, towards), 0.0) : 0.0;
}

// What one point stands for: as much of its plane as a part of the picture shows.
struct shade_footprint {
    vec4 part;   // from xy to zw, pixels
    float width; // at most, m
    float slope; // cosine of the view and the plane's normal
};

shade_footprint shade_footprint_of(const shade_point p, vec4 part)
{
    vec3 ray = p.position - camera.origin;
    vec2 size = camera_pixel(camera) * (part.zw - part.xy);
    float slope = abs(dot(camera_select(camera, camera.forward, normalize(ray)), p.facet));
    float wide = length(size) * camera_select(camera, 1.0, dot(ray, camera.forward));
    return shade_footprint(part, wide / max(slope, 1e-3), slope);
}

// A point for shadows. Its plane is one triangle's, but samples of a pixel, and texels of a map, show others beside
// that, if the surface is curved: then normals for shading turn away from the facet's, by half the angle to the next
// triangle where that begins. Not in edges of boxes, even if their corners have mean normals.
shadow_surface shade_shadowed(const shade_point p, const shade_footprint foot)
{
    float turned = length(cross(p.facet, p.normal));
    float bend = 2.0 * min(turned, max(1.4 - 2.0 * turned, 0.0));
    float rounding = 2e-6 * distance(p.position, camera.origin);
    // Of a silhouette, which is seen edge-on, a part of the picture shows no more than the surface has.
    float width = foot.width * max(foot.slope, 1e-3) / max(foot.slope, 0.25);
    return shadow_surface(p.position, p.facet, rounding, 0.5 * bend * width, bend);
}

// ---- suns ----

// The way of a sun's light through the medium's box to p: from x to y away from p towards the sun; x >= y: none.
vec2 shade_way(vec3 p, vec3 towards)
{
    vec2 span = ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent);
    return vec2(max(span.x, 0.0), span.y);
}

beam_tau shade_sun_depth(uint n, vec3 p, vec3 towards, vec2 way)
{
    beam_tau none = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
    return way.x < way.y ? beam_depth(n, p + way.x * towards) : none;
}

uint shade_sun_light(uint n)
{
    return shade_has(SHADE_MEDIUM) ? beams[n].light : n;
}

// Irradiance per that of a beam, of light that comes from around: a beam lights a surface with its cosine, light from
// everywhere with a quarter of its fluence. `around`: mean direction, not of unit length, and fluence.
float shade_around(vec4 around, vec3 normal)
{
    float toward = length(around.xyz) / max(around.w, 1e-6);
    return max(mix(0.5, 1.0, toward) * dot(around.xyz, normal) + 0.25 * (1.0 - toward) * around.w, 0.0);
}

// `around[n]`: from where what the medium scattered forward of sun n comes, as shade_forward.comp has it, if `spread`.
// Else it comes with what was not scattered. `sharp`: what comes straight; `soft`: what comes from around.
vec3 shade_suns(const shade_point p, vec4 part, vec4 around[TYN_BEAM_MAX_SUNS], bool spread, bool sharp, bool soft)
{
    vec3 sum = vec3(0.0);
    shadow_surface surface = shade_shadowed(p, shade_footprint_of(p, part));
    [[unroll]] for (uint n = 0u; n < shade_num_suns; n++) {
        uint sun = shade_sun_light(n);
        vec3 towards = -suns[sun].direction;
        float straight = sharp ? shade_cosine(p, towards) : 0.0;
        float wide = soft && spread ? shade_around(around[n], p.normal) : 0.0;
        if (straight + wide > 0.0) {
            if (sharp && shade_has(SHADE_SHADOWS)) {
                straight *= shadow_visibility_surface_sun_of(shadow_light_of(sun), surface);
            }
            if (straight + wide > 0.0) {
                vec3 light = vec3(straight);
                if (shade_has(SHADE_MEDIUM)) {
                    beam_tau tau = shade_sun_depth(n, p.position, towards, shade_way(p.position, towards));
                    vec3 scaled = exp(-(tau.a + tau.p));
                    light *= scaled;
                    if (shade_has(SHADE_SPREAD)) {
                        vec3 unscattered = exp(-(tau.a + tau.s));
                        light = spread ? straight * unscattered + wide * (scaled - unscattered) : light;
                    }
                }
                sum += suns[sun].color * light;
            }
        }
    }
    return sum;
}

// ---- local lights ----

// Lamp n, in the order of their grids where there is a medium.
light_block shade_lamp_of(uint n)
{
    uint lamp = shade_has(SHADE_MEDIUM) ? radial_grid_of(n).light.shadow - TYN_SHADOW_LAMP(0u) : n;
    return lights[args.num_directional + lamp];
}

// What is left of a local light at a point that may be outside the medium's box.
vec3 shade_through_radial(const radial_grid grid, vec3 p)
{
    vec3 o = grid.light.position, away = p - o;
    float r = length(away);
    vec3 d = away / max(r, 1e-20);
    vec2 span = ray_box(o, ray_inverse(d), vec3(0.0), medium.extent);
    float inside = min(r, span.y);
    return max(span.x, 0.0) < inside ? shade_left(radial_tau(radial_place_in(grid, inside * d, inside)))
                                     : vec3(1.0);
}

const float SHADE_NEAR = 8.0; // widths; at lamps farther away the point's irradiance is the mean, within half a per cent
const int SHADE_SPOT_PARTS = 16; // of a footprint, along each side

// Where the plane of p is seen in the picture; what is beyond its horizon, or nearly, is drawn nearer.
vec3 shade_seen(const shade_point p, vec2 pixel)
{
    camera_ray ray = camera_ray_through(camera, pixel);
    vec3 way = p.position - ray.origin;
    float along = dot(way, ray.direction), height = min(dot(way, p.facet), -1e-6 * along);
    float slope = min(dot(ray.direction, p.facet), 0.25 * height / along);
    vec3 off = height / slope * ray.direction - way;
    return p.position + off - dot(off, p.facet) * p.facet;
}

// Where the picture shows q.
vec2 shade_shown(vec3 q)
{
    vec3 way = q - camera.origin;
    float z = camera_select(camera, 1.0, max(dot(way, camera.forward), 1e-6 * length(way)));
    vec2 s = vec2(dot(way, camera.right) / camera.half_width, dot(way, camera.up) / camera.half_height) / z - camera.shift;
    return (0.5 + 0.5 * vec2(s.x, -s.y)) * camera_whole(camera) - vec2(camera.corner);
}

// Solid angle of a triangle whose plane is at the height h from 0; twice_area: that of the triangle (Van Oosterom and
// Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30(2), 1983; their triple product is
// h * twice_area, without cancellation).
float shade_triangle(vec3 a, vec3 b, vec3 c, float h, out float twice_area)
{
    float la = length(a), lb = length(b), lc = length(c);
    twice_area = length(cross(b - a, c - a));
    return 2.0 * atan(h * twice_area, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// Mean irradiance of a lamp, per intensity, over the footprint of p. What a lamp sends through a part of a plane is its
// intensity times the solid angle under which it sees that part: exact, however near it is. No more
// light arrives than it sends.
float shade_lamp_on(const shade_point p, const shade_footprint foot, const light_block lamp)
{
    vec3 position = lamp.position;
    float unit = 1.0 / foot.width, h = dot(position - p.position, p.facet);
    vec3 a = (shade_seen(p, foot.part.xy) - position) * unit, b = (shade_seen(p, foot.part.zy) - position) * unit;
    vec3 c = (shade_seen(p, foot.part.zw) - position) * unit, d = (shade_seen(p, foot.part.xw) - position) * unit;
    vec2 twice;
    float angle = shade_triangle(a, b, c, h * unit, twice.x) + shade_triangle(a, c, d, h * unit, twice.y);
    float density = 2.0 / max((twice.x + twice.y) * foot.width * foot.width, 1e-37); // of the picture, in parts by m^2
    // The place below the lamp, or next to it, has most of the light where the lamp is near.
    vec2 shown = clamp(shade_shown(position - h * p.facet), foot.part.xy, foot.part.zw);
    vec3 most = shade_seen(p, shown);
    float nearness = 1.0 / (1.0 + 3.0 * unit * distance(position, most));
    // In perspective what is nearer to the eye takes more of the picture.
    vec2 size = camera_pixel(camera) * (foot.part.zw - foot.part.xy);
    float z = dot(most - camera.origin, camera.forward);
    float there = abs(dot(most - camera.origin, p.facet)) / (size.x * size.y) / z / z / z;
    density = camera_select(camera, density, mix(density, there, nearness));
    vec3 towards = normalize(position - mix(shade_seen(p, 0.5 * (foot.part.xy + foot.part.zw)), most, nearness));
    float straight = max(dot(towards, p.facet), 1e-6);
    float lobe = angle * light_lobe(lamp, dot(-towards, lamp.direction));
    lobe = min(lobe, light_lobe_integral(lamp));
    return lobe * density * clamp(dot(p.normal, towards) / straight, 0.0, 2.0);
}

// Borders of a footprint's parts, which are the smaller the nearer they are to `middle`; t is 0 to 1, as they are.
vec2 shade_border(vec2 t, vec2 middle)
{
    vec2 before = max(middle - t, 0.0), after = max(t - middle, 0.0);
    return middle - before * before / max(middle, 1e-6) + after * after / max(1.0 - middle, 1e-6);
}

// ... of a lamp whose lobe may be narrower than the footprint, over parts of it.
float shade_lamp_near(const shade_point p, const shade_footprint foot, const light_block lamp)
{
    vec3 position = lamp.position;
    bool close = distance(position, p.position) < 2.0 * foot.width;
    int side = lamp.kind == TYN_LIGHT_KIND_POINT ? 1 : close ? SHADE_SPOT_PARTS : SHADE_SPOT_PARTS / 4;
    vec2 size = foot.part.zw - foot.part.xy;
    vec2 shown = shade_shown(position - dot(position - p.position, p.facet) * p.facet);
    vec2 middle = clamp((shown - foot.part.xy) / size, 0.0, 1.0);
    float sum = 0.0;
    for (int k = 0; k < side * side; k++) {
        vec2 t = vec2(k % side, k / side) / float(side);
        vec2 first = shade_border(t, middle), last = shade_border(t + 1.0 / float(side), middle), share = last - first;
        shade_footprint part = shade_footprint(foot.part.xyxy + vec4(first, last) * size.xyxy,
                                               foot.width * max(max(share.x, share.y), 1e-6), foot.slope);
        sum += share.x * share.y * shade_lamp_on(p, part, lamp);
    }
    return sum;
}

vec3 shade_lamp(const shade_point p, const shade_footprint foot, uint n)
{
    light_block lamp = shade_lamp_of(n);
    vec3 way = lamp.position - p.position;
    float rr = max(dot(way, way), 1e-13 * dot(medium.extent, medium.extent));
    vec3 towards = way * inversesqrt(rr);
    float share = shade_cosine(p, towards) * light_lobe(lamp, dot(-towards, lamp.direction)) / rr;
    float reach = SHADE_NEAR * foot.width;
    if (rr < reach * reach && dot(way, p.facet) > 0.0) {
        share = shade_lamp_near(p, foot, lamp);
    }
    vec3 irradiance = lamp.color * share;
    if (share > 0.0) {
        if (shade_has(SHADE_SHADOWS)) {
            irradiance *= shadow_visibility_surface_lamp_of(shadow_light_of(lamp.shadow), shade_shadowed(p, foot));
        }
        if (shade_has(SHADE_MEDIUM)) {
            irradiance *= shade_through_radial(radial_grid_of(n), p.position);
        }
    }
    return irradiance;
}

// `part` of the picture that p stands for: from xy to zw, pixels.
vec3 shade_lamps(const shade_point p, vec4 part)
{
    vec3 sum = vec3(0.0);
    if (!shade_has(SHADE_LAMPS)) {
        return sum;
    }
    shade_footprint foot = shade_footprint_of(p, part);
    for (uint n = 0u; n < args.num_lamps; n++) {
        sum += shade_lamp(p, foot, n);
    }
    return sum;
}

// Of VPLs first, first + stride, ..., on SHADE_MANY points: a light is read once for all of them. Nothing is left out
// where a light does not shine: lavapipe would go through it anyway, under a mask. `rooms` of the points: shade_rooms.glsl.
// `nearest` of those that shine there: square of the distance or of the radius, which is more, m^2.
vec3[SHADE_MANY] shade_vpls(shade_point p[SHADE_MANY], uint rooms[SHADE_MANY], uint first, uint stride,
                            out float nearest[SHADE_MANY])
{
    vec3 sum[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        sum[i] = vec3(0.0);
        nearest[i] = 1e30;
    }
    uint count = min(vpl_count(), uint(TYN_RADIAL_VPLS_MAX));
    for (uint k = first; k < count; k += stride) {
        light_block light = vpl_light(k);
        vpl_map map = vpl_map_of(k, light.direction);
        uint shines_in = shade_has(SHADE_ROOMS) ? rooms_of_vpl(shade_lattice().dims, k) : TYN_ROOMS_ANY;
        radial_grid grid;
        if (shade_has(SHADE_MEDIUM)) {
            grid = radial_grid_of(args.num_lamps + k);
        }
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            vec3 away = p[i].position - light.position;
            float share = vpl_irradiance(light, p[i].position, p[i].normal);
            share = dot(p[i].facet, away) < 0.0 ? share : 0.0;
            share *= vpl_map_visibility_surface(map, away, p[i].facet);
            if (shade_has(SHADE_ROOMS)) {
                share = rooms[i] == TYN_ROOMS_ANY || rooms_joined(shines_in, rooms[i]) ? share : 0.0;
            }
            float far = max(dot(away, away), light.radius * light.radius);
            nearest[i] = share > 0.0 ? min(nearest[i], far) : nearest[i];
            vec3 irradiance = light.color * share;
            if (shade_has(SHADE_MEDIUM)) {
                irradiance *= shade_through_radial(grid, p[i].position);
            }
            sum[i] += irradiance;
        }
    }
    return sum;
}

#endif
