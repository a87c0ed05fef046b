// medium_emission.comp -- summed emission of all shapes per voxel.
#define MEDIUM_BLOCK 0
#define SHAPES 1
#define ATLAS 2
#define MEDIUM_GROUP 4
#define COLORS 4
#include "medium_shapes.glsl"
#include "medium_args.h"

layout(local_size_x = MEDIUM_GROUP, local_size_y = MEDIUM_GROUP, local_size_z = MEDIUM_GROUP) in;
layout(set = 0, binding = 3, rgba32f) writeonly uniform image3D emission_image;
TYN_ARGS(resample_args args);

void main()
{
    shapes_find();
    uvec3 voxel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(voxel, medium.size))) {
        return;
    }
    vec3 p = (vec3(voxel) + 0.5) * medium.voxel;
    vec3 emission = vec3(0.0);
    for (uint i = shapes_next(0u); i < medium.num_shapes; i = shapes_next(i + 1u)) {
#ifdef TYN_COLORS
        if (any(greaterThan(shapes[i].emission, vec3(0.0))) || shape_has_color(shapes[i], TYN_COLORS_RADIANCE)) {
            emission += shape_means(shapes[i], p, int(args.samples))[2];
        }
#else
        if (any(greaterThan(shapes[i].emission, vec3(0.0)))) {
            emission += shape_mean(shapes[i], p, int(args.samples)) * shapes[i].emission;
        }
#endif
    }
    float mean = (emission.x + emission.y + emission.z) / 3.0;
    imageStore(emission_image, ivec3(voxel), vec4(emission, mean));
}
