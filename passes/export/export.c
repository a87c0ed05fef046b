// export.c -- see export.h.
#include "export.h"
#include "export_float.comp.h"
#include "export_half.comp.h"
#include "export_one.comp.h"

static const tyn_port ports[] = {EXPORT_PORTS(TYN_PORT_ROW)};

static const tyn_kernel kernels[] = {
    [TYN_EXPORT_FLOAT] = TYN_KERNEL(export_float),
    [TYN_EXPORT_HALF] = TYN_KERNEL(export_half),
    [TYN_EXPORT_ONE] = TYN_KERNEL(export_one),
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    static const VkFormat formats[] = {
        [TYN_EXPORT_FLOAT] = VK_FORMAT_R32G32B32A32_SFLOAT,
        [TYN_EXPORT_HALF] = VK_FORMAT_R16G16B16A16_SFLOAT,
        [TYN_EXPORT_ONE] = VK_FORMAT_R32_SFLOAT,
    };
    const tyn_export_params *p = params;
    tyn_build_format(b, EXPORT_PORT_HOST, formats[p->kind]);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_export_params *p = params;
    TYN_DISPATCH(r, .kernel = p->kind, .cells = tyn_rec_extent(r, EXPORT_PORT_HOST));
}

const tyn_pass_desc tyn_pass_export = {
    .name = "export",
    .summary = "writes a result into a host's image",
    .serves = "a host's images of results",
    TYN_PASS_TABLES(tyn_export_params),
    .of_pixels = true,
    .debug_port = EXPORT_PORT_HOST,
    .debug_meaning = "the host's image",
};
