// raymarch_sparse.glsl -- the march at a lower resolution, upsampled where the picture is smooth.
//
// Include after raymarch_pixel.glsl.
//
// Some pixels, the nodes of a grid, are marched first. A cell is the pixels between four nodes. Second differences of the nodes'
// radiance and transmittance tell how far linear interpolation is off in a cell. Where that is little, and surfaces do not jump,
// its pixels are interpolated by cubics; elsewhere the grid is refined, from nodes four pixels apart to two, and at last to
// all pixels. Rays of the refinement are listed and dispatched indirectly: every thread of such a dispatch has a ray. A node is
// in the middle of a pixel, and each pixel is marched once at most.
//
// Of a function with the second difference b between nodes, linear interpolation is off by b / 8 at most.
// Bounds of the error of linear interpolation, relative to what is seen in the cell: of the first grid, between whose nodes details
// may be missed, and of one that refines it. Among surfaces both have the first: light there has more edges. Cubics are far less
// off where the light is smooth.

const float SPARSE_TOLERANCE_FIRST = 0.018, SPARSE_TOLERANCE = 0.04;
// Relative error of a ray's length x. The light of fog of depth t, 1 - e^-t, changes by x t e^-t with it: 1.1 % at most.
const float SPARSE_DISTANCE_TOLERANCE = 0.03;

// Looks beside a ray disagree with it about as often as it crosses edges of wide shadows. So many more tell of a shaft or a
// shadow that is narrower than a cell.
const uint SPARSE_BESIDE = 2u;

// What is kept of the ray of a node: three texels, or four. Nodes are counted from args.first on, two pixels apart.
// SPARSE_RADIANCE.a: -1 if one ray cannot stand for the pixel, 2 if its coarse cell is interpolated, else 1 and a 1024th for each
// edge of a shadow that the ray crosses; SPARSE_THIN more if a shaft or a shadow beside it is narrower than a cell.
const float SPARSE_THIN = 0.25;
const int SPARSE_RADIANCE = 0;
const int SPARSE_TRANSMITTANCE = 1; // transmittance; a = 1 / distance of the surface, or 0
const int SPARSE_SCALED = 2;         // e^-tau'; a = which shapes are met (rays_of_pixel)
const int SPARSE_SINGLE = 3;         // light that has scattered once, where a layer wants it

// It is interpolated where the picture is smooth, whether it is smooth itself or not.
#define SPARSE_HAS_SINGLE raymarch_has(RAYMARCH_SINGLE | RAYMARCH_MULTIPLE)

// The image is at most two texels wider and higher than the picture, at whose size other images may have reached what the
// device can hold: two texels of nodes beside each other, below them the third ones of two rows in one, and the fourth ones, if
// there are any.
ivec2 sparse_texel(ivec2 node, int k)
{
    ivec2 nodes = (imageSize(radiance_image) + 1) / 2;
    ivec2 below = ivec2(node.x + (node.y & 1) * nodes.x, nodes.y + (k - 2) * ((nodes.y + 1) / 2) + node.y / 2);
    return k < 2 ? ivec2(2 * node.x + k, node.y) : below;
}

vec4 sparse_load(ivec2 node, int k)
{
    return imageLoad(sparse_image, sparse_texel(node, k));
}

ivec2 sparse_pixel(ivec2 node)
{
    return ivec2(args.first) + 2 * node;
}

bool in_window(ivec2 pixel)
{
    return all(lessThan(pixel, ivec2(args.end)));
}

// Has the pixel one ray, to one surface or none?
bool is_simple(ivec2 pixel, const surface_group group, out uint shapes_met)
{
    return rays_of_pixel(pixel, shapes_met) == 1u && group.share > 0.999;
}

float sparse_nearness(const pixel_ray to)
{
    return to.surface < TYN_INFINITY ? 1.0 / max(to.surface, 1e-30) : 0.0;
}

struct sparse_ray {
    vec3 radiance, transmittance, scaled_transmittance, single;
};

vec3 sparse_single(ivec2 node)
{
    return SPARSE_HAS_SINGLE ? sparse_load(node, SPARSE_SINGLE).rgb : vec3(0.0);
}

