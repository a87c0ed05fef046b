// resume.h -- a picture that a method samples, taken up again from its .exr.
#pragma once
#include "tags.h"
#include <tyndall/context.h>

// Sums and errors that a damaged file may have: all must be finite, and spreads not negative. One line, and the exit code.
int resume_check_sums(app *a, const char *path, const tyn_image_file *file);

typedef struct resumed {
    tyn_resume resume; // num_samples 0: there is nothing to go on from
    float *planes;     // what it points to
} resumed;

// Reads the .exr at `path`, which must be of the picture that `tags` tells of, with samples of view.seed from
// view.sample_offset on. A file that is not there is no fault. Gives the exit code; resumed_finish is due in any case.
int resumed_read(app *a, const char *path, const picture_tags *tags, resumed *r);
void resumed_finish(resumed *r);
