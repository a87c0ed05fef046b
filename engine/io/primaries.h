// primaries.h -- colours of a file's primaries as linear Rec. 709.
#pragma once
#include <stddef.h>

// Of `count` RGB triples; `c` is x and y of red, green, blue, white. White stays white, by Bradford's adaptation of cones to
// D65; what Rec. 709 does not reach is negative then. Without effect where they span no colours, or are those of Rec. 709
// to a thousandth.
void tyn_pixels_to_rec709(float *pixels, size_t count, const double c[8]);
