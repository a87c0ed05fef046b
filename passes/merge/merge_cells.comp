// merge_cells.comp -- what a cell scatters towards the eye of the light that has scattered before, and of that
// of VPLs and of the sky's mean, which come
// from all around as well.
#include "shaders/common/scene_args.h"
#include "merge_args.h"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(merge_args args);
TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, camera, camera_block camera);
layout(binding = 2) uniform sampler3D cells;
layout(binding = 3) uniform sampler3D moments;
layout(binding = 5) uniform sampler3D vpl_light; // of lattice_lamps; one texel if there is none
layout(binding = 6) uniform sampler3D even; // of lattice_ordinates; one texel if there is none
TYN_WRITE(4, field, float field[]);
#include "merge.glsl"

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    // The field is linear in direction: (phi + 3 g' v.F) / 4 pi, v towards the eye.
    vec3 v = merge_towards_eye(camera, lattice_box_of(medium.extent, dims), c);
    float most = 0.0;
    for (int ch = 0; ch < int(args.channels); ch++) {
        ivec3 texel = c + ivec3(0, 0, ch * dims.z);
        vec4 cell = texelFetch(cells, texel, 0), m = texelFetch(moments, texel, 0);
        m += lattice_fetch_source(vpl_light, cells, texel) + lattice_fetch_source(even, cells, texel);
        field[merge_index(c, uint(ch))] = (m.x + 3.0 * cell.z * dot(v, m.yzw)) / 12.56637061;
        most = max(most, cell.x);
    }
    field[merge_index(c, args.channels)] = most;
}
