// surface_tables.h -- the tables by which `path` draws triangles (shaders/surfaces/surface_table_args.h).
#pragma once
#include <tyndall/scene.h>

typedef enum tyn_surface_table_kind {
    TYN_SURFACE_EMITTERS, // by area times the largest channel of the emission
    TYN_SURFACE_AREAS,    // by area
} tyn_surface_table_kind;

// Makes struct surface_table and its cells in `*table` (from malloc; NULL if no triangle has any weight) of `*size`
// bytes. Deterministic. False if out of memory.
bool tyn_surface_table_build(const tyn_surfaces *surfaces, tyn_surface_table_kind kind,
                             void **table, size_t *size);
