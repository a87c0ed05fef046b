// gradient_grid.glsl -- grids of points for samples, from level to level twice as fine.
//
// Include after medium.glsl; `args` is struct gradient_args. Points are the centres of cells that fill the medium's box, at most a
// radius apart along each axis, so that the sphere of that radius around the nearest one has every point of the box.

struct gradient_grid {
    ivec3 size;
    uint first;   // points of all levels before
    vec3 spacing; // m
    float radius; // valid radius of samples, m
};

ivec3 gradient_size(uint level)
{
    const uint packed = args.grids[level];
    return ivec3(packed & 255u, packed >> 8 & 255u, packed >> 16);
}

gradient_grid gradient_grid_of(uint level)
{
    gradient_grid grid;
    grid.size = gradient_size(level);
    grid.first = 0u;
    for (uint k = 0u; k < level; k++) {
        const ivec3 n = gradient_size(k);
        grid.first += uint(n.x * n.y * n.z);
    }
    grid.spacing = medium.extent / vec3(grid.size);
    grid.radius = args.radius / float(1u << level);
    return grid;
}

uint gradient_points(const gradient_grid grid)
{
    return uint(grid.size.x * grid.size.y * grid.size.z);
}

uint gradient_index(const gradient_grid grid, ivec3 at)
{
    return uint((at.z * grid.size.y + at.y) * grid.size.x + at.x);
}

ivec3 gradient_at(const gradient_grid grid, uint index)
{
    const uint row = index / uint(grid.size.x);
    return ivec3(index % uint(grid.size.x), row % uint(grid.size.y), row / uint(grid.size.y));
}

vec3 gradient_place(const gradient_grid grid, ivec3 at)
{
    return (vec3(at) + 0.5) * grid.spacing;
}

// What a sample's light is where it differs by `change`, to first order. Light falls off as exponentials do and is never
// negative; a sample beside a lamp knows nothing of how bright it is there.
const float GRADIENT_MOST = 2.0;

vec3 gradient_extrapolated(vec3 light, vec3 change)
{
    const vec3 exponential = light * exp(min(change / max(light, 1e-30), GRADIENT_MOST));
    return mix(exponential, light + change, bvec3(args.linear != 0u));
}
