// radial_beam_setup.comp -- one thread per light: lays out its grid.
#include "shaders/common/scene_args.h"
#include "shaders/beams/radial_args.h"
#include "radial_beam_args.h"

layout(local_size_x = 64) in;
TYN_ARGS(radial_beam_args args);
TYN_UNIFORM(0, medium, medium_block medium);
TYN_READ(1, lamps, light_block lamps[]);
TYN_READ(2, vpls, radial_vpls vpls);
TYN_WRITE(3, grids, uint count; uint num_lamps; uvec2 pad; radial_grid list[]);

// Tangent of the half angle of the cone around `axis` that holds the box; 1e9 where it is no cone.
float tangent_of_box(vec3 from, vec3 axis)
{
    float most = 0.0;
    for (uint i = 0u; i < 8u; i++) {
        vec3 corner = medium.extent * vec3(i & 1u, i >> 1 & 1u, i >> 2) - from;
        float along = dot(corner, axis), across = length(corner - along * axis);
        most = max(most, along > 1e-6 * across ? across / along : 1e9);
    }
    return most;
}

// Directions of the map: its upper half, which is half of it, goes to the cone of tangent 2 and what little
// lies outside. Flattened along the axis that is any cone.
void point_map(inout radial_grid grid, vec3 axis, float tangent)
{
    float flatness = clamp(0.5 * tangent, 1e-3, 1.0);
    vec3 side = abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    grid.to_map[0] = normalize(cross(side, axis));
    grid.to_map[1] = cross(axis, grid.to_map[0]);
    grid.to_map[2] = flatness * axis;
}

void aim(inout radial_grid grid)
{
    light_block light = grid.light;
    grid.to_map = vec3[3](vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    float c = light.cos_outer, tangent = c > 0.0 ? sqrt(max(1.0 - c * c, 0.0)) / c : 1e9;
    if (light.kind != TYN_LIGHT_KIND_POINT) {
        point_map(grid, light.direction, tangent);
    }
    if (grid.inside == 0u) {
        vec3 axis = normalize(0.5 * medium.extent - light.position);
        float box = tangent_of_box(light.position, axis);
        if (box < tangent || light.kind == TYN_LIGHT_KIND_POINT) {
            point_map(grid, axis, box);
        }
    }
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint most = args.num_lamps + args.max_vpls;
    uint total = args.num_lamps + min(args.max_vpls > 0u ? vpls.count : 0u, args.max_vpls);
    if (i == 0u) {
        count = total;
        num_lamps = args.num_lamps;
        pad = uvec2(0u);
    }
    if (i >= most) {
        return;
    }
    radial_grid grid;
    if (i < args.num_lamps) {
        grid.light = lamps[i];
    } else {
        grid.light = vpls.list[i - args.num_lamps];
    }
    vec3 o = grid.light.position;
    grid.inside = all(greaterThanEqual(o, vec3(0.0))) && all(lessThanEqual(o, medium.extent)) ? 1u : 0u;
    aim(grid);

    uint c = 0u;
    while (c + 1u < RADIAL_CLASSES && i >= args.classes[c].first_light + args.classes[c].count) {
        c++;
    }
    radial_class own = args.classes[c];
    uint tile = i - own.first_light, per_layer = own.per_row * own.per_row;
    grid.cells = own.cells;
    grid.shells = own.shells;
    grid.first = uvec3((own.cells + 2u) * uvec2(tile % own.per_row, tile / own.per_row % own.per_row),
                       own.first_layer + tile / per_layer * (own.shells + 1u));

    // Cells as deep as they are wide where the map has all directions.
    float begin = length(max(max(-o, o - medium.extent), vec3(0.0)));
    float far = length(max(abs(o), abs(o - medium.extent)));
    float near = begin + far / 13.0;
    grid.begin = begin;
    grid.inverse_near = 1.0 / near;
    grid.per_shell = log(1.0 + (far - begin) / near) / float(own.shells);
    vec3 texels = vec3(args.size);
    grid.base = (vec3(grid.first) + vec3(vec2(1.0 + 0.5 * float(own.cells)), 0.5)) / texels;
    grid.scale = vec3(vec2(0.5 * float(own.cells)), 1.0 / grid.per_shell) / texels;
    list[i] = grid;
}
