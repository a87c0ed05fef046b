// lpv_scatter_args.h -- rays from lights, and push constants of lpv_scatter. Included by C and GLSL.
#include "shaders/common/shared.h"
#include "shaders/light/light_args.h"
#include "shaders/light/shadow_args.h"

#define LPV_SCATTER_SIDE 8 // of a workgroup
#define LPV_SCATTER_BUNDLES (TYN_SHADOW_SUNS + 6 * TYN_SHADOW_LAMPS)

// Ray (u, v), both in [0, 1]: from origin + u origin_u + v origin_v along direction + u direction_u + v direction_v, in M.
struct lpv_scatter_bundle {
    tyn_vec3 origin;
    float
        measure; // of all rays: of a sun the area across it, m^2; of a lamp that of the map in the plane at 1
    tyn_vec3 origin_u;
    tyn_uint light; // index of shadow_args.h
    tyn_vec3 origin_v;
    tyn_uint texels; // rays along a side
    tyn_vec3 direction;
    tyn_uint pad0;
    tyn_vec3 direction_u;
    tyn_uint pad1;
    tyn_vec3 direction_v;
    tyn_uint pad2;
};
TYN_ASSERT_SIZE(lpv_scatter_bundle, 96);

struct lpv_scatter_args {
    tyn_uvec3 dims; // cells
    tyn_uint channels;
    tyn_vec3 tint;
    float unit;     // W
    tyn_uint first; // bundle of the first layer of threads
    tyn_uint samples;
    float majorant; // of what scatters, 1/m
};
TYN_ASSERT_SIZE(lpv_scatter_args, 44);
