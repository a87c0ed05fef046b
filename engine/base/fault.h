// fault.h -- how a check ends: one line in `log`, and TYN_ERR_PARAMS; and how a fault goes up.
#pragma once
#include <tyndall/base.h>

#define FAULT(...) return (tyn_log_print(log, TYN_LOG_ERROR, __VA_ARGS__), TYN_ERR_PARAMS)

// Returns the fault of a call, if there is one.
#define TYN_TRY(call)                                                                              \
    do {                                                                                           \
        tyn_result r_ = (call);                                                                    \
        if (r_) {                                                                                  \
            return r_;                                                                             \
        }                                                                                          \
    } while (0)
