// point_pass.c -- a pass for tests that evaluates a shader function at a list of points.
#include "point_pass.h"
#include <string.h>

static tyn_result declare(tyn_builder *b, const void *params)
{
    const point_pass_params *p = params;
    tyn_build_buffer(b, (uint8_t)p->results, (uint64_t)p->count * p->result_size);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const point_pass_params *p = params;
    tyn_rec_dispatch(r, &(tyn_dispatch){.cells = {p->count, 1, 1}, .spec = &p->spec});
}

void point_pass_init(point_pass *pass, const uint32_t *spirv, size_t spirv_size,
                     const point_input *inputs, uint32_t num_inputs)
{
    *pass = (point_pass){.points = (uint8_t)num_inputs, .results = (uint8_t)(num_inputs + 1)};
    for (uint32_t i = 0; i < num_inputs; i++) {
        pass->ports[i] = (tyn_port){inputs[i].name, TYN_IN, inputs[i].dim, 0, true, "input"};
        pass->bindings[i] = (tyn_binding){(uint8_t)i, inputs[i].use, false};
    }
    pass->ports[pass->points] = (tyn_port){"points", TYN_IN, TYN_BUFFER, 0, false, "where"};
    pass->bindings[pass->points] = (tyn_binding){pass->points, TYN_USE_STORAGE_READ, false};
    pass->ports[pass->results] = (tyn_port){"results", TYN_OUT, TYN_BUFFER, 0, false, "what"};
    pass->bindings[pass->results] = (tyn_binding){pass->results, TYN_USE_STORAGE_WRITE, false};
    pass->kernel =
        (tyn_kernel){"points", spirv, spirv_size, 0, {64, 1, 1}, pass->bindings, num_inputs + 2, 1};
    pass->desc = (tyn_pass_desc){
        .name = "points",
        .summary = "a function at points",
        .ports = pass->ports,
        .num_ports = num_inputs + 2,
        .kernels = &pass->kernel,
        .num_kernels = 1,
        .params_size = sizeof(point_pass_params),
        .declare = declare,
        .record = record,
        .debug_port = pass->results,
        .debug_meaning = "none",
    };
}
