// ceilings_cache.h -- the ceilings of a device, measured once a day.
#pragma once
#include "bench/ceilings.h"

// From $XDG_CACHE_HOME/tyndall if they were measured within a day on this machine, else measured now. Gives the
// exit code.
int ceilings_known(app *a, tyn_device *device, ceilings *c);
