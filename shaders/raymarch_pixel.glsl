// raymarch_pixel.glsl -- the rays of one pixel and what is stored of them.
//
// Include after raymarch.glsl and display.glsl.
#ifndef TYN_RAYMARCH_PIXEL_GLSL
#define TYN_RAYMARCH_PIXEL_GLSL

// Pixel of a thread of an 8x8 group, so that any 8 threads in a row are a block of 4x2 pixels, whose
// rays take about equally many steps.
ivec2 pixel_of_thread(uvec2 group, uint i)
{
    uvec2 p = uvec2((i & 3u) | (i >> 1 & 4u), (i >> 2 & 1u) | (i >> 3 & 6u));
    return ivec2(group * 8u + p);
}

// Which of the first 64 shapes a ray meets, as bits.
uvec2 shapes_met(camera_ray ray)
{
    uvec2 met = uvec2(0u);
    for (uint i = 0u; i < min(medium.num_shapes, 64u); i++) {
        vec2 span = ray_shape(shapes[i], ray.origin, ray.direction);
        if (span.x < span.y && span.y > 0.0) {
            met[i >> 5] |= 1u << (i & 31u);
        }
    }
    return met;
}

vec2 quarter_pixel(uint i)
{
    return vec2(0.25 + 0.5 * float(i & 1u), 0.25 + 0.5 * float(i >> 1));
}

// 4 if the rays of the pixel's quarters disagree on which shapes they meet, else 1.
uint rays_of_pixel(ivec2 pixel)
{
    if (args.supersample == 0u) {
        return 1u;
    }
    uvec2 first = shapes_met(camera_ray_through(camera, vec2(pixel) + quarter_pixel(0u)));
    bool agree = true;
    for (uint i = 1u; i < 4u; i++) {
        agree = agree &&
                shapes_met(camera_ray_through(camera, vec2(pixel) + quarter_pixel(i))) == first;
    }
    return agree ? 1u : 4u;
}

// Distance along the ray to the host's surface.
float host_distance(ivec2 pixel, camera_ray ray)
{
    ivec2 size = textureSize(host_depth_tex, 0);
    ivec2 texel = ivec2((vec2(pixel) + 0.5) / vec2(camera.size) * vec2(size));
    float depth = texelFetch(host_depth_tex, min(texel, size - 1), 0).r;
    // Clip z and w are linear in view z: depth (p11 z + p15) = p10 z + p14.
    float below = depth * args.depth.z - args.depth.x;
    float z = (args.depth.y - depth * args.depth.w) / below;
    // An infinite far plane divides by zero.
    return abs(below) > 1e-12 ? abs(z) / dot(ray.direction, camera.forward) : RAYMARCH_INFINITY;
}

bool is_finite(vec3 v)
{
    return !any(isnan(v)) && !any(isinf(v));
}

void shade_pixel(ivec2 pixel)
{
    vec3 radiance = vec3(0.0), single = vec3(0.0), multiple = vec3(0.0), transmittance = vec3(0.0);
    float surface = RAYMARCH_INFINITY, half_distance = RAYMARCH_INFINITY;
    uint steps = 0u, num_rays = rays_of_pixel(pixel);
    bool met = false;
    for (uint i = 0u; i < num_rays; i++) {
        vec2 where = num_rays == 1u ? vec2(0.5) : quarter_pixel(i);
        camera_ray ray = camera_ray_through(camera, vec2(pixel) + where);
        vec2 span = ray_box(ray.origin, ray_inverse(ray.direction), vec3(0.0), medium.extent);
        span.x = max(span.x, 0.0);
        if (raymarch_has(RAYMARCH_HOST_DEPTH)) {
            surface = host_distance(pixel, ray);
            span.y = min(span.y, surface);
        }
        met = met || span.x < span.y;
        // Distances from where the ray enters: the camera may be far away.
        march_result r = march_ray(ray.origin + span.x * ray.direction, ray.direction,
                                   max(span.y - span.x, 0.0), display_bayer(uvec2(pixel)));
        steps += r.steps;
        transmittance += r.transmittance;
        single += r.single;
        half_distance = min(half_distance, span.x + r.half_distance);
        // What went through or was scattered forward of the part of the environment that the field
        // holds: L_mean (e^-tau' - e^-tau) counts as scattered.
        vec3 scattered = r.radiance - r.single;
        if (raymarch_has(RAYMARCH_MEAN)) {
            scattered += environment.mean * max(r.scaled_transmittance - r.transmittance, 0.0);
        }
        multiple += max(scattered, 0.0);
        radiance += r.single + scattered;
        if (raymarch_has(RAYMARCH_BACKGROUND) && surface == RAYMARCH_INFINITY) {
            radiance += r.transmittance *
                        environment_radiance(environment, environment_tex, ray.direction);
        }
    }
    float share = 1.0 / float(num_rays);
    radiance *= share;
    transmittance *= share;
    if (!is_finite(radiance) || !is_finite(transmittance)) {
        atomicAdd(counters.non_finite, 1u);
        radiance = single = multiple = vec3(0.0);
        transmittance = vec3(1.0);
    }
    if (met) {
        atomicAdd(counters.steps, steps);
        atomicAdd(counters.pixels, 1u);
    }
    float cover = raymarch_has(RAYMARCH_BACKGROUND) ? 1.0 : 1.0 - dot(transmittance, vec3(1.0 / 3.0));
    imageStore(radiance_image, pixel, vec4(max(radiance, 0.0), cover));
    if (raymarch_has(RAYMARCH_TRANSMITTANCE)) {
        imageStore(transmittance_image, pixel, vec4(transmittance, 1.0));
    }
    if (raymarch_has(RAYMARCH_DEPTH)) {
        imageStore(depth_image, pixel, vec4(surface, half_distance, 0.0, 0.0));
    }
    if (raymarch_has(RAYMARCH_SINGLE)) {
        imageStore(single_image, pixel, vec4(single * share, 1.0));
    }
    if (raymarch_has(RAYMARCH_MULTIPLE)) {
        imageStore(multiple_image, pixel, vec4(multiple * share, 1.0));
    }
}

#endif
