// rsm_args.h -- reflective shadow maps: what each light shines on. Included by C and GLSL; scalar layout.
//
// The maps of all lights lie in one atlas of three images:
//   "rsm_flux"      rgb: power that the surface in the texel reflects, W, as if there were no medium on
//                   the way from the light: irradiance x area x albedo, or intensity x solid angle x albedo
//   "rsm_position"  rgb: M, m; a: area of the surface in the texel, m^2
//   "rsm_normal"    rgb: M, unit, on the side of the light
// Texels that see no surface are 0. So is the flux of surfaces that face nothing, neither media nor other
// surfaces (surface_faces.glsl): what they reflect leaves the scene.
//
// The sky shines from everywhere, so no map of one view has what it shines on: its two tiles have places that stand for all
// surfaces, fronts in one and backs in the other, and their flux is of light that has passed the medium.
#ifndef TYN_RSM_ARGS_H
#define TYN_RSM_ARGS_H
#include "shaders/common/shared.h"

#define TYN_RSM_MAX_TILES (4 + 6 * 64 + 2)
#define TYN_RSM_SKY                                                                                \
    (4 + 64) // rsm_tile.light of the places' fronts under the sky; that of their backs is the next

struct rsm_tile {     // one map: of a sun or a spot, or a face of a point light's cube
    tyn_uvec2 offset; // in the atlas, texels
    tyn_uint texels;  // of each side: a power of two, 16 or more
    tyn_uint light;   // index of shadow_args.h: suns first, then lamps from TYN_SHADOW_SUNS on; the
                      // maps of a light follow each other
};
TYN_ASSERT_SIZE(rsm_tile, 16);

#endif
