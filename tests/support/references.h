// references.h -- what `path` finds, kept in tests/references: rendered once, read in every later run.
//
// A reference is keyed by its scene and view with samples and seed; the kernels of `path` that made all files are noted beside
// them. A key without a file, or other kernels, render anew and say so. The test golden-path guards the code between scene and
// kernels. tools/references renews all files.
#pragma once
#include "picture.h"
#include <stddef.h>
#include <stdint.h>

// The key of what `path` makes of the scene and view, for view->outputs.
uint64_t reference_key(const tyn_scene *scene, const tyn_view *view);

// A picture with its standard errors, as half floats. False: there is none of this key, or all are renewed.
bool reference_read_picture(uint64_t key, picture *p);
void reference_write_picture(uint64_t key, const picture *p);

// `count` numbers: a balance, fluxes or probes.
bool reference_read_floats(uint64_t key, float *values, size_t count);
void reference_write_floats(uint64_t key, const float *values, size_t count);
bool reference_read_doubles(uint64_t key, double *values, size_t count);
void reference_write_doubles(uint64_t key, const double *values, size_t count);
