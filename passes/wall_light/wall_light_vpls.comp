// wall_light_vpls.comp -- light of virtual point lights (VPLs) that arrives at the walls of a cell.
//
// Areas as in wall_light_suns.comp. Links that meet surfaces of about the same normal are taken together, at their mean
// place. 1 / r^2 is bounded by the disc that a VPL stands for and by half a cell. Whether a VPL is seen is
// asked of the lattice, which no light leaks through.
#include "wall_light_args.h"
#include "shaders/surfaces/surface_args.h"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#define WALLS_AT 9
#define WALLS_STORAGE
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/walls/walls_triangle.glsl"

layout(local_size_x = WALL_LIGHT_GROUP) in; // through the list
TYN_ARGS(wall_light_args args);
#define GEOMETRY_AT 5
#include "shaders/surfaces/surfaces.glsl"
TYN_READ(11, hits, uint hits[]);
TYN_WRITE(12, arrived, vec3 arrived[]); // irradiance, W/m^2, times the area over dx^2
TYN_READ(13, list, wall_light_list list; uint list_entries[]);
layout(constant_id = 1) const uint rooms = 0;
#define LATTICE_ROOMS 14
#include "shaders/walls/lattice_rooms.glsl"

#include "shaders/walls/walls_place.glsl"

const uint SIDES = 4u;

struct wall_side {
    vec3 normal, place; // sums over links; M, m
    float area;
};

// As walls_visible; `index` is that of cell a.
bool sees(ivec3 a, uint index, ivec3 b)
{
    ivec3 dims = ivec3(args.dims), at = a;
    vec3 way = vec3(b - a);
    float n = max(abs(way.x), max(abs(way.y), abs(way.z)));
    bool open = true, inside = true;
    for (float i = 1.0; i <= n && open && inside; i += 1.0) {
        ivec3 next = a + ivec3(floor(way * (i / n) + 0.5)), d = next - at;
        open = (list_entries[index] >> uint(13 + d.x + 3 * d.y + 9 * d.z) & 1u) == 0u;
        index += uint(d.x + dims.x * (d.y + dims.y * d.z));
        inside = all(lessThan(uvec3(next), args.dims));
        at = next;
    }
    return open;
}

void main()
{
    if (gl_GlobalInvocationID.x >= list.count) {
        return;
    }
    uint cells = args.dims.x * args.dims.y * args.dims.z, i = list_entries[cells + gl_GlobalInvocationID.x];
    ivec3 c = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / (args.dims.x * args.dims.y));
    uint cut = wall_links[i];
    vec3 sum = vec3(0.0);
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    wall_side sides[SIDES];
    uint num_sides = 0u;
    for (uint link = 0u; link < 6u; link++) {
        if ((cut >> link & 1u) == 0u) {
            continue;
        }
        walls_triangle t = walls_triangle_at(hits[link * cells + i] & 0xffffffu);
        vec3 d = vec3(walls_step(link)), n = normalize(t.normal);
        float rise = -dot(n, d);
        float where = abs(rise) > 1e-6 ? clamp(dot(n, vec3(c) - t.a) / rise, 0.0, 1.0) : 0.5;
        vec3 p = lattice_to_m(box, vec3(c) + where * d + 0.5 + shift);
        n = rise < 0.0 ? -n : n;
        float a = abs(rise); // of the wall, over dx^2
        uint k = 0u;
        while (k < num_sides && dot(sides[k].normal, n) < 0.95 * sides[k].area) {
            k++;
        }
        k = min(k, SIDES - 1u);
        if (a <= 1e-6) {
            continue;
        }
        if (k == num_sides) {
            sides[num_sides++] = wall_side(vec3(0.0), vec3(0.0), 0.0);
        }
        sides[k].normal += a * n;
        sides[k].place += a * p;
        sides[k].area += a;
    }
    for (uint k = 0u; k < num_sides; k++) {
        sides[k].normal = normalize(sides[k].normal);
        sides[k].place /= max(sides[k].area, 1e-6);
    }
    // First which VPLs are seen, then their light: threads that run together each go through their own, which are few.
    for (uint first = radial_num_lamps; first < radial_count; first += 32u) {
        uint seen = 0u, last = min(radial_count - first, 32u);
        for (uint k = 0u; k < last; k++) {
            light_block light = radials[first + k].light;
            bool faces = false;
            for (uint side = 0u; side < num_sides; side++) {
                vec3 away = sides[side].place - light.position;
                faces = faces || dot(away, sides[side].normal) < 0.0 && dot(away, light.direction) > 0.0;
            }
            ivec3 from = walls_cell_before(box, light.position, light.direction);
            if (rooms == 1) {
                faces = rooms_cell_before(box.dims, first + k - radial_num_lamps, from) && faces;
            }
            seen |= faces && sees(c, i, from) ? 1u << k : 0u;
        }
        for (; seen != 0u; seen &= seen - 1u) {
            radial_grid grid = radials[first + findLSB(seen)]; // once: some devices read buffers slowly
            float least = max(grid.light.radius * grid.light.radius, 0.25 * box.dx * box.dx);
            for (uint k = 0u; k < num_sides; k++) {
                vec3 away = sides[k].place - grid.light.position;
                float r2 = dot(away, away), r = sqrt(r2), cosine = -dot(away, sides[k].normal) / max(r, 1e-20);
                float share = max(cosine, 0.0) * radial_share_of(grid.light, away, r);
                beam_tau tau = radial_tau(radial_place_in(grid, away, r));
                vec3 light = grid.light.color * (sides[k].area * share / max(r2, least) * exp(-(tau.a + tau.p)));
                sum += share > 0.0 ? light : vec3(0.0);
            }
        }
    }
    arrived[i] = sum;
}
