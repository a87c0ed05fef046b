// virtual.c -- virtual point lights: what surfaces reflect and emit.
#include "frame/shadow_cull.h"
#include "passes/methods/light/sources.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

_Static_assert(2 * TYN_SHADOW_VIEWS <= TYN_VIEWS_SEEN, "a place for each view of both passes");

// 0: nothing emits; 2: some materials on both sides.
static uint32_t emitters(const tyn_surfaces *surfaces)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < surfaces->num_materials; i++) {
        const tyn_surface_material *m = &surfaces->materials[i];
        if (m->emission[0] + m->emission[1] + m->emission[2] > 0.0f) {
            const uint32_t sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
            most = most > sides ? most : sides;
        }
    }
    return most;
}

bool tyn_reach_beyond(const tyn_frame_scene *frame, float sides)
{
    const float *from = frame->near_lo, *to = frame->near_hi;
    float lo[3], hi[3], longest = 0;
    bool beyond = false;
    tyn_surfaces_box(frame, lo, hi);
    for (int a = 0; a < 3; a++) {
        longest = fmaxf(longest, to[a] - from[a]);
    }
    for (int a = 0; a < 3; a++) {
        beyond = beyond || lo[a] < from[a] - sides * longest || hi[a] > to[a] + sides * longest;
    }
    return beyond;
}

bool tyn_surfaces_beyond(const tyn_job *job)
{
    return job->frame->empty || tyn_reach_beyond(job->frame, 0.15f);
}

// The area of a sun's texel across the light; the solid angle of a lamp's in the middle of its map.
static float texel_of(const struct shadow_light *l)
{
    if (l->kind != TYN_SHADOW_SUN) {
        const float side = 2.0f / (l->texels * l->scale);
        return side * side;
    }
    float area = 1.0f;
    for (int r = 0; r < 2; r++) {
        const float *row = l->rows[r];
        area *= 2.0f / (l->texels * sqrtf(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]));
    }
    return area;
}

// The sky's light reaches surfaces once its columns are known.
static bool reflects_sky(const tyn_job *job, const tyn_sources *s)
{
    const bool passes = job->frame->empty || s->sky.columns.columns.resource;
    return s->sky.maps.sky_maps.resource && passes;
}

static void connect_sky(const tyn_job *job, const tyn_sources *s, tyn_rsm_params *params,
                        tyn_ref refs[TYN_MAX_PORTS])
{
    const tyn_lattice_shape *shape = &s->lattice.shape;
    const bool dimmed = s->sky.columns.columns.resource;
    uint32_t cells[3] = {0};
    if (dimmed) {
        const tyn_extent dims = tyn_lattice_dims(shape->extent, shape->cells);
        memcpy(cells, (const uint32_t[]){dims.x, dims.y, dims.z}, sizeof cells);
    }
    params->mode = job->frame->medium.mode;
    tyn_rsm_add_sky(params, s->sky.fan, dimmed ? cells : NULL);
    tyn_connect(refs, RSM_PORT_SKY_ATLAS, s->sky.maps);
    refs[RSM_PORT_MEDIUM] = job->refs.medium;
    refs[RSM_PORT_ORDINATES] = s->sky.directions;
    refs[RSM_PORT_COLUMNS] = s->sky.columns.columns;
}

// `s`: whose sky is reflected, too; or NULL.
static void add_rsm(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_rsm *rsm)
{
    const tyn_frame_scene *frame = job->frame;
    const struct light_block *lamps = tyn_first_lamp(&frame->lights);
    const uint32_t num_suns = tyn_num_beams(&frame->lights), num_lamps = frame->lights.num_lamps;
    memset(rsm, 0, sizeof *rsm);
    if (!frame->num_triangles || (num_suns + num_lamps == 0 && !s)) {
        return;
    }
    tyn_rsm_params params;
    tyn_settings_params(job->settings, &tyn_pass_rsm, &params);
    // The views of the shadow maps, smaller.
    tyn_shadow_map_params views = {.sun_texels = 256, .lamp_texels = 64};
    tyn_shadow_map_plan(&views, frame->lights.suns, num_suns, lamps, num_lamps, &frame->surfaces);
    memcpy(params.size, views.size, sizeof params.size);
    params.num_triangles = frame->num_triangles;
    if (!frame->empty) {
        memcpy(params.extent, frame->medium.extent, sizeof params.extent);
    }
    memcpy(params.near_lo, frame->near_lo, sizeof params.near_lo);
    memcpy(params.near_hi, frame->near_hi, sizeof params.near_hi);
    const tyn_surfaces *surfaces = &job->scene->surfaces;
    for (uint32_t i = 0; i < views.num_views; i++) {
        const tyn_shadow_view *v = &views.views[i];
        const struct shadow_light *l = &views.lights[v->light];
        const struct rsm_tile tile = {{v->place[0], v->place[1]}, v->texels, v->light};
        tyn_rsm_add(&params, &tile, l->kind, v->args.clip,
                    v->light < TYN_SHADOW_SUNS
                        ? v->light
                        : frame->lights.num_directional + v->light - TYN_SHADOW_SUNS,
                    texel_of(l));
        tyn_view_cull_seen(frame->seen, TYN_SHADOW_VIEWS + i, surfaces, frame->below, v->args.clip,
                           params.drawn[i]);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RSM_PORT_SUNS] = job->refs.suns, [RSM_PORT_LIGHTS] = job->refs.lights};
    if (s) {
        connect_sky(job, s, &params, refs);
    }
    rsm->num_tiles = params.num_tiles;
    memcpy(rsm->tiles, params.tiles, sizeof rsm->tiles);
    if (rsm->num_tiles == 0) {
        return;
    }
    tyn_connect(refs, RSM_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, RSM_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_rsm, &params, refs);
    tyn_take(refs, RSM_PORT_RSM_FLUX, rsm->maps);
}

