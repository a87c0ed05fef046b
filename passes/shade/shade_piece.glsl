// shade_piece.glsl -- radiance of one piece of surface in a pixel. Its irradiance is that of suns, lamps, VPLs, and the
// light of the lattice, or of the sky where that is not.
//
// Samples of a pixel on one piece of surface are shaded together.
#include "shade.glsl"
#include "shade_part.glsl"
#include "shaders/common/counters.h"

layout(binding = SHADE_AT, rgba32ui) uniform readonly uimage2D part_image; // shade_part.glsl
#define WALLS_OTHERS TYN_BEAM_MAX_SUNS
#include "walls_irradiance.glsl"
#include "shade_rooms.glsl"
layout(binding = SHADE_AT + 1) uniform sampler3D forward_tex; // shade_forward.comp
layout(binding = SHADE_AT + 2) uniform sampler2D faces_tex; // shade_faces.h
layout(binding = SHADE_AT + 3) uniform sampler3D sight_tex; // shade_sight.comp
TYN_UPDATE(SHADE_AT + 4, counters, counters_block counters);
#define SHADE_PIECE_AT (SHADE_AT + 5)

const float PI = 3.14159265358979;

#include "shade_outside.glsl"

#ifdef SHADE_COLOURS
// Towards the camera, W/(m^2 sr).
vec3 shade_radiance(const gbuffer_colours colours, vec3 irradiance)
{
    return colours.emission + colours.albedo * irradiance / PI;
}
#endif

// What the lattice's light counts on a face of its box, beside that of the faces (docs/measurements.md, "Constants").
const float SHADE_WITHIN = 0.25;

// Eight threads of so many times as many tell of the light that clamps let through: atomics of all would take time.
const uint COUNTED = 16u;

// The irradiance set to 0 where it is below, which is counted.
vec3 clamped_light(vec3 irradiance)
{
    bool told = (gl_GlobalInvocationID.x / 8u + 3u * gl_GlobalInvocationID.y) % COUNTED == 0u;
    float below = light_below(irradiance), above = told ? float(COUNTED) * light_above(irradiance) : 0.0;
    TYN_LIGHT_CLAMP_ADD(counters.clamp_0, below, above)
    if (below > 0.0) {
        atomicAdd(counters.clamped, 1u);
    }
    return max(irradiance, vec3(0.0));
}

// Is a place where the lattice has light for it? Also where it is in a wall of the lattice, which may be up to half a cell
// outside: the link that it cuts leads there.
bool lattice_lights(const lattice_box box, vec3 x)
{
    vec3 beyond = x - clamp(x, vec3(0.0), vec3(box.dims)), off = abs(beyond);
    float most = max(off.x, max(off.y, off.z));
    bool inside = most < 0.02;
    for (bool close = shade_has(SHADE_LATTICE) && !inside && most < 0.5; close; close = false) {
        ivec3 outwards = ivec3(sign(beyond)) * ivec3(greaterThanEqual(off, vec3(most)));
        ivec3 cell = clamp(ivec3(floor(x)), ivec3(0), box.dims - 1);
        inside = (walls_links_of(lattice_index(box, cell)) >> walls_link(outwards) & 1u) != 0u;
    }
    return inside;
}

