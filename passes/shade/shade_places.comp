// shade_places.comp -- blocks of pixels that take all of the shared light themselves: those that shade_gather.comp lists.
#include "shade_place.glsl"
#include "shade_rooms.glsl"
#define SHADE_SKY_AT (SHADE_AT + 3)
#include "shade_sky.glsl"
#define SHADE_ALONE_COUNT (SHADE_AT + 1)
#define SHADE_ALONE (SHADE_AT + 2)
#define SHADE_ALONE_TAKEN
#include "shade_alone.glsl"

layout(local_size_x = GBUFFER_EDGES) in;

layout(binding = SHADE_AT, rgba32ui) uniform writeonly uimage2D part_image; // shade_part.glsl

void main()
{
    uint n = gbuffer_edge() * uint(SHADE_MANY), count = alone_count.count;
    if (n >= count) {
        return;
    }
    shade_point p[SHADE_MANY];
    shade_part part[SHADE_MANY];
    uint rooms[SHADE_MANY];
    float nearest[SHADE_MANY];
    ivec2 block[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        uint entry = alone_pixels[min(n + uint(i), count - 1u)].x;
        block[i] = ivec2(entry & 0xffffu, entry >> 16);
        p[i] = shade_place(block[i], part[i]);
        rooms[i] = shade_has(SHADE_ROOMS) ? shade_room_of(p[i].position) : TYN_ROOMS_ANY;
    }
    vec3 light[SHADE_MANY] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    nearest = float[](1e30, 1e30, 1e30, 1e30);
    if (shade_has(SHADE_VPLS)) {
        light = shade_vpls(p, rooms, 0u, 1u, nearest);
    }
    if (shade_has(SHADE_SKY_MAPS)) {
        vec3 sky[SHADE_MANY] = shade_sky(p, shade_parts(block), 0u, 1u);
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            light[i] += sky[i];
        }
    }
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        part[i].irradiance = light[i];
        part[i].near = shade_near(p[i], block[i], nearest[i]);
        if (n + uint(i) < count) {
            imageStore(part_image, block[i], shade_pack(part[i]));
        }
    }
}
