// gpu_test.h -- runs single passes on the device, with validation and synchronization validation on.
//
// A test declares nodes on `t.graph`, asks for outputs with tyn_graph_output(..., true), calls
// gpu_run and looks at gpu_map. gpu_run fails the test on any validation message.
#pragma once
#include "graph/graph.h"
#include "gpu/device.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

typedef struct gpu_test {
    tyn_device *dev;
    tyn_graph *graph;
    tyn_log log;
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
    uint32_t errors;      // log lines of level error
    char last_error[512]; // the newest one
    bool quiet;           // expected errors: count, don't print
} gpu_test;

// cmocka group setup and teardown: *state is a gpu_test. Exits with 77 where there is no device, unless
// the environment variable CI is set. The teardown prints all bounds (bound.h), and fails where one is wide.
int gpu_setup(void **state);
int gpu_teardown(void **state);

// Compiles if needed, records, submits, waits; fails on a result or a validation message.
void gpu_run(gpu_test *t);
// The same, but gives the result back (validation messages still fail).
tyn_result gpu_try(gpu_test *t);
const void *gpu_map(gpu_test *t, const char *name);
// Values that were not finite, of the output "counters" (struct counters_block).
uint32_t gpu_non_finite(gpu_test *t);

// Uploads float data as an image (format R32F, RG32F, RGBA32F by channels 1, 2, 4; R16F: channels = -1;
// R32UI, RGBA32UI: -2, -4).
tyn_ref gpu_image(gpu_test *t, const char *name, tyn_dim dim, tyn_extent extent, int channels,
                  const float *data);
tyn_ref gpu_buffer(gpu_test *t, const char *name, const void *data, size_t size);

// The port of a pass that is called `name`, of its `refs`; fails the test where there is none.
tyn_ref *gpu_port(const tyn_pass_desc *pass, tyn_ref *refs, const char *name);

// ---- what arithmetic of the device may be off by: bounds of tests are derived from these --------------
//
// A test's own bound holds on a software device, which filters with whole floats and rounds quotients and roots once. What other
// devices may be off by besides is 0 there.

// By how much of a texel a filtered read may be off along each axis: half a step of subTexelPrecisionBits. So a filtered value
// is off by up to what the exact one changes by over so much of a texel.
double gpu_filter_shift(const gpu_test *t);
// Relative error of a function that Vulkan allows to be off by `allowed` ulps.
double gpu_ulps(const gpu_test *t, double allowed);
// Specification, "Precision and Operation of SPIR-V Instructions".
#define GPU_QUOTIENT 2.5
#define GPU_ROOT (2 + 2.5) // 1 / inversesqrt
#define GPU_EXP(x) (3 + 2 * fabs(x))

// Milliseconds the node took in the last run (0 without timestamps).
double gpu_ms(gpu_test *t, const char *node);
