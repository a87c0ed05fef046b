// raymarch_pixel.glsl -- the rays of one pixel and what is stored of them.
//
// Include after raymarch.glsl, background.glsl, surface_samples.glsl, glow.glsl and display.glsl.
#ifndef TYN_RAYMARCH_PIXEL_GLSL
#define TYN_RAYMARCH_PIXEL_GLSL

// Pixel of a thread of an 8x8 group, so that any 8 threads in a row are a block of 4x2 pixels, whose
// rays take about equally many steps.
uvec2 pixel_of_thread(uvec2 group, uint i)
{
    return group * 8u + uvec2((i & 3u) | (i >> 1 & 4u), (i >> 2 & 1u) | (i >> 3 & 6u));
}

vec2 quarter_pixel(uint i)
{
    return vec2(0.25 + 0.5 * float(i & 1u), 0.25 + 0.5 * float(i >> 1));
}

// 4 if the rays through the pixel's quarters disagree on which shapes they meet, else 1.
uint rays_of_pixel(ivec2 pixel)
{
    if (!raymarch_has(RAYMARCH_SUPERSAMPLE)) {
        return 1u;
    }
    // Origin or direction is linear in the image position.
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    vec2 quarter = 0.5 / vec2(camera.size);
    vec3 across = quarter.x * camera.half_width * camera.right;
    vec3 up = quarter.y * camera.half_height * camera.up;
    bool orthographic = camera.orthographic != 0u;
    if (!orthographic) {
        ray.direction /= dot(ray.direction, camera.forward);
    }
    bool agree = true;
    uint count = raymarch_has(RAYMARCH_ONE_SHAPE) ? 1u : medium.num_shapes;
    for (uint i = 0u; i < count; i++) {
        vec3 o = shape_point(shapes[i], ray.origin), d = shape_vector(shapes[i], ray.direction);
        vec3 x = shape_vector(shapes[i], across), y = shape_vector(shapes[i], up);
        uint met = 0u;
        for (uint k = 0u; k < 4u; k++) {
            vec3 shift = ((k & 1u) == 0u ? -x : x) + ((k & 2u) == 0u ? -y : y);
            vec2 span = orthographic ? ray_unit_shape(shapes[i].kind, o + shift, d)
                                     : ray_unit_shape(shapes[i].kind, o, d + shift);
            met += span.x < span.y && span.y > 0.0 ? 1u : 0u;
        }
        agree = agree && (met == 0u || met == 4u);
    }
    return agree ? 1u : 4u;
}

bool is_finite(vec3 v)
{
    return !any(isnan(v)) && !any(isinf(v));
}

// Where a ray is in the medium's box, from the eye on.
vec2 pixel_span(camera_ray ray)
{
    vec3 beyond = vec3(0.0); // a periodic medium: so many periods that none sees farther
    if (raymarch_has(RAYMARCH_REPEAT)) {
        beyond = 256.0 * medium.extent * vec3(medium.repeat);
    }
    vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), -beyond, medium.extent + beyond);
    return vec2(max(span.x, 0.0), span.y);
}

// What is shown of the pixel: the light of its rays, and how much of it is covered.
struct pixel_light {
    vec3 radiance, single, multiple, transmittance;
    float cover;
    float nearest, half_distance;
    uint steps;
    bool met; // the medium's box
};

