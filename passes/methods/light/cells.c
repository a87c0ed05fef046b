// cells.c -- the lattice: its cells, and the light of all sources that arrives there unscattered.
#include "passes/methods/light/sources.h"
#include <tyndall/registry.h>
#include <math.h>
#include <string.h>

void tyn_put_lattice(const tyn_lattice_shape *shape, float extent[3], uint32_t dims[3])
{
    const tyn_extent size = tyn_lattice_dims(shape->extent, shape->cells);
    dims[0] = size.x;
    dims[1] = size.y;
    dims[2] = size.z;
    memcpy(extent, shape->extent, sizeof shape->extent);
}

// One channel is solved if medium and light allow it.
static void choose_channels(tyn_sources *s, const tyn_scene *scene, const tyn_frame_scene *frame)
{
    bool grey = frame->grey; // and so are the walls
    float colors[2 * TYN_LIGHTS_MAX + 2][3];
    uint32_t count = 0;
    for (uint32_t i = 0; i < frame->lights.num_suns; i++) {
        memcpy(colors[count++], frame->lights.suns[i].color, sizeof colors[0]);
    }
    for (uint32_t i = 0; i < frame->lights.num_lamps; i++) {
        memcpy(colors[count++], tyn_first_lamp(&frame->lights)[i].color, sizeof colors[0]);
    }
    memcpy(colors[count++], frame->environment.sky, sizeof colors[0]);
    memcpy(colors[count++], frame->medium.emission, sizeof colors[0]);
    // A map may have another colour in every direction.
    const tyn_surfaces *surfaces = &scene->surfaces;
    bool walls = tyn_has_walls(frame);
    for (uint32_t i = 0; walls && i < surfaces->num_materials; i++) {
        const tyn_surface_material *m = &surfaces->materials[i];
        grey = grey && m->texture == TYN_NO_TEXTURE && m->albedo[0] == m->albedo[1] &&
               m->albedo[1] == m->albedo[2] && !tyn_is_lit(m->emission);
    }
    bool one = tyn_lattice_tint((const float(*)[3])colors, count, s->lattice.shape.tint) &&
               !s->sky.map.resource && !s->lamps.vpls; // which have the colours of surfaces
    s->lattice.shape.channels = one && grey ? 1 : 3;
    if (s->lattice.shape.channels == 3) {
        s->lattice.shape.tint[0] = s->lattice.shape.tint[1] = s->lattice.shape.tint[2] = 1.0f;
    }
}

static void add_cells(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_lattice_cells_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_cells, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_connect(refs, LATTICE_CELLS_PORT_MEDIUM, s->medium);
    tyn_graph_add(g, &tyn_pass_lattice_cells, &params, refs);
    s->lattice.cells = refs[LATTICE_CELLS_PORT_CELLS];
}

static void add_source(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_lattice_source_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_source, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    params.num_suns = s->num_suns;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_SOURCE_PORT_LIGHTS] = job->refs.suns,
        [LATTICE_SOURCE_PORT_CELLS] = s->lattice.cells,
    };
    tyn_connect(refs, LATTICE_SOURCE_PORT_MEDIUM, s->medium);
    tyn_connect(refs, LATTICE_SOURCE_PORT_BEAMS, s->beams);
    tyn_connect(refs, LATTICE_SOURCE_PORT_WALL_LINKS, s->walls.cut);
    tyn_connect(refs, LATTICE_SOURCE_PORT_SHADOW_ATLAS, s->shadows);
    tyn_graph_add(g, &tyn_pass_lattice_source, &params, refs);
    s->lattice.source = refs[LATTICE_SOURCE_PORT_SOURCE];
    s->lattice.sun_power = refs[LATTICE_SOURCE_PORT_POWER];
}

