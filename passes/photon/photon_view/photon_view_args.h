// photon_view_args.h -- push constants of what the cache sends to the eye. Included by C and GLSL.
#include "shaders/common/shared.h"

// How a lobe's light is distributed: from all sides alike, about the strongest sun, about its net flux in each cell.
#define PHOTON_LOBE_EVEN 0
#define PHOTON_LOBE_AXIS 1
#define PHOTON_LOBE_FLUX 2

struct photon_view_args {
    tyn_uvec3 dims;
    tyn_vec3 sun;    // reference direction (M), of travel
    tyn_uint lobes;  // of a cell
    tyn_uint suns;   // 1: the first is the strongest sun's
    tyn_uint sun_is; // PHOTON_LOBE_AXIS or _FLUX
    tyn_uint sky_is; // PHOTON_LOBE_EVEN or _FLUX
    tyn_uint scaled; // 1: forward scattering counts as none
};
TYN_ASSERT_SIZE(photon_view_args, 44);
