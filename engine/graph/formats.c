// formats.c -- what the graph knows of formats of texels.
#include "graph/internal.h"

uint32_t graph_texel_size(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return 1;
    case VK_FORMAT_R16_SFLOAT:
        return 2;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_D32_SFLOAT:
        return 4;
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
        return 16;
    default:
        return 16;
    }
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
    switch (use) {
    case TYN_USE_TEXELS_FLOAT:
        return 0;
    case TYN_USE_TEXELS_VEC4:
        return 1;
    case TYN_USE_TEXELS_UINT:
        return 2;
    case TYN_USE_TEXELS_UVEC4:
        return 3;
    default:
        return -1;
    }
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
