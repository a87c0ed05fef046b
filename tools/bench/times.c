// times.c -- names of the frames that are timed.
#include "times.h"

const char *const bench_time_names[NUM_TIMES] = {"first_picture", "animated_medium",
                                                 "animated_light", "camera_moved", "unchanged"};
