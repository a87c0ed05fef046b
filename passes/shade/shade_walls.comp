// shade_walls.comp -- walls of the lattice's cells into the image that walls_table.glsl describes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "walls_table.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(binding = 0, scalar) readonly buffer link_buffer
{
    uint wall_links[];
};
layout(binding = 1, scalar) readonly buffer cell_buffer
{
    wall_cell wall_cells[];
};
layout(binding = 3, scalar) readonly buffer room_buffer
{
    uint rooms[];
};
layout(constant_id = 0) const uint has_rooms = 0;
layout(binding = 2, rgba32f) uniform writeonly image3D table_image;

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = imageSize(table_image);
    dims.z /= TYN_WALLS_PLANES + 1;
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    uint i = uint((c.z * dims.y + c.y) * dims.x + c.x), links = wall_links[i];
    bool near = (links & TYN_WALLS_NEAR) != 0u; // else there are no planes
    for (int k = 0; k < TYN_WALLS_PLANES; k++) {
        imageStore(table_image, c + ivec3(0, 0, k * dims.z), near ? wall_cells[i].planes[k] : vec4(0.0));
    }
    imageStore(table_image, c + ivec3(0, 0, TYN_WALLS_PLANES * dims.z), walls_table_entry_of(links, has_rooms == 1u ? rooms[1u + i] : 0u));
}
