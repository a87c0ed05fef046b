// rsm_sky_areas.comp -- what triangles that reflect count for (rsm_sky_args.h). One workgroup a block.
#include "rsm_sky_args.h"
#define GEOMETRY_AT 0
#define MATERIALS_AT 4
#include "shaders/surfaces/surface_frame.glsl"
#include "shaders/surfaces/reflectance.glsl"

layout(local_size_x = RSM_SKY_BLOCK) in;
#define WORKGROUP_SIZE RSM_SKY_BLOCK
#define WORKGROUP_SUM float
#include "shaders/common/workgroup.glsl"
TYN_ARGS(rsm_sky_args args);
TYN_WRITE(7, areas, float areas[]);
TYN_WRITE(8, area_blocks, float area_blocks[]);
#include "rsm_sky_places.glsl"

vec3 corner(uint vertex)
{
    return surface_transform(surfaces.from_world, surface_position(vertex));
}

void main()
{
    uint i = gl_GlobalInvocationID.x, lane = gl_LocalInvocationIndex;
    float own = 0.0;
    if (i < args.triangles) {
        uvec4 t = surface_triangle_at(i);
        if (surface_reflected(surface_material_at(t.w), vec3(1.0)) != vec3(0.0)) {
            own = rsm_sky_count(corner(t.x), corner(t.y), corner(t.z));
        }
    }
    workgroup_cumulate(own < 1e30 ? own : 0.0); // also where it is no number
    areas[i] = workgroup_sums[lane];
    if (lane == RSM_SKY_BLOCK - 1u) {
        area_blocks[gl_WorkGroupID.x] = workgroup_sums[lane];
    }
}
