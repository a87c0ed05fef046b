// module.c -- what the module light_list brings: passes that other modules share.
#include <tyndall/extend/plugin.h>
#include "light_list/light_list.h"
#include "median_cut/median_cut.h"

static const tyn_pass_desc *const passes[] = {&tyn_pass_light_list, &tyn_pass_median_cut, NULL};

TYN_PLUGIN("light_list", "all lights of a scene in one list", passes, NULL, NULL)
