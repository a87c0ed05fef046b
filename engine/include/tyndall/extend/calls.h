// calls.h -- what a plugin may call, as one list: the table that the loader hands over, and the plugin's own functions
// that go through it, are made of it. Tier 11.
//
// A plugin links nothing: the host that loads it may have the library as a shared one, as a static one, or privately
// (dlopen with RTLD_LOCAL), and the plugin calls the copy that loads it. The functions below have their ordinary names
// in a plugin, declared by the headers of this folder, so the same source compiles inside the library and outside.
//
// X(result, name, parameters, arguments); V for those without a result.
#pragma once
#include "method.h"
#include "path_scene.h"

// clang-format off
#define TYN_CALLS(X, V) \
    /* pass.h */ \
    V(tyn_pass_defaults, (const tyn_pass_desc *pass, void *params), (pass, params)) \
    X(bool, tyn_build_has, (const tyn_builder *b, uint8_t port), (b, port)) \
    X(tyn_extent, tyn_build_extent, (const tyn_builder *b, uint8_t port), (b, port)) \
    V(tyn_build_image, (tyn_builder *b, uint8_t port, tyn_extent extent, uint32_t mips), (b, port, extent, mips)) \
    V(tyn_build_buffer, (tyn_builder *b, uint8_t port, uint64_t bytes), (b, port, bytes)) \
    V(tyn_build_format, (tyn_builder *b, uint8_t port, VkFormat format), (b, port, format)) \
    X(const tyn_log *, tyn_build_log, (const tyn_builder *b), (b)) \
    X(bool, tyn_rec_has, (const tyn_recorder *r, uint8_t port), (r, port)) \
    X(tyn_extent, tyn_rec_extent, (const tyn_recorder *r, uint8_t port), (r, port)) \
    V(tyn_rec_dispatch, (tyn_recorder *r, const tyn_dispatch *d), (r, d)) \
    V(tyn_rec_dispatch_indirect, (tyn_recorder *r, const tyn_dispatch *d, uint8_t port, uint64_t offset), \
        (r, d, port, offset)) \
    X(const uint8_t *, tyn_ports_exchanged, \
        (const tyn_kernel *kernel, const uint8_t (*pairs)[2], uint32_t num_pairs, uint8_t out[TYN_MAX_BINDINGS]), \
        (kernel, pairs, num_pairs, out)) \
    V(tyn_rec_draw, (tyn_recorder *r, const tyn_draw *d), (r, d)) \
    V(tyn_rec_update, (tyn_recorder *r, uint8_t port, uint64_t offset, const void *data, size_t size), \
        (r, port, offset, data, size)) \
    X(bool, tyn_rec_live, (const tyn_recorder *r), (r)) \
    V(tyn_rec_fill, (tyn_recorder *r, uint8_t port, uint32_t value), (r, port, value)) \
    V(tyn_rec_clear, (tyn_recorder *r, uint8_t port), (r, port)) \
    V(tyn_rec_copy_buffer, (tyn_recorder *r, uint8_t src, uint8_t dst, uint64_t bytes), (r, src, dst, bytes)) \
    V(tyn_rec_work, (tyn_recorder *r, const char *name, double amount), (r, name, amount)) \
    /* registry.h */ \
    V(tyn_settings_params, (const tyn_settings *settings, const tyn_pass_desc *pass, void *params), \
        (settings, pass, params)) \
    X(tyn_result, tyn_settings_get, \
        (const tyn_settings *settings, const char *name, tyn_setting *setting, const tyn_log *log), \
        (settings, name, setting, log)) \
    /* scene.h */ \
    X(double, tyn_phase_mean_cosine, (tyn_phase phase), (phase)) \
    X(double, tyn_phase_delta_fraction, (tyn_phase phase), (phase)) \
    X(double, tyn_light_solid_angle, (const tyn_light *light), (light)) \
    X(bool, tyn_surfaces_emit, (const tyn_surfaces *surfaces), (surfaces)) \
    X(bool, tyn_scene_bounds, (const tyn_scene *scene, float lo[3], float hi[3]), (scene, lo, hi)) \
    /* graph.h */ \
    X(tyn_ref, tyn_graph_upload_buffer, \
        (tyn_graph *g, const char *name, const void *data, size_t size, uint64_t hash), (g, name, data, size, hash)) \
    X(tyn_ref, tyn_graph_upload_image, \
        (tyn_graph *g, const char *name, tyn_dim dim, VkFormat format, tyn_extent extent, tyn_fill_fn fill, \
            void *user, uint64_t hash), (g, name, dim, format, extent, fill, user, hash)) \
    X(tyn_result, tyn_graph_add, \
        (tyn_graph *g, const tyn_pass_desc *pass, const void *params, tyn_ref *refs), (g, pass, params, refs)) \
    X(tyn_result, tyn_graph_status, (const tyn_graph *g), (g)) \
    V(tyn_graph_refuse, (tyn_graph *g, tyn_result why), (g, why)) \
    X(tyn_ref, tyn_graph_history_image, \
        (tyn_graph *g, const char *name, tyn_dim dim, VkFormat format, tyn_extent extent, uint64_t key), \
        (g, name, dim, format, extent, key)) \
    X(tyn_ref, tyn_graph_history_buffer, (tyn_graph *g, const char *name, uint64_t bytes, uint64_t key), \
        (g, name, bytes, key)) \
    V(tyn_graph_output, (tyn_graph *g, const char *name, tyn_ref ref, bool readback), (g, name, ref, readback)) \
    V(tyn_graph_mark_media, (tyn_graph *g, tyn_ref ref), (g, ref)) \
    X(VkFormat, tyn_graph_format, (const tyn_graph *g, tyn_ref ref), (g, ref)) \
    X(uint32_t, tyn_graph_drawn_side, (const tyn_graph *g), (g)) \
    /* lattice_shape.h, frame_scene.h */ \
    X(tyn_extent, tyn_lattice_dims, (const float extent[3], int32_t cells), (extent, cells)) \
    X(int32_t, tyn_lattice_fit, (const float extent[3], const uint32_t repeat[3], int32_t cells), \
        (extent, repeat, cells)) \
    X(bool, tyn_lattice_tint, (const float (*colors)[3], uint32_t n, float tint[3]), (colors, n, tint)) \
    X(struct light_block, tyn_light_block, (const tyn_light *light), (light)) \
    /* job.h */ \
    V(tyn_job_output, (tyn_graph *g, const tyn_job *job, tyn_output which, tyn_ref ref), (g, job, which, ref)) \
    V(tyn_job_counters, (tyn_graph *g, const tyn_job *job, const tyn_pass_desc *pass, tyn_ref ref), \
        (g, job, pass, ref)) \
    X(const char *, tyn_output_name, (tyn_output which), (which)) \
    X(uint32_t, tyn_job_hooks_read, (const tyn_job *job), (job)) \
    V(tyn_job_warn_suns, (const tyn_job *job, const char *what), (job, what)) \
    V(tyn_job_warn_surfaces, (const tyn_job *job, const char *what), (job, what)) \
    X(bool, tyn_job_refuse_repeat, (const tyn_job *job), (job)) \
    V(tyn_range_of_g, (const tyn_scene *scene, float *least, float *most), (scene, least, most)) \
    V(tyn_surfaces_box, (const tyn_frame_scene *frame, float lo[3], float hi[3]), (frame, lo, hi)) \
    V(tyn_scene_box, (const tyn_frame_scene *frame, float lo[3], float hi[3]), (frame, lo, hi)) \
    X(bool, tyn_has_walls, (const tyn_frame_scene *frame), (frame)) \
    X(bool, tyn_is_periodic, (const tyn_frame_scene *frame), (frame)) \
    X(bool, tyn_can_trace, (const tyn_job *job), (job)) \
    /* path_scene.h */ \
    V(tyn_path_scene, (const tyn_job *job, tyn_path_params *params), (job, params)) \
    V(tyn_connect_path_scene, (tyn_ref *refs, const tyn_job *job, tyn_ref bricks), (refs, job, bricks)) \
    X(double, tyn_path_cost_ns, (const tyn_job *job, bool homogeneous), (job, homogeneous)) \
    /* sources.h */ \
    V(tyn_add_medium, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    V(tyn_add_beams, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    V(tyn_add_shadows, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    V(tyn_add_radials, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    V(tyn_add_vpls, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    V(tyn_add_sky, (tyn_graph *g, const tyn_job *job, uint32_t first_sun, bool can_split, tyn_sources *s), \
        (g, job, first_sun, can_split, s)) \
    V(tyn_add_surroundings, (tyn_graph *g, const tyn_job *job, bool can_split, tyn_sources *s), \
        (g, job, can_split, s)) \
    V(tyn_add_whole_sky, (tyn_graph *g, const tyn_job *job, tyn_sources *s), (g, job, s)) \
    X(bool, tyn_average_medium, \
        (tyn_graph *g, const tyn_job *job, const uint32_t dims[3], tyn_medium_refs *medium, float texel[3]), \
        (g, job, dims, medium, texel)) \
    V(tyn_add_columns, (tyn_graph *g, const tyn_job *job, int32_t cells, tyn_sources *s), (g, job, cells, s)) \
    X(tyn_ref, tyn_add_map_sums, (tyn_graph *g, const tyn_job *job, bool suns), (g, job, suns)) \
    V(tyn_add_cells, (tyn_graph *g, const tyn_job *job, int32_t cells, const char *setting, tyn_sources *s), \
        (g, job, cells, setting, s)) \
    X(tyn_ref, tyn_mean_environment, (const tyn_job *job, const tyn_sources *s), (job, s)) \
    X(uint32_t, tyn_radial_groups, (const tyn_lamps *lamps), (lamps)) \
    X(bool, tyn_vpls_bounce, (const tyn_job *job), (job)) \
    V(tyn_add_rsm, (tyn_graph *g, const tyn_job *job, tyn_rsm *rsm), (g, job, rsm)) \
    V(tyn_add_rsm_views, \
        (tyn_graph *g, const tyn_job *job, const tyn_rsm_view *views, uint32_t count, uint32_t texels, \
            tyn_rsm_refs *maps), (g, job, views, count, texels, maps)) \
    /* field.h */ \
    V(tyn_solve_lattice, (tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field), \
        (g, job, s, field)) \
    /* view.h */ \
    V(tyn_add_forward_tables, (tyn_graph *g, const tyn_job *job, tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_glow, (tyn_graph *g, const tyn_job *job, tyn_view_inputs *in), (g, job, in)) \
    V(tyn_gather, (tyn_graph *g, const tyn_job *job, tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_surfaces, (tyn_graph *g, const tyn_job *job, tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_surfaces_apart, (tyn_graph *g, const tyn_job *job, tyn_sources s, tyn_view_inputs *in), \
        (g, job, s, in)) \
    X(float, tyn_longest_step, (const tyn_frame_scene *frame, float cell), (frame, cell)) \
    X(tyn_picture, tyn_add_march, (tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_results, (tyn_graph *g, const tyn_job *job, tyn_picture picture), (g, job, picture)) \
    V(tyn_add_picture, (tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_display, (tyn_graph *g, const tyn_job *job, tyn_ref radiance), (g, job, radiance)) \
    V(tyn_add_probe, (tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_light_field, (tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_balance, (tyn_graph *g, const tyn_job *job, const tyn_view_inputs *in), (g, job, in)) \
    V(tyn_add_views, (tyn_graph *g, const tyn_job *job, tyn_view_inputs *in), (g, job, in)) \
    /* limits.h */ \
    X(double, tyn_limit_along, (const tyn_limit_point *curve, size_t count, double x), (curve, count, x)) \
    X(double, tyn_limit_floats, (const tyn_regime *r), (r)) \
    X(double, tyn_limit_again, (const tyn_regime *r), (r)) \
    X(float, tyn_limit_scatterings, (const tyn_job *job), (job)) \
    V(tyn_limits_warn, (const tyn_job *job, float cell), (job, cell))

#define TYN_CALL_MEMBER(type, name, params, args) type (*name) params;
#define TYN_CALL_MEMBER_VOID(name, params, args) void (*name) params;
typedef struct tyn_calls {
    TYN_CALLS(TYN_CALL_MEMBER, TYN_CALL_MEMBER_VOID)
} tyn_calls;
// clang-format on
