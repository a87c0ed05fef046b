// raymarch_pixel.glsl -- where the rays of a pixel go, and what is stored of them.
//
// Include after raymarch.glsl, background.glsl, surface_samples.glsl, glow.glsl and display.glsl.
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

// 4 if the rays through the pixel's quarters disagree on which shapes they meet, else 1. `shapes_met`: which ones all of them meet, by
// 24 bits.
uint rays_of_pixel(ivec2 pixel, out uint shapes_met)
{
    shapes_met = 0u;
    if (!raymarch_has(RAYMARCH_SUPERSAMPLE)) {
        return 1u;
    }
    // Origin or direction is linear in the image position.
    camera_ray ray = camera_ray_through(camera, vec2(pixel) + 0.5);
    vec2 quarter = 0.5 / camera_whole(camera);
    vec3 across = quarter.x * camera.half_width * camera.right;
    vec3 up = quarter.y * camera.half_height * camera.up;
    vec3 direction = ray.direction / camera_select(camera, 1.0, dot(ray.direction, camera.forward));
    bool agree = true;
    for (uint i = 0u; i < raymarch_num_shapes; i++) {
        vec3 o = shape_point(shapes[i], ray.origin), d = shape_vector(shapes[i], direction);
        vec3 x = shape_vector(shapes[i], across), y = shape_vector(shapes[i], up);
        uint met = 0u;
        for (uint k = 0u; k < 4u; k++) {
            vec3 shift = ((k & 1u) == 0u ? -x : x) + ((k & 2u) == 0u ? -y : y);
            vec3 moved = camera_select(camera, shift, vec3(0.0)), turned = camera_select(camera, vec3(0.0), shift);
            uint kind = raymarch_kind == TYN_SHAPE_KIND_ANY ? shapes[i].kind : raymarch_kind;
            vec2 span = ray_unit_shape(kind, o + moved, d + turned);
            met += span.x < span.y && span.y > 0.0 ? 1u : 0u;
        }
        agree = agree && (met == 0u || met == 4u);
        shapes_met ^= met == 4u ? 1u << i % 24u : 0u;
    }
    return agree ? 1u : 4u;
}

bool is_finite(vec3 v)
{
    return !any(isnan(v)) && !any(isinf(v));
}

// Where a ray is in the medium's box, from the eye on.
vec2 pixel_span(const camera_ray ray)
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

// A ray of a pixel, and where it ends.
struct pixel_ray {
    camera_ray ray;
    vec2 span;     // in the medium's box; empty if x >= y
    float surface; // distance of what it ends at, or infinity
    bool shown;    // that is one of the scene's surfaces
};

// `where` in the pixel: to several surfaces rays go through the middle of their samples.
pixel_ray ray_to(ivec2 pixel, vec2 where, const surface_group group)
{
    pixel_ray to;
    to.ray = camera_ray_through(camera, vec2(pixel) + (group.share < 1.0 ? group.where : where));
    to.span = pixel_span(to.ray);
    to.surface = group.mean.a;
    if (raymarch_has(RAYMARCH_HOST_DEPTH)) {
        to.surface = min(to.surface, host_distance(host_depth_tex, camera, args.depth, pixel, to.ray.direction));
    }
    to.span.y = min(to.span.y, to.surface);
    to.shown = raymarch_has(RAYMARCH_SURFACE) && group.mean.a < TYN_INFINITY && group.mean.a == to.surface;
    return to;
}

// Adds what the ray brings, `r`, and what is behind the medium, with the group's share. `single`: of light that has
// scattered once.
void add_light(inout pixel_light sum, ivec2 pixel, vec2 where, float footprint, const surface_group group, const pixel_ray to,
               const march_result r, vec3 single)
{
    sum.nearest = min(sum.nearest, to.surface);
    sum.met = sum.met || to.span.x < to.span.y;
    // Light of what is behind that was scattered forward only: of the environment or, hardly out of
    // place, of the surface. In front of a host's surface it is not what lies behind that; the mean
    // keeps uniform surroundings uniform.
    vec3 light = r.radiance;
    if (raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN | RAYMARCH_SURFACE)) {
        vec3 smeared = raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN) ? environment.sky : vec3(0.0);
        if (to.shown) {
            smeared = group.mean.rgb;
        } else if (raymarch_has(RAYMARCH_GLOW) && to.surface == TYN_INFINITY) {
            smeared = environment.radiance *
                      glow_radiance(glow_wrapped, environment, to.ray.direction, spectrum_of(march_forward_depth(r)));
        }
        light += smeared * max(r.scaled_transmittance - r.transmittance, 0.0);
    }
    sum.transmittance += group.share * r.transmittance;
    sum.single += group.share * single;
    sum.multiple += group.share * max(light - single, 0.0);
    if (raymarch_has(RAYMARCH_SURFACE_SEEN) && to.shown) {
        light += r.transmittance * group.mean.rgb;
        sum.cover += group.share;
    } else if (!raymarch_has(RAYMARCH_BACKGROUND)) {
        sum.cover += group.share * (1.0 - dot(r.transmittance, vec3(1.0 / 3.0)));
    } else if (to.surface == TYN_INFINITY) {
        light += r.transmittance * background_radiance(environment, env_map_wrapped, camera, to.ray.direction,
                                                       vec2(pixel) + where, footprint);
    }
    sum.radiance += group.share * light;
}

pixel_light pixel_light_none()
{
    return pixel_light(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, TYN_INFINITY, TYN_INFINITY, 0u, false);
}

// The nearest surfaces of a pixel, or that there are none. `one_piece`: as surface_group_from has it.
surface_group first_surface(ivec2 pixel, bool one_piece)
{
    if (raymarch_has(RAYMARCH_SURFACE)) {
        return surface_group_from(pixel, ~0u, one_piece);
    }
    return surface_group(vec4(vec3(0.0), TYN_INFINITY), 1.0, 0u, vec2(0.5));
}

// One block of pixels of so many tells of the picture's light: atomics of all would take time. Threads that run together
// tell all or nothing.
const int COUNTED = 16;

// Counts what the clamp of the pixel at 0 hides. One number a pixel: what a negative one shows in other channels is left out.
void count_light(ivec2 pixel, vec3 radiance)
{
    bool told = ((pixel.x >> 2) + 3 * (pixel.y >> 1)) % COUNTED == 0;
    float below = light_below(radiance), above = told ? float(COUNTED) * light_above(radiance) : 0.0;
    bool negative = below > 0.0;
    float light = negative ? below : above;
    if (light > 0.0) {
        TYN_LIGHT_ADD(counters.clamp_0, negative ? TYN_LIGHT_HIDDEN : TYN_LIGHT_SHOWN, light);
    }
    if (negative) {
        atomicAdd(counters.clamped, 1u);
    }
}

// `share` of the sum is the pixel's light.
void store_pixel(ivec2 pixel, const pixel_light sum, float share)
{
    vec3 radiance = share * sum.radiance, transmittance = share * sum.transmittance;
    vec3 single = share * sum.single, multiple = share * sum.multiple;
    float cover = share * sum.cover;
    if (!is_finite(radiance) || !is_finite(transmittance)) {
        atomicAdd(counters.non_finite, 1u);
        radiance = single = multiple = vec3(0.0);
        transmittance = vec3(1.0);
        cover = 0.0;
    }
    cover = raymarch_has(RAYMARCH_BACKGROUND) ? 1.0 : cover;
    count_light(pixel, radiance);
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
