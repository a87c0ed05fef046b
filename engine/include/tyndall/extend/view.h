// view.h -- what pictures, probes and balances are made of: sources and field in, outputs of the job out. Tier 9.
#pragma once
#include "field.h"

#ifdef __cplusplus
extern "C" {
#endif

// All that a picture is gathered from; {0} refs are left out.
typedef struct tyn_view_inputs {
    const tyn_sources *sources;
    const tyn_field *field;
    tyn_ref lut, lut_block; // given: all forward orders of the suns, else the first
    tyn_ref tms;            // the same of ordinates
    tyn_ref glow;           // the map scattered forward
    tyn_ref inscatter;      // the field, towards the eye (tyn_gather)
    // Lamps that are marched everywhere, the first of `sources`, and those after them that are marched nearby.
    uint32_t num_marched_lamps, num_near_lamps;
    bool no_sky_on_surfaces; // it is not known what hides of it
    bool mean_in_field;      // the environment's mean came in through the field
    tyn_ref surface,
        seen; // light of the surfaces before the camera (piece_light.glsl); gbuffer.glsl
} tyn_view_inputs;

// What scatters forward more than once, as tables by depth and angle.
TYN_API void tyn_add_forward_tables(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in);
// What the map looks like behind a medium that scatters forward.
TYN_API void tyn_add_glow(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in);
// The field towards the eye: as the solver brings it, or the lattice's moments and the light of ordinates and distant lamps
// in its cells.
TYN_API void tyn_gather(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in);
// Surfaces that the camera sees, in direct light, that of `sources.surface_light`, and the field's.
TYN_API void tyn_add_surfaces(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in);
// The same in the light of suns, lamps and VPLs that the medium leaves, by the shadows of `s`: for methods whose march knows none
// of these.
TYN_API void tyn_add_surfaces_apart(tyn_graph *g, const tyn_job *job, tyn_sources s,
                                    tyn_view_inputs *in);
// m: no step of a march is longer where the extinction is the scene's largest. `cell`: of the field; 0: there is none.
TYN_API float tyn_longest_step(const tyn_frame_scene *frame, float cell);
// Marches: what the job and its hooks want of radiance, transmittance and depth; makes the outputs SINGLE and MULTIPLE.
TYN_API tyn_picture tyn_add_march(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// Hands the picture through the job's hooks and makes what the job wants of it: radiance, transmittance, depth, the host's
// picture, the display image; and beside it albedo and normal of the surfaces.
TYN_API void tyn_add_results(tyn_graph *g, const tyn_job *job, tyn_picture picture);
// Both: a method that changes the picture itself does so between the two.
TYN_API void tyn_add_picture(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// The display image of a radiance.
TYN_API void tyn_add_display(tyn_graph *g, const tyn_job *job, tyn_ref radiance);
// The light field at the job's points.
TYN_API void tyn_add_probe(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// Middles of `size` cells of a grid over the media's box, x fastest: for tyn_scene_refs.points.
TYN_API tyn_ref tyn_add_field_points(tyn_graph *g, const tyn_job *job, tyn_extent size);
// Probes' `results` at these places as images: for tyn_scene_refs.field.
TYN_API void tyn_add_field_images(tyn_graph *g, const tyn_job *job, tyn_extent size,
                                  tyn_ref results, tyn_ref images[3]);
// What paths are guided by, into job->guide.
TYN_API void tyn_add_guide(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// The light field in the host's images.
TYN_API void tyn_add_light_field(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// Where the energy goes.
TYN_API void tyn_add_balance(tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in);
// All of these that the job wants.
TYN_API void tyn_add_views(tyn_graph *g, const tyn_job *job, tyn_view_inputs *in);

// The passes of these calls, for a method's table (method.h).
#define TYN_GATHER_PASSES(X) X(scatter_lut), X(env_glow), X(merge)
#define TYN_SURFACE_PASSES(X) X(gbuffer), X(shade), X(guides)
#define TYN_PICTURE_PASSES(X) X(halve_depth), X(raymarch), X(composite), X(tonemap), X(export)
#define TYN_FIELD_PASSES(X) X(light_points), X(probe), X(light_field), X(balance)

#ifdef __cplusplus
}
#endif
