// lattice_power.h -- what lattice_source tells balance about a sun. Included by C and GLSL.
#ifndef TYN_LATTICE_POWER_H
#define TYN_LATTICE_POWER_H
#include "shared.h"

// Power of sun n in channel c at [n * channels + c], W per unit of the sun's colour.
struct lattice_power {
    float entering; // through the medium's box
    float lost;     // by the beam on its way, from the optical depths where it leaves the box
    float collided; // the same summed over the cells, after scaling
    float scale;    // factor that makes the cells lose what the beam loses
};
TYN_ASSERT_SIZE(lattice_power, 16);

#endif
