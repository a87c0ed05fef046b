// path_trace.comp -- samples of an image: each thread follows some paths of one pixel.
#include "shaders/path/path_args.h"

const bool PROBE = false;
#include "shaders/path/path_resources.glsl"

TYN_UNIFORM(18, camera, camera_block camera_in);
TYN_WRITE(19, partials, path_partial partials[]);
TYN_UPDATE(20, counters, counters_block counters);
TYN_WRITE(21, layers, path_partial_layers layers[]);
TYN_UPDATE(22, queue, uint taken);

layout(binding = 23) uniform sampler3D field_red_tex;
layout(binding = 24) uniform sampler3D field_green_tex;
layout(binding = 25) uniform sampler3D field_blue_tex;

layout(binding = 26) uniform sampler3D guide_scattered_tex;
layout(binding = 27) uniform sampler3D guide_beams_tex;

#define PATH_FIELDS
#include "shaders/path/path.glsl"

// Of radiance (fluence + 3 flux . direction) / (4 pi).
vec3 path_field(vec3 at, vec3 way, const media_point m)
{
    const vec3 place = at / medium.extent;
    const vec4 red = textureLod(field_red_tex, place, 0.0), green = textureLod(field_green_tex, place, 0.0),
               blue = textureLod(field_blue_tex, place, 0.0);
    const vec3 along = -vec3(dot(red.yzw, way), dot(green.yzw, way), dot(blue.yzw, way));
    return max(vec3(red.x, green.x, blue.x) + 3.0 * phase_mean_cosine(m.phase) * along, 0.0) * (0.25 / HG_PI);
}

path_guide path_guide_at(vec3 at, vec3 way, float g)
{
    const vec3 place = at / medium.extent;
    return guide_of(textureLod(guide_scattered_tex, place, 0.0), textureLod(guide_beams_tex, place, 0.0), way, g);
}

// Welford's running mean and sum of squared deviations: exact 0 for equal samples, however many.
path_partial partial = path_partial(vec3(0.0), vec3(0.0), 0.0, 0u);
path_partial_layers partial_layers = path_partial_layers(vec3(0.0), vec3(0.0), vec3(0.0));
camera_block camera; // in registers, as path_load has it
uvec2 pixel;

const bool QUEUE = (FLAGS & TYN_PATH_QUEUE) != 0u;
const uint NO_SLOT = 0xffffffffu;
uint slot = NO_SLOT; // that this thread works on, of all pixels
uint of_slots, slots_with_more; // samples of a slot at least; how many of a pixel's slots have one more
uint pixels = 0u;    // whose first slot has met media

// Samples of a pixel are dealt out evenly to its slots; the earlier ones get one more where they do not divide.
void take_slot(uint next, inout uint element, inout uint first, inout uint end)
{
    slot = next;
    partial = path_partial(vec3(0.0), vec3(0.0), 0.0, 0u);
    partial_layers = path_partial_layers(vec3(0.0), vec3(0.0), vec3(0.0));
    uint from = slot / args.slots, part = slot - from * args.slots;
    element = args.first + from;
    uint row = element / camera.size.x;
    pixel = uvec2(element - row * camera.size.x, row);
    first = args.first_sample + part * of_slots + min(part, slots_with_more);
    end = first + of_slots + (part < slots_with_more ? 1u : 0u);
}

void put_slot()
{
    pixels += path_count.hits > 0u && slot % args.slots == 0u ? 1u : 0u;
    path_count.hits = 0u;
    partials[slot] = partial;
    if ((FLAGS & TYN_PATH_LAYERS) != 0u) {
        layers[slot] = partial_layers;
    }
}

// Threads take slots one after another, so that those that run together stay busy until the last is taken. Every
// thread asks for one at least, so none is left.
bool path_next(inout uint element, inout uint first, inout uint end)
{
    if (!QUEUE) {
        return false;
    }
    put_slot();
    slot = NO_SLOT;
    if (path_turns + surface_turns > PATH_TURNS) {
        return false;
    }
    uint next = atomicAdd(taken, 1u);
    if (next >= args.num * args.slots) {
        return false;
    }
    take_slot(next, element, first, end);
    return true;
}

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

void path_end(const path_result result)
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
    path_load();
    camera = camera_in;
    of_slots = args.num_samples / args.slots;
    slots_with_more = args.num_samples % args.slots;
    if (gl_GlobalInvocationID.x >= args.num * args.slots) {
        return;
    }
    uint next = gl_GlobalInvocationID.x;
    if (QUEUE) {
        next = atomicAdd(taken, 1u);
        if (next >= args.num * args.slots) {
            return;
        }
    }
    uint element, first, end;
    take_slot(next, element, first, end);
    path_run(element, first, end);
    if (slot != NO_SLOT) { // without a queue, or a device has ended the loop
        put_slot();
    }
    path_tally(pixels);
}
