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

void shade_pixel(ivec2 pixel)
{
    vec3 radiance = vec3(0.0), single = vec3(0.0), multiple = vec3(0.0), transmittance = vec3(0.0);
    float surface = TYN_INFINITY, half_distance = TYN_INFINITY, nearest = TYN_INFINITY, cover = 0.0;
    uint steps = 0u, num_rays = rays_of_pixel(pixel);
    bool met = false;
    vec4 first = vec4(vec3(0.0), TYN_INFINITY); // surface of the scene
    int side = 0; // of the samples of several surfaces: a ray each
    if (raymarch_has(RAYMARCH_SURFACE)) {
        surface_samples samples = surface_samples_of(surface_tex, camera, pixel);
        first = samples.mean;
        side = samples.even ? 0 : samples.side;
        num_rays = samples.even ? num_rays : uint(side * side);
    }
    for (uint i = 0u; i < num_rays; i++) {
        vec2 where = num_rays == 1u ? vec2(0.5) : quarter_pixel(i);
        if (raymarch_has(RAYMARCH_SURFACE) && side > 0) {
            ivec2 at = ivec2(int(i) % side, int(i) / side);
            where = (vec2(at) + 0.5) / float(side);
            first = texelFetch(surface_tex, pixel * side + at, 0);
        }
        camera_ray ray = camera_ray_through(camera, vec2(pixel) + where);
        vec3 beyond = vec3(0.0); // a periodic medium: so many periods that none sees farther
        if (raymarch_has(RAYMARCH_REPEAT)) {
            beyond = 256.0 * medium.extent * vec3(medium.repeat);
        }
        vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), -beyond, medium.extent + beyond);
        span.x = max(span.x, 0.0);
        surface = first.a;
        if (raymarch_has(RAYMARCH_HOST_DEPTH)) {
            surface = min(surface, host_distance(host_depth_tex, camera, args.depth, pixel,
                                                 ray.direction));
        }
        bool shown = raymarch_has(RAYMARCH_SURFACE) && first.a < TYN_INFINITY && first.a == surface;
        nearest = min(nearest, surface);
        span.y = min(span.y, surface);
        met = met || span.x < span.y;
        // Distances from where the ray enters: the camera may be far away.
        march_result r = march_ray(ray.origin + span.x * ray.direction, ray.direction,
                                   max(span.y - span.x, 0.0), display_bayer(uvec2(pixel)), span.x);
        steps += r.steps;
        transmittance += r.transmittance;
        single += r.single;
        half_distance = min(half_distance, span.x + r.half_distance);
        // Light of what is behind that was scattered forward only: of the environment or, hardly out of
        // place, of the surface. In front of a host's surface it is not what lies behind that; the mean
        // keeps uniform surroundings uniform.
        vec3 light = r.radiance;
        if (raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN | RAYMARCH_SURFACE)) {
            vec3 smeared = raymarch_has(RAYMARCH_GLOW | RAYMARCH_MEAN) ? environment.sky : vec3(0.0);
            if (shown) {
                smeared = first.rgb;
            } else if (raymarch_has(RAYMARCH_GLOW) && surface == TYN_INFINITY) {
                smeared = environment.radiance *
                          glow_radiance(glow_tex, environment, ray.direction, r.forward_depth);
            }
            light += smeared * max(r.scaled_transmittance - r.transmittance, 0.0);
        }
        multiple += max(light - r.single, 0.0);
        radiance += light;
        if (raymarch_has(RAYMARCH_SURFACE_SEEN) && shown) {
            radiance += r.transmittance * first.rgb;
            cover += 1.0;
        } else if (!raymarch_has(RAYMARCH_BACKGROUND)) {
            cover += 1.0 - dot(r.transmittance, vec3(1.0 / 3.0));
        } else if (surface == TYN_INFINITY) {
            radiance += r.transmittance *
                        background_radiance(environment, environment_tex, camera, ray.direction,
                                            vec2(pixel) + where, num_rays == 1u ? 1.0 : 0.5);
        }
    }
    float share = 1.0 / float(num_rays);
    radiance *= share;
    transmittance *= share;
    if (!is_finite(radiance) || !is_finite(transmittance)) {
        atomicAdd(counters.non_finite, 1u);
        radiance = single = multiple = vec3(0.0);
        transmittance = vec3(1.0);
        cover = 0.0;
    }
    if (met) {
        atomicAdd(counters.steps, steps);
        atomicAdd(counters.pixels, 1u);
    }
    cover = raymarch_has(RAYMARCH_BACKGROUND) ? 1.0 : cover * share;
    imageStore(radiance_image, pixel, vec4(max(radiance, 0.0), cover));
    if (raymarch_has(RAYMARCH_TRANSMITTANCE)) {
        imageStore(transmittance_image, pixel, vec4(transmittance, 1.0));
    }
    if (raymarch_has(RAYMARCH_DEPTH)) {
        imageStore(depth_image, pixel, vec4(nearest, half_distance, 0.0, 0.0));
    }
    if (raymarch_has(RAYMARCH_SINGLE)) {
        imageStore(single_image, pixel, vec4(single * share, 1.0));
    }
    if (raymarch_has(RAYMARCH_MULTIPLE)) {
        imageStore(multiple_image, pixel, vec4(multiple * share, 1.0));
    }
}

#endif
