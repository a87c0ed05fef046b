// flip.h -- FLIP: how different two pictures look to somebody who flips between them, 0 to 1 a pixel.
//
// LDR-FLIP (Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", 2020) of pictures on a display, and HDR-FLIP (Andersson, Nilsson, Shirley and Akenine-Moeller,
// "Visualizing Errors in Rendered High Dynamic Range Images", 2021): the largest of LDR-FLIP over exposures. Both at 67
// pixels per degree, a display of 3840 pixels on 0.7 m that is seen from 0.7 m.
//
// Pictures are linear R, G, B with the primaries of sRGB and have the same size. `map` (width * height values, or NULL)
// gets the value of each pixel. A value of either picture that is not finite makes the pixels around it NaN, and the
// mean NaN. Functions that return false are out of memory.
#pragma once
#include "metrics.h"

// The mean of LDR-FLIP: both pictures times `scale`, cut to [0, 1], are what the display shows.
bool flip_ldr(const metrics_image *image, const metrics_image *reference, float scale, float *map,
              double *mean);

// The tone map of linear pictures is flip_ldr with this scale, 1 / v: v is the least value that 99.5 % of all R, G and B
// of the reference do not exceed, or their largest where that is 0. It is 1 where no value is above 0.
bool flip_scale(const metrics_image *reference, float *scale);

// Exposures from `start` to `stop` in stops, at equal distances; count >= 2.
typedef struct flip_exposures {
    float start, stop;
    uint32_t count;
} flip_exposures;

// The mean of HDR-FLIP: each picture at each exposure goes through Narkowicz's fit to the ACES transforms.
bool flip_hdr(const metrics_image *image, const metrics_image *reference,
              const flip_exposures *exposures, float *map, double *mean);

// The range of HDR-FLIP for a reference: its largest luminance is 0.85 after the tone map at `start`, its median
// luminance is so at `stop`, with one exposure a stop, at least two. Pixels with a luminance of 0 do not count for the
// median: no exposure shows them. A reference without any other has both exposures at 0.
bool flip_find_exposures(const metrics_image *reference, flip_exposures *exposures);
