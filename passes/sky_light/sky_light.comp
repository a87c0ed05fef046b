// sky_light.comp -- gives each ordinate the environment's light; a thread per ordinate.
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "sky_light_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(sky_light_args args);
TYN_UNIFORM(0, environment, env_block environment);
TYN_UNIFORM(1, ordinates, ordinates_block ordinates);
TYN_WRITE(2, lit, uint count; uint num_fixed; uvec2 pad; ordinate list[]);

void main()
{
    const uint n = gl_GlobalInvocationID.x;
    if (n == 0u) {
        count = ordinates.count;
        num_fixed = ordinates.num_fixed;
        pad = uvec2(0u);
    }
    if (n < args.num_fixed || n >= TYN_ORDINATES_MAX) {
        return;
    }
    ordinate o = ordinates.list[n];
    o.irradiance *= environment.radiance;
    o.irradiance -= args.split != 0u ? environment.sky * o.solid_angle : vec3(0.0);
    list[n] = o;
}
