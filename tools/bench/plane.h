// plane.h -- the runs of a scene as points of error against time, over blocks of one size: what follows from them.
#pragma once
#include "front.h"
#include "times.h"
#include <cjson/cJSON.h>

typedef struct plane_line { // the runs of one group
    const char *name;
    bool sampling, baseline;
} plane_line;

typedef struct plane {
    front_point *points; // one a run
    const cJSON **runs;
    uint32_t count, block;
    plane_line *lines;
    uint32_t num_lines;
    // Of the reference; 0: not known. An error below it is one of it or less, below twice it vague.
    double noise;
    bench_time time; // which of a run's
} plane;

// `index`: which of the errors; `block`: what they are of, 0: FLIP. Borrows from `runs`. False: out of memory;
// plane_finish is due in any case.
bool plane_make(plane *p, const cJSON *runs, int index, uint32_t block, bench_time time);
void plane_finish(plane *p);

// As report.json has them (docs/report-schema.md).
cJSON *plane_front(const plane *p);
// The least error of each method that does not sample: what no setting of this suite gets below in this time's frames.
void plane_add_floors(const plane *p, cJSON *floors);
cJSON *plane_ranges(const plane *p);   // of errors in which one method is fastest
cJSON *plane_verdicts(const plane *p); // the same as sentences
// What is promised of `pop`: that it is on the front at errors above max(3 %, 1.2 times its floor). Null without `pop`.
cJSON *plane_promise(const plane *p);
// Every method against the baselines, at the errors asked for: at each against the one that is the fastest there,
// measured or extrapolated.
void plane_add_equal_errors(const plane *p, cJSON *list);
// A peer, a group of the runs of plane_make, beside the baselines and `pop`: the times to 10, 5 and 2 %. FLIP: nothing.
void plane_add_peer(const plane *p, const char *peer, cJSON *list);
// What the fastest of the baselines needs for the error of each run that does not sample, unless that is vague, and
// what error the best of them has after its time (of a
// sweep only for TIME_LIGHT), and which errors are vague; `runs` are those of plane_make.
void plane_add_own_equal_errors(const plane *p, cJSON *runs);
// Pages hold pictures: of a sweep only those on a front, the best and what no sweep made are worth it.
void plane_choose_pictures(const plane *p, cJSON *runs);
