// converge.h -- a picture of `path` that is rendered in rounds until it is good enough.
#pragma once
#include "method_setup.h"
#include "reference.h"

// Called after each round that is worth keeping, and at the end. Gives the exit code.
typedef int (*converge_keep)(void *user, const bench_reference *r);

// Adds samples to r (which holds r->spp of them, none if r->file is empty) until the goal is reached: spp, seconds and
// image are then those of the whole. Rounds have seeds of their own, which follow from r->spp. After an interruption r
// holds, and `keep` has got, what whole rounds gave. Gives the exit code.
int converge(app *a, const bench_machine *on, const method *m, const tyn_scene *scene,
             const tyn_view *view, const bench_goal *goal, const char *name, converge_keep keep,
             void *user, bench_reference *r);

// Nothing is missing.
bool converge_is_done(const bench_reference *r, const bench_goal *goal);
