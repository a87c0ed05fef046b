// fault.h -- how a check ends: one line in `log`, and TYN_ERR_PARAMS.
#pragma once
#include <tyndall/base.h>

#define FAULT(...) return (tyn_log_print(log, TYN_LOG_ERROR, __VA_ARGS__), TYN_ERR_PARAMS)
