// lattice.c -- the solver of method "pop": one lattice for everything that has scattered.
#include <tyndall/extend/field.h>
#include "passes/passes.h"
#include <tyndall/registry.h>
#include <string.h>

// The solution of the last frame: what is remembered, and what light puts in now.
typedef struct memory {
    tyn_lattice_recall_params params;
    tyn_ref history, power;
} memory;

// `solve` are the refs of the lattice, which gets the guess.
static void add_recall(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_ref *solve,
                       memory *m)
{
    m->params = (tyn_lattice_recall_params){.shape = s->lattice.shape};
    // The inverse of a rigid matrix (column-major): its transpose turns back.
    const float *from = job->frame->m_from_world;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            m->params.world[i][k] = from[4 * i + k];
            m->params.world[i][3] -= from[4 * i + k] * from[12 + k];
        }
    }
    m->history = tyn_graph_history_buffer(
        g, "lattice_memory",
        tyn_lattice_memory_size(s->lattice.shape.cells, s->lattice.shape.channels), job->view->cut);
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_RECALL_PORT_MEMORY] = m->history,
        [LATTICE_RECALL_PORT_CELLS] = solve[LATTICE_PORT_CELLS],
        [LATTICE_RECALL_PORT_SOURCE] = solve[LATTICE_PORT_SOURCE],
        [LATTICE_RECALL_PORT_ENVIRONMENT] = solve[LATTICE_PORT_ENVIRONMENT],
    };
    tyn_graph_add(g, &tyn_pass_lattice_recall, &m->params, refs);
    solve[LATTICE_PORT_GUESS] = refs[LATTICE_RECALL_PORT_GUESS];
    m->power = refs[LATTICE_RECALL_PORT_POWER];
}

static void add_keep(tyn_graph *g, const tyn_field *field, const memory *m)
{
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_KEEP_PORT_MOMENTS] = field->moments,
        [LATTICE_KEEP_PORT_POWER] = m->power,
        [LATTICE_KEEP_PORT_MEMORY] = m->history,
    };
    tyn_graph_add(g, &tyn_pass_lattice_keep, &m->params, refs);
    tyn_graph_output(g, "lattice_memory", refs[LATTICE_KEEP_PORT_MEMORY], false);
}

void tyn_solve_lattice(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    tyn_lattice_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &params);
    params.shape = s->lattice.shape;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_PORT_CELLS] = s->lattice.cells,
        [LATTICE_PORT_SOURCE] = s->lattice.source,
        [LATTICE_PORT_ENVIRONMENT] = tyn_mean_environment(job, s),
        [LATTICE_PORT_WALL_LIGHT] = s->walls.light,
        [LATTICE_PORT_GUESS] = s->sky.guess,
    };
    tyn_connect(refs, LATTICE_PORT_WALL_LINKS, s->walls.around);
    memory last = {0};
    if (params.warm) {
        add_recall(g, job, s, refs, &last);
    }
    tyn_graph_add(g, &tyn_pass_lattice, &params, refs);
    field->moments = refs[LATTICE_PORT_MOMENTS];
    field->leaks = refs[LATTICE_PORT_LEAKS];
    field->wall_power =
        s->walls.around.wall_links.resource ? refs[LATTICE_PORT_WALL_POWER] : (tyn_ref){0};
    field->cell = s->lattice.side;
    field->one_channel = s->lattice.shape.channels == 1;
    memcpy(field->tint, s->lattice.shape.tint, sizeof field->tint);
    if (params.warm) {
        add_keep(g, field, &last);
    }
}
