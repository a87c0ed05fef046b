// walls_beyond.comp -- cuts the links that lead out of the lattice towards surfaces close by.
//
// A link stands for the tube around it: it is cut if most rays of four places in the cell meet something, so that a leaf beside
// a cloud cuts none.
#include "walls_beyond_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/lattice/cell_places.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 0) const uint inner = 0u; // 1: there are walls in the lattice
TYN_ARGS(walls_beyond_args args);
#define GEOMETRY_AT 0
#define MATERIALS_AT 4
#include "shaders/surfaces/reflectance.glsl"
#include "shaders/surfaces/surface_texture.glsl"
#include "shaders/surfaces/surface_trace.glsl"
TYN_READ(7, inner_links, uint inner_links[]);
TYN_READ(8, inner_cells, wall_cell inner_cells[]);
TYN_WRITE(9, wall_links, uint wall_links[]);
TYN_WRITE(10, wall_cells, wall_cell wall_cells[]);

const uint RAYS = 4u, MOST = 3u;

// What of the light of a diffuse surface of the normal `n` goes back through the faces that a step leaves the lattice by
// (`outwards`): (1 + cos) / 2 to the half space behind a face, the mean of the faces.
float share_back(vec3 n, vec3 outwards)
{
    return 0.5 - 0.5 * dot(n, outwards) / dot(outwards, outwards);
}

// Does the link's tube from the cell at `centre` (M, m) end on surfaces? `albedo`: what they send back into the lattice.
bool ends_beyond(vec3 centre, vec3 step, vec3 outwards, float dx, out vec3 albedo)
{
    vec3 d = normalize(step), sum = vec3(0.0);
    float length = (0.5 * dx + args.reach) * length(step);
    uint hits = 0u;
    for (uint k = 0u; k < RAYS && hits + (RAYS - k) >= MOST; k++) {
        surface_hit hit = surface_hit(length, SURFACE_NONE, vec2(0.0));
        surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, centre + dx * place_in_cell(k)),
                                           surface_turn(surfaces.to_world, d), SURFACE_NONE);
        if (surface_trace_world(ray, false, hit)) {
            uvec4 t = surface_triangle_at(hit.triangle);
            vec3 n = surface_point_at(hit.triangle, hit.barycentric).normal;
            sum += share_back(dot(n, d) > 0.0 ? -n : n, outwards) *
                   surface_reflected(surface_material_at(t.w), surface_colour_over(t, hit.barycentric, dx * dx));
            hits++;
        }
    }
    albedo = sum / float(max(hits, 1u));
    return hits >= MOST;
}

void main()
{
    uvec3 c = gl_GlobalInvocationID;
    if (any(greaterThanEqual(c, args.dims))) {
        return;
    }
    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    uint i = (c.z * args.dims.y + c.y) * args.dims.x + c.x, cut = 0u;
    wall_cell cell = wall_cell(vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)), vec3(0.0), 0.0);
    if (inner == 1u) {
        cut = inner_links[i];
        cell = inner_cells[i];
    }
    bool outer = any(equal(c, uvec3(0))) || any(equal(c, args.dims - 1u));
    if (outer && !(args.shining == 1u && cell.area > 0.0)) {
        vec3 centre = lattice_to_m(box, vec3(c) + 0.5), all = cell.area * cell.albedo;
        float area = cell.area;
        for (uint link = 0u; link < 14u; link++) {
            ivec3 step = lattice_step(link), to = ivec3(c) + step;
            vec3 outwards = vec3(greaterThanEqual(to, ivec3(args.dims))) - vec3(lessThan(to, ivec3(0)));
            bool leaves = any(notEqual(outwards, vec3(0.0)));
            vec3 albedo;
            if (leaves && (cut >> link & 1u) == 0u && ends_beyond(centre, vec3(step), outwards, box.dx, albedo)) {
                float a = lattice_share(link);
                cut |= 1u << link;
                area += a;
                all += a * albedo;
            }
        }
        cell.area = area;
        cell.albedo = area > 0.0 ? clamp(all / area, vec3(0.0), vec3(1.0)) : vec3(0.0);
    }
    wall_links[i] = cut;
    wall_cells[i] = cell;
}
