// shdom_view_peaks.comp -- adds what a cell scatters on in forward peaks, of the light behind it that goes to the eye.
#include "shaders/common/scene_args.h"
#include "shdom_view_args.h"
#include "shaders/common/camera.glsl"
#include "shaders/lattice/lattice.glsl"
#include "../common/delta_bands.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(shdom_view_args args);
TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, camera, camera_block camera);
layout(binding = 2) uniform sampler3D cells;
layout(binding = 3) uniform sampler3D towards;
layout(binding = 4) uniform sampler3D extinction;
layout(binding = 5) uniform sampler3D scattered;
layout(binding = 6, rgba32f) uniform writeonly image3D seen;

// Radiance that arrives at p, in cells, along v: steps of half a cell back to the box.
vec3 arriving(const lattice_box box, vec3 p, vec3 v)
{
    vec3 size = vec3(args.dims);
    vec2 way = ray_box(p, ray_inverse(-v), vec3(0.0), size);
    int steps = clamp(int(ceil(2.0 * way.y)), 1, 1024);
    float step = max(way.y, 0.0) / float(steps);
    vec3 light = vec3(0.0), through = vec3(1.0);
    for (int i = 0; i < steps; i++) {
        vec3 uvw = (p - (float(i) + 0.5) * step * v) / size;
        vec3 tau = step * box.dx * textureLod(extinction, uvw, 0.0).rgb, e = exp(-tau);
        vec3 mean = mix((1.0 - e) / max(tau, vec3(1e-3)), 1.0 - 0.5 * tau, lessThan(tau, vec3(1e-3)));
        light += through * mean * (step * box.dx) * textureLod(towards, uvw, 0.0).rgb;
        through *= e;
    }
    return light;
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = ivec3(args.dims);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 v = camera.origin - lattice_to_m(box, vec3(c) + 0.5);
    v = camera_select(camera, -camera.forward, v / max(length(v), 1e-20));
    vec3 sent = texelFetch(scattered, c, 0).rgb, behind = arriving(box, vec3(c) + 0.5, v), sum = vec3(0.0);
    bool any_medium = false;
    for (uint ch = 0u; ch < args.channels; ch++) {
        bands_medium m = bands_medium_of(texelFetch(cells, c + ivec3(0, 0, int(ch) * dims.z), 0), args.bands);
        any_medium = any_medium || m.sigma_s > 0.0;
        sum[ch] = m.sigma_s > 0.0 ? sent[ch] / m.sigma_s + m.f * behind[ch] : 0.0;
    }
    imageStore(seen, c, vec4(sum, any_medium ? 1.0 : 0.0));
}
