// alias_table.h -- tables that draw an index in proportion to its weight, in constant time.
#pragma once
#include <stdbool.h>
#include <stddef.h>

// Walker's alias method: draw a cell uniformly, keep it with probability `keep`, else take `alias`. Fills these
// two, a float and a uint32_t next to each other, in `count` cells that are `stride` bytes apart; the rest of
// the cells is left alone. `weights` (>= 0) are changed. All weights 0: all are drawn alike. False if out of
// memory. Deterministic.
bool tyn_alias_build(double *weights, size_t count, void *cells, size_t stride);
