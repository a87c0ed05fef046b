// point_pass.h -- a pass for tests that evaluates a shader function at a list of points.
//
// Ports 0..n-1 are inputs as the test gives them, then `points` (IN buffer), then `results` (OUT buffer).
// The kernel has a local size of 64, no push constants, and one specialisation constant.
#pragma once
#include <tyndall/pass.h>

enum { POINT_PASS_INPUTS = 8, POINT_PASS_RESULTS = POINT_PASS_INPUTS + 1 };

typedef struct point_pass_params {
    uint32_t count;       // points
    uint32_t result_size; // bytes per point
    uint32_t spec;
    uint32_t results; // point_pass.results
} point_pass_params;

typedef struct point_pass {
    tyn_port ports[POINT_PASS_INPUTS + 2];
    tyn_binding bindings[POINT_PASS_INPUTS + 2];
    tyn_kernel kernel;
    tyn_pass_desc desc;
    uint8_t points, results; // port numbers
} point_pass;

typedef struct point_input {
    const char *name;
    tyn_dim dim;
    tyn_use use;
} point_input;

// `pass` must outlive the graph's use of it.
void point_pass_init(point_pass *pass, const uint32_t *spirv, size_t spirv_size,
                     const point_input *inputs, uint32_t num_inputs);
