// shade_lights.comp -- all lights into the image that shade_table.h describes. A thread a light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shade_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/beams/radial_args.h"
#include "shaders/light/shadow_args.h"
#include "shade_table.h"

layout(constant_id = 0) const uint mode = 0u; // as all kernels of the pass have it, and num_suns
layout(constant_id = 1) const uint shade_features = 0u;
layout(push_constant, scalar) uniform Args
{
    shade_args args;
};
layout(local_size_x = 64) in;

layout(binding = 0, scalar) readonly buffer radial_buffer
{
    uint radial_count, radial_num_lamps;
    uvec2 radial_pad;
    radial_grid radials[];
};
layout(binding = 1, scalar) readonly buffer shadow_buffer
{
    shadow_light shadows[];
};
layout(binding = 2, scalar) readonly buffer vpl_buffer
{
    uint vpl_count;
    uvec3 vpl_pad;
    radial_light vpls[];
};
layout(binding = 3, scalar) uniform light_uniform
{
    light_block lights[TYN_LIGHTS_MAX];
};
layout(binding = 4, rgba32f) uniform writeonly image2D table_image;

bool has(uint feature)
{
    return (shade_features & feature) != 0u;
}

void put(uint row, int entry, vec3 v, float w)
{
    imageStore(table_image, ivec2(entry, row), vec4(v, w));
}

void put_light(uint row, radial_light light)
{
    put(row, SHADE_POSITION, light.position, light.radius);
    put(row, SHADE_AXIS, light.axis, float(light.kind));
    put(row, SHADE_INTENSITY, light.intensity, light.cos_inner);
    put(row, SHADE_CONE, vec3(0.0), light.cos_outer);
}

void put_grid(uint row, uint n)
{
    put(row, SHADE_TO_MAP, radials[n].to_map[0], radials[n].begin);
    put(row, SHADE_TO_MAP + 1, radials[n].to_map[1], radials[n].inverse_near);
    put(row, SHADE_TO_MAP + 2, radials[n].to_map[2], float(radials[n].inside));
    put(row, SHADE_BASE, radials[n].base, 0.0);
    put(row, SHADE_SCALE, radials[n].scale, 0.0);
}

void put_shadow(uint row, uint n)
{
    for (int k = 0; k < 3; k++) {
        put(row, SHADE_SHADOW_ROWS + k, shadows[n].rows[k].xyz, shadows[n].rows[k].w);
    }
    put(row, SHADE_SHADOW_PLACE, vec3(shadows[n].offset, shadows[n].texels), shadows[n].scale);
    put(row, SHADE_SHADOW_KIND, vec3(shadows[n].near, float(shadows[n].kind), 0.0), 0.0);
}

void main()
{
    uint row = gl_GlobalInvocationID.x;
    if (row >= uint(SHADE_ROWS)) {
        return;
    }
    if (row == 0u) {
        float count = has(SHADE_VPLS) ? float(min(vpl_count, uint(TYN_RADIAL_VPLS_MAX))) : 0.0;
        put(row, SHADE_COUNT, vec3(count, 0.0, 0.0), 0.0);
    }
    if (row >= uint(SHADE_ROW_SUNS)) {
        if (has(SHADE_SHADOWS) && row - uint(SHADE_ROW_SUNS) < TYN_SHADOW_SUNS) {
            put_shadow(row, row - uint(SHADE_ROW_SUNS));
        }
    } else if (row >= uint(SHADE_ROW_VPLS)) {
        uint k = row - uint(SHADE_ROW_VPLS);
        if (has(SHADE_VPLS) && k < vpl_count) {
            put_light(row, vpls[k]);
            if (has(SHADE_MEDIUM)) {
                put_grid(row, args.num_lamps + k);
            }
        }
    } else if (row < args.num_lamps) {
        // Grids are in the order of the lamps' strength.
        uint lamp = has(SHADE_MEDIUM) ? radials[row].light.light - TYN_SHADOW_LAMP(0u) : row;
        light_block l = lights[args.num_directional + lamp];
        uint kind = l.kind == TYN_LIGHT_KIND_SPOT ? TYN_RADIAL_SPOT : TYN_RADIAL_ISOTROPIC;
        put_light(row, radial_light(l.position, kind, l.color, l.cos_inner, l.direction, l.cos_outer, 0.0, 0u));
        if (has(SHADE_MEDIUM)) {
            put_grid(row, row);
        }
        if (has(SHADE_SHADOWS)) {
            put_shadow(row, TYN_SHADOW_LAMP(lamp));
        }
    }
}
