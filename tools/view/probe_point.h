// probe_point.h -- the light field at a point that the user picked in the picture.
#pragma once
#include <tyndall/context.h>

typedef enum probe_state {
    PROBE_OFF = 0,
    PROBE_PLACED, // at a pixel: the next sharp picture tells how deep it is
    PROBE_ASKED,  // at a point: the next one tells its light
    PROBE_KNOWN,
} probe_state;

typedef struct probe_point {
    probe_state state;
    float x, y;        // in parts of the window
    float position[3]; // world, m
    tyn_probe_result result;
} probe_point;
