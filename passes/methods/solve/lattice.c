// lattice.c -- the solver of method "pop": one lattice for everything that has scattered.
#include <tyndall/extend/field.h>
#include "passes/passes.h"
#include <tyndall/registry.h>
#include <string.h>

void tyn_solve_lattice(tyn_graph *g, const tyn_job *job, const tyn_sources *s, tyn_field *field)
{
    tyn_lattice_params params;
    tyn_settings_params(job->settings, &tyn_pass_lattice, &params);
    params.shape = s->lattice.shape;
    params.little_shared = job->capacity.little_shared;
    tyn_ref refs[TYN_MAX_PORTS] = {
        [LATTICE_PORT_CELLS] = s->lattice.cells,
        [LATTICE_PORT_SOURCE] = s->lattice.source,
        [LATTICE_PORT_ENVIRONMENT] = tyn_mean_environment(job, s),
        [LATTICE_PORT_WALL_LIGHT] = s->walls.light,
        [LATTICE_PORT_GUESS] = s->sky.guess,
    };
    tyn_connect(refs, LATTICE_PORT_WALL_LINKS, s->walls.cut);
    tyn_graph_add(g, &tyn_pass_lattice, &params, refs);
    field->moments = refs[LATTICE_PORT_MOMENTS];
    field->leaks = refs[LATTICE_PORT_LEAKS];
    field->wall_power =
        s->walls.cut.wall_links.resource ? refs[LATTICE_PORT_WALL_POWER] : (tyn_ref){0};
    field->cell = s->lattice.side;
    field->one_channel = s->lattice.shape.channels == 1;
    memcpy(field->tint, s->lattice.shape.tint, sizeof field->tint);
}
