// lattice_power.h -- what lattice_source tells balance about a sun, and lattice_lamps about a group of local
// lights. Included by C and GLSL.
#ifndef TYN_LATTICE_POWER_H
#define TYN_LATTICE_POWER_H
#include "shaders/common/shared.h"

// Power of sun n in channel c at [n * channels + c], W per unit of the sun's colour.
struct lattice_power {
    float entering; // through the medium's box
    float lost;     // by the beam on its way, from the optical depths where it leaves the box
    float collided; // the same summed over the cells, after scaling
    float scale;    // factor that makes the cells lose what the beam loses
};
TYN_ASSERT_SIZE(lattice_power, 16);

// Of a group of local lights in channel c at [group * channels + c], W.
struct lattice_lamp_power {
    float entering; // from outside the medium's box
    float emitted;  // in it
    float lost;     // on the way to where the light leaves the box, from the optical depths there
    float scale;    // factor that makes the cells lose as much
};
TYN_ASSERT_SIZE(lattice_lamp_power, 16);

#endif