sparse_ray sparse_ray_of(ivec2 node)
{
    return sparse_ray(sparse_load(node, SPARSE_RADIANCE).rgb, sparse_load(node, SPARSE_TRANSMITTANCE).rgb,
                      sparse_load(node, SPARSE_SCALED).rgb, sparse_single(node));
}

// sum + weight * ray
sparse_ray sparse_add(const sparse_ray sum, float weight, const sparse_ray ray)
{
    return sparse_ray(sum.radiance + weight * ray.radiance, sum.transmittance + weight * ray.transmittance,
                      sum.scaled_transmittance + weight * ray.scaled_transmittance, sum.single + weight * ray.single);
}

// What is seen of the ray, or of a difference of rays, sum of all channels: before black, and before the radiance `behind`. A medium
// before a radiance like its own cannot be seen, however its opacity changes, nor can a thin one before a bright radiance.
vec2 sparse_seen(const sparse_ray ray, vec3 behind)
{
    return vec2(dot(abs(ray.radiance), vec3(1.0)), dot(abs(ray.radiance + ray.transmittance * behind), vec3(1.0)));
}

const sparse_ray SPARSE_NONE = sparse_ray(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

// The mean second difference along `way` at the nodes a (`node`) and b (`node + way`), of those whose outer node is known and lies
// on the same surface, in the same shapes: beyond their edges the light tells nothing of the cell's. `nearness`: of a and b.
// `size`: the larger of the two as it is seen (sparse_seen), or infinity if none is known.
sparse_ray sparse_second_difference(ivec2 node, ivec2 way, const sparse_ray a, const sparse_ray b, vec2 nearness, float shapes_met, vec3 behind,
                                    out vec2 size)
{
    sparse_ray sum = SPARSE_NONE;
    float known = 0.0;
    size = vec2(0.0);
    [[unroll]] for (int i = 0; i < 2; i++) {
        ivec2 beyond = i == 0 ? node - way : node + 2 * way;
        bool there = all(greaterThanEqual(beyond, ivec2(0))) && in_window(sparse_pixel(beyond));
        beyond = there ? beyond : node;
        float onwards = i == 0 ? 2.0 * nearness.x - nearness.y : 2.0 * nearness.y - nearness.x;
        vec4 transmittance = sparse_load(beyond, SPARSE_TRANSMITTANCE), scaled = sparse_load(beyond, SPARSE_SCALED);
        there = there && sparse_load(beyond, SPARSE_RADIANCE).a > 0.0 && scaled.a == shapes_met &&
                abs(transmittance.a - onwards) <= SPARSE_DISTANCE_TOLERANCE * transmittance.a;
        sparse_ray outer = sparse_ray(sparse_load(beyond, SPARSE_RADIANCE).rgb, transmittance.rgb, scaled.rgb, sparse_single(beyond));
        sparse_ray second = sparse_add(sparse_add(outer, -2.0, i == 0 ? a : b), 1.0, i == 0 ? b : a);
        size = there ? max(size, sparse_seen(second, behind)) : size;
        sum = sparse_add(sum, there ? 1.0 : 0.0, second);
        known += there ? 1.0 : 0.0;
    }
    size = known > 0.0 ? size : vec2(TYN_INFINITY);
    return sparse_add(SPARSE_NONE, 1.0 / max(known, 1.0), sum);
}

// The four nodes of a cell.
struct sparse_cell {
    ivec2 node; // the first
    int stride; // nodes (2 pixels) from one to the next
    sparse_ray rays[4];
    vec4 nearness;
    float shapes_met; // by the first node
    vec3 behind;
    bool known; // all four stand for their pixels, and meet the same shapes
};

sparse_cell sparse_cell_of(ivec2 node, int stride)
{
    sparse_cell cell;
    cell.node = node;
    cell.stride = stride;
    bool whole = in_window(sparse_pixel(node + stride));
    cell.known = whole;
    cell.shapes_met = sparse_load(node, SPARSE_SCALED).a;
    vec3 radiance = vec3(0.0), transmittance = vec3(0.0);
    [[unroll]] for (int i = 0; i < 4; i++) {
        ivec2 at = whole ? node + stride * ivec2(i & 1, i >> 1) : node;
        cell.rays[i] = sparse_ray_of(at);
        cell.nearness[i] = sparse_load(at, SPARSE_TRANSMITTANCE).a;
        cell.known = cell.known && sparse_load(at, SPARSE_RADIANCE).a > 0.0 &&
                     sparse_load(at, SPARSE_SCALED).a == cell.shapes_met;
        radiance += 0.25 * cell.rays[i].radiance;
        transmittance += 0.25 * cell.rays[i].transmittance;
    }
    // As bright as the medium itself, or as what is around.
    cell.behind = max(radiance / max(1.0 - transmittance, 1e-3), environment.sky);
    return cell;
}

// `cubic` in the middle between nodes, but `linear` in channels where a cubic leaves the values that radiance and transmittance
// may have: beside the edge of a medium. All of a channel changes: light and what it hides keep their sum.
sparse_ray sparse_valid(const sparse_ray cubic, const sparse_ray linear)
{
    bvec3 off = lessThan(min(cubic.radiance, min(cubic.transmittance, cubic.scaled_transmittance)), vec3(0.0));
    off = bvec3(ivec3(off) | ivec3(greaterThan(max(cubic.transmittance, cubic.scaled_transmittance), vec3(1.0))));
    return sparse_ray(mix(cubic.radiance, linear.radiance, off), mix(cubic.transmittance, linear.transmittance, off),
                      mix(cubic.scaled_transmittance, linear.scaled_transmittance, off), max(cubic.single, 0.0));
}

// Rays in the middle of the cell's first row, of its first column, and of the cell, by cubics along rows and columns. `error`:
// a bound of what linear interpolation is off by, relative to what is seen.
void sparse_interpolate(const sparse_cell cell, out sparse_ray middle[3], out float error)
{
    ivec2 right = ivec2(cell.stride, 0), down = ivec2(0, cell.stride);
    vec2 sizes[4];
    sparse_ray top = sparse_second_difference(cell.node, right, cell.rays[0], cell.rays[1], cell.nearness.xy, cell.shapes_met,
                                               cell.behind, sizes[0]);
    sparse_ray bottom = sparse_second_difference(cell.node + down, right, cell.rays[2], cell.rays[3], cell.nearness.zw, cell.shapes_met,
                                               cell.behind, sizes[1]);
    sparse_ray left = sparse_second_difference(cell.node, down, cell.rays[0], cell.rays[2], cell.nearness.xz, cell.shapes_met,
                                               cell.behind, sizes[2]);
    sparse_ray beside = sparse_second_difference(cell.node + right, down, cell.rays[1], cell.rays[3], cell.nearness.yw, cell.shapes_met,
                                               cell.behind, sizes[3]);
    sparse_ray row = sparse_add(sparse_add(SPARSE_NONE, 0.5, cell.rays[0]), 0.5, cell.rays[1]);
    sparse_ray column = sparse_add(sparse_add(SPARSE_NONE, 0.5, cell.rays[0]), 0.5, cell.rays[2]);
    sparse_ray mean = sparse_add(sparse_add(sparse_add(SPARSE_NONE, 0.5, row), 0.25, cell.rays[2]), 0.25, cell.rays[3]);
    middle[0] = sparse_valid(sparse_add(row, -0.125, top), row);
    middle[1] = sparse_valid(sparse_add(column, -0.125, left), column);
    middle[2] = sparse_add(sparse_add(mean, -0.0625, top), -0.0625, bottom);
    middle[2] = sparse_valid(sparse_add(sparse_add(middle[2], -0.0625, left), -0.0625, beside), mean);
    vec2 off = (max(sizes[0], sizes[1]) + max(sizes[2], sizes[3])) / (8.0 * max(sparse_seen(mean, cell.behind), 1e-20));
    error = max(off.x, off.y);
}

// 1 / distance of surfaces is linear in the picture of a plane. `t`: place in the cell, 0 to 1.
float sparse_nearness_between(const sparse_cell cell, vec2 t)
{
    return mix(mix(cell.nearness[0], cell.nearness[1], t.x), mix(cell.nearness[2], cell.nearness[3], t.x), t.y);
}

// Is a sun behind the cell? It is far brighter than what is around.
bool sees_sun(const sparse_cell cell)
{
    float across = 2.0 * float(cell.stride);
    if (!raymarch_has(RAYMARCH_BACKGROUND) || environment.has_map == 0u) {
        return false;
    }
    float angle = camera_select(camera, 0.0, across * camera_pixel(camera).x);
    vec3 direction = camera_ray_through(camera, vec2(sparse_pixel(cell.node)) + 0.5 * across + 0.5).direction;
    bool sees = false;
    for (uint n = 0u; n < raymarch_num_suns; n++) {
        light_block light = lights[beams[n].light];
        // Of a disc of the radius r the mean cosine is 1 - r^2 / 4.
        float radius = 2.0 * sqrt(max(1.0 - light.mean_cosine, 0.0));
        sees = sees || distance(direction, -light.direction) < radius + angle;
    }
    return sees;
}

// Has the pixel one ray, and is its length what the cell's nodes say?
bool is_between(const sparse_cell cell, ivec2 pixel, const surface_group group)
{
    if (!raymarch_has(RAYMARCH_SURFACE | RAYMARCH_HOST_DEPTH | RAYMARCH_SUPERSAMPLE)) {
        return true; // nothing ends or splits a ray
    }
    float nearness = sparse_nearness(ray_to(pixel, vec2(0.5), group));
    vec2 t = vec2(pixel - sparse_pixel(cell.node)) / float(2 * cell.stride);
    uint shapes_met;
    return is_simple(pixel, group, shapes_met) &&
           abs(nearness - sparse_nearness_between(cell, t)) <= SPARSE_DISTANCE_TOLERANCE * nearness;
}

// `which` of the lists: 0 of nodes, 1 of pixels.
void list_places(int which, ivec2 places[4], uint count)
{
    uint first = atomicAdd(sparse_rest.head[which].count, count);
    for (uint i = 0u; i < count; i++) {
        sparse_rest.places[first + i] = uint(places[i].x) | uint(places[i].y) << 16;
    }
    atomicMax(sparse_rest.head[which].groups.y, (first + count - 1u) / (64u * RAYMARCH_REST_GROUPS) + 1u);
}

// Place `i` of a list; false beyond its end.
bool listed_place(int which, uint i, out ivec2 place)
{
    bool is = i < sparse_rest.head[which].count;
    uint at = is ? sparse_rest.places[i] : 0u;
    place = ivec2(at & 0xffffu, at >> 16);
    return is;
}

bool sparse_thin(float edges) // SPARSE_RADIANCE.a
{
    return edges >= 1.0 + SPARSE_THIN && edges < 2.0;
}

// Do all rays of a coarse cell and of those around it cross as many edges of shadows? A shaft may be seen between nodes otherwise.
bool sparse_edges_agree(ivec2 node)
{
    float first = sparse_load(node, SPARSE_RADIANCE).a;
    bool agree = !sparse_thin(first);
    for (int i = 0; i < 16 && agree; i++) {
        ivec2 at = node + 2 * (ivec2(i % 4, i / 4) - 1);
        bool there = all(greaterThanEqual(at, ivec2(0))) && in_window(sparse_pixel(at));
        float other = sparse_load(there ? at : node, SPARSE_RADIANCE).a;
        agree = other < 0.0 || other == first;
    }
    return agree;
}

// Is there a thin shaft or shadow in the coarse cell of a fine one? Nodes two apart may miss it as well.
bool sparse_thin_within(ivec2 node)
{
    bool thin = false;
    for (int i = 0; i < 4; i++) {
        ivec2 at = (node & ~1) + 2 * ivec2(i & 1, i >> 1);
        thin = thin || (in_window(sparse_pixel(at)) && sparse_thin(sparse_load(at, SPARSE_RADIANCE).a));
    }
    return thin;
}

// Of a coarse cell, 4x4 pixels: interpolates or lists the nodes in it that the finer grid has.
void fill_nodes(ivec2 node)
{
    sparse_cell cell = sparse_cell_of(node, 2);
    sparse_ray middle[3];
    float error;
    sparse_interpolate(cell, middle, error);
    bool smooth_cell = cell.known && error <= SPARSE_TOLERANCE_FIRST && !sees_sun(cell);
    if (raymarch_has(RAYMARCH_SHADOWS)) {
        smooth_cell = smooth_cell && sparse_edges_agree(node);
    }
    for (int i = 1; i < 16 && smooth_cell; i++) {
        ivec2 pixel = sparse_pixel(node) + ivec2(i % 4, i / 4);
        smooth_cell = is_between(cell, pixel, first_surface(pixel, false));
    }
    ivec2 listed[4];
    uint count = 0u;
    for (int i = 0; i < 3; i++) {
        ivec2 way = ivec2(i != 1, i != 0), at = node + way;
        if (smooth_cell) {
            float nearness = sparse_nearness_between(cell, 0.5 * vec2(way));
            imageStore(sparse_image, sparse_texel(at, SPARSE_RADIANCE), vec4(middle[i].radiance, 2.0));
            imageStore(sparse_image, sparse_texel(at, SPARSE_TRANSMITTANCE), vec4(middle[i].transmittance, nearness));
            imageStore(sparse_image, sparse_texel(at, SPARSE_SCALED), vec4(middle[i].scaled_transmittance, cell.shapes_met));
            if (SPARSE_HAS_SINGLE) {
                imageStore(sparse_image, sparse_texel(at, SPARSE_SINGLE), vec4(middle[i].single, 0.0));
            }
        } else if (in_window(sparse_pixel(at))) {
            listed[count++] = at;
        }
    }
    if (count > 0u) {
        list_places(0, listed, count);
    }
}

// Stores a pixel that has `ray` before its surface; true if it meets the medium.
bool store_interpolated(ivec2 pixel, const surface_group group, const sparse_ray ray)
{
    march_result r = march_result(ray.radiance, ray.transmittance, ray.scaled_transmittance);
    pixel_light sum = pixel_light_none();
    add_light(sum, pixel, vec2(0.5), 1.0, group, ray_to(pixel, vec2(0.5), group), r, ray.single);
    store_pixel(pixel, sum, 1.0);
    return sum.met;
}

// Of a fine cell, 2x2 pixels: interpolates or lists its pixels.
void fill_pixels(ivec2 node)
{
    sparse_cell cell = sparse_cell_of(node, 1);
    surface_group groups[4];
    for (int i = 0; i < 4; i++) {
        groups[i] = first_surface(min(sparse_pixel(node) + ivec2(i & 1, i >> 1), ivec2(args.end) - 1), false);
    }
    sparse_ray middle[3];
    float error;
    sparse_interpolate(cell, middle, error);
    const ivec2 coarse_middle = node | 1; // of its coarse cell, which ends the window or has been filled
    float tolerance = raymarch_has(RAYMARCH_SHADOWS | RAYMARCH_WALLS) ? SPARSE_TOLERANCE_FIRST : SPARSE_TOLERANCE;
    bool smooth_cell = cell.known && error <= tolerance;
    // A coarse cell that is smooth has been looked at, but beside it something may begin that spoils a cubic.
    if (!in_window(sparse_pixel(coarse_middle)) || sparse_load(coarse_middle, SPARSE_RADIANCE).a < 1.5) {
        smooth_cell = smooth_cell && !sees_sun(cell);
        if (raymarch_has(RAYMARCH_SHADOWS)) {
            smooth_cell = smooth_cell && !sparse_thin_within(node);
        }
        for (int i = 1; i < 4 && smooth_cell; i++) {
            smooth_cell = is_between(cell, sparse_pixel(node) + ivec2(i & 1, i >> 1), groups[i]);
        }
    }
    ivec2 listed[4];
    uint count = 0u, met = 0u;
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = sparse_pixel(node) + ivec2(i & 1, i >> 1);
        sparse_ray ray = i == 0 ? cell.rays[0] : middle[i - 1];
        if (smooth_cell || (i == 0 && sparse_load(node, SPARSE_RADIANCE).a > 0.0)) {
            met += store_interpolated(pixel, groups[i], ray) ? 1u : 0u;
        } else if (in_window(pixel)) {
            listed[count++] = pixel;
        }
    }
    if (met > 0u) {
        atomicAdd(counters.pixels, met);
    }
    if (count > 0u) {
        list_places(1, listed, count);
    }
}

void fill_cells(ivec2 at)
{
    ivec2 node = (raymarch_has(RAYMARCH_SPARSE_COARSE) ? 2 : 1) * at;
    if (!in_window(sparse_pixel(node))) {
        return;
    }
    if (raymarch_has(RAYMARCH_SPARSE_COARSE)) {
        fill_nodes(node);
    } else {
        fill_pixels(node);
    }
}
