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

// The refs of a bundle as a struct; {0} in a scene without the things behind it.
#define TYN_REFS(name, BUNDLE)                                                                     \
    typedef struct name {                                                                          \
        tyn_ref BUNDLE(TYN_PORT_NAME, );                                                           \
    } name

TYN_REFS(tyn_medium_refs, TYN_MEDIUM);
TYN_REFS(tyn_beam_refs, TYN_BEAMS);       // suns
TYN_REFS(tyn_radial_refs, TYN_RADIALS);   // lamps, virtual point lights
TYN_REFS(tyn_column_refs, TYN_COLUMNS);   // ordinates
TYN_REFS(tyn_shadow_refs, TYN_SHADOWS);   // surfaces and lights
TYN_REFS(tyn_sky_map_refs, TYN_SKY_MAPS); // surfaces and ordinates, as the next
TYN_REFS(tyn_sky_seen_refs, TYN_SKY_SEEN);
TYN_REFS(tyn_wall_refs, TYN_WALLS);         // surfaces near the media
TYN_REFS(tyn_vpl_refs, TYN_VPLS);           // surfaces that light reaches
TYN_REFS(tyn_rsm_refs, TYN_RSM);            // surfaces and lights
TYN_REFS(tyn_gbuffer_refs, TYN_GBUFFER);    // surfaces
TYN_REFS(tyn_geometry_refs, TYN_GEOMETRY);  // surfaces; `nodes`: their hierarchy
TYN_REFS(tyn_material_refs, TYN_MATERIALS); // surfaces

#ifdef __cplusplus
}
#endif
