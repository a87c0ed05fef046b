// constellation_behind.glsl -- what a pixel shows behind the medium: up to four surfaces and the background.
//
// Include after surface_samples.glsl, host_depth.glsl and background.glsl. A pixel has one ray. What is before a surface
// shines for all of the pixel, what is behind it only for the share of the pixel in which the surface is not.

const uint BEHIND_MAX = 4u;

struct behind {
    float away[BEHIND_MAX];  // m from the eye; infinity: none
    float share[BEHIND_MAX]; // of the pixel
    vec3 radiance[BEHIND_MAX];
    float open;    // share without any of them
    float nearest; // m
    float host;    // distance of the host's surface, or infinity
};

behind behind_pixel(ivec2 pixel, vec3 direction)
{
    behind b;
    b.open = 1.0;
    b.host = TYN_INFINITY;
    for (uint i = 0u; i < BEHIND_MAX; i++) {
        b.away[i] = TYN_INFINITY;
        b.share[i] = 0.0;
        b.radiance[i] = vec3(0.0);
    }
    if (constellation_has(CONSTELLATION_HOST_DEPTH)) {
        b.host = host_distance(host_depth_tex, camera, args.depth, pixel, direction);
    }
    b.nearest = b.host;
    if (constellation_has(CONSTELLATION_SURFACE)) {
        uint left = ~0u;
        [[unroll]] for (uint i = 0u; i < BEHIND_MAX; i++) {
            // The last one has all that are left at about one distance.
            surface_group group = surface_group_from(pixel, left, i + 1u < BEHIND_MAX);
            if (b.open > 1e-3 && group.mean.a < b.host) {
                b.away[i] = group.mean.a;
                b.share[i] = group.share;
                b.radiance[i] = group.mean.rgb;
                b.open -= group.share;
                left = group.left;
            }
        }
        b.nearest = min(b.host, b.away[0]);
    }
    return b;
}

// Beyond this nothing is seen of the medium, m.
float behind_end(const behind b)
{
    float end = b.host;
    if (constellation_has(CONSTELLATION_SURFACE)) {
        float farthest = 0.0;
        [[unroll]] for (uint i = 0u; i < BEHIND_MAX; i++) {
            farthest = max(farthest, b.share[i] > 0.0 ? b.away[i] : 0.0);
        }
        end = b.open > 1e-3 ? end : min(end, farthest);
    }
    return end;
}
