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

bool tyn_vpls_bounce(const tyn_job *job)
{
    return job->frame->empty || tyn_reach_beyond(job->frame, 0.15f);
}

// The area of a triangle if it is outside the medium's box by more than `margin` and its front looks there, m^2.
static float area_around(const tyn_frame_scene *frame, const tyn_surfaces *surfaces,
                         const tyn_surface_triangle *t, float margin)
{
    const float *m = frame->m_from_world, *extent = frame->medium.extent;
    float p[3][3], normal[3];
    for (int k = 0; k < 3; k++) {
        const float *w = surfaces->vertices[t->vertices[k]].position;
        for (int a = 0; a < 3; a++) {
            p[k][a] = m[a] * w[0] + m[4 + a] * w[1] + m[8 + a] * w[2] + m[12 + a];
        }
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        normal[a] = 0.5f * ((p[1][b] - p[0][b]) * (p[2][c] - p[0][c]) -
                            (p[1][c] - p[0][c]) * (p[2][b] - p[0][b]));
    }
    const float area = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    bool around = false;
    for (int a = 0; a < 3; a++) {
        const float least = fminf(p[0][a], fminf(p[1][a], p[2][a]));
        const float most = fmaxf(p[0][a], fmaxf(p[1][a], p[2][a]));
        around = around || (most < -margin && normal[a] > 0.5f * area) ||
                 (least > extent[a] + margin && normal[a] < -0.5f * area);
    }
    return around ? area : 0.0f;
}

// Do surfaces outside the medium's box look at it that have a twentieth of its area? Not the outsides of walls whose insides are
// walls of the lattice.
static bool stand_around(const tyn_job *job)
{
    const float *e = job->frame->medium.extent;
    const float margin = 0.01f * fmaxf(e[0], fmaxf(e[1], e[2]));
    const float enough = 0.1f * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
    const tyn_surfaces *surfaces = &job->scene->surfaces;
    float area = 0.0f;
    for (uint32_t i = 0; i < surfaces->num_triangles && area < enough; i++) {
        area += area_around(job->frame, surfaces, &surfaces->triangles[i], margin);
    }
    return area >= enough;
}

// tyn_vpls_bounce; or do surfaces stand around the box that reflect the sky, and are no walls of the lattice; or do they reach
// beyond it and have the sky alone? Measured: in rooms that a sky lights through windows walls lose 4 to 8 % of it; in a hall
// with a sun VPLs are too few for both.
static bool carry_all(const tyn_job *job, const tyn_sources *s)
{
    const tyn_lights *lights = &job->frame->lights;
    const bool alone = tyn_num_beams(lights) + lights->num_lamps == 0; // all VPLs are the sky's
    return tyn_vpls_bounce(job) ||
           (s->sky.maps.sky_maps.resource &&
            ((alone && tyn_reach_beyond(job->frame, 0.01f)) || stand_around(job)));
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

// Do VPLs have what surfaces reflect first of the sky? Where they carry all reflections; where they do not, the lattice's walls
// do.
static bool reflects_sky(const tyn_job *job, const tyn_sources *s)
{
    const bool passes = job->frame->empty || s->sky.columns.columns.resource;
    return s->sky.maps.sky_maps.resource && passes && carry_all(job, s);
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
    params.bounces = carry_all(job, s);
    memcpy(params.near_lo, job->frame->near_lo, sizeof params.near_lo);
    memcpy(params.near_hi, job->frame->near_hi, sizeof params.near_hi);
    s->surface_light.bounces = params.bounces;
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
                          "through other surfaces");
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
