// frame_scene.h -- the scene of a frame in the medium's frame M, as methods read it. Tier 5.
//
// Its blocks are those that shaders read: shaders/common/scene_args.h, shaders/light/light_args.h and
// shaders/surfaces/surface_args.h say what is in them. (Those files are installed with the GLSL that includes them.)
#pragma once
#include "../scene.h"
#include "shaders/beams/beam_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/surfaces/surface_args.h"

#ifdef __cplusplus
extern "C" {
#endif

// The lights in M, in the order in which shaders have them.
typedef struct tyn_lights {
    struct light_block scene[TYN_LIGHTS_MAX]; // directional lights, strongest first, then lamps
    uint32_t num_directional, num_lamps;
    // Directional lights and the suns of the environment's map, strongest first. `path` has the map's in the map.
    struct light_block suns[TYN_LIGHTS_MAX];
    uint32_t num_suns;
} tyn_lights;

// The strongest suns have a beam each: an aligned grid of optical depths and a shadow map. So many have.
static inline uint32_t tyn_num_beams(const tyn_lights *lights)
{
    return lights->num_suns < TYN_BEAM_MAX_SUNS ? lights->num_suns : TYN_BEAM_MAX_SUNS;
}

// Kind, colour and lobe of a light: all but where it is in M, and its shadow map.
TYN_API struct light_block tyn_light_block(const tyn_light *light);

static inline const struct light_block *tyn_first_lamp(const tyn_lights *lights)
{
    return lights->scene + lights->num_directional;
}

// The scene in the medium frame M (shaders/common/scene_args.h), made once per frame by the engine; methods read it.
typedef struct tyn_frame_scene {
    struct medium_block medium; // the box of all media, and one medium's coefficients
    struct shape_block shapes[TYN_MAX_SHAPES]; // medium.num_shapes of them
    tyn_lights lights;
    struct camera_block camera;
    struct env_block environment; // without one its radiances are 0
    // Of the phase functions of `medium` and `shapes`; NULL: all are Henyey-Greenstein lobes, if the method knows no others.
    const tyn_phase_table *phase_tables;
    bool direct; // one unsheared box: the atlas is the density texture, `medium` need not resample
    bool grey;   // sigma_s, sigma_a, g equal in all channels (and no coefficient textures)
    bool emissive; // a medium emits
    // Of the box, where the density may not be 0: bit 2 a + (1: high face of axis a).
    uint32_t open_faces;
    float typical_density; // mean over the medium's mass, likewise; 0 = not known
    // Over what is not empty, mode DENSITY: in units of the texture's values; 0 = not known.
    float mean_density;
    float majorant;         // no place has a larger extinction in any channel, 1/m
    bool empty;             // no medium at all, or no coefficient above 0
    uint32_t num_triangles; // of the surfaces; 0: there are none, nor their refs
    uint32_t num_vertices;
    uint32_t num_textures; // of their materials
    // Area times the largest channel of the emission, of all that emit, W/sr; 0 if there are none, or no tyn_scene_refs.emitters.
    float emitters;
    struct surface_block surfaces;
    // M, m: the box that pictures are of, around which maps of surfaces are fine: that of all media; without media that of most
    // triangles.
    float near_lo[3], near_hi[3];
    // World space -> M: a turn and a move, column-major.
    float m_from_world[16];
    const struct tyn_map_light *map; // map_light.h
    // The engine's own, for the calls of sources.h: not to be looked into.
    const struct surface_range *below;
    struct tyn_views_seen *seen;
} tyn_frame_scene;

#ifdef __cplusplus
}
#endif
