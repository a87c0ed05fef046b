// image.h -- limits of images that are read.
#pragma once

#define TYN_MAX_IMAGE_SIDE 65536
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
#define TYN_MAX_PIXELS (1ull << 20)
#else
#define TYN_MAX_PIXELS (1ull << 28)
#endif
