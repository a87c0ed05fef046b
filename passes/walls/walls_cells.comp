// walls_cells.comp -- of each cell: the albedo its cut links meet, and the planes of its walls.
#include "walls_pass_args.h"
#include "shaders/surfaces/surface_args.h"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"
#include "shaders/walls/walls_triangle.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(walls_pass_args args);
#define GEOMETRY_AT 0
#define MATERIALS_AT 4
#include "shaders/surfaces/reflectance.glsl"
TYN_READ(7, wall_links, uint links[]);
TYN_READ(8, hits, uint hits[]);
TYN_READ(9, nearest, uint nearest[]);
TYN_WRITE(10, wall_cells, wall_cell wall_cells[]);
#include "shaders/walls/walls_place.glsl"
#include "walls_texture.glsl"

// Mean over about a cell around the place where the link from p along d meets triangle i.
vec3 texture_at(uint i, uint index, vec3 p, vec3 d)
{
    walls_triangle t = walls_triangle_at(i);
    float rise = -dot(t.normal, d);
    float where = abs(rise) > 1e-20 ? clamp(dot(t.normal, p - t.a) / rise, 0.0, 1.0) : 0.5;
    vec3 hit = p + where * d - t.a, u = t.b - t.a, v = t.c - t.a;
    float area = dot(t.normal, t.normal);
    vec2 share = vec2(dot(cross(hit, v), t.normal), dot(cross(u, hit), t.normal)) / area;
    mat3x2 uv = surface_uvs(surface_triangle_at(i));
    vec2 size = vec2(surface_texture_at(index).size);
    float texels_per_cell = abs(uv[1].x * uv[2].y - uv[1].y * uv[2].x) * size.x * size.y / sqrt(area);
    return walls_texture(index, uv[0] + share.x * uv[1] + share.y * uv[2], texels_per_cell);
}

vec3 albedo_at(uint i, vec3 p, vec3 d)
{
    surface_material m = surface_material_at(surface_triangle_at(i).w);
    return surface_reflected(m, m.texture != TYN_SURFACE_NO_TEXTURE ? texture_at(i, m.texture, p, d) : vec3(1.0));
}

// In M, m, with the centre on its positive side.
vec4 plane_of(uint i, ivec3 c, const lattice_box box)
{
    walls_triangle t = walls_triangle_at(i);
    vec3 n = normalize(t.normal);
    n = dot(n, vec3(c) - t.a) < 0.0 ? -n : n;
    vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    return vec4(n, -dot(n, lattice_to_m(box, t.a + 0.5 + shift)));
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(c, ivec3(args.dims)))) {
        return;
    }
    uint i = walls_cell_index(c), n = args.dims.x * args.dims.y * args.dims.z, cut = links[i];
    wall_cell cell = wall_cell(vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)), vec3(0.0), 0.0);
    for (uint some = cut & 0x3fffu; some != 0u; some &= some - 1u) {
        uint link = uint(findLSB(some));
        float a = lattice_share(link);
        cell.area += a;
        cell.albedo += a * albedo_at(hits[link * n + i] & 0xffffffu, vec3(c), vec3(walls_step(link)));
    }
    cell.albedo = cell.area > 0.0 ? clamp(cell.albedo / cell.area, vec3(0.0), vec3(1.0)) : vec3(0.0);

    lattice_box box = lattice_box_of(args.extent, ivec3(args.dims));
    uint used = 0u, found = 0u;
    // A cell far from walls has no planes.
    for (uint k = (cut & TYN_WALLS_NEAR) != 0u ? 0u : TYN_WALLS_PLANES; k < TYN_WALLS_PLANES; k++) {
        uint best = 0xffffffffu, slot = 0u;
        for (uint s = 0u; s < WALLS_SLOTS; s++) {
            uint key = (used >> s & 1u) != 0u ? 0xffffffffu : nearest[s * n + i];
            slot = key < best ? s : slot;
            best = min(best, key);
        }
        if (best == 0xffffffffu) {
            break;
        }
        used |= 1u << slot;
        cell.planes[found++] = plane_of(best & 0xffffffu, c, box);
    }
    wall_cells[i] = cell;
}
