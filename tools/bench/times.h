// times.h -- which frames are timed, as report.json names them (docs/report-schema.md).
#pragma once

typedef enum bench_time {
    TIME_FIRST,     // the first picture: driver warm, everything else from nothing
    TIME_MEDIUM,    // the media have changed
    TIME_LIGHT,     // every node runs but those that depend on the media alone
    TIME_CAMERA,    // the camera has moved
    TIME_UNCHANGED, // nothing has changed
    NUM_TIMES
} bench_time;

extern const char *const bench_time_names[NUM_TIMES];
