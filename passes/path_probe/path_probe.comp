// path_probe.comp -- samples of the light field at points: each thread follows some paths from one point, in
// all directions.
#include "shaders/path/path_args.h"

const bool PROBE = true;
#include "shaders/path/path_resources.glsl"

TYN_READ(18, points, vec3 points[]);
TYN_WRITE(19, partials, path_probe_partial partials[]);
TYN_UPDATE(20, counters, counters_block counters);

#include "shaders/path/path.glsl"
#include "shaders/path/path_heading.glsl"

path_probe_partial partial;
vec3 point;
vec3 direct, direct_heading; // irradiance from lamps and suns, and where it comes from

bool path_next(inout uint element, inout uint first, inout uint end)
{
    return false;
}

void path_begin(inout rng_state rng, vec2 random, out vec3 origin, out vec3 direction)
{
    origin = point;
    direction = heading_draw(point, vec3(0.0), rng);
    direct = vec3(0.0);
    direct_heading = vec3(0.0);
}

void path_direct(vec3 direction, vec3 irradiance)
{
    direct = irradiance;
    direct_heading = direction;
}

// Running mean and sum of squared deviations of one value.
void add_value(uint i, float value, float share)
{
    float delta = value - partial.mean[i];
    partial.mean[i] += delta * share;
    partial.deviation[i] += delta * (value - partial.mean[i]);
}

void path_end(const path_result result)
{
    vec3 radiance = result.radiance + result.reflected;
    if ((FLAGS & TYN_PATH_SCATTERED) == 0u) {
        radiance += result.background;
    }
    vec3 fluence = radiance / heading_pdf;
    partial.count++;
    float share = 1.0 / float(partial.count);
    for (uint c = 0u; c < 3u; c++) {
        add_value(c, fluence[c] + direct[c], share);
        // Light travels against the path. Net flux along axis a: minus the component of `heading`.
        for (uint a = 0u; a < 3u; a++) {
            float flux = -(fluence[c] * dot(heading, args.world[a]) +
                           direct[c] * dot(direct_heading, args.world[a]));
            add_value(3u + 3u * a + c, flux, share);
        }
    }
}

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    path_load();
    if (thread >= args.num * args.slots) {
        return;
    }
    uint element = args.first + thread / args.slots, slot = thread % args.slots;
    point = points[element];
    for (uint i = 0u; i < TYN_PATH_PROBE_VALUES; i++) {
        partial.mean[i] = 0.0;
        partial.deviation[i] = 0.0;
    }
    partial.count = 0u;
    uint each = args.num_samples / args.slots, more = args.num_samples % args.slots;
    uint first = args.first_sample + slot * each + min(slot, more);
    path_run(element, first, first + each + (slot < more ? 1u : 0u));
    partials[thread] = partial;
    path_tally(slot == 0u && path_count.hits > 0u ? 1u : 0u);
}
