// output.c -- what outputs are called, and which the host may lend images for.
#include "frame/output.h"
#include <tyndall/extend/job.h>
#include <stddef.h>
#include <string.h>

const char *tyn_output_name(tyn_output which)
{
#define ROW(constant, bit, name, bytes, set) name,
    static const char *const names[] = {TYN_OUTPUTS(ROW)};
#undef ROW
    for (uint32_t i = 0; i < TYN_NUM_OUTPUTS; i++) {
        if (which == (tyn_output)(1u << i)) {
            return names[i];
        }
    }
    return "unknown";
}

const char *tyn_job_output_name(tyn_output which)
{
    return which == TYN_OUTPUT_PROBE ? "points" : tyn_output_name(which);
}

#define LENT(constant, field, other, formats)                                                      \
    {                                                                                              \
        TYN_OUTPUT_##constant, offsetof(tyn_frame_images, field), #constant, "images." #field,     \
            "host_" #field, #field "_image", other, formats                                        \
    }
const tyn_lent_image tyn_lent_images[TYN_NUM_LENT] = {
    LENT(RADIANCE, radiance, VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f or rgba32f"),
    LENT(TRANSMITTANCE, transmittance, VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f or rgba32f"),
    LENT(DEPTH, depth, VK_FORMAT_R32_SFLOAT, "r32f or rgba32f"),
};

const tyn_image *tyn_lent(const tyn_frame_images *images, uint32_t index)
{
    const tyn_image *image;
    memcpy(&image, (const char *)images + tyn_lent_images[index].at, sizeof image);
    return image;
}