// Adds the ray through `where` in the pixel. To samples of several surfaces it has the same way as far as the first
// of them, and goes on through the middle of the others: these never see what is behind the first.
// `known`: what the ray brings, if `given`.
void add_ray(inout pixel_light sum, ivec2 pixel, vec2 where, float footprint, surface_group group, bool given,
             march_result known)
{
    float left = 1.0, start = 0.0;
    march_state state = march_start(display_bayer(uvec2(pixel)));
    while (left > 1e-3) {
        camera_ray ray = camera_ray_through(camera, vec2(pixel) + (group.share < 1.0 ? group.where : where));
        vec2 span = pixel_span(ray);
        start = span.x;
        float surface = group.mean.a;
        if (raymarch_has(RAYMARCH_HOST_DEPTH)) {
            surface = min(surface, host_distance(host_depth_tex, camera, args.depth, pixel, ray.direction));
        }
        float end = min(span.y, surface);
        bool shown = raymarch_has(RAYMARCH_SURFACE) && group.mean.a < TYN_INFINITY && group.mean.a == surface;
        sum.nearest = min(sum.nearest, surface);
        sum.met = sum.met || span.x < end;
        // Distances from where the ray enters: the camera may be far away.
        march_result r = march_ray(state, ray.origin + span.x * ray.direction, ray.direction,
                                   given ? 0.0 : max(end - span.x, 0.0), span.x);
        if (given) {
            r = known;
        }
        // Light of what is behind that was scattered forward only: of the environment or, hardly out of
        // place, of the surface. In front of a host's surface it is not what lies behind that; the mean
        // keeps uniform surroundings uniform.
        vec3 light = r.radiance;
        if (raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN | RAYMARCH_SURFACE)) {
            vec3 smeared = raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN) ? environment.sky : vec3(0.0);
            if (shown) {
                smeared = group.mean.rgb;
            } else if (raymarch_has(RAYMARCH_GLOW) && surface == TYN_INFINITY) {
                smeared = environment.radiance *
                          glow_radiance(glow_tex, environment, ray.direction, spectrum_of(march_forward_depth(r)));
            }
            light += smeared * max(r.scaled_transmittance - r.transmittance, 0.0);
        }
        sum.transmittance += group.share * r.transmittance;
        sum.single += group.share * state.single;
        sum.multiple += group.share * max(light - state.single, 0.0);
        if (raymarch_has(RAYMARCH_SURFACE_SEEN) && shown) {
            light += r.transmittance * group.mean.rgb;
            sum.cover += group.share;
        } else if (!raymarch_has(RAYMARCH_BACKGROUND)) {
            sum.cover += group.share * (1.0 - dot(r.transmittance, vec3(1.0 / 3.0)));
        } else if (surface == TYN_INFINITY) {
            light += r.transmittance * background_radiance(environment, environment_tex, camera, ray.direction,
                                                           vec2(pixel) + where, footprint);
        }
        sum.radiance += group.share * light;
        left -= group.share;
        if (!raymarch_has(RAYMARCH_SURFACE)) {
            break;
        }
        if (left > 1e-3) {
            group = surface_group_from(surface_tex, camera, pixel, group.end);
        }
    }
    sum.half_distance = min(sum.half_distance, start + state.half_distance);
    sum.steps += state.steps;
}

// ---- sparse rays ------------------------------------------------------------------------------------
//
// Most of a fog is smooth. So there is first one ray for every 2x2 pixels, through their middle and as far as their
// surfaces. Where that picture bends by no more than SPARSE_BEND of itself from block to block a pixel takes what
// lies between the four blocks around it, which is then wrong by a ninth of that bend at most; other pixels,
// and those at edges of surfaces and media, have a ray of their own.

const float SPARSE_BEND = 0.06;

// Stores what the block's ray brings; alpha -1 where one ray cannot stand for the block.
void march_block(ivec2 block)
{
    ivec2 corner = ivec2(args.first) + 2 * block;
    float inverses = 0.0, nearest = TYN_INFINITY, farthest = 0.0;
    bool even = true;
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = min(corner + ivec2(i & 1, i >> 1), ivec2(args.end) - 1);
        even = even && rays_of_pixel(pixel) == 1u;
        if (raymarch_has(RAYMARCH_SURFACE)) {
            surface_group group = surface_group_from(surface_tex, camera, pixel, 0.0);
            even = even && group.share > 0.999;
            nearest = min(nearest, group.mean.a);
            farthest = max(farthest, group.mean.a);
            inverses += 1.0 / max(group.mean.a, 1e-30);
        }
    }
    float surface = TYN_INFINITY;
    if (raymarch_has(RAYMARCH_SURFACE) && nearest < TYN_INFINITY) {
        even = even && farthest < 1.1 * nearest;
        surface = even ? 4.0 / inverses : nearest;
    }
    camera_ray ray = camera_ray_through(camera, vec2(corner) + 1.0);
    vec2 span = pixel_span(ray);
    march_state state = march_start(0.5);
    march_result r = march_ray(state, ray.origin + span.x * ray.direction, ray.direction,
                               even ? max(min(span.y, surface) - span.x, 0.0) : 0.0, span.x);
    even = even && is_finite(r.radiance) && is_finite(r.transmittance);
    atomicAdd(counters.steps, state.steps);
    ivec2 texel = ivec2(3 * block.x, block.y);
    imageStore(sparse_image, texel, vec4(r.radiance, even ? 1.0 : -1.0));
    imageStore(sparse_image, texel + ivec2(1, 0), vec4(r.transmittance, 1.0));
    imageStore(sparse_image, texel + ivec2(2, 0), vec4(r.scaled_transmittance, 1.0));
}

