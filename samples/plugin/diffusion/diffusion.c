// diffusion.c -- tables, shapes and dispatches of pass "diffusion".
#include "diffusion.h"
#include "diffusion_args.h"
#include "shaders/common/counters.h"
#include "diffusion_setup.comp.h"
#include "diffusion_relax.comp.h"
#include "diffusion_moments.comp.h"
#include <math.h>

static const tyn_port ports[] = {DIFFUSION_PORTS(TYN_PORT_ROW)};

enum { SETUP, RELAX, MOMENTS };
static const tyn_kernel kernels[] = {
    [SETUP] = TYN_KERNEL(diffusion_setup),
    [RELAX] = TYN_KERNEL(diffusion_relax),
    [MOMENTS] = TYN_KERNEL(diffusion_moments),
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const diffusion_params *p = params;
    const tyn_extent texels = tyn_build_extent(b, DIFFUSION_PORT_CELLS);
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    if (texels.x != dims.x || texels.y != dims.y || texels.z != dims.z * p->shape.channels) {
        tyn_log_print(
            tyn_build_log(b), TYN_LOG_ERROR,
            "pass 'diffusion': 'cells' has %u x %u x %u texels; its shape has %u x %u x %u",
            texels.x, texels.y, texels.z, dims.x, dims.y, dims.z * p->shape.channels);
        return TYN_ERR_PARAMS;
    }
    const uint64_t n = (uint64_t)texels.x * texels.y * texels.z;
    tyn_build_image(b, DIFFUSION_PORT_MOMENTS, texels, 1);
    tyn_build_buffer(b, DIFFUSION_PORT_SYSTEM, 16 * n);
    tyn_build_buffer(b, DIFFUSION_PORT_FORWARD, 16 * n);
    tyn_build_buffer(b, DIFFUSION_PORT_FLUENCE, 4 * n);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const diffusion_params *p = params;
    const tyn_extent dims = tyn_lattice_dims(p->shape.extent, p->shape.cells);
    const tyn_extent all = {dims.x, dims.y, dims.z * p->shape.channels};
    const tyn_extent half = {(dims.x + 1) / 2, all.y, all.z};
    const float *extent = p->shape.extent;
    const float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    struct diffusion_args args = {
        .dims = {dims.x, dims.y, dims.z},
        .channels = p->shape.channels,
        .tint = {p->shape.tint[0], p->shape.tint[1], p->shape.tint[2]},
        .dx = longest / (float)p->shape.cells,
        .least = 1 / longest,
        .omega = 1,
        .first = 1,
        .lit = tyn_rec_has(r, DIFFUSION_PORT_ENVIRONMENT),
    };
    TYN_DISPATCH(r, .kernel = SETUP, .cells = all, .args = &args);
    // The factor by which Jacobi's iteration converges without absorption; Chebyshev's sequence of omega goes with it.
    const double pi = 3.14159265358979, rho = cos(pi / (1 + fmax(dims.x, fmax(dims.y, dims.z))));
    // In the second half of the sweeps D is found anew from what the fluence has become, every 16 of them.
    for (int32_t i = 0; i < 2 * p->sweeps; i++) {
        if (i > p->sweeps && i % 32 == 0) {
            args.first = 0;
            TYN_DISPATCH(r, .kernel = SETUP, .cells = all, .args = &args);
        }
        args.colour = (tyn_uint)i % 2;
        TYN_DISPATCH(r, .kernel = RELAX, .cells = half, .args = &args);
        args.omega = (float)(1 / (1 - rho * rho * (i == 0 ? 0.5 : 0.25 * args.omega)));
    }
    TYN_DISPATCH(r, .kernel = MOMENTS, .cells = all, .args = &args);
    const double cells = (double)all.x * all.y * all.z * p->sweeps;
    tyn_rec_work(r, "cells", cells);
    tyn_rec_work(r, "flops", cells * 60);
    tyn_rec_work(r, "bytes", cells * 24);
}

static const tyn_param table[] = {
    {"cells", TYN_PARAM_INT, offsetof(diffusion_params, shape.cells), 32, 4, TYN_LATTICE_MAX_CELLS,
     "cells", "lattice cells along the longest side of the medium; 262144 in all", NULL},
    {"sweeps", TYN_PARAM_INT, offsetof(diffusion_params, sweeps), 96, 1, 4096, "",
     "of the relaxation, each over all cells; three times as many as there are cells along a side "
     "will do",
     NULL},
};

const tyn_pass_desc pass_diffusion = {
    .name = "diffusion",
    .summary = "light that has scattered, by the diffusion approximation on the lattice",
    .serves = "media that scatter more than once",
    TYN_PASS_TABLES(diffusion_params),
    .params = table,
    .num_params = TYN_COUNT(table),
    .debug_port = DIFFUSION_PORT_MOMENTS,
    .debug_meaning = "fluence and flux of the scattered light in a slice, W/m^2",
    TYN_COUNTS(DIFFUSION_PORT_COUNTERS, struct counters_block, TYN_COUNTER_NON_FINITE),
};
