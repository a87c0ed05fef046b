// wall_light.comp -- sunlight that arrives at the walls of a cell, as radiance they send out.
//
// Each cut link along an axis stands for |n.axis| dx^2 of the wall that it meets (normal n): a wall of area A is
// met by A |n.axis| / dx^2 links of an axis, so all areas add up to A. What arrives there, times albedo, is the
// power that the walls send out: 4 pi dx^2 area times their radiance (walls_args.h). Light in the forward peak of the
// medium counts as not scattered (delta scaling), as in the lattice.
#include "wall_light_args.h"
#include "shaders/surfaces/surface_args.h"
#define MEDIUM_BLOCK 0
#define BEAMS_AT 2
#define BEAMS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"
#include "shaders/walls/walls_triangle.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(wall_light_args args);
TYN_READ(1, lights, light_block lights[]);
#define GEOMETRY_AT 6
#include "shaders/surfaces/surfaces.glsl"
TYN_READ(10, wall_links, uint links[]);
TYN_READ(11, wall_cells, wall_cell wall_cells[]);
TYN_READ(12, hits, uint hits[]);
TYN_WRITE(13, wall_light, vec3 wall_light[]);
#include "shaders/walls/walls_place.glsl"

// Irradiance of the suns at p (M) on the side n (M, unit).
vec3 sunlight(vec3 p, vec3 n)
{
    vec3 sum = vec3(0.0);
    for (uint sun = 0u; sun < args.num_suns; sun++) {
        float cosine = -dot(lights[sun].direction, n);
        if (cosine > 0.0) {
            beam_tau tau = beam_depth(sun, p);
            sum += cosine * lights[sun].color * exp(-(tau.a + tau.p));
        }
    }
    return sum;
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(c, ivec3(args.dims)))) {
        return;
    }
    uint i = walls_cell_index(c), cells = args.dims.x * args.dims.y * args.dims.z, cut = links[i];
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z), sum = vec3(0.0);
    for (uint link = 0u; link < 6u; link++) {
        if ((cut >> link & 1u) == 0u) {
            continue;
        }
        walls_triangle t = walls_triangle_at(hits[link * cells + i] & 0xffffffu);
        vec3 d = vec3(walls_step(link)), n = normalize(t.normal);
        float rise = -dot(n, d);
        float where = abs(rise) > 1e-6 ? clamp(dot(n, vec3(c) - t.a) / rise, 0.0, 1.0) : 0.5;
        vec3 p = lattice_to_m(box, vec3(c) + where * d + 0.5 + shift);
        sum += abs(rise) * sunlight(p, rise < 0.0 ? -n : n);
    }
    float area = wall_cells[i].area;
    wall_light[i] = area > 0.0 ? wall_cells[i].albedo * sum / (LATTICE_4PI * area) : vec3(0.0);
}
