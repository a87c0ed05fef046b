// exr_attributes.h -- what an EXR file says of its image beside the pixels.
#pragma once
#include <tyndall/io.h>
#include <openexr.h>

// Those of the kinds that tyn_attribute has.
tyn_result tyn_exr_read_attributes(exr_context_t context, tyn_image_file *image);
exr_result_t tyn_exr_write_attributes(exr_context_t context, const tyn_image_file *image);
