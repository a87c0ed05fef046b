// medium.comp -- all shapes resampled to voxels: the mean texture value (built with TYN_DENSITY, for that mode), or
// summed coefficients; with grids of colours (TYN_COLORS) what varies by them is averaged as a product.
#define MEDIUM_BLOCK 0
#define SHAPES 1
#define ATLAS 2
#define MEDIUM_GROUP 4
#define COLORS 6
#include "shaders/common/uniform_branch.glsl"
#include "shaders/phase/phase.glsl"
#include "medium_shapes.glsl"
#include "medium_args.h"

layout(local_size_x = MEDIUM_GROUP, local_size_y = MEDIUM_GROUP, local_size_z = MEDIUM_GROUP) in;
#ifdef TYN_DENSITY
layout(set = 0, binding = 3, r32f) writeonly uniform image3D density_image;
#else
layout(set = 0, binding = 3, rgba32f) writeonly uniform image3D density_image;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image3D sigma_a_image;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image3D g_image;
#endif
TYN_ARGS(resample_args args);

float mean_of(vec3 v)
{
    return (v.x + v.y + v.z) / 3.0;
}

void main()
{
    shapes_find();
    uvec3 voxel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(voxel, medium.size))) {
        return;
    }
    vec3 p = (vec3(voxel) + 0.5) * medium.voxel;
#ifdef TYN_DENSITY
    float density = 0.0;
    for (uint i = shapes_next(0u); i < medium.num_shapes; i = shapes_next(i + 1u)) {
        density += shape_scale(shapes[i]) * shape_mean(shapes[i], p, int(args.samples));
    }
    imageStore(density_image, ivec3(voxel), vec4(density));
#else
    vec3 sigma_s = vec3(0.0), sigma_a = vec3(0.0), weighted = vec3(0.0);
    for (uint i = shapes_next(0u); i < medium.num_shapes; i = shapes_next(i + 1u)) {
#ifdef TYN_COLORS
        mat3 means = shape_means(shapes[i], p, int(args.samples));
#else
        float value = shape_mean(shapes[i], p, int(args.samples));
        mat3 means = mat3(value * shapes[i].sigma_s, value * shapes[i].sigma_a, vec3(0.0));
#endif
        sigma_s += means[0];
        sigma_a += means[1];
        weighted += means[0] * phase_mean_cosine(shapes[i].phase);
    }
    imageStore(density_image, ivec3(voxel), vec4(sigma_s, mean_of(sigma_s)));
    imageStore(sigma_a_image, ivec3(voxel), vec4(sigma_a, mean_of(sigma_a)));
    if (uniform_branch(medium.mode == TYN_MEDIUM_COEFFICIENTS)) {
        vec3 g = mix(vec3(0.0), weighted / max(sigma_s, vec3(1e-30)), greaterThan(sigma_s, vec3(0.0)));
        float mean_s = mean_of(sigma_s);
        imageStore(g_image, ivec3(voxel), vec4(g, mean_s > 0.0 ? mean_of(weighted) / mean_s : 0.0));
    }
#endif
}
