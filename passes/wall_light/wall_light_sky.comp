// wall_light_sky.comp -- light of the sky's ordinates that arrives at the walls of a cell past the surfaces, as radiance they
// send out.
//
// Areas as in wall_light_suns.comp. What passes the surfaces and the medium is that of the cell, which is on the lit side of the
// walls if its centre is.
#include "wall_light_args.h"
#include "shaders/surfaces/surface_args.h"
#define MEDIUM_BLOCK 0
#define COLUMNS_AT 1
#include "shaders/medium/medium.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"
#include "shaders/walls/walls_triangle.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 1) const uint whole = 0u; // 1: the sky's mean was not split off
TYN_ARGS(wall_light_args args);
#define SKY_SEEN_AT 3
#include "shaders/light/sky_seen.glsl"
#define GEOMETRY_AT 5
#include "shaders/surfaces/surfaces.glsl"
TYN_READ(9, wall_links, uint links[]);
TYN_READ(10, wall_cells, wall_cell wall_cells[]);
TYN_READ(11, hits, uint hits[]);
TYN_WRITE(12, wall_light, vec3 wall_light[]);
#include "shaders/walls/walls_place.glsl"

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(c, ivec3(args.dims)))) {
        return;
    }
    uint i = walls_cell_index(c), cells = args.dims.x * args.dims.y * args.dims.z, cut = links[i];
    vec3 sides[6]; // areas over dx^2 times normals, towards the cell
    uint num_sides = 0u;
    for (uint link = 0u; link < 6u; link++) {
        if ((cut >> link & 1u) != 0u) {
            walls_triangle t = walls_triangle_at(hits[link * cells + i] & 0xffffffu);
            vec3 n = normalize(t.normal);
            float rise = -dot(n, vec3(walls_step(link)));
            sides[num_sides++] = rise * n;
        }
    }
    vec3 sum = vec3(0.0);
    uint count = num_sides > 0u ? min(ordinates.count, uint(TYN_ORDINATES_MAX)) : 0u;
    for (uint n = 0u; n < count; n++) {
        ordinate o = ordinates.list[n];
        float share = sky_seen_share(n + 1u, uvec3(c), args.dims), across = 0.0;
        for (uint k = 0u; k < num_sides; k++) {
            across += max(-dot(o.direction, sides[k]), 0.0);
        }
        if (share * across > 0.0) {
            beam_tau tau = columns_tau(n, uvec3(c), args.dims);
            vec3 light = whole == 1u ? o.irradiance : sky_whole_irradiance(o);
            sum += share * across * o.mean_cosine * light * exp(-(tau.a + tau.p));
        }
    }
    float area = wall_cells[i].area;
    wall_light[i] = area > 0.0 ? wall_cells[i].albedo * sum / (LATTICE_4PI * area) : vec3(0.0);
}
