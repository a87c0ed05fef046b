// shade_alone.glsl -- lists of what takes all VPLs itself, as neighbours do not tell of its light: blocks of pixels, for
// shade_vpls.comp; then pixels with such pieces of surface, for shade_alone.comp. Order does not matter.
#include "shaders/surfaces/gbuffer_edges.glsl"

// SHADE_ALONE_TAKEN: the list is gone through; else added to.
#ifdef SHADE_ALONE_TAKEN
#define SHADE_ALONE_COUNTED readonly
#define SHADE_ALONE_LISTED readonly
#else
#define SHADE_ALONE_COUNTED
#define SHADE_ALONE_LISTED writeonly
#endif

layout(binding = SHADE_ALONE_COUNT, scalar) SHADE_ALONE_COUNTED buffer alone_count_buffer
{
    gbuffer_edge_count alone_count;
};
layout(binding = SHADE_ALONE, scalar) SHADE_ALONE_LISTED buffer alone_buffer
{
    uvec2 alone_pixels[]; // x | y << 16; of pixels the samples of such pieces: bits
};

#ifndef SHADE_ALONE_TAKEN
// `threads` that take `many` elements of the list.
void shade_list_alone(ivec2 pixel, uint samples, uint threads, uint many)
{
    GBUFFER_ADD(n, alone_count, threads, many, GBUFFER_ROW)
    alone_pixels[n] = uvec2(uint(pixel.y) << 16 | uint(pixel.x), samples);
}
#endif
