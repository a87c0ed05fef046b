// env_importance_mips.comp -- the next three levels of the pyramid.
//
// A workgroup owns 16 x 16 texels of the level it reads. Radiance is averaged by solid angle, the
// fourth channel is added up.
#include "shaders/light/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D sky_image0;
layout(binding = 1, rgba32f) uniform writeonly image2D sky_image1;
layout(binding = 2, rgba32f) uniform writeonly image2D sky_image2;
layout(binding = 3, rgba32f) uniform writeonly image2D sky_image3;

shared vec4 texels[2][8][8]; // of the first and of the second level

// Two texels of one row beside two of the next; `row` is the first one's, of `size` texels.
vec4 parent(vec4 a, vec4 b, vec4 c, vec4 d, int row, ivec2 size)
{
    float upper = sky_texel_solid_angle(row, size), lower = sky_texel_solid_angle(row + 1, size);
    vec3 mean = ((a.rgb + b.rgb) * upper + (c.rgb + d.rgb) * lower) / (2.0 * (upper + lower));
    return vec4(mean, a.a + b.a + c.a + d.a);
}

// The level of 2 x 1 texels.
vec4 parent_of_row(vec4 a, vec4 b)
{
    return vec4(0.5 * (a.rgb + b.rgb), a.a + b.a);
}

void main()
{
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), me = ivec2(gl_LocalInvocationID.xy);
    ivec2 size = imageSize(sky_image0);
    if (all(lessThan(2 * at, size))) {
        vec4 p = parent(imageLoad(sky_image0, 2 * at), imageLoad(sky_image0, 2 * at + ivec2(1, 0)),
                        imageLoad(sky_image0, 2 * at + ivec2(0, 1)), imageLoad(sky_image0, 2 * at + 1),
                        2 * at.y, size);
        texels[0][me.y][me.x] = p;
        imageStore(sky_image1, at, p);
    }
    barrier();
    size /= 2;
    const ivec2 at_2 = ivec2(gl_WorkGroupID.xy) * 4 + me;
    if (all(lessThan(me, ivec2(4))) && all(lessThan(2 * at_2, size))) {
        const ivec2 m = 2 * me;
        vec4 p = parent(texels[0][m.y][m.x], texels[0][m.y][m.x + 1], texels[0][m.y + 1][m.x],
                        texels[0][m.y + 1][m.x + 1], 2 * at_2.y, size);
        texels[1][me.y][me.x] = p;
        imageStore(sky_image2, at_2, p);
    }
    barrier();
    size /= 2;
    const ivec2 at_3 = ivec2(gl_WorkGroupID.xy) * 2 + me;
    if (all(lessThan(me, ivec2(2))) && all(lessThan(2 * at_3, size))) {
        const ivec2 m = 2 * me;
        vec4 p = size.y == 1
                     ? parent_of_row(texels[1][m.y][m.x], texels[1][m.y][m.x + 1])
                     : parent(texels[1][m.y][m.x], texels[1][m.y][m.x + 1], texels[1][m.y + 1][m.x],
                              texels[1][m.y + 1][m.x + 1], 2 * at_3.y, size);
        imageStore(sky_image3, at_3, p);
    }
}
