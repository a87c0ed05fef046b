// propagate_radial_setup.comp -- one workgroup per light: lays out its grid, and what of its light starts in
// each direction.
#include "../common/propagate_radial.glsl"
#include "propagate_radial_args.h"

layout(local_size_x = PROPAGATE_RADIAL_LANES) in;
TYN_UNIFORM(0, medium, medium_block medium);
TYN_READ(1, lamps, light_block lamps[]);
TYN_READ(2, vpls, radial_vpls vpls);
TYN_WRITE(3, grids, propagate_radial_grid grids[]);
TYN_WRITE(4, places, propagate_radial_place places[]);
TYN_UPDATE(5, map, vec2 map[]);
TYN_ARGS(propagate_radial_args args);

shared float sums[PROPAGATE_RADIAL_LANES];

// The map's +z along `axis`, its upper half filled by a cone of tangent `2 flatness`.
void aim(inout propagate_radial_grid grid, vec3 axis, float flatness)
{
    vec3 side = abs(axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    grid.to_map[0] = normalize(cross(side, axis));
    grid.to_map[1] = cross(axis, grid.to_map[0]);
    grid.to_map[2] = flatness * axis;
}

propagate_radial_grid grid_of(light_block light, bool used)
{
    propagate_radial_grid grid;
    grid.light = light;
    vec3 o = light.position, middle = 0.5 * medium.extent - o;
    float begin = length(max(max(-o, o - medium.extent), vec3(0.0))); // to the box
    float far = length(max(abs(o), abs(o - medium.extent)));          // to its farthest corner
    grid.inside = begin > 0.0 ? 0u : 1u;
    grid.to_map = vec3[3](vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    float flatness = 1.0, reach = 0.5 * length(medium.extent), away = length(middle);
    if (away > reach) { // the box is within a cone; so is all that can be lit
        flatness = clamp(0.5 * reach * inversesqrt((away - reach) * (away + reach)), 1e-4, 1.0);
        aim(grid, middle / away, flatness);
    } else if (light.kind != TYN_LIGHT_KIND_POINT) {
        aim(grid, light.direction, 1.0);
    }
    // A cell of the map is sqrt(4 pi) / cells wide in the mean: shells as deep as that, outwards from the
    // box's farthest corner, as many as there are or as it takes to get to the box.
    float width = flatness * sqrt(4.0 * HG_PI) / float(args.cells), shells = float(args.layers - 1u);
    grid.inner = far * exp(-width * shells);
    if (grid.inner < begin) {
        grid.inner = begin;
        float depth = log(far / begin);
        shells = clamp(ceil(depth / width), 1.0, shells);
        width = max(depth / shells, 1e-6);
    }
    grid.growth = exp(width);
    grid.layers = used ? uint(shells) + 1u : 0u;
    // A disc at half the way to the farthest corner: a cap's mean cosine about its middle.
    float r = 0.5 * far;
    float mean = light.radius > 0.0 ? 0.5 + 0.5 * r * inversesqrt(r * r + light.radius * light.radius) : 1.0;
    grid.mean_cosine = args.prefilter != 0u ? pow(mean, args.beta) : 1.0;
    return grid;
}

// What starts in a texel and its solid angle, means over points spread evenly.
vec2 integrals(const propagate_radial_grid grid, ivec2 texel, int along)
{
    vec2 sum = vec2(0.0);
    for (int n = 0; n < along * along; n++) {
        vec2 part = (vec2(n % along, n / along) + 0.5) / float(along);
        vec3 x = propagate_radial_heading(grid, 2.0 * (vec2(texel) + part) / float(args.cells) - 1.0);
        float area = propagate_radial_solid_angle(grid, x);
        sum += area * vec2(light_lobe(grid.light, dot(normalize(x), grid.light.direction)), 1.0);
    }
    float side = 2.0 / float(args.cells * uint(along));
    return sum * side * side;
}

void main()
{
    uint n = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    light_block light;
    bool used = true;
    if (n < args.num_lamps) {
        light = lamps[n];
    } else {
        used = n - args.num_lamps < min(vpls.count, args.max_vpls);
        light = vpls.list[n - args.num_lamps];
        light.kind = used ? light.kind : TYN_LIGHT_KIND_POINT;
        light.position = used ? light.position : 0.5 * medium.extent;
        light.radius = used ? light.radius : 0.0;
    }
    propagate_radial_grid grid = grid_of(light, used);
    uint total = args.cells * args.cells, base = n * total;
    // 128 points along a side of the map at least: solid angles are right to half a percent, and
    // lobes of a degree are met.
    int along = max(2, int((128u + args.cells - 1u) / args.cells));
    float sum = 0.0;
    for (uint q = lane; q < total; q += PROPAGATE_RADIAL_LANES) {
        ivec2 texel = ivec2(q % args.cells, q / args.cells);
        vec2 power = integrals(grid, texel, along);
        map[base + q] = power;
        sum += power.x;
    }
    sums[lane] = sum;
    barrier();
    for (uint half_size = PROPAGATE_RADIAL_LANES / 2u; half_size > 0u; half_size /= 2u) {
        if (lane < half_size) {
            sums[lane] += sums[lane + half_size];
        }
        barrier();
    }
    // The light's power is what it should be whatever the points have met; a lobe that none has met goes
    // where its axis points.
    float all = light_lobe_integral(light), met = sums[0];
    vec3 axis = vec3(dot(grid.to_map[0], light.direction), dot(grid.to_map[1], light.direction),
                     dot(grid.to_map[2], light.direction));
    ivec2 on_axis = met > 0.0 ? ivec2(-1)
                              : clamp(ivec2(floor((0.5 * octahedral_of(axis) + 0.5) * float(args.cells))),
                                      ivec2(0), ivec2(args.cells - 1u));
    for (uint q = lane; q < total; q += PROPAGATE_RADIAL_LANES) {
        bool here = ivec2(q % args.cells, q / args.cells) == on_axis;
        map[base + q].x = met > 0.0 ? map[base + q].x * (all / met) : here ? all : 0.0;
    }
    if (lane == 0u) {
        grids[n] = grid;
        places[n] = propagate_radial_place(light.position, 1.0 / grid.inner, grid.to_map,
                                           1.0 / log(grid.growth), used ? light.color : vec3(0.0),
                                           grid.layers);
    }
}
