// lights.c -- lights of a scene as shaders see them.
#include <tyndall/extend/frame_scene.h>
#include <string.h>

_Static_assert((int)TYN_LIGHT_DIRECTIONAL == TYN_LIGHT_KIND_DIRECTIONAL &&
                   (int)TYN_LIGHT_POINT == TYN_LIGHT_KIND_POINT &&
                   (int)TYN_LIGHT_SPOT == TYN_LIGHT_KIND_SPOT,
               "kinds of a scene are kinds of shaders");

struct light_block tyn_light_block(const tyn_light *light)
{
    struct light_block block = {.kind = (tyn_uint)light->kind, .shadow = TYN_LIGHT_NO_SHADOW};
    memcpy(block.color, light->color, sizeof block.color);
    switch (light->kind) {
    case TYN_LIGHT_DIRECTIONAL:
        block.mean_cosine = 1;
        break;
    case TYN_LIGHT_POINT:
        block.cos_inner = block.cos_outer = -1;
        break;
    case TYN_LIGHT_SPOT:
        block.cos_inner = light->cos_inner;
        block.cos_outer = light->cos_outer;
        break;
    }
    return block;
}

double tyn_light_solid_angle(const tyn_light *light)
{
    return !light || light->kind == TYN_LIGHT_DIRECTIONAL
               ? 0
               : (double)light_lobe_integral(tyn_light_block(light));
}
