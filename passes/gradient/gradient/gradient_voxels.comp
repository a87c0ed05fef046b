// gradient_voxels.comp -- the field of radiance towards the eye, followed for each of its cells: what samples are compared with.
#include "gradient_bindings.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 16, rgba32f) uniform writeonly image3D inscatter_image;

void main()
{
    const ivec3 dims = ivec3(args.x, args.y, args.z), texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    const vec3 x = within_box(lattice_to_m(lattice_box_of(medium.extent, dims), vec3(texel) - 0.5));
    imageStore(inscatter_image, texel, vec4(finite_light(light_at(x, args.nearest)), 0.0));
    atomicAdd(counters.steps, 1u);
}
