// importance_step.comp -- one iteration: every cell gathers from its six neighbours.
#include "importance.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_READ(0, cells, importance_cell cells[]);
TYN_READ(1, light_other, importance_light light[]);
TYN_WRITE(2, light, importance_light out_light[]);
TYN_UPDATE(3, tracks, vec2 tracks[]);
TYN_ARGS(importance_args args);

const ivec3 beside[4] = ivec3[](ivec3(-1, 0, 0), ivec3(1, 0, 0), ivec3(0, -1, 0), ivec3(0, 1, 0));

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    const int n = int(args.cells), layer = n * n;
    if (any(greaterThanEqual(cell, ivec3(n)))) {
        return;
    }
    // Power, and power times spread. Vacuum is beyond the grid: nothing comes in.
    const int index = (cell.z * n + cell.y) * n + cell.x;
    vec2 along = vec2(0.0), across = vec2(0.0);
    if (cell.z > 0) {
        importance_light from = light[index - layer];
        along += from.ahead * vec2(1.0, from.spread_along);
    }
    if (cell.z < n - 1) {
        importance_light from = light[index + layer];
        along += from.behind * vec2(1.0, from.spread_along);
    }
    for (int i = 0; i < 4; i++) {
        ivec2 other = cell.xy + beside[i].xy;
        if (all(greaterThanEqual(other, ivec2(0))) && all(lessThan(other, ivec2(n)))) {
            importance_light from = light[index + beside[i].y * n + beside[i].x];
            across += from.side * vec2(1.0, from.spread_across);
        }
    }
    importance_cell here = cells[index];
    vec2 hop = here.hop_along;
    along = hop.x * vec2(along.x, along.y + (along.x - along.y) * hop.y);
    hop = here.hop_across;
    across = hop.x * vec2(across.x, across.y + (across.x - across.y) * hop.y);
    float power = along.x + across.x;
    float spread = power > 0.0 ? (along.y + across.y) / power : 1.0;
    vec2 track = tracks[index];
    out_light[index] = importance_leave(here, power, spread, track);
    tracks[index] = track;
}
