// surfaces.h -- what every owner of surfaces needs: freeing, bounds, content hash, checks.
#pragma once
#include <tyndall/scene.h>

void tyn_surfaces_free(tyn_surfaces *surfaces); // leaves them empty

// World box of the vertices. False (and zeros) without triangles.
bool tyn_surfaces_bounds(const tyn_surfaces *surfaces, float lo[3], float hi[3]);

// `hash`, or one of the whole content if that is 0; 0 without triangles.
uint64_t tyn_surfaces_hash(const tyn_surfaces *surfaces);

// Everything; the first fault is one log line.
tyn_result tyn_surfaces_check(const tyn_surfaces *surfaces, const tyn_log *log);
