// refs.h -- the bundles of ports (shaders/common/bundles.h) as structs of refs. Tier 5.
//
// A bundle goes from whoever fills it to the node that reads it in one call: tyn_connect(refs, MERGE_PORT_BEAMS, s->beams).
#pragma once
#include "graph.h"
#include "shaders/common/bundles.h"
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

// Of a bundle, into the refs of a node, from its first port on; and what a node made, out of them.
#define tyn_connect(refs, first, bundle) memcpy(&(refs)[first], &(bundle), sizeof(bundle))
#define tyn_take(refs, first, bundle) memcpy(&(bundle), &(refs)[first], sizeof(bundle))

typedef struct tyn_medium_refs {
    tyn_ref TYN_MEDIUM(TYN_PORT_NAME, );
} tyn_medium_refs;

// {0} without suns.
typedef struct tyn_beam_refs {
    tyn_ref TYN_BEAMS(TYN_PORT_NAME, );
} tyn_beam_refs;

// {0} without lamps and virtual point lights.
typedef struct tyn_radial_refs {
    tyn_ref TYN_RADIALS(TYN_PORT_NAME, );
} tyn_radial_refs;

// {0} without ordinates.
typedef struct tyn_column_refs {
    tyn_ref TYN_COLUMNS(TYN_PORT_NAME, );
} tyn_column_refs;

// {0} without surfaces, or without lights.
typedef struct tyn_shadow_refs {
    tyn_ref TYN_SHADOWS(TYN_PORT_NAME, );
} tyn_shadow_refs;

// {0} without surfaces, or without ordinates.
typedef struct tyn_sky_map_refs {
    tyn_ref TYN_SKY_MAPS(TYN_PORT_NAME, );
} tyn_sky_map_refs;
typedef struct tyn_sky_seen_refs {
    tyn_ref TYN_SKY_SEEN(TYN_PORT_NAME, );
} tyn_sky_seen_refs;

// {0} without surfaces near the media.
typedef struct tyn_wall_refs {
    tyn_ref TYN_WALLS(TYN_PORT_NAME, );
} tyn_wall_refs;

// {0} without surfaces that light reaches.
typedef struct tyn_vpl_refs {
    tyn_ref TYN_VPLS(TYN_PORT_NAME, );
} tyn_vpl_refs;

// {0} without surfaces, or without lights.
typedef struct tyn_rsm_refs {
    tyn_ref TYN_RSM(TYN_PORT_NAME, );
} tyn_rsm_refs;

// {0} without surfaces.
typedef struct tyn_gbuffer_refs {
    tyn_ref TYN_GBUFFER(TYN_PORT_NAME, );
} tyn_gbuffer_refs;

// {0} without surfaces; `nodes` also where they have no hierarchy.
typedef struct tyn_geometry_refs {
    tyn_ref TYN_GEOMETRY(TYN_PORT_NAME, );
} tyn_geometry_refs;
typedef struct tyn_material_refs {
    tyn_ref TYN_MATERIALS(TYN_PORT_NAME, );
} tyn_material_refs;

#ifdef __cplusplus
}
#endif
