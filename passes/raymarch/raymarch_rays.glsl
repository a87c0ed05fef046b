// raymarch_rays.glsl -- the rays of a pixel, or the one of a node of the sparse march: in one kernel, as the march is by far the
// most of it, and takes a driver a second to compile.
//
// Include after raymarch_sparse.glsl.

// What a march is for.
struct march_target {
    ivec2 pixel;
    ivec2 node; // of the grid, if `is_node`
    bool is_node;
    bool simple; // one ray stands for the pixel; a node whose does not has none
    uint shapes_met;
};

void store_node(const march_target target, const pixel_ray to, const march_result r, const march_state state)
{
    bool good = target.simple && is_finite(r.radiance) && is_finite(r.transmittance);
    if (state.steps > 0u) {
        atomicAdd(counters.steps, state.steps);
    }
    float edges = float(min(state.shadow.edges, 255u)) / 1024.0;
    edges += state.shadow.beside > state.shadow.edges + SPARSE_BESIDE ? SPARSE_THIN : 0.0;
    imageStore(sparse_image, sparse_texel(target.node, SPARSE_RADIANCE), vec4(r.radiance, good ? 1.0 + edges : -1.0));
    imageStore(sparse_image, sparse_texel(target.node, SPARSE_TRANSMITTANCE), vec4(r.transmittance, sparse_nearness(to)));
    imageStore(sparse_image, sparse_texel(target.node, SPARSE_SCALED),
               vec4(r.scaled_transmittance, float(target.shapes_met)));
    if (SPARSE_HAS_SINGLE) {
        imageStore(sparse_image, sparse_texel(target.node, SPARSE_SINGLE), vec4(state.single, 0.0));
    }
}

// Adds the ray through `where` in the pixel, or stores that of a node. To samples of several surfaces it has the same way as far as
// the first of them, and goes on through the middle of the others: these never see what is behind the first.
void add_ray(inout pixel_light sum, const march_target target, vec2 where, float footprint, surface_group group)
{
    float left = 1.0, start = 0.0;
    march_state state = march_start(target.is_node ? 0.5 : display_bayer(uvec2(target.pixel)));
    while (left > 1e-3) {
        pixel_ray to = ray_to(target.pixel, where, group);
        start = to.span.x;
        float length = target.is_node && !target.simple ? 0.0 : max(to.span.y - start, 0.0);
        // Distances from where the ray enters: the camera may be far away.
        march_result r = march_ray(state, to.ray.origin + start * to.ray.direction, to.ray.direction, length, start);
        if (target.is_node) {
            store_node(target, to, r, state);
            break;
        }
        add_light(sum, target.pixel, where, footprint, group, to, r, state.single);
        left -= group.share;
        if (!raymarch_has(RAYMARCH_SURFACE)) {
            break;
        }
        if (left > 1e-3) {
            group = surface_group_from(target.pixel, group.left, true);
        }
    }
    sum.half_distance = min(sum.half_distance, start + state.half_distance);
    sum.steps += state.steps;
}

void march_to(march_target target)
{
    pixel_light sum = pixel_light_none();
    surface_group group = first_surface(target.pixel, true);
    uint num_rays = rays_of_pixel(target.pixel, target.shapes_met);
    target.simple = num_rays == 1u && group.share > 0.999;
    num_rays = target.is_node || group.share < 1.0 ? 1u : num_rays;
    for (uint i = 0u; i < num_rays; i++) {
        vec2 where = num_rays == 1u ? vec2(0.5) : quarter_pixel(i);
        add_ray(sum, target, where, num_rays == 1u ? 1.0 : 0.5, group);
    }
    if (target.is_node) {
        return;
    }
    if (sum.met) {
        atomicAdd(counters.steps, sum.steps);
        atomicAdd(counters.pixels, 1u);
    }
    store_pixel(target.pixel, sum, 1.0 / float(num_rays));
}

// Thread `i` of a dispatch for what is listed, in groups of 64; `at`: of one for all nodes, or for all pixels.
void march_rays(uint i, ivec2 at)
{
    march_target target = march_target(ivec2(args.first) + at, ivec2(0), false, false, 0u);
    bool is = in_window(target.pixel);
    if (raymarch_has(RAYMARCH_SPARSE_NODES | RAYMARCH_SPARSE_PIXELS)) {
        target.is_node = raymarch_has(RAYMARCH_SPARSE_NODES);
        if (raymarch_has(RAYMARCH_SPARSE_PIXELS)) {
            target.is_node = target.is_node && args.rays != RAYMARCH_LISTED_PIXELS;
        }
        ivec2 place = RAYMARCH_NODES / 2 * at;
        is = in_window(sparse_pixel(place));
        if (args.rays != RAYMARCH_ALL_NODES) {
            is = listed_place(target.is_node ? 0 : 1, i, place);
        }
        target.node = place;
        target.pixel = target.is_node ? sparse_pixel(place) : place;
    }
    if (is) {
        march_to(target);
    }
}
