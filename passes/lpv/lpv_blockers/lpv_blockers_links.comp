// lpv_blockers_links.comp -- of light that comes to a cell along its 26 links, how much is blocked.
#include "lpv_blockers_args.h"
#include "shaders/walls/walls_links.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
TYN_ARGS(lpv_blockers_args args);
TYN_READ(0, potential, ivec4 potential[]);
TYN_WRITE(1, blocking, uint blocking[]);

// The shifted cells around the middle of the link from c along `way`, where light comes from: at its end in the axes it steps
// along, on both sides in the others.
float blocked(ivec3 c, ivec3 way)
{
    ivec3 dims = ivec3(args.dims) + 1, lo = c + max(way, ivec3(0)), more = 1 - abs(way);
    vec4 sum = vec4(0.0);
    for (int z = 0; z <= more.z; z++) {
        for (int y = 0; y <= more.y; y++) {
            for (int x = 0; x <= more.x; x++) {
                ivec3 q = lo + ivec3(x, y, z);
                sum += vec4(potential[(q.z * dims.y + q.y) * dims.x + q.x]);
            }
        }
    }
    sum /= float((1 + more.x) * (1 + more.y) * (1 + more.z)) * LPV_BLOCKERS_UNIT;
    // Surfaces are seen from the middle of the lattice alone, and block light to either side of them. A link's own direction
    // stands for its transfer function.
    return clamp(sum.x + abs(dot(sum.yzw, normalize(vec3(way)))), 0.0, 1.0);
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(c, ivec3(args.dims)))) {
        return;
    }
    uint at = 7u * uint((c.z * int(args.dims.y) + c.y) * int(args.dims.x) + c.x);
    for (uint word = 0u; word < 7u; word++) {
        uint bytes = 0u;
        for (uint k = 0u; k < 4u && 4u * word + k < 26u; k++) {
            bytes |= uint(round(255.0 * blocked(c, -walls_step(4u * word + k)))) << 8u * k;
        }
        blocking[at + word] = bytes;
    }
}
