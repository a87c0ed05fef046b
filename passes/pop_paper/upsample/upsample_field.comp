// upsample_field.comp -- see upsample.h; one thread a texel.
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/lattice/lattice.glsl"
#include "upsample_args.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 5) uniform sampler3D merged;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image3D inscatter_image;
TYN_ARGS(upsample_args args);

// Likeness of two scattering coefficients, in (0, 1]. The floor keeps a point that is like none of its
// neighbours at their trilinear mean.
float likeness(float a, float b)
{
    if (args.range <= 0.0) {
        return 1.0;
    }
    float d = abs(a - b) / max(a + b, 1e-30) / args.range;
    return exp(-0.5 * d * d) + 1e-4;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(uvec3(texel), args.dims + 2u))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    ivec3 cell = clamp(texel - 1, ivec3(0), box.dims - 1);
    vec3 p = clamp(lattice_to_m(box, vec3(cell) + 0.5), vec3(0.0), medium.extent);
    float here = dot(medium_sample(p).sigma_s, vec3(1.0 / 3.0));

    lattice_box coarse = lattice_box_of(medium.extent, textureSize(merged, 0));
    vec3 at = lattice_from_m(coarse, p) - 0.5;
    ivec3 base = ivec3(floor(at)), last = coarse.dims - 1;
    vec3 part = at - vec3(base), sum = vec3(0.0);
    float weights = 0.0;
    for (int n = 0; n < 8; n++) {
        ivec3 corner = ivec3(n & 1, n >> 1 & 1, n >> 2);
        vec4 found = texelFetch(merged, clamp(base + corner, ivec3(0), last), 0);
        vec3 tent = mix(1.0 - part, part, vec3(corner));
        float weight = tent.x * tent.y * tent.z * likeness(here, found.a);
        sum += weight * found.rgb;
        weights += weight;
    }
    imageStore(inscatter_image, texel, vec4(sum / weights, 0.0));
}
