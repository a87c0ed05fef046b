// module.c -- what the module lpv brings.
#include <tyndall/extend/plugin.h>
#include "lpv/lpv.h"
#include "lpv_blockers/lpv_blockers.h"
#include "lpv_reflect/lpv_reflect.h"
#include "lpv_scatter/lpv_scatter.h"

extern const tyn_method tyn_method_lpv;
static const tyn_pass_desc *const passes[] = {&tyn_pass_lpv, &tyn_pass_lpv_blockers,
                                              &tyn_pass_lpv_reflect, &tyn_pass_lpv_scatter, NULL};
static const tyn_method *const methods[] = {&tyn_method_lpv, NULL};

TYN_PLUGIN("lpv", "light propagation volumes: scattered light moves on from cell to cell", passes,
           methods, NULL)
