// primaries.h -- colours of a file's primaries as linear Rec. 709.
#pragma once
#include <stdbool.h>
#include <stddef.h>

// Row by row; `c` is x and y of red, green, blue, white. White stays white, by Bradford's adaptation of cones to D65.
// False: they span no colours, or are those of Rec. 709 to a thousandth, and `m` is the identity.
bool tyn_primaries_to_rec709(const double c[8], float m[9]);

// The same for `count` RGB triples; what Rec. 709 does not reach is negative then. Without effect where that is false.
void tyn_pixels_to_rec709(float *pixels, size_t count, const double c[8]);