// Light of the medium and of far walls, and of the sky where it comes along the lattice's lines.
// `inside` the lattice: from where sunlight comes that was scattered forward.
vec3 light_of_lattice(const shade_point p, out vec4 around[TYN_BEAM_MAX_SUNS], out bool inside)
{
    inside = false;
    vec3 sky = shade_has(SHADE_SKY) ? PI * environment.sky : vec3(0.0);
    if (!shade_has(SHADE_LATTICE | SHADE_OUTSIDE)) {
        return sky;
    }
    lattice_box box = shade_lattice();
    ivec3 dims = box.dims;
    vec3 x = lattice_from_m(box, p.position + 0.02 * box.dx * p.facet);
    inside = lattice_lights(box, x);
    bool has_outside = shade_has(SHADE_OUTSIDE);
    // The nearest place on a face of the box that the surface goes through, as seen from inside and from just
    // outside; 1 there: how near.
    vec3 lo = box.origin, hi = lattice_to_m(box, vec3(dims));
    vec3 beyond = x - clamp(x, vec3(0.5), vec3(dims) - 0.5), across = 1.0 - p.normal * p.normal, far = abs(beyond) * across;
    int axis = far.x >= far.y && far.x >= far.z ? 0 : far.y >= far.z ? 1 : 2;
    vec3 place = clamp(p.position, lo, hi), before = place;
    before[axis] = beyond[axis] > 0.0 ? hi[axis] : lo[axis];
    vec3 away = p.position - before, push = mix(sign(away), vec3(0.0), equal(p.position, place));
    push[axis] = sign(beyond[axis]);
    float near = inside ? clamp(2.0 * abs(beyond[axis]), 0.0, 1.0) : max(1.0 - length(away) / shade_reach(lo, hi), 0.0);
    // Another surface's light does not matter here: the place is to be on this one.
    float off = abs(dot(p.position - place, p.facet)) / (0.25 * box.dx);
    bool through = has_outside && shade_has(SHADE_LATTICE) && (inside || beyond[axis] != 0.0);
    near = through ? near * near * across[axis] * max(1.0 - off, 0.0) : 0.0;

    vec3 irradiance = vec3(0.0), within = vec3(0.0);
    if (!inside) {
        irradiance = has_outside ? clamped_light(sky + shade_outside(p.position, p.normal, p.facet, lo, hi)) : sky;
    }
    if (shade_has(SHADE_LATTICE) && (inside || near > 0.0)) {
        int channels = shade_has(SHADE_ONE_CHANNEL) ? 1 : 3;
        uint num_suns = shade_has(SHADE_SPREAD) ? shade_num_suns : 0u;
        uint room = shade_has(SHADE_ROOMS) ? shade_room_of(p.position) : TYN_ROOMS_ANY;
        within = walls_irradiance_at(moments_tex, box, place, p.normal, channels, forward_tex, num_suns, room, around);
        within = clamped_light(within);
        within = channels == 1 ? within.r * args.tint : within;
        irradiance = inside ? within : irradiance;
    }
    // Four moments a cell are too bright at the box's face, patches too dark: they meet in between.
    if (near > 0.0) {
        vec3 seen = clamped_light(sky + shade_outside(before + 0.03 * box.dx * push, p.normal, p.facet, lo, hi));
        vec3 change = near * (within - seen) * vec3(notEqual(seen, sky)) * vec3(greaterThan(min(seen, within), vec3(0.0)));
        irradiance = clamped_light(irradiance + (inside ? SHADE_WITHIN - 1.0 : SHADE_WITHIN) * change);
    }
    return irradiance;
}

// Is p where the lattice has light?
bool inside_lattice(const shade_point p)
{
    lattice_box box = shade_lattice();
    vec3 x = lattice_from_m(box, p.position + 0.02 * box.dx * p.facet);
    return lattice_lights(box, x);
}

// Light that changes little from pixel to pixel, but for that of VPLs.
vec3 smooth_light_at(const shade_point p)
{
    vec4 around[TYN_BEAM_MAX_SUNS];
    bool inside;
    vec3 light = light_of_lattice(p, around, inside);
    return shade_has(SHADE_SPREAD) ? light + shade_suns(p, vec4(0.0), around, inside, false, true) : light;
}

// All light but that of VPLs. `part` of the picture that p stands for: from xy to zw, pixels.
vec3 irradiance_at(const shade_point p, vec4 part)
{
    vec4 around[TYN_BEAM_MAX_SUNS];
    bool inside;
    vec3 light = light_of_lattice(p, around, inside);
    light += shade_suns(p, part, around, inside && shade_has(SHADE_SPREAD), true, true);
    return light + shade_lamps(p, part);
}

