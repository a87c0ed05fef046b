// light_blocks.c -- lights of a scene as shaders see them.
#include <tyndall/extend/frame_scene.h>
#include <string.h>

_Static_assert((int)TYN_LIGHT_DIRECTIONAL == TYN_LIGHT_KIND_DIRECTIONAL &&
                   (int)TYN_LIGHT_POINT == TYN_LIGHT_KIND_POINT &&
                   (int)TYN_LIGHT_SPOT == TYN_LIGHT_KIND_SPOT,
               "kinds of a scene are kinds of shaders");

struct light_block tyn_light_block(const tyn_light *light)
{
    const tyn_light_traits *kind = tyn_light_traits_of(light->kind);
    struct light_block block = {.kind = (tyn_uint)light->kind,
                                .shadow = TYN_LIGHT_NO_SHADOW,
                                .mean_cosine = kind->has_position ? 0 : 1,
                                .cos_inner = kind->has_cone ? light->cos_inner : kind->cos_inner,
                                .cos_outer = kind->has_cone ? light->cos_outer : kind->cos_outer};
    memcpy(block.color, light->color, sizeof block.color);
    return block;
}

double tyn_light_solid_angle(const tyn_light *light)
{
    const tyn_light_traits *kind = light ? tyn_light_traits_of(light->kind) : NULL;
    return kind && kind->has_position ? (double)light_lobe_integral(tyn_light_block(light)) : 0;
}