bool tyn_average_medium(tyn_graph *g, const tyn_job *job, const uint32_t dims[3],
                        tyn_medium_refs *medium, float texel[3])
{
    const struct medium_block *m = &job->frame->medium;
    tyn_columns_average_params params;
    tyn_settings_params(job->settings, &tyn_pass_columns_average, &params);
    params.mode = m->mode;
    if (!tyn_columns_average_size(m, dims, params.size)) {
        memcpy(texel, m->voxel, sizeof m->voxel);
        return false;
    }
    for (int a = 0; a < 3; a++) {
        texel[a] = m->extent[a] / (float)params.size[a];
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [COLUMNS_AVERAGE_PORT_DENSITY] = medium->density,
        [COLUMNS_AVERAGE_PORT_SIGMA_A] = medium->sigma_a,
        [COLUMNS_AVERAGE_PORT_G] = medium->g,
    };
    tyn_graph_add(g, &tyn_pass_columns_average, &params, refs);
    medium->density = m->mode != TYN_MEDIUM_DENSITY ? refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S]
                                                    : refs[COLUMNS_AVERAGE_PORT_MEAN_DENSITY];
    medium->sigma_a = refs[COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A];
    medium->g = refs[COLUMNS_AVERAGE_PORT_MEAN_G];
    return true;
}

static void add_columns(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_columns_params params;
    tyn_settings_params(job->settings, &tyn_pass_columns, &params);
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    params.mode = job->frame->medium.mode;
    params.count = s->sky.count;
    tyn_medium_refs medium = s->medium;
    float texel[3];
    tyn_average_medium(g, job, params.dims, &medium, texel);
    tyn_ref refs[TYN_MAX_PORTS] = {[COLUMNS_PORT_ORDINATES] = s->sky.unlit_ordinates};
    tyn_connect(refs, COLUMNS_PORT_MEDIUM, medium);
    tyn_graph_add(g, &tyn_pass_columns, &params, refs);
    tyn_take(refs, COLUMNS_PORT_ORDINATES, s->sky.columns);
    s->sky.columns.ordinates = s->sky.ordinates;
}

// What surfaces leave of the ordinates.
static void add_seen(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_sky_seen_params params;
    tyn_settings_params(job->settings, &tyn_pass_sky_seen, &params);
    tyn_put_lattice(&s->lattice.shape, params.extent, params.dims);
    params.count = s->sky.count;
    params.fan = s->sky.fan;
    // In steps of 1/256, so that a sky that is dimmed keeps them through rounding.
    const float *radiance = job->frame->environment.radiance;
    const float most = fmaxf(radiance[0], fmaxf(radiance[1], radiance[2]));
    for (int c = 0; c < 3; c++) {
        params.tint[c] = most > 0 ? roundf(256 * radiance[c] / most) / 256 : 1;
    }
    tyn_ref refs[TYN_MAX_PORTS] = {[SKY_SEEN_PORT_ORDINATES] = s->sky.unlit_ordinates,
                                   [SKY_SEEN_PORT_DIRECTIONS] = s->sky.unlit_directions};
    tyn_connect(refs, SKY_SEEN_PORT_SKY_ATLAS, s->sky.maps);
    tyn_connect(refs, SKY_SEEN_PORT_WALL_LINKS, s->walls.cut);
    tyn_graph_add(g, &tyn_pass_sky_seen, &params, refs);
    s->sky.seen.sky_seen = refs[SKY_SEEN_PORT_SKY_SEEN];
    s->sky.seen.environment = job->refs.environment;
}

static void add_ordinates(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    tyn_lattice_ordinates_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_ordinates, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    params.grey = job->frame->grey;
    params.count = s->sky.count;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_ORDINATES_PORT_MEDIUM] = job->refs.medium,
        [LATTICE_ORDINATES_PORT_CELLS] = s->lattice.cells,
        [LATTICE_ORDINATES_PORT_SUNLIGHT] = s->lattice.source,
    };
    tyn_connect(refs, LATTICE_ORDINATES_PORT_ORDINATES, s->sky.columns);
    tyn_connect(refs, LATTICE_ORDINATES_PORT_SKY_SEEN, s->sky.seen);
    params.mean = s->sky.seen.sky_seen.resource && s->sky.split && !s->mean_from_all_sides;
    tyn_graph_add(g, &tyn_pass_lattice_ordinates, &params, refs);
    s->lattice.source = refs[LATTICE_ORDINATES_PORT_SOURCE];
    if (params.mean) {
        s->sky.even = refs[LATTICE_ORDINATES_PORT_EVEN];
        s->sky.guess = refs[LATTICE_ORDINATES_PORT_GUESS];
    }
}

