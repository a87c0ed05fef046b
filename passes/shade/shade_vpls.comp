// shade_vpls.comp -- light of the VPLs and of the directions of the sky at blocks of pixels.
//
// First every block takes a part of them. Neighbours in a pattern of 5 x 5 blocks take different ones (Wald et al. 2002,
// interleaved sampling), and shade_rows.comp and shade_gather.comp sum over the pattern. A thread has several blocks of one place in
// the pattern. Then blocks that shade_gather.comp lists take all of that light (args.listed). There are too few of them to keep a
// card busy: threads of a column share it (SHADE_SLICED).
#include "shade_place.glsl"
#include "shade_rooms.glsl"
#define SHADE_SKY_AT (SHADE_AT + 3)
#include "shade_sky.glsl"
#define SHADE_ALONE_COUNT (SHADE_AT + 1)
#define SHADE_ALONE (SHADE_AT + 2)
#define SHADE_ALONE_TAKEN
#include "shade_alone.glsl"

layout(local_size_x = GBUFFER_EDGES / SHADE_SLICES, local_size_y = SHADE_SLICES) in;

layout(binding = SHADE_AT, rgba32ui) uniform writeonly uimage2D part_image; // shade_part.glsl

shared vec4 slices[GBUFFER_EDGES * SHADE_MANY]; // of each block: light, and nearest

void main()
{
    bool listed = args.listed != 0u;
    uint n = gbuffer_edge(), count = listed ? alone_count.count : 0u, of_pattern = gl_WorkGroupID.z;
    if (shade_has(SHADE_SLICED)) { // a column of threads for a thread's blocks
        n = n / GBUFFER_EDGES * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    }
    n *= uint(SHADE_MANY);
    if (listed && n >= count && !shade_has(SHADE_SLICED)) {
        return;
    }
    ivec2 cell = ivec2(of_pattern % shade_side, of_pattern / shade_side), size = shade_blocks();
    ivec2 first = shade_side * ivec2(gl_GlobalInvocationID.xy * uvec2(1, SHADE_MANY)) + cell;
    ivec2 block[SHADE_MANY];
    shade_point p[SHADE_MANY];
    shade_part part[SHADE_MANY];
    uint rooms[SHADE_MANY];
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        block[i] = first + ivec2(0, i * shade_side);
        if (listed) {
            uint entry = alone_pixels[min(n + uint(i), count - 1u)].x;
            block[i] = ivec2(entry & 0xffffu, entry >> 16);
        }
        p[i] = shade_place(min(block[i], size - 1), part[i]);
        rooms[i] = shade_has(SHADE_ROOMS) ? shade_room_of(p[i].position) : TYN_ROOMS_ANY;
    }
    // Of many each place takes a 25th; of fewer a fifth, so that any row takes all; of few all. Else differences
    // between parts would be larger than what sums even out.
    uint side = uint(shade_side), vpls = shade_has(SHADE_VPLS) ? vpl_count() : 0u;
    bool sky = shade_has(SHADE_SKY_MAPS);
    uint parts = sky ? side * side : vpls <= SHADE_MOST ? 1u : vpls <= SHADE_MOST * side ? side : side * side;
    uint part_of = parts < side * side ? uint(cell.x + 2 * cell.y) % parts : of_pattern;
    if (listed) {
        part_of = shade_has(SHADE_SLICED) ? gl_LocalInvocationID.y : 0u;
        parts = shade_has(SHADE_SLICED) ? gl_WorkGroupSize.y : 1u;
    }
    float nearest[SHADE_MANY] = float[](1e30, 1e30, 1e30, 1e30);
    vec3 light[SHADE_MANY] = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    if (shade_has(SHADE_VPLS)) {
        light = shade_vpls(p, rooms, part_of, parts, nearest);
    }
    if (sky) {
        vec3 others[SHADE_MANY] = shade_sky(p, shade_parts(block), part_of, parts);
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            light[i] += others[i];
        }
    }
    if (listed && shade_has(SHADE_SLICED)) { // the sums over a column
        uint first = gl_LocalInvocationID.x * uint(SHADE_MANY), row = gl_WorkGroupSize.x * uint(SHADE_MANY);
        [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
            slices[gl_LocalInvocationID.y * row + first + uint(i)] = vec4(light[i], nearest[i]);
            light[i] = vec3(0.0);
        }
        barrier();
        for (uint at = first; at < gl_WorkGroupSize.y * row; at += row) {
            [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
                light[i] += slices[at + uint(i)].rgb;
                nearest[i] = min(nearest[i], slices[at + uint(i)].a);
            }
        }
    }
    [[unroll]] for (int i = 0; i < SHADE_MANY; i++) {
        if (listed ? n + uint(i) < count && part_of == 0u : all(lessThan(block[i], size))) {
            part[i].irradiance = part[i].along > 0.0 ? light[i] : vec3(0.0);
            part[i].near = part[i].along > 0.0 && shade_near(p[i], block[i], nearest[i]);
            imageStore(part_image, block[i], shade_pack(part[i]));
        }
    }
}
