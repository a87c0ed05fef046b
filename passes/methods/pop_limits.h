// pop_limits.h -- what method "pop" is good and bad at.
#pragma once
#include <tyndall/registry.h>

extern const tyn_limit tyn_limits_pop[];
