// light_chain.c -- medium -> beam -> lattice_cells -> lattice_source -> lattice -> merge, probe,
// balance.
#include "light_chain.h"
#include "shaders/common/counters.h"
#include <tyndall/extend/refs.h>
#include "passes/beam/beam.h"
#include "passes/columns/columns.h"
#include "passes/lattice_cells/lattice_cells.h"
#include "passes/lattice_source/lattice_source.h"
#include "passes/lattice_ordinates/lattice_ordinates.h"
#include "passes/lattice/lattice.h"
#include "passes/merge/merge.h"
#include "passes/probe/probe.h"
#include "passes/balance/balance.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void add(gpu_test *t, const tyn_pass_desc *pass, const void *params, tyn_ref *refs)
{
    assert_int_equal(tyn_graph_add(t->graph, pass, params, refs), TYN_OK);
}

static tyn_ref upload_coefficients(gpu_test *t, const light_chain *c, const char *name,
                                   const float value[3], bool times_density)
{
    size_t n = (size_t)c->size.x * c->size.y * c->size.z;
    float *texels = calloc(n, 16);
    for (size_t i = 0; i < n; i++) {
        for (int k = 0; k < 3; k++) {
            texels[4 * i + k] = value[k] * (times_density && c->density ? c->density[i] : 1);
        }
    }
    tyn_ref ref = gpu_image(t, name, TYN_IMAGE_3D, c->size, 4, texels);
    free(texels);
    return ref;
}

