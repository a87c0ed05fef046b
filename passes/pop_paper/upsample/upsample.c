// upsample.c -- see upsample.h.
#include "upsample.h"
#include "upsample_args.h"
#include "passes/upsample_tables.h"
#include "shaders/common/scene_args.h"
#include <math.h>

#define PORT(name) UPSAMPLE_PORT_##name

static const tyn_param params[] = {
    {"cells", TYN_PARAM_INT, offsetof(tyn_upsample_params, cells), 64, 8, 256, "cells",
     "most cubic cells along the longest side; needless ones beyond the resolution of the medium "
     "and of the merged grid are not made"},
    {"range", TYN_PARAM_FLOAT, offsetof(tyn_upsample_params, range), 1, 0, 10, "",
     "relative difference of sigma_s that counts as another kind of place; 0 = plain trilinear"},
};

// Cells of the result: cubes, as fine as the medium's voxels and as the merged grid's cells, but not more
// than asked for.
static tyn_extent dims_of(const tyn_upsample_params *p, tyn_extent merged)
{
    float longest = fmaxf(p->extent[0], fmaxf(p->extent[1], p->extent[2]));
    float finest = fmaxf((float)merged.x, fmaxf((float)merged.y, (float)merged.z));
    for (int i = 0; i < 3; i++) {
        finest = fmaxf(finest, ceilf((float)p->size[i] * longest / p->extent[i] - 1e-3f));
    }
    float dx = longest / fminf((float)p->cells, finest);
    uint32_t dims[3];
    for (int i = 0; i < 3; i++) {
        dims[i] = (uint32_t)fmaxf(1.0f, ceilf(p->extent[i] / dx - 1e-3f));
    }
    return (tyn_extent){dims[0], dims[1], dims[2]};
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    tyn_extent dims = dims_of(data, tyn_build_extent(b, PORT(MERGED)));
    tyn_build_image(b, PORT(INSCATTER), (tyn_extent){dims.x + 2, dims.y + 2, dims.z + 2}, 1);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_upsample_params *p = data;
    tyn_extent dims = dims_of(p, tyn_rec_extent(r, PORT(MERGED)));
    tyn_extent texels = tyn_rec_extent(r, PORT(INSCATTER));
    struct upsample_args args = {{dims.x, dims.y, dims.z}, p->range};
    TYN_DISPATCH(r, .cells = texels, .args = &args, .spec = &p->mode);
    tyn_rec_work(r, "cells", (double)texels.x * texels.y * texels.z);
}

const tyn_pass_desc tyn_pass_upsample = {
    .name = "upsample",
    .summary = "joint bilateral upsampling of the merged grid's light",
    TYN_PASS_TABLES(tyn_upsample_params),
    TYN_SETTINGS(params),
    .debug_port = PORT(INSCATTER),
    .debug_meaning = "light towards the eye, middle slice of the medium's box",
};
