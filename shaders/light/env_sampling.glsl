// env_sampling.glsl -- draws directions in proportion to the brightness of the environment map.
//
// The includer declares `env_table` (env_table_block) and `env_cells[]` (env_cell). The pdf is constant
// in a cell of the map's unit square; d(solid angle) = 2 pi^2 sin(theta) du dv.
#ifndef TYN_ENV_SAMPLING_GLSL
#define TYN_ENV_SAMPLING_GLSL
#include "env_args.h"
#include "environment.glsl"

const float ENV_SQUARE_TO_SPHERE = 19.7392088; // 2 pi^2

// pdf per steradian of drawing `d_M` (unit, outwards).
float env_pdf(const env_block env, vec3 d_M)
{
    vec3 d = environment_map_direction(env, d_M);
    vec2 uv = environment_uv(d);
    uvec2 size = uvec2(env_table.width, env_table.height);
    uvec2 cell = min(uvec2(uv * vec2(size)), size - 1u);
    float sin_theta = sqrt(max(1.0 - d.y * d.y, 1e-12));
    return env_cells[cell.y * size.x + cell.x].density / (ENV_SQUARE_TO_SPHERE * sin_theta);
}

vec3 env_sample(const env_block env, uvec4 bits, out float pdf)
{
    uvec2 size = uvec2(env_table.width, env_table.height);
    uint high, low;
    umulExtended(bits.x, size.x * size.y, high, low); // floor(u * count), with all 32 bits of u
    env_cell cell = env_cells[high];
    uint index = high;
    float density = cell.density;
    if (float(bits.y) * (1.0 / 4294967296.0) >= cell.keep) {
        index = cell.alias;
        density = env_cells[index].density;
    }
    vec2 within = (vec2(bits.zw >> 8) + 0.5) * (1.0 / 16777216.0);
    vec2 uv = (vec2(index % size.x, index / size.x) + within) / vec2(size);
    float theta = 3.14159265359 * uv.y, phi = 6.28318530718 * (uv.x - 0.5);
    float sin_theta = sin(theta);
    vec3 d = vec3(sin_theta * sin(phi), cos(theta), -sin_theta * cos(phi));
    pdf = density / (ENV_SQUARE_TO_SPHERE * max(sin_theta, 1e-6));
    // Back to the medium frame: the rows are orthonormal.
    return d.x * env.rows[0].xyz + d.y * env.rows[1].xyz + d.z * env.rows[2].xyz;
}

#endif
