// exr.h -- OpenEXR images in memory.
#pragma once
#include <tyndall/io.h>

tyn_result tyn_exr_parse(tyn_image_file *image, const void *bytes, size_t size, const char *file,
                         const tyn_log *log);
