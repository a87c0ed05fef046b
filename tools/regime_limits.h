// regime_limits.h -- errors that methods are known to make in a regime, whatever was measured elsewhere.
//
// Where a method says "accuracy:" of a scene when it renders it (docs/stress.md), there is a figure here, and it is
// no less than what that warning says.
#pragma once
#include "regime.h"

typedef enum regime_limit_kind {
    LIMIT_NONE = 0,
    LIMIT_THICK,    // lattice cells of several mean free paths
    LIMIT_THIN,     // a box of few lattice cells
    LIMIT_BACKWARD, // a backward peak
    LIMIT_FORWARD,  // a forward lobe narrower than tables follow
    LIMIT_MULTIPLE, // what has scattered again is missing
    LIMIT_HOPS,     // the published propagation
    LIMIT_STEPS,    // paths are ended
    LIMIT_FLOATS,   // places are single precision
    LIMIT_NUM,
} regime_limit_kind;
extern const char *const regime_limit_names[LIMIT_NUM]; // "thick lattice cells", ...; NULL: none

typedef struct regime_limit {
    regime_limit_kind kind;
    double error; // of the medium's light, as `compare --block 8` gives it; 0: none is known
} regime_limit;

// Of a method by its name with so many lattice cells along the longest side: the largest, and the root of the sum
// of the squares of all.
regime_limit regime_limit_of(const regime *r, const char *method, double cells);

// One of them, of `pop`.
double regime_thick_error(const regime *r, double cells);
double regime_thin_error(const regime *r, double cells);
double regime_backward_error(const regime *r);

// Of a lattice cell where the medium is dense: mean free paths (delta scaled), transport ones if they are
// shorter.
double regime_cell_depth(const regime *r, double cells);
double regime_cells_thick(const regime *r, double cells); // lattice cells through the box