static void add_lamps(tyn_graph *g, const tyn_job *job, tyn_sources *s)
{
    const tyn_lamps *lamps = &s->lamps;
    tyn_lattice_lamps_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice_lamps, &params);
    params.shape = s->lattice.shape;
    params.mode = job->frame->medium.mode;
    params.num_fine = lamps->num_fine;
    params.num_lamps = lamps->num_lamps;
    params.vpls = lamps->vpls;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_LAMPS_PORT_CELLS] = s->lattice.cells,
        [LATTICE_LAMPS_PORT_VPL_DISTANCES] = s->surface_light.vpls.vpl_distances,
        [LATTICE_LAMPS_PORT_ROOMS] = s->surface_light.rooms,
        [LATTICE_LAMPS_PORT_OTHERS] = s->lattice.source,
    };
    tyn_connect(refs, LATTICE_LAMPS_PORT_MEDIUM, s->medium);
    tyn_connect(refs, LATTICE_LAMPS_PORT_RADIALS, s->lamps.radials);
    tyn_connect(refs, LATTICE_LAMPS_PORT_WALL_LINKS, s->walls.cut);
    tyn_connect(refs, LATTICE_LAMPS_PORT_SHADOW_ATLAS, s->shadows);
    tyn_graph_add(g, &tyn_pass_lattice_lamps, &params, refs);
    s->lattice.source = refs[LATTICE_LAMPS_PORT_SOURCE];
    s->lattice.lamp_power = refs[LATTICE_LAMPS_PORT_POWER];
    s->lattice.vpl_light = refs[LATTICE_LAMPS_PORT_VPL_LIGHT];
}

// A lattice may be as long as a row of clouds, but not have more cells than a cube of 64.
static void warn_of_cells(const tyn_job *job, const tyn_sources *s, int32_t asked,
                          const char *setting)
{
    const tyn_extent n = tyn_lattice_dims(s->lattice.shape.extent, asked);
    if ((uint64_t)n.x * n.y * n.z > TYN_LATTICE_MAX_ALL) {
        tyn_job_warn(job, "%s is %d, which makes more than %d cells; %d are used", setting,
                     (int)asked, TYN_LATTICE_MAX_ALL, (int)s->lattice.shape.cells);
    }
}

// The cells of the lattice, without what is in them.
static void set_shape(const tyn_job *job, int32_t cells, tyn_sources *s)
{
    tyn_lattice_shape *shape = &s->lattice.shape;
    memcpy(shape->extent, job->frame->medium.extent, sizeof shape->extent);
    memcpy(shape->repeat, job->frame->medium.repeat, sizeof shape->repeat);
    shape->cells = tyn_lattice_fit(shape->extent, shape->repeat, cells);
    const float longest = fmaxf(shape->extent[0], fmaxf(shape->extent[1], shape->extent[2]));
    s->lattice.side = longest / (float)shape->cells;
}

void tyn_add_columns(tyn_graph *g, const tyn_job *job, int32_t cells, tyn_sources *s)
{
    set_shape(job, cells, s);
    if (s->sky.ordinates.resource) {
        add_columns(g, job, s);
    }
}

void tyn_add_cells(tyn_graph *g, const tyn_job *job, int32_t cells, const char *setting,
                   tyn_sources *s)
{
    const tyn_frame_scene *frame = job->frame;
    set_shape(job, cells, s);
    warn_of_cells(job, s, cells, setting);
    choose_channels(s, job->scene, frame);
    add_cells(g, job, s);
    tyn_add_walls(g, job, s);
    if (s->sky.ordinates.resource && !s->sky.columns.columns.resource) {
        add_columns(g, job, s);
    }
    if (s->sky.maps.sky_maps.resource) {
        add_seen(g, job, s);
    }
    if (s->num_suns) {
        add_source(g, job, s);
    }
    if (s->sky.ordinates.resource) {
        add_ordinates(g, job, s);
    }
    if (s->lamps.radials.radials.resource) {
        add_lamps(g, job, s);
    }
    tyn_add_wall_light(g, job, s);
}

tyn_ref tyn_mean_environment(const tyn_job *job, const tyn_sources *s)
{
    return s->mean_from_all_sides ? job->refs.environment : (tyn_ref){0};
}
