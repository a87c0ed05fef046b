// fault.h -- how a check ends: one line in `log`, and TYN_ERR_PARAMS; and how a fault goes up.
#pragma once
#include <tyndall/base.h>

#define FAULT(...) return TYN_FAULT(log, TYN_ERR_PARAMS, __VA_ARGS__)

// Returns the fault of a call, if there is one.
#define TYN_TRY(call)                                                                              \
    do {                                                                                           \
        tyn_result r_ = (call);                                                                    \
        if (r_) {                                                                                  \
            return r_;                                                                             \
        }                                                                                          \
    } while (0)