void light_chain_run(gpu_test *t, light_chain *c)
{
    c->size = c->size.x ? c->size : (tyn_extent){1, 1, 1};
    const uint32_t size[3] = {c->size.x, c->size.y, c->size.z};
    struct medium_block medium = {.num_shapes = 1, .max_density = 1};
    struct light_block lights[4] = {{{0}}};
    struct env_block env = {.pad = 0};
    struct camera_block camera = {.origin = {1e6f, 0, 0}, .orthographic = 0, .forward = {-1, 0, 0}};
    uint32_t mode = c->coefficients ? TYN_MEDIUM_COEFFICIENTS : TYN_MEDIUM_DENSITY;
    medium.mode = mode;
    for (int a = 0; a < 3; a++) {
        medium.extent[a] = c->extent[a];
        medium.size[a] = size[a];
        medium.voxel[a] = c->extent[a] / (float)size[a];
        medium.bricks[a] = (size[a] + TYN_BRICK - 1) / TYN_BRICK;
        medium.brick_size[a] = medium.voxel[a] * TYN_BRICK;
        medium.phase[a].g = c->g[a];
        medium.sigma_s[a] = c->coefficients ? 0 : c->sigma_s[a];
        medium.sigma_a[a] = c->coefficients ? 0 : c->sigma_a[a];
        medium.emission[a] = c->coefficients ? 0 : c->emission[a];
        medium.sigma_t_max = fmaxf(medium.sigma_t_max, c->sigma_s[a] + c->sigma_a[a]);
        env.mean[a] = env.radiance[a] = env.sky[a] = c->environment[a];
        for (uint32_t s = 0; s < c->num_suns; s++) {
            lights[s].mean_cosine = c->mean_cosine > 0 ? c->mean_cosine : 1;
            lights[s].color[a] = c->sun_color[s][a];
            lights[s].direction[a] = c->sun_direction[s][a];
        }
    }

    tyn_graph_begin(t->graph);
    tyn_ref medium_ref = gpu_buffer(t, "medium", &medium, sizeof medium);
    tyn_ref lights_ref = gpu_buffer(t, "lights", lights, sizeof lights);
    tyn_medium_refs media = {.medium = medium_ref};
    if (c->coefficients) {
        media.density = upload_coefficients(t, c, "sigma_s", c->sigma_s, true);
        media.sigma_a = upload_coefficients(t, c, "sigma_a", c->sigma_a, true);
        media.g = upload_coefficients(t, c, "g", c->g, false);
        media.emission = upload_coefficients(t, c, "emission", c->emission, true);
    } else {
        static const float one = 1;
        media.density =
            gpu_image(t, "density", TYN_IMAGE_3D, c->size, 1, c->density ? c->density : &one);
    }

    tyn_ref beam[TYN_MAX_PORTS] = {{0}};
    if (c->num_suns) {
        tyn_beam_params p;
        tyn_pass_defaults(&tyn_pass_beam, &p);
        p.mode = mode;
        tyn_beam_plan(&p, &medium, lights, c->num_suns);
        tyn_connect(beam, BEAM_PORT_MEDIUM, media);
        add(t, &tyn_pass_beam, &p, beam);
    }
    tyn_beam_refs beams;
    tyn_take(beam, BEAM_PORT_BEAMS, beams);

    tyn_lattice_params solve;
    tyn_pass_defaults(&tyn_pass_lattice, &solve);
    solve.sweeps = c->sweeps ? c->sweeps : solve.sweeps;
    solve.cycles = c->cycles >= 0 ? c->cycles : solve.cycles;
    solve.shape = (tyn_lattice_shape){.extent = {c->extent[0], c->extent[1], c->extent[2]},
                                      .cells = c->cells,
                                      .channels = c->channels,
                                      .tint = {1, 1, 1}};
    if (c->channels == 1) {
        const float(*colors)[3] =
            c->num_suns ? (const float(*)[3])c->sun_color : (const float(*)[3]) & c->environment;
        assert_true(tyn_lattice_tint(colors, 1, solve.shape.tint));
    }
    tyn_ref cells[TYN_MAX_PORTS] = {{0}};
    tyn_connect(cells, LATTICE_CELLS_PORT_MEDIUM, media);
    add(t, &tyn_pass_lattice_cells, &(tyn_lattice_cells_params){solve.shape, mode}, cells);
    tyn_ref source[TYN_MAX_PORTS] = {
        [LATTICE_SOURCE_PORT_LIGHTS] = lights_ref,
        [LATTICE_SOURCE_PORT_CELLS] = cells[LATTICE_CELLS_PORT_CELLS],
    };
    tyn_connect(source, LATTICE_SOURCE_PORT_MEDIUM, media);
    tyn_connect(source, LATTICE_SOURCE_PORT_BEAMS, beams);
    if (c->num_suns) {
        add(t, &tyn_pass_lattice_source,
            &(tyn_lattice_source_params){solve.shape, mode, c->num_suns}, source);
    }
    tyn_ref env_ref = gpu_buffer(t, "environment", &env, sizeof env);
    tyn_ref source_ref = source[LATTICE_SOURCE_PORT_SOURCE], ordinates_ref = {0};
    tyn_ref columns[TYN_MAX_PORTS] = {{0}};
    tyn_extent dims = tyn_lattice_dims(c->extent, c->cells);
    uint32_t count = c->ordinates ? c->ordinates->count : 0;
    if (count) {
        ordinates_ref = gpu_buffer(t, "ordinates", c->ordinates, sizeof *c->ordinates);
        tyn_connect(columns, COLUMNS_PORT_MEDIUM, media);
        columns[COLUMNS_PORT_ORDINATES] = ordinates_ref;
        tyn_columns_params p = {.extent = {c->extent[0], c->extent[1], c->extent[2]},
                                .dims = {dims.x, dims.y, dims.z},
                                .mode = mode,
                                .count = count};
        add(t, &tyn_pass_columns, &p, columns);
        tyn_ref light[TYN_MAX_PORTS] = {
            [LATTICE_ORDINATES_PORT_MEDIUM] = medium_ref,
            [LATTICE_ORDINATES_PORT_ORDINATES] = ordinates_ref,
            [LATTICE_ORDINATES_PORT_COLUMNS] = columns[COLUMNS_PORT_COLUMNS],
            [LATTICE_ORDINATES_PORT_CELLS] = cells[LATTICE_CELLS_PORT_CELLS],
            [LATTICE_ORDINATES_PORT_SUNLIGHT] = source_ref,
        };
        bool grey = c->sigma_s[0] == c->sigma_s[1] && c->sigma_s[1] == c->sigma_s[2] &&
                    c->sigma_a[0] == c->sigma_a[1] && c->sigma_a[1] == c->sigma_a[2] &&
                    c->g[0] == c->g[1] && c->g[1] == c->g[2];
        add(t, &tyn_pass_lattice_ordinates,
            &(tyn_lattice_ordinates_params){solve.shape, mode, grey, count}, light);
        source_ref = light[LATTICE_ORDINATES_PORT_SOURCE];
    }
    if (source_ref.resource) {
        tyn_graph_output(t->graph, "source", source_ref, true);
    }
    tyn_ref lattice[TYN_MAX_PORTS] = {
        [LATTICE_PORT_CELLS] = cells[LATTICE_CELLS_PORT_CELLS],
        [LATTICE_PORT_SOURCE] = source_ref,
        [LATTICE_PORT_ENVIRONMENT] = env_ref,
    };
    add(t, &tyn_pass_lattice, &solve, lattice);
    tyn_graph_output(t->graph, "counters", lattice[LATTICE_PORT_COUNTERS], true);

    tyn_ref merge[TYN_MAX_PORTS] = {
        [MERGE_PORT_MEDIUM] = medium_ref,
        [MERGE_PORT_CAMERA] = gpu_buffer(t, "camera", &camera, sizeof camera),
        [MERGE_PORT_CELLS] = cells[LATTICE_CELLS_PORT_CELLS],
        [MERGE_PORT_MOMENTS] = lattice[LATTICE_PORT_MOMENTS],
    };
    tyn_merge_params merge_params = {.channels = c->channels};
    add(t, &tyn_pass_merge, &merge_params, merge);
    tyn_graph_output(t->graph, "inscatter", merge[MERGE_PORT_INSCATTER], true);

    tyn_balance_params balance_params = {.channels = c->channels, .num_suns = c->num_suns};
    memcpy(balance_params.tint, solve.shape.tint, sizeof balance_params.tint);
    tyn_ref balance[TYN_MAX_PORTS] = {
        [BALANCE_PORT_MEDIUM] = medium_ref,
        [BALANCE_PORT_ENVIRONMENT] = env_ref,
        [BALANCE_PORT_ORDINATES] = ordinates_ref,
        [BALANCE_PORT_LIGHTS] = lights_ref,
        [BALANCE_PORT_CELLS] = cells[LATTICE_CELLS_PORT_CELLS],
        [BALANCE_PORT_MOMENTS] = lattice[LATTICE_PORT_MOMENTS],
        [BALANCE_PORT_SOURCE] = source_ref,
        [BALANCE_PORT_POWER] = source[LATTICE_SOURCE_PORT_POWER],
        [BALANCE_PORT_LEAKS] = lattice[LATTICE_PORT_LEAKS],
    };
    add(t, &tyn_pass_balance, &balance_params, balance);
    tyn_graph_output(t->graph, "balance", balance[BALANCE_PORT_BALANCE], true);

    if (c->num_points) {
        tyn_probe_params p = {.mode = mode,
                              .channels = c->channels,
                              .num_suns = c->num_suns,
                              .num_ordinates = count,
                              .scattered_only = c->scattered_only,
                              .world = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        memcpy(p.tint, solve.shape.tint, sizeof p.tint);
        tyn_ref probe[TYN_MAX_PORTS] = {
            [PROBE_PORT_MEDIUM] = medium_ref,
            [PROBE_PORT_LIGHTS] = lights_ref,
            [PROBE_PORT_MOMENTS] = lattice[LATTICE_PORT_MOMENTS],
            [PROBE_PORT_ENVIRONMENT] = env_ref,
            [PROBE_PORT_ORDINATES] = ordinates_ref,
            [PROBE_PORT_COLUMNS] = columns[COLUMNS_PORT_COLUMNS],
            [PROBE_PORT_POINTS] =
                gpu_buffer(t, "points", c->points, c->num_points * sizeof c->points[0]),
        };
        tyn_connect(probe, PROBE_PORT_BEAMS, beams);
        add(t, &tyn_pass_probe, &p, probe);
        tyn_graph_output(t->graph, "results", probe[PROBE_PORT_RESULTS], true);
    }
    gpu_run(t);

    memcpy(&c->balance, gpu_map(t, "balance"), sizeof c->balance);
    const void *inscatter = tyn_graph_map(t->graph, "inscatter", &c->inscatter_size, NULL);
    size_t texels = (size_t)c->inscatter_size.x * c->inscatter_size.y * c->inscatter_size.z;
    c->inscatter = realloc(c->inscatter, texels * 16);
    if (c->channels == 1) {
        for (size_t i = 0; i < texels * 4; i++) {
            c->inscatter[i] =
                i % 4 < 3 ? ((const float *)inscatter)[i / 4] * solve.shape.tint[i % 4] : 1;
        }
    } else {
        memcpy(c->inscatter, inscatter, texels * 16);
    }
    if (c->num_points) {
        c->results = realloc(c->results, c->num_points * sizeof *c->results);
        memcpy(c->results, gpu_map(t, "results"), c->num_points * sizeof *c->results);
    }
    if (source_ref.resource) {
        size_t bytes = (size_t)dims.x * dims.y * dims.z * c->channels * 16;
        c->source = realloc(c->source, bytes);
        memcpy(c->source, gpu_map(t, "source"), bytes);
    }
    const struct counters_block *counters = gpu_map(t, "counters");
    assert_int_equal(counters->non_finite, 0);
    c->ms_cells = gpu_ms(t, "lattice_cells");
    c->ms_source = gpu_ms(t, "lattice_source");
    c->ms_solve = gpu_ms(t, "lattice");
}

void light_chain_finish(light_chain *c)
{
    free(c->results);
    free(c->source);
    free(c->inscatter);
    memset(c, 0, sizeof *c);
}