void tyn_add_rsm(tyn_graph *g, const tyn_job *job, tyn_rsm *rsm)
{
    add_rsm(g, job, NULL, rsm);
}

// Rows M -> clip as rows world -> clip.
static void from_world(const tyn_job *job, const float rows[4][4], tyn_vec4 clip[4])
{
    const float *m = job->frame->m_from_world; // column-major
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) {
            clip[r][c] = c == 3 ? rows[r][3] : 0;
            for (int k = 0; k < 3; k++) {
                clip[r][c] += rows[r][k] * m[4 * c + k];
            }
        }
    }
}

void tyn_add_rsm_views(tyn_graph *g, const tyn_job *job, const tyn_rsm_view *views, uint32_t count,
                       uint32_t texels, tyn_rsm_refs *maps)
{
    tyn_rsm_params params;
    tyn_settings_params(job->settings, &tyn_pass_rsm, &params);
    params.num_triangles = job->frame->num_triangles;
    for (uint32_t i = 0; i < count; i++) {
        struct rsm_tile tile = {.texels = texels};
        tyn_vec4 clip[4];
        for (int a = 0; a < 2; a++) {
            const uint32_t end = views[i].offset[a] + texels;
            tile.offset[a] = views[i].offset[a];
            params.size[a] = params.size[a] > end ? params.size[a] : end;
        }
        from_world(job, views[i].rows, clip);
        tyn_rsm_add(&params, &tile, TYN_SHADOW_SUN, (const tyn_vec4 *)clip, TYN_LIGHTS_MAX - 1, 0);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RSM_PORT_SUNS] = job->refs.suns, [RSM_PORT_LIGHTS] = job->refs.lights};
    tyn_connect(refs, RSM_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, RSM_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_rsm, &params, refs);
    tyn_take(refs, RSM_PORT_RSM_FLUX, *maps);
}

// Of what shines along ordinates: on a plane under the environment's mean, and of suns without beams across them; W/m^2.
static float sky_irradiance(const tyn_frame_scene *frame)
{
    const float pi = 3.14159265f, *mean = frame->environment.sky;
    float sum = pi * (mean[0] + mean[1] + mean[2]);
    for (uint32_t i = tyn_num_beams(&frame->lights); i < frame->lights.num_suns; i++) {
        const float *sun = frame->lights.suns[i].color;
        sum += sun[0] + sun[1] + sun[2];
    }
    return sum;
}

void tyn_add_vpls(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    if (!job->frame->num_triangles) {
        return;
    }
    tyn_vpl_params params;
    tyn_settings_params(job->settings, &tyn_pass_vpl, &params);
    params.mode = job->frame->medium.mode;
    params.num_suns = job->frame->lights.num_directional;
    params.num_triangles = job->frame->num_triangles;
    params.emitters = emitters(&job->scene->surfaces);
    memcpy(params.near_lo, job->frame->near_lo, sizeof params.near_lo);
    memcpy(params.near_hi, job->frame->near_hi, sizeof params.near_hi);
    params.sky_irradiance = sky_irradiance(job->frame);
    if (params.count == 0) {
        return;
    }
    const bool sky = reflects_sky(job, s);
    tyn_rsm rsm;
    add_rsm(g, job, sky ? s : NULL, &rsm);
    if (rsm.num_tiles + params.emitters == 0) {
        return;
    }
    s->surface_light.of_sky =
        sky && rsm.num_tiles && rsm.tiles[rsm.num_tiles - 1].light >= TYN_RSM_SKY;
    if (!tyn_can_trace(job)) {
        tyn_job_warn(job, "the surfaces have no hierarchy: light that they reflect passes "
                          "through other surfaces, and is reflected no second time");
        params.visibility = 0;
    }
    params.num_tiles = rsm.num_tiles;
    memcpy(params.tiles, rsm.tiles, sizeof params.tiles);

    tyn_ref refs[TYN_MAX_PORTS] = {
        [VPL_PORT_SUNS] = job->refs.suns,
        [VPL_PORT_LIGHTS] = job->refs.lights,
    };
    tyn_connect(refs, VPL_PORT_RSM_FLUX, rsm.maps);
    tyn_connect(refs, VPL_PORT_MEDIUM, s->medium);
    refs[VPL_PORT_MEDIUM] = job->refs.medium; // also without media
    tyn_connect(refs, VPL_PORT_SURFACES, job->refs.geometry);
    tyn_connect(refs, VPL_PORT_MATERIALS, job->refs.materials);
    tyn_graph_add(g, &tyn_pass_vpl, &params, refs);
    tyn_take(refs, VPL_PORT_VPLS, s->surface_light.vpls);
}
