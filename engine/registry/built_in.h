// built_in.h -- what the library is built of: its own passes and methods, then its modules. The build makes the list.
#pragma once
#include <tyndall/extend/plugin.h>

extern const tyn_plugin tyn_built_in_core;     // the library's own
extern const tyn_plugin *const tyn_built_in[]; // NULL at the end; none has calls
extern const char tyn_left_out[];              // the methods of the other modules: "lpv, photon"
