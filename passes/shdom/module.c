// module.c -- what the module shdom brings.
#include <tyndall/extend/plugin.h>
#include "shdom/shdom.h"
#include "shdom_view/shdom_view.h"

extern const tyn_method tyn_method_shdom;
static const tyn_pass_desc *const passes[] = {&tyn_pass_shdom, &tyn_pass_shdom_view, NULL};
static const tyn_method *const methods[] = {&tyn_method_shdom, NULL};

TYN_PLUGIN("shdom", "spherical harmonics and discrete ordinates (1998), to be compared with",
           passes, methods, NULL)
