// inscatter.h -- what a field of light towards the eye is, as the ray march reads it.
#pragma once

enum {
    TYN_INSCATTER_SCALED =
        0, // light per sigma_s' (sources.h: delta scaling); depths of the picture are delta scaled
    TYN_INSCATTER_PLAIN, // light per sigma_s; nothing is scaled
};
