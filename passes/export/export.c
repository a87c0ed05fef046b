// export.c -- see export.h.
#include "export.h"
#include "passes/export_tables.h"

static const struct {
    VkFormat format;
    uint32_t kernel;
} kinds[] = {
    [TYN_EXPORT_FLOAT] = {VK_FORMAT_R32G32B32A32_SFLOAT, KERNEL_FLOAT},
    [TYN_EXPORT_HALF] = {VK_FORMAT_R16G16B16A16_SFLOAT, KERNEL_HALF},
    [TYN_EXPORT_ONE] = {VK_FORMAT_R32_SFLOAT, KERNEL_ONE},
};

static tyn_result declare(tyn_builder *b, const void *params)
{
    const tyn_export_params *p = params;
    tyn_build_format(b, EXPORT_PORT_HOST, kinds[p->kind].format);
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_export_params *p = params;
    TYN_DISPATCH(r, .kernel = kinds[p->kind].kernel, .cells = tyn_rec_extent(r, EXPORT_PORT_HOST));
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
