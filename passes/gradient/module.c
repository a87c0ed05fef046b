// module.c -- what the module gradient brings.
#include <tyndall/extend/plugin.h>
#include "gradient/gradient.h"

extern const tyn_method tyn_method_gradient;
static const tyn_pass_desc *const passes[] = {&tyn_pass_gradient, NULL};
static const tyn_method *const methods[] = {&tyn_method_gradient, NULL};

TYN_PLUGIN("gradient", "one scattering from few samples with gradients, split where they err",
           passes, methods, NULL)