// All light of which shade_smooth.comp makes none.
vec3 sharp_light_at(const shade_point p, vec4 part)
{
    vec4 around[TYN_BEAM_MAX_SUNS];
    bool spread = shade_has(SHADE_SPREAD) && inside_lattice(p);
    return shade_suns(p, part, around, spread, true, false) + shade_lamps(p, part);
}

// Weights of places on the same piece of surface, below which a piece is alone.
const float SHADE_ALIKE = 0.001, SHADE_ALIKE_BESIDE = 0.01;

// Smooth light of the four blocks whose middles are around the place `at` of the picture (pixels): of those on the same
// piece of surface, in proportion to how near they are, or of the one that is most like p. `alone`: that will not do.
vec3 smooth_light_around(const shade_point p, vec2 at, out bool alone)
{
    vec2 x = at / float(shade_step) - 0.5, first = floor(x), f = x - first;
    ivec2 last = shade_blocks() - 1;
    float size = float(shade_step) * camera_pixel(camera).y;
    size *= camera_select(camera, 1.0, dot(p.position - camera.origin, camera.forward));
    float per = 1.0 / max(size, 1e-30), best = -1e30;
    vec4 sum = vec4(0.0);
    vec3 other = vec3(0.0);
    [[unroll]] for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1), block = clamp(ivec2(first) + step, ivec2(0), last);
        shade_part there = shade_unpack(imageLoad(part_image, block));
        vec2 share = mix(1.0 - f, f, vec2(step));
        // The nearer the normal, the more it counts: edges stay sharp, and what is curved is smooth.
        float off = abs(dot(shade_part_position(block, there.along) - p.position, p.facet)) * per;
        float turned = dot(p.normal, there.facet);
        float like = (clamp(2.0 - off, 0.0, 1.0) + (off < 6.0 ? 1e-3 : 0.0)) * exp2(-200.0 * (1.0 - turned));
        sum += (there.along > 0.0 ? like * share.x * share.y : 0.0) * vec4(there.irradiance, 1.0);
        float alike = there.along > 0.0 ? turned - min(0.05 * off, 2.0) : -1e30;
        other = alike > best ? there.irradiance : other;
        best = max(best, alike);
    }
    alone = sum.a < SHADE_ALIKE;
    return sum.a > 1e-9 ? sum.rgb / sum.a : other;
}

// Of the nine blocks around the place `at` of the picture (pixels): of those on the same plane, the nearer the more. Not of
// the one that is most like p: of several on one plane that is a matter of rounding, which changes with the scale.
// `alone`: that will not do.
vec3 smooth_light_beside(const shade_point p, vec2 at, out bool alone)
{
    bool near = false;
    vec2 x = at / float(shade_step);
    ivec2 last = shade_blocks() - 1;
    float size = float(shade_step) * camera_pixel(camera).y;
    size *= camera_select(camera, 1.0, dot(p.position - camera.origin, camera.forward));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 9; i++) {
        ivec2 block = clamp(ivec2(x) + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
        shade_part there = shade_unpack(imageLoad(part_image, block));
        vec3 d = shade_part_position(block, there.along) - p.position;
        vec2 away = vec2(block) + 0.5 - x;
        // A place nearer than a block tells nothing of planes: it may be p, but for rounding.
        float off = abs(dot(d, p.facet)) / max(max(length(d), size), 1e-30);
        float like = exp2(max(-40.0 * (1.0 - dot(there.facet, p.facet) + off), -100.0) - 4.0 * dot(away, away));
        sum += (there.along > 0.0 ? like : 0.0) * vec4(there.irradiance, 1.0);
        near = near || there.along > 0.0 && there.near && like > 1e-3;
    }
    alone = near || sum.a < SHADE_ALIKE_BESIDE || shade_side == 1;
    return sum.rgb / max(sum.a, 1e-37);
}
