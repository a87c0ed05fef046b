// raymarch_sparse.glsl -- fewer rays than pixels, where the light is smooth.
//
// Include after raymarch_pixel.glsl.
//
// Most of a fog is smooth. So there is first one ray for every 2x2 pixels, through their middle and as far as their
// surfaces. Where that picture bends by no more than SPARSE_BEND of itself from block to block a pixel takes what
// lies between the four blocks around it; other blocks, and those at edges of surfaces and media, are listed, and their
// pixels have rays of their own: in a dispatch of its own, so that none of the threads that run together has nothing to
// do.
//
// A quarter of the way between two rays a parabola is 1/4 x 3/4 / 2 of its second difference off the straight line: along
// both axes pixels are wrong by 3/16 of SPARSE_BEND at most, 1.1 %.
#ifndef TYN_RAYMARCH_SPARSE_GLSL
#define TYN_RAYMARCH_SPARSE_GLSL

const float SPARSE_BEND = 0.06;
// The ray ends in the middle of its pixels' distances, so it is a twentieth too long or short, which in fog of depth t changes
// light by t e^-t / 20 at most, 1.8 %.
const float SPARSE_UNEVEN = 1.1; // farthest over nearest distance

// Where part k, 0 to 2, of what a block's ray brings is: the image has no more texels than the picture, at whose size
// other images may have reached what the device can hold.
ivec2 sparse_texel(ivec2 block, int k)
{
    return 2 * block + ivec2(k & 1, k >> 1);
}

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
            surface_group group = surface_group_from(camera, pixel, ~0u, false);
            even = even && group.share > 0.999;
            nearest = min(nearest, group.mean.a);
            farthest = max(farthest, group.mean.a);
            inverses += 1.0 / max(group.mean.a, 1e-30);
        }
    }
    float surface = TYN_INFINITY;
    if (raymarch_has(RAYMARCH_SURFACE) && nearest < TYN_INFINITY) {
        even = even && farthest < SPARSE_UNEVEN * nearest;
        surface = even ? 4.0 / inverses : nearest;
    }
    camera_ray ray = camera_ray_through(camera, vec2(corner) + 1.0);
    vec2 span = pixel_span(ray);
    march_state state = march_start(0.5);
    march_result r = march_ray(state, ray.origin + span.x * ray.direction, ray.direction,
                               even ? max(min(span.y, surface) - span.x, 0.0) : 0.0, span.x);
    even = even && is_finite(r.radiance) && is_finite(r.transmittance);
    atomicAdd(counters.steps, state.steps);
    imageStore(sparse_image, sparse_texel(block, 0), vec4(r.radiance, even ? 1.0 : -1.0));
    imageStore(sparse_image, sparse_texel(block, 1), vec4(r.transmittance, 1.0));
    imageStore(sparse_image, sparse_texel(block, 2), vec4(r.scaled_transmittance, 1.0));
}

vec4 sparse_fetch(ivec2 block, int k)
{
    ivec2 last = (ivec2(args.end - args.first) + 1) / 2 - 1;
    block = clamp(block, ivec2(0), last);
    return texelFetch(sparse_tex, sparse_texel(block, k), 0);
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

void list_block(ivec2 block)
{
    uint n = atomicAdd(sparse_rest.head.count, 1u);
    sparse_rest.blocks[n] = uvec2(block).x | uvec2(block).y << 16;
    atomicMax(sparse_rest.head.groups.y, n / (RAYMARCH_REST_BLOCKS * RAYMARCH_REST_GROUPS) + 1u);
}

// Gives the block's pixels what lies between rays, or lists it.
void fill_block(ivec2 block)
{
    if (!sparse_smooth(block, 0) || !sparse_smooth(block, 1)) {
        list_block(block);
        return;
    }
    uint met = 0u;
    for (int i = 0; i < 4; i++) {
        ivec2 in_block = ivec2(i & 1, i >> 1), pixel = ivec2(args.first) + 2 * block + in_block;
        ivec2 other = block + 2 * in_block - 1;
        if (any(greaterThanEqual(pixel, ivec2(args.end)))) {
            continue;
        }
        march_result r = march_result(sparse_between(block, other, 0), sparse_between(block, other, 1),
                                      sparse_between(block, other, 2));
        pixel_light sum = pixel_light_none();
        surface_group group = first_surface(pixel, false);
        add_light(sum, pixel, vec2(0.5), 1.0, group, ray_to(pixel, vec2(0.5), group), r, vec3(0.0));
        store_pixel(pixel, sum, 1.0);
        met += sum.met ? 1u : 0u;
    }
    if (met > 0u) {
        atomicAdd(counters.pixels, met);
    }
}

// Thread `i` of those for the pixels that were listed.
void shade_rest(uint i)
{
    if (i / 4u < sparse_rest.head.count) {
        uint block = sparse_rest.blocks[i / 4u];
        uvec2 pixel = args.first + 2u * uvec2(block & 0xffffu, block >> 16) + uvec2(i & 1u, i >> 1 & 1u);
        if (all(lessThan(pixel, args.end))) {
            shade_pixel(ivec2(pixel));
        }
    }
}

#endif
