// columns_average.comp -- the medium averaged over the texels of a coarser grid of the same box. Built twice:
// TYN_DENSITY is defined for mode DENSITY.
//
// The means of sigma_s, sigma_a and (1 - f) sigma_s are those of the medium; g is what makes the last of
// the first. In mode ONE_PHASE f is known from the phase function.
#include "shaders/beams/columns_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/phase/phase.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(columns_average_args args);
#ifdef TYN_DENSITY
layout(binding = 0) uniform sampler3D density;
layout(binding = 1, r32f) writeonly uniform image3D mean_density;
#else
layout(constant_id = 0) const uint medium_mode = TYN_MEDIUM_COEFFICIENTS; // or ONE_PHASE: no g
layout(binding = 0) uniform sampler3D density_tex;
layout(binding = 1) uniform sampler3D sigma_a_tex;
layout(binding = 2) uniform sampler3D g_tex;
layout(binding = 3, rgba32f) writeonly uniform image3D mean_sigma_s;
layout(binding = 4, rgba32f) writeonly uniform image3D mean_sigma_a;
layout(binding = 5, rgba32f) writeonly uniform image3D mean_g;
#endif

uint columns_average_count()
{
    return args.samples.x * args.samples.y * args.samples.z;
}

// Texture coordinate of sample i of a texel.
vec3 columns_average_uvw(uvec3 texel, uint i)
{
    uvec3 s = uvec3(i % args.samples.x, i / args.samples.x % args.samples.y,
                    i / (args.samples.x * args.samples.y));
    return (vec3(texel) + (vec3(s) + 0.5) / vec3(args.samples)) / vec3(args.size);
}

void main()
{
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel, args.size))) {
        return;
    }
#ifdef TYN_DENSITY
    float sum = 0.0;
    for (uint i = 0; i < columns_average_count(); i++) {
        sum += textureLod(density, columns_average_uvw(texel, i), 0.0).r;
    }
    imageStore(mean_density, ivec3(texel), vec4(sum / float(columns_average_count())));
#else
    vec3 sum_s = vec3(0.0), sum_a = vec3(0.0), sum_p = vec3(0.0);
    for (uint i = 0; i < columns_average_count(); i++) {
        vec3 uvw = columns_average_uvw(texel, i);
        vec3 sigma_s = textureLod(density_tex, uvw, 0.0).rgb;
        if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
            phase p[3] = phase_of_mean_cosine(textureLod(g_tex, uvw, 0.0).rgb);
            similarity_clamp(sigma_s, p);
            sum_p += sigma_s * (1.0 - delta_fraction(p));
        }
        sum_s += sigma_s;
        sum_a += textureLod(sigma_a_tex, uvw, 0.0).rgb;
    }
    float norm = 1.0 / float(columns_average_count());
    imageStore(mean_sigma_s, ivec3(texel), vec4(sum_s * norm, 0.0));
    imageStore(mean_sigma_a, ivec3(texel), vec4(sum_a * norm, 0.0));
    if (medium_mode == TYN_MEDIUM_COEFFICIENTS) {
        vec3 f = 1.0 - sum_p / max(sum_s, vec3(1e-30));
        f = mix(vec3(0.0), clamp(f, 0.0, 1.0), greaterThan(sum_s, vec3(0.0)));
        imageStore(mean_g, ivec3(texel), vec4(delta_lobe(f), 0.0));
    }
#endif
}
