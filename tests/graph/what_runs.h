// what_runs.h -- which nodes of a method run when something changes, on a device that only writes down what it is told.
#pragma once
#include <tyndall/context.h>
#include <tyndall/registry.h>

// A voxel of medium in a box, a sun, a map, a camera.
typedef struct stage {
    tyn_scene scene;
    tyn_view view;
} stage;
void make_stage(stage *s);

void change_nothing(stage *s);
void turn_map(stage *s);
void dim_map(stage *s);
void change_map(stage *s);
void move_camera(stage *s);
void dim_sun(stage *s);
void turn_sun(stage *s);
void thin_medium(stage *s); // coefficients, not the grid
void change_grid(stage *s);
void lights_out(stage *s);
void take_medium(stage *s);

typedef struct what_runs_row {
    const char *what; // NULL ends a table
    void (*change)(stage *s);
    const char *right; // r: ran, u: unchanged, -: not declared; in the order of the nodes
    int before;        // so many frames go by between the change and the one that is looked at
} what_runs_row;

// One frame after each change, all of which stay. Prints the table; false: a row is not right. At most 15 nodes; NULL ends
// them. Where nodes come or go all run.
bool what_runs(const char *method, const char *const *nodes, const what_runs_row *rows);
