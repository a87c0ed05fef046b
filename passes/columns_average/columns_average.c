// columns_average.c -- the medium as coarse as columns between the lattice's cells can tell.
#include "columns_average.h"
#include "passes/columns_average_tables.h"
#include <math.h>
#include <string.h>

bool tyn_columns_average_size(const struct medium_block *medium, const uint32_t dims[3],
                              uint32_t size[3])
{
    const float *extent = medium->extent;
    double dx = fmax(extent[0], fmax(extent[1], extent[2])) / fmax(dims[0], fmax(dims[1], dims[2]));
    bool coarser = false;
    for (int a = 0; a < 3; a++) {
        double most = fmax(ceil(2 * extent[a] / dx - 1e-3), 1);
        size[a] = medium->size[a] < most ? medium->size[a] : (uint32_t)most;
        coarser = coarser || medium->size[a] > 1.25 * most;
    }
    return coarser;
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_columns_average_params *p = params;
    tyn_extent size = {p->size[0], p->size[1], p->size[2]};
    if (p->mode != TYN_MEDIUM_DENSITY) {
        tyn_build_image(b, COLUMNS_AVERAGE_PORT_MEAN_SIGMA_S, size, 1);
        tyn_build_image(b, COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A, size, 1);
        if (p->mode == TYN_MEDIUM_COEFFICIENTS) {
            tyn_build_image(b, COLUMNS_AVERAGE_PORT_MEAN_G, size, 1);
        }
    } else {
        tyn_build_image(b, COLUMNS_AVERAGE_PORT_MEAN_DENSITY, size, 1);
    }
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_columns_average_params *p = params;
    tyn_extent texels = tyn_rec_extent(r, COLUMNS_AVERAGE_PORT_DENSITY);
    const uint32_t fine[3] = {texels.x, texels.y, texels.z};
    struct columns_average_args args = {.size = {p->size[0], p->size[1], p->size[2]}};
    double fetches = 1;
    for (int a = 0; a < 3; a++) {
        // One trilinear sample for two voxels along an axis.
        double pairs = ceil(0.5 * fine[a] / p->size[a] - 1e-3);
        args.samples[a] = (uint32_t)fmin(fmax(pairs, 1), 16);
        fetches *= (double)args.samples[a] * p->size[a];
    }
    const bool coefficients = p->mode != TYN_MEDIUM_DENSITY,
               varies = p->mode == TYN_MEDIUM_COEFFICIENTS;
    // An image that is not written to may be any.
    static const uint8_t absent[][2] = {
        {COLUMNS_AVERAGE_PORT_MEAN_G, COLUMNS_AVERAGE_PORT_MEAN_SIGMA_A}};
    const uint32_t kernel = coefficients ? KERNEL_COEFFICIENTS : KERNEL_DENSITY;
    uint8_t bindings[TYN_MAX_BINDINGS];
    tyn_ports_exchanged(&kernels[kernel], absent, coefficients && !varies, bindings);
    TYN_DISPATCH(r, .kernel = kernel, .cells = {p->size[0], p->size[1], p->size[2]}, .args = &args,
                 .ports = bindings, .spec = &p->mode);
    tyn_rec_work(r, "fetches", fetches * (coefficients ? 2 + varies : 1));
}

const tyn_pass_desc tyn_pass_columns_average = {
    .name = "columns_average",
    .summary = "the medium averaged over half cells of the lattice, for columns",
    .serves = "principal ordinates in a medium much finer than the lattice",
    TYN_PASS_TABLES(tyn_columns_average_params),
    .media_only = true,
    .debug_port = COLUMNS_AVERAGE_PORT_MEAN_DENSITY,
    .debug_meaning = "mean density",
};
