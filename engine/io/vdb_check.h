// vdb_check.h -- walks over the structure of an OpenVDB file before the library reads it.
#pragma once
#include <tyndall/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// False: a line that names `file` was logged. True: every length and count that the library will believe fits into the
// file, so that it ends, and asks for no more memory than a small multiple of `size`. `newest` is the file format's
// version that the library knows.
bool tyn_vdb_check(const void *bytes, size_t size, uint32_t newest, const char *file,
                   const tyn_log *log);

#ifdef __cplusplus
}
#endif
