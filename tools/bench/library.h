// library.h -- which build of the library measures.
#pragma once
#include <stdint.h>

// A hash of the file that the library was loaded from: of its code, host side and kernels. 0 where it cannot be read.
uint64_t library_hash(void);
