// light_list_shades.comp -- the directions of the sky that each light stands for: one group.
//
// A thread a direction finds the light that is nearest to it; then one a light gathers its own, in their order.
#include "light_list_args.h"
#include "../common/light_shades_args.h"
#include "shaders/light/ordinate_args.h"

layout(local_size_x = 256) in;
TYN_ARGS(light_list_args args);
TYN_READ(0, light_list, light_list_block light_list);
TYN_READ(1, directions, ordinates_block directions);
TYN_WRITE(2, light_shades, light_shades_block light_shades);

shared uint nearest[TYN_ORDINATES_MAX];   // the light
shared float power[TYN_ORDINATES_MAX];    // of the direction
shared uint firsts[TYN_LIGHT_LIST_MAX + 1]; // counts, then where each light's shades begin

const uint NONE = 0xffffffffu;

uint directions_in_use()
{
    return min(directions.count, uint(TYN_ORDINATES_MAX));
}

// Of direction k: the distant light of the environment that is nearest to it.
uint light_nearest(uint k, uint stars)
{
    const vec3 d = directions.list[k].direction;
    uint best = NONE;
    float most = -2.0;
    for (uint n = 0u; n < stars; n++) {
        const float cosine = dot(d, light_list.lights[n].direction);
        best = cosine > most ? n : best;
        most = max(most, cosine);
    }
    return best;
}

// Of light n: the direction nearest to it.
uint direction_nearest(uint n, uint count)
{
    uint best = directions.num_fixed;
    float most = -2.0;
    for (uint k = directions.num_fixed; k < count; k++) {
        const float cosine = dot(directions.list[k].direction, light_list.lights[n].direction);
        best = cosine > most ? k : best;
        most = max(most, cosine);
    }
    return best;
}

void main()
{
    const uint i = gl_LocalInvocationIndex, lights = min(light_list.count, uint(TYN_LIGHT_LIST_MAX));
    const uint stars = lights - min(lights, args.num_suns + args.num_lamps), count = directions_in_use();
    const uint own = min(directions.num_fixed, count); // directions of suns
    nearest[i] = NONE;
    if (i < count) {
        // Suns without shadow maps are the last ones.
        nearest[i] = i < own ? stars + args.num_suns - own + i : light_nearest(i, stars);
        power[i] = max(dot(directions.list[i].irradiance, vec3(1.0)), 0.0) + 1e-30;
    }
    barrier();
    if (i < lights) {
        uint found = 0u;
        for (uint k = 0u; k < count; k++) {
            found += nearest[k] == i ? 1u : 0u;
        }
        firsts[i] = found == 0u && i < stars && count > own ? 1u : found;
    }
    barrier();
    if (i == 0u) {
        uint sum = 0u;
        for (uint n = 0u; n < lights; n++) {
            const uint next = sum + firsts[n];
            firsts[n] = sum;
            sum = next;
        }
        firsts[lights] = sum;
    }
    barrier();
    if (i >= lights) {
        return;
    }
    light_shades_range of_light;
    of_light.first = firsts[i];
    of_light.count = firsts[i + 1u] - firsts[i];
    of_light.pad = uvec2(0u);
    light_shades.lights[i] = of_light;
    float sum = 0.0;
    for (uint k = 0u; k < count; k++) {
        sum += nearest[k] == i ? power[k] : 0.0;
    }
    uint at = of_light.first;
    for (uint k = 0u; k < count; k++) {
        if (nearest[k] == i) {
            const ordinate o = directions.list[k];
            light_shades.shades[at++] = light_shade(k, power[k] / sum, uvec2(0u), o.direction, o.mean_cosine);
        }
    }
    if (sum == 0.0 && of_light.count > 0u) {
        const light_block own_light = light_list.lights[i];
        light_shades.shades[at] = light_shade(direction_nearest(i, count), 1.0, uvec2(0u), own_light.direction,
                                              own_light.mean_cosine);
    }
}
