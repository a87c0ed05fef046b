// radial_lights.comp -- see radial_lights.h; one thread a light.
#include "shaders/beams/radial_args.h"

layout(local_size_x = 64) in;
TYN_READ(0, grids, uint count; uint num_lamps; uvec2 pad; radial_grid list[]) of;
TYN_READ(1, colors, vec4 colors[]);
TYN_WRITE(2, radials, uint count; uint num_lamps; uvec2 pad; radial_grid list[]) to;

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i == 0u) {
        to.count = of.count;
        to.num_lamps = of.num_lamps;
        to.pad = of.pad;
    }
    // What is beyond the lights that there are is not read.
    if (i < of.count) {
        radial_grid grid = of.list[i];
        if (i < of.num_lamps) {
            grid.light.color = colors[i].rgb;
        }
        to.list[i] = grid;
    }
}
