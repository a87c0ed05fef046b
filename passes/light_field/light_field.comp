// light_field.comp -- see light_field.h; one thread a texel; built for each format of the images, FIELD_FORMAT.
#include "light_field_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
struct probe_values { // tyn_probe_result
    float fluence[3];
    float flux[9]; // x_r x_g x_b y_r ...
    float errors[12];
};
TYN_READ(0, results, probe_values results[]);
layout(binding = 1, FIELD_FORMAT) uniform writeonly image3D red;
layout(binding = 2, FIELD_FORMAT) uniform writeonly image3D green;
layout(binding = 3, FIELD_FORMAT) uniform writeonly image3D blue;
TYN_ARGS(light_field_args args);

const float LARGEST = FIELD_LARGEST; // what the format holds

vec4 channel(uint i, uint c)
{
    vec3 flux = vec3(0.0);
    for (uint axis = 0u; axis < 3u; axis++) {
        flux += results[i].flux[3u * axis + c] * args.world[axis];
    }
    return clamp(vec4(results[i].fluence[c], flux), vec4(-LARGEST), vec4(LARGEST));
}

void main()
{
    uvec3 size = uvec3(imageSize(red)), texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    uint i = (texel.z * size.y + texel.y) * size.x + texel.x;
    imageStore(red, ivec3(texel), channel(i, 0u));
    imageStore(green, ivec3(texel), channel(i, 1u));
    imageStore(blue, ivec3(texel), channel(i, 2u));
}
