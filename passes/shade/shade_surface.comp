// shade_surface.comp -- radiance of the surfaces towards the camera.
//
// A thread has a pixel of the picture, which it shades if all its samples see one triangle; else it lists the pixel. Then a thread has
// one of the list, whose pieces of surface it shades one after another (args.listed).
#define SHADE_COLOURS
#include "shaders/surfaces/gbuffer_edges.glsl"
#include "shaders/surfaces/piece_light.glsl"
#include "shade_piece.glsl"
#define SHADE_ALONE_COUNT (SHADE_PIECE_AT + 1)
#define SHADE_ALONE (SHADE_PIECE_AT + 2)
#include "shade_alone.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = SHADE_PIECE_AT, rgba32ui) uniform writeonly uimage2D surface_radiance_image; // piece_light.glsl
TYN_UPDATE(SHADE_PIECE_AT + 3, edge_count, gbuffer_edge_count edge_count);
layout(binding = SHADE_PIECE_AT + 4, scalar) buffer edges_buffer
{
    uint edges[]; // x | y << 16
};

bool is_listed()
{
    bool listed = shade_has(SHADE_EDGES);
    if (shade_has(SHADE_PIXELS)) {
        listed = listed && args.listed != 0u;
    }
    return listed;
}

// Smooth light that is looked up. `lone`: no place tells of it.
vec3 smooth_light_found(const shade_point p, ivec2 pixel, vec2 middle, bool several, out bool lone)
{
    lone = false;
    if (shade_step > 1) {
        return smooth_light_around(p, middle, lone);
    }
    vec3 light = vec3(0.0);
    if (shade_has(SHADE_SHARED)) {
        if (several) {
            light = smooth_light_beside(p, middle, lone);
        } else {
            light = shade_unpack(imageLoad(part_image, pixel)).irradiance;
        }
    }
    return light;
}

void main()
{
    bool listed = is_listed();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool is = all(lessThan(pixel, ivec2(camera.size)));
    if (listed) {
        uint n = gbuffer_edge();
        is = n < edge_count.count;
        uint entry = edges[is ? n : 0u];
        pixel = ivec2(entry & 0xffffu, entry >> 16);
    }
    if (!is) {
        return;
    }
    gbuffer_pixel seen = shade_pixel(pixel);
    if (!listed && gbuffer_is_mixed(seen)) {
        GBUFFER_ADD(n, edge_count, 1u, 1u, GBUFFER_ROW)
        edges[n] = uint(pixel.y) << 16 | uint(pixel.x);
        return;
    }
    uint alone = 0u; // samples of pieces that no place tells of: bits
    gbuffer_groups groups = gbuffer_groups_of(seen);
    piece_light light[2] = piece_light[2](piece_light(vec3(0.0), 0.0), piece_light(vec3(0.0), 0.0));
    for (uint left = groups.first | groups.second, members; left != 0u; left &= ~members) {
        gbuffer_point found = gbuffer_piece(seen, gbuffer_of_group(groups, left), members);
        shade_point p = shade_point_of(found);
        bool several = listed && gbuffer_is_several(seen);
        vec4 part = vec4(pixel, pixel + 1);
        if (several) {
            part = gbuffer_part(seen, members);
        }
        bool lone;
        vec3 smoothed = smooth_light_found(p, pixel, 0.5 * (part.xy + part.zw), several, lone);
        vec3 irradiance = shade_step > 1 ? sharp_light_at(p, part) : irradiance_at(p, part);
        irradiance += lone ? vec3(0.0) : smoothed;
        alone |= lone ? members : 0u;
        vec3 radiance = shade_radiance(gbuffer_colours_of(seen, members, found), irradiance);
        light[0] = piece_light_add(light[0], bitCount(members & groups.first), radiance, found.distance);
        light[1] = piece_light_add(light[1], bitCount(members & groups.second), radiance, found.distance);
        if (!shade_has(SHADE_EDGES)) {
            break; // known when the kernel is compiled
        }
    }
    light[0] = piece_light_mean(light[0], bitCount(groups.first));
    light[1] = piece_light_mean(light[1], bitCount(groups.second));
    imageStore(surface_radiance_image, pixel, piece_light_pack(light[0], light[1], groups.second != 0u));
    if (alone != 0u) {
        shade_list_alone(pixel, alone, 1u, 1u);
    }
}
