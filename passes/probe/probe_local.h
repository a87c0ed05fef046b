// probe_local.h -- which grids of local lights a probe looks at. Included by C and GLSL.

#define TYN_PROBE_LOCAL_NONE 0
#define TYN_PROBE_LOCAL_LAMPS 1
#define TYN_PROBE_LOCAL_ALL 2 // and virtual point lights
