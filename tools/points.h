// points.h -- probe points from a CSV file.
#pragma once
#include "app.h"

typedef struct points {
    float (*xyz)[3]; // world, m
    uint32_t count;
} points;

// "x,y,z" a line; a first line that does not start with a number is a header; empty lines and lines
// that start with # are left out. Gives the exit code; points_finish is due in any case.
int points_read(app *a, const char *path, points *p);
void points_finish(points *p);
