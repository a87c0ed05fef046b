// photon_view.comp -- what the cache's light scatters towards the eye, per sigma_s.
//
// Light in a Henyey-Greenstein lobe of g' about a direction is scattered, by a medium of g, into one of g g' (Elek et al. 2012,
// App. C).
#include "photon_view_args.h"
#include "shaders/common/counters.h"
#define MEDIUM_AT 0
#include "shaders/medium/medium.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(photon_view_args args);
TYN_UNIFORM(5, camera, camera_block camera);
layout(binding = 6) uniform sampler3D fluence_tex;
layout(binding = 7) uniform sampler3D way_tex;
layout(binding = 8, rgba32f) uniform writeonly image3D inscatter_image;
TYN_UPDATE(9, counters, counters_block counters);

// Of a lobe of the mean cosine `cosine` about `axis`, 1/sr.
vec3 scattered(vec3 g, float cosine, vec3 axis, vec3 v)
{
    vec3 apart = v - axis;
    float one_minus_mu = 0.5 * dot(apart, apart);
    return vec3(hg_near(g.x * cosine, one_minus_mu), hg_near(g.y * cosine, one_minus_mu), hg_near(g.z * cosine, one_minus_mu));
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    ivec3 c = clamp(texel - 1, ivec3(0), dims - 1);
    vec3 p = clamp(lattice_to_m(lattice_box_of(medium.extent, dims), vec3(c) + 0.5), vec3(0.0), medium.extent);
    vec3 v = camera.origin - p;
    v = camera_select(camera, -camera.forward, v / max(length(v), 1e-20));
    phase kinds[3] = medium_sample(p).phase;
    vec3 g = min(args.scaled == 1u ? delta_cosine(kinds) : phase_mean_cosine(kinds), vec3(HG_MAX));
    vec3 sum = vec3(0.0);
    for (uint lobe = 0u; lobe < args.lobes; lobe++) {
        ivec3 at = c + ivec3(0, 0, int(lobe) * dims.z);
        vec3 light = texelFetch(fluence_tex, at, 0).rgb, way = texelFetch(way_tex, at, 0).xyz;
        bool sun = lobe < args.suns;
        float narrow = sun && args.sun_is == PHOTON_LOBE_AXIS ? dot(way, args.sun) : length(way);
        vec3 axis = sun && args.sun_is == PHOTON_LOBE_AXIS ? args.sun : way / max(narrow, 1e-20);
        if (abs(narrow) > 1e-6 && (sun || args.sky_is == PHOTON_LOBE_FLUX)) {
            sum += light * scattered(g, narrow, axis, v);
        } else {
            sum += light * (0.25 / HG_PI);
        }
    }
    if (any(isnan(sum)) || any(isinf(sum))) {
        sum = vec3(0.0);
        atomicAdd(counters.non_finite, 1u);
    }
    imageStore(inscatter_image, texel, vec4(sum, 0.0));
}
