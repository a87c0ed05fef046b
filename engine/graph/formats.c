// formats.c -- what the graph knows of formats of texels.
#include "graph/internal.h"

// Those that passes may give their resources.
static const struct {
    VkFormat format;
    uint32_t size; // of a texel, bytes
    const char *name;
} formats[] = {
    {VK_FORMAT_R8_UNORM, 1, "other"},
    {VK_FORMAT_R16_SFLOAT, 2, "R16F"},
    {VK_FORMAT_R32_SFLOAT, 4, "R32F"},
    {VK_FORMAT_R32_UINT, 4, "R32UI"},
    {VK_FORMAT_R16G16_SFLOAT, 4, "other"},
    {VK_FORMAT_R8G8B8A8_UNORM, 4, "RGBA8"},
    {VK_FORMAT_D32_SFLOAT, 4, "D32F"},
    {VK_FORMAT_R32G32_SFLOAT, 8, "RG32F"},
    {VK_FORMAT_R32G32_UINT, 8, "RG32UI"},
    {VK_FORMAT_R16G16B16A16_SFLOAT, 8, "RGBA16F"},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 16, "RGBA32F"},
    {VK_FORMAT_R32G32B32A32_UINT, 16, "RGBA32UI"},
    {VK_FORMAT_UNDEFINED, 16, "other"}, // all else: the most that a texel takes
};

static uint32_t row_of(VkFormat format)
{
    uint32_t i = 0;
    while (formats[i].format && formats[i].format != format) {
        i++;
    }
    return i;
}

uint32_t graph_texel_size(VkFormat format)
{
    return formats[row_of(format)].size;
}

const char *graph_format_name(VkFormat format)
{
    return formats[row_of(format)].name;
}

VkImageAspectFlags graph_aspect(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

const VkFormat graph_texel_formats[NUM_TEXEL_FORMATS] = {
    VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_UINT,
    VK_FORMAT_R32G32B32A32_UINT};

int graph_texel_index(tyn_use use)
{
    static const tyn_use uses[NUM_TEXEL_FORMATS] = {TYN_USE_TEXELS_FLOAT, TYN_USE_TEXELS_VEC4,
                                                    TYN_USE_TEXELS_UINT, TYN_USE_TEXELS_UVEC4};
    int i = NUM_TEXEL_FORMATS - 1;
    while (i >= 0 && uses[i] != use) {
        i--;
    }
    return i;
}

uint64_t graph_resource_bytes(const resource *r)
{
    if (r->dim == TYN_BUFFER) {
        return r->extent.x;
    }
    uint64_t bytes = 0;
    for (uint32_t m = 0; m < r->mips; m++) {
        uint64_t x = r->extent.x >> m, y = r->extent.y >> m, z = r->extent.z >> m;
        bytes += (x ? x : 1) * (y ? y : 1) * (z ? z : 1) * graph_texel_size(r->format);
    }
    return bytes;
}
