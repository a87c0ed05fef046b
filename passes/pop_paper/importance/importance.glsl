// importance.glsl -- the grid in the camera's pyramid, and directions of the importance map.
// No bindings.
#include "shaders/common/scene_args.h"
#include "../common/propagate_hop.glsl"
#include "importance_args.h"

const float IMPORTANCE_PI = 3.14159265358979;

// ---- placing the grid -----------------------------------------------------------------------------

// Position in camera coordinates: along right, up, forward.
vec3 importance_camera_vector(const importance_grid grid, vec3 v)
{
    return vec3(dot(grid.right, v), dot(grid.up, v), dot(grid.forward, v));
}

// How much wider a pencil of rays is at depth z than (s, t) say.
float importance_widening(const importance_grid grid, float z)
{
    return grid.orthographic != 0u ? 1.0 : z;
}

// Around what the camera sees of the box [0, extent], and as much of it beside the picture as light
// can take a detour through.
importance_grid importance_grid_of(const camera_block camera, vec3 extent)
{
    importance_grid grid;
    grid.origin = camera.origin;
    grid.right = camera.right;
    grid.up = camera.up;
    grid.forward = camera.forward;
    grid.orthographic = camera.orthographic;
    vec2 half_window = vec2(camera.half_width, camera.half_height);
    grid.window_low = (camera.shift - 1.0) * half_window;
    grid.window_high = (camera.shift + 1.0) * half_window;

    vec3 corners[8];
    grid.near = 1e30;
    grid.far = -1e30;
    for (int i = 0; i < 8; i++) {
        vec3 corner = vec3(i & 1, i >> 1 & 1, i >> 2) * extent;
        corners[i] = importance_camera_vector(grid, corner - grid.origin);
        grid.near = min(grid.near, corners[i].z);
        grid.far = max(grid.far, corners[i].z);
    }
    // Nearer layers than that would be of no width, with the camera in the medium.
    grid.near = max(grid.near, grid.orthographic != 0u ? 0.0 : max(grid.far, 0.0) / 32.0);
    grid.empty = grid.far > grid.near ? 0u : 1u;
    grid.octaves = grid.orthographic != 0u ? 0.0 : max(log2(max(grid.far, 1e-30) / max(grid.near, 1e-30)), 1e-6);

    // The edges of the box, cut at the near plane: s and t are monotone along each.
    grid.low = vec2(1e30);
    grid.high = vec2(-1e30);
    for (int i = 0; i < 8; i++) {
        for (int axis = 0; axis < 3; axis++) {
            vec3 a = corners[i], b = corners[i | 1 << axis];
            if (a.z < grid.near && b.z < grid.near) {
                continue;
            }
            if (a.z < grid.near) {
                a = mix(b, a, (b.z - grid.near) / (b.z - a.z));
            } else if (b.z < grid.near) {
                b = mix(a, b, (a.z - grid.near) / (a.z - b.z));
            }
            vec2 at_a = a.xy / importance_widening(grid, max(a.z, grid.near));
            vec2 at_b = b.xy / importance_widening(grid, max(b.z, grid.near));
            grid.low = min(grid.low, min(at_a, at_b));
            grid.high = max(grid.high, max(at_a, at_b));
        }
    }
    if (grid.orthographic == 0u) { // a box close by is seen under all angles: not beyond 63 degrees
        grid.low = max(grid.low, min(grid.window_low, vec2(-2.0)));
        grid.high = min(grid.high, max(grid.window_high, vec2(2.0)));
    }
    if (any(lessThanEqual(min(grid.high, grid.window_high), max(grid.low, grid.window_low)))) {
        grid.empty = 1u;
    }
    return grid;
}

// Depth of a layer in [0, 1] of the grid, and back. Layers of a pyramid grow with their width.
float importance_depth(const importance_grid grid, float layer)
{
    return grid.orthographic != 0u ? mix(grid.near, grid.far, layer)
                                   : grid.near * exp2(grid.octaves * layer);
}

float importance_layer(const importance_grid grid, float z)
{
    z = max(z, grid.near);
    return grid.orthographic != 0u ? (z - grid.near) / (grid.far - grid.near)
                                   : log2(z / grid.near) / grid.octaves;
}

// Camera coordinates -> grid [0, 1]^3; what is before the first layer is in it.
vec3 importance_from_camera(const importance_grid grid, vec3 p)
{
    vec2 at = p.xy / importance_widening(grid, max(p.z, grid.near));
    return vec3((at - grid.low) / (grid.high - grid.low), importance_layer(grid, p.z));
}

// ---- one hop ----------------------------------------------------------------------------------------
//
// Elek et al. 2014, Eqs 2-6. A hop is half the way in either cell, so each does its half once for all
// neighbours. Cells hold power, so the growing width of the columns needs no account.

// What a cell of power `power` and mean cosine 1 - spread hands on; adds its way to the track: half a
// hop in, half a hop out.
importance_light importance_leave(const importance_cell cell, float power, float spread, inout vec2 track)
{
    vec4 state = propagate_state(power, spread, PROPAGATE_CONE);
    float way = power * mix(cell.along, cell.across, 4.0 * state.z);
    track += vec2(way, way * spread);
    vec2 along = cell.hop_along, across = cell.hop_across;
    return importance_light(propagate_part(state, 1) * along.x, propagate_part(state, 0) * across.x,
                            propagate_part(state, -1) * along.x, spread + (1.0 - spread) * along.y,
                            spread + (1.0 - spread) * across.y);
}

// ---- directions of the map ----------------------------------------------------------------------------

// Centre of a texel, the inverse of environment_uv; unit, M.
vec3 importance_direction(uint texel)
{
    float azimuth = (float(texel % TYN_IMPORTANCE_WIDTH) + 0.5) * 2.0 * IMPORTANCE_PI /
                        float(TYN_IMPORTANCE_WIDTH) - IMPORTANCE_PI;
    float polar = (float(texel / TYN_IMPORTANCE_WIDTH) + 0.5) * IMPORTANCE_PI /
                  float(TYN_IMPORTANCE_HEIGHT);
    return vec3(sin(polar) * sin(azimuth), cos(polar), -sin(polar) * cos(azimuth));
}

// Part of the sphere that a texel of row `row` is; all of them sum to 1.
float importance_share(uint row)
{
    float step = IMPORTANCE_PI / float(TYN_IMPORTANCE_HEIGHT);
    return 0.5 * (cos(float(row) * step) - cos(float(row + 1u) * step)) /
           float(TYN_IMPORTANCE_WIDTH);
}
