// submission.h -- one command buffer on a queue of our own: begun, submitted and waited for.
#pragma once
#include "gpu/device.h"

typedef struct tyn_submission {
    tyn_device *dev;
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
} tyn_submission;

// `s` may be destroyed whatever create gave, and when it is zero but for `dev`.
tyn_result tyn_submission_create(tyn_device *dev, tyn_submission *s);
void tyn_submission_destroy(tyn_submission *s);

// Between the two s->cmd is recorded; what it held before is gone. `what`: for the log, "rendering a frame".
tyn_result tyn_submission_begin(tyn_submission *s);
tyn_result tyn_submission_run(tyn_submission *s, const char *what);
