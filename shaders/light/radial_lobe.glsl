// radial_lobe.glsl -- how much a local light shines in a direction. No bindings.
#ifndef TYN_RADIAL_LOBE_GLSL
#define TYN_RADIAL_LOBE_GLSL
#include "shaders/beams/radial_args.h"

// Share of the intensity in direction d (unit, away from the light).
float radial_lobe(uint kind, vec3 axis, float cos_inner, float cos_outer, vec3 d)
{
    if (kind == TYN_RADIAL_ISOTROPIC) {
        return 1.0;
    }
    float c = dot(d, axis);
    if (kind == TYN_RADIAL_COSINE) {
        return max(c, 0.0);
    }
    float width = cos_inner - cos_outer;
    if (width < 1e-6) { // a sharp edge
        return c >= cos_outer ? 1.0 : 0.0;
    }
    float a = clamp((c - cos_outer) / width, 0.0, 1.0);
    return a * a;
}

// Its integral over all directions, sr.
float radial_lobe_integral(uint kind, float cos_inner, float cos_outer)
{
    const float PI = 3.14159265358979;
    return kind == TYN_RADIAL_ISOTROPIC ? 4.0 * PI
           : kind == TYN_RADIAL_COSINE  ? PI
                                        : 2.0 * PI * (1.0 - (2.0 * cos_inner + cos_outer) / 3.0);
}

#endif
