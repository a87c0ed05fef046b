// light_kinds.c -- what there is to know of the kinds of lights, but for how they shine (shaders/light/light_args.h).
#include "scene/check.h"
#include "base/fault.h"

const tyn_light_traits *tyn_light_traits_of(tyn_light_kind kind)
{
    static const tyn_light_traits kinds[] = {
        [TYN_LIGHT_DIRECTIONAL] = {"directional", "W/m^2", .has_direction = true},
        [TYN_LIGHT_POINT] = {"point", "W/sr", .has_position = true, .cos_inner = -1,
                             .cos_outer = -1},
        [TYN_LIGHT_SPOT] = {"spot", "W/sr", .has_position = true, .has_direction = true,
                            .has_cone = true},
    };
    return (size_t)kind < sizeof kinds / sizeof kinds[0] ? &kinds[kind] : NULL;
}

tyn_result tyn_light_check_lobe(const tyn_light *l, uint32_t i, const tyn_log *log)
{
    if (tyn_light_traits_of(l->kind)->has_cone &&
        !(l->cos_outer >= -1.0f && l->cos_outer <= l->cos_inner && l->cos_inner <= 1.0f)) {
        FAULT("lights[%u]: cosines of its cone are %g (inner), %g (outer): must be -1 <= outer <= "
              "inner <= 1",
              i, l->cos_inner, l->cos_outer);
    }
    return TYN_OK;
}
