// refine_field_images.comp -- see refine_field.h; one thread a texel.
#include "refine_field_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_ARGS(refine_field_args args);
struct probe_values { // tyn_probe_result
    float fluence[3];
    float flux[9]; // x_r x_g x_b y_r ...
    float errors[12];
};
TYN_READ(0, results, probe_values results[]);
layout(binding = 1, rgba32f) uniform writeonly image3D red_image;
layout(binding = 2, rgba32f) uniform writeonly image3D green_image;
layout(binding = 3, rgba32f) uniform writeonly image3D blue_image;

vec4 channel(uint i, uint c)
{
    const vec3 flux = results[i].flux[c] * args.world[0] + results[i].flux[3u + c] * args.world[1] +
                      results[i].flux[6u + c] * args.world[2];
    return vec4(results[i].fluence[c], flux);
}

void main()
{
    const uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel, args.size))) {
        return;
    }
    const uint i = (texel.z * args.size.y + texel.y) * args.size.x + texel.x;
    imageStore(red_image, ivec3(texel), channel(i, 0u));
    imageStore(green_image, ivec3(texel), channel(i, 1u));
    imageStore(blue_image, ivec3(texel), channel(i, 2u));
}
