// path_trace.comp -- samples of an image: each thread follows some paths of one pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path/path_args.h"

const bool PROBE = false;
#include "shaders/path/path_resources.glsl"

TYN_UNIFORM(16, camera, camera_block camera_in);
TYN_WRITE(17, partials, path_partial partials[]);
TYN_UPDATE(18, counters, counters_block counters);
TYN_WRITE(19, layers, path_partial_layers layers[]);

#include "shaders/path/path.glsl"

// Welford's running mean and sum of squared deviations: exact 0 for equal samples, however many.
path_partial partial = path_partial(vec3(0.0), vec3(0.0), 0.0, 0u);
path_partial_layers partial_layers = path_partial_layers(vec3(0.0), vec3(0.0), vec3(0.0));
camera_block camera; // in registers, as path_load has it
uvec2 pixel;

void path_begin(inout rng_state rng, vec2 random, out vec3 origin, out vec3 direction)
{
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + random);
    origin = ray.origin;
    direction = ray.direction;
}

float path_begin_pdf(vec3 direction)
{
    return 0.0;
}

void path_direct(vec3 direction, vec3 irradiance)
{
}

void path_end(path_result result)
{
    bool background = camera.background != 0u;
    vec3 radiance = result.radiance + (background ? result.background + result.reflected : vec3(0.0));
    bool opaque = background && result.solid;
    partial.count++;
    float share = 1.0 / float(partial.count);
    vec3 delta = radiance - partial.mean;
    partial.mean += delta * share;
    partial.deviation += delta * (radiance - partial.mean);
    partial.alpha += ((opaque ? 1.0 : 1.0 - channel_mean(result.transmittance)) - partial.alpha) * share;
    if ((FLAGS & TYN_PATH_LAYERS) != 0u) {
        partial_layers.single += (result.single - partial_layers.single) * share;
        partial_layers.multiple += (result.radiance - result.single - partial_layers.multiple) * share;
        partial_layers.transmittance += (result.transmittance - partial_layers.transmittance) * share;
    }
}

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    path_load();
    camera = camera_in;
    if (thread >= args.num * args.slots) {
        return;
    }
    uint element = args.first + thread / args.slots, slot = thread % args.slots;
    pixel = uvec2(element % camera.size.x, element / camera.size.x);
    // Samples are dealt out evenly; the earlier slots get one more where they do not divide.
    uint each = args.num_samples / args.slots, more = args.num_samples % args.slots;
    uint first = args.first_sample + slot * each + min(slot, more);
    path_run(element, first, first + each + (slot < more ? 1u : 0u));

    partials[thread] = partial;
    if ((FLAGS & TYN_PATH_LAYERS) != 0u) {
        layers[thread] = partial_layers;
    }
    path_tally(slot);
}