vec4 sparse_fetch(ivec2 block, int k)
{
    ivec2 last = (ivec2(args.end - args.first) + 1) / 2 - 1;
    block = clamp(block, ivec2(0), last);
    return texelFetch(sparse_tex, ivec2(3 * block.x + k, block.y), 0);
}

bool sparse_bends(vec4 a, vec4 b, vec4 c)
{
    vec3 bend = abs(a.rgb - 2.0 * b.rgb + c.rgb), most = SPARSE_BEND * max(b.rgb, 1e-20);
    return any(greaterThan(bend, most)) || min(a.a, min(b.a, c.a)) < 0.0;
}

bool sparse_smooth(ivec2 block, int k)
{
    vec4 at = sparse_fetch(block, k);
    bool bends = false;
    for (int i = 0; i < 4; i++) { // along rows, columns and both diagonals
        ivec2 way = i == 0 ? ivec2(1, 0) : ivec2(i - 2, 1);
        bends = bends || sparse_bends(sparse_fetch(block - way, k), at, sparse_fetch(block + way, k));
    }
    return !bends;
}

vec3 sparse_between(ivec2 block, ivec2 other, int k)
{
    return 0.5625 * sparse_fetch(block, k).rgb +
           0.1875 * (sparse_fetch(ivec2(other.x, block.y), k).rgb + sparse_fetch(ivec2(block.x, other.y), k).rgb) +
           0.0625 * sparse_fetch(other, k).rgb;
}

void shade_pixel(ivec2 pixel)
{
    pixel_light sum = pixel_light(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, TYN_INFINITY, TYN_INFINITY, 0u,
                                  false);
    uint num_rays = rays_of_pixel(pixel);
    surface_group group = surface_group(vec4(vec3(0.0), TYN_INFINITY), 1.0, TYN_INFINITY, vec2(0.5));
    if (raymarch_has(RAYMARCH_SURFACE)) {
        group = surface_group_from(surface_tex, camera, pixel, 0.0);
        num_rays = group.share < 1.0 ? 1u : num_rays;
    }
    march_result known = march_result(vec3(0.0), vec3(1.0), vec3(1.0));
    bool given = false;
    if (raymarch_has(RAYMARCH_SPARSE)) {
        ivec2 inside = pixel - ivec2(args.first), block = inside / 2, other = block + 2 * (inside & 1) - 1;
        given = sparse_smooth(block, 0) && sparse_smooth(block, 1);
        known = march_result(sparse_between(block, other, 0), sparse_between(block, other, 1),
                             sparse_between(block, other, 2));
    }
    for (uint i = 0u; i < num_rays; i++) {
        vec2 where = num_rays == 1u ? vec2(0.5) : quarter_pixel(i);
        add_ray(sum, pixel, where, num_rays == 1u ? 1.0 : 0.5, group, given, known);
    }
    float share = 1.0 / float(num_rays);
    vec3 radiance = share * sum.radiance, transmittance = share * sum.transmittance;
    vec3 single = share * sum.single, multiple = share * sum.multiple;
    float cover = share * sum.cover;
    if (!is_finite(radiance) || !is_finite(transmittance)) {
        atomicAdd(counters.non_finite, 1u);
        radiance = single = multiple = vec3(0.0);
        transmittance = vec3(1.0);
        cover = 0.0;
    }
    if (sum.met) {
        atomicAdd(counters.steps, sum.steps);
        atomicAdd(counters.pixels, 1u);
    }
    cover = raymarch_has(RAYMARCH_BACKGROUND) ? 1.0 : cover;
    imageStore(radiance_image, pixel, vec4(max(radiance, 0.0), cover));
    if (raymarch_has(RAYMARCH_TRANSMITTANCE)) {
        imageStore(transmittance_image, pixel, vec4(transmittance, 1.0));
    }
    if (raymarch_has(RAYMARCH_DEPTH)) {
        imageStore(depth_image, pixel, vec4(sum.nearest, sum.half_distance, 0.0, 0.0));
    }
    if (raymarch_has(RAYMARCH_SINGLE)) {
        imageStore(single_image, pixel, vec4(single, 1.0));
    }
    if (raymarch_has(RAYMARCH_MULTIPLE)) {
        imageStore(multiple_image, pixel, vec4(multiple, 1.0));
    }
}

#endif
