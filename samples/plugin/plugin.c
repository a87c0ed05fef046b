// plugin.c -- what this plugin brings: the one thing that Tyndall looks for in it.
#include <tyndall/extend/plugin.h>
#include "diffusion/diffusion.h"
#include "false_colour/false_colour.h"
#include "method.h"

static const tyn_pass_desc *const passes[] = {&pass_diffusion, &pass_false_colour, NULL};
static const tyn_method *const methods[] = {&method_diffusion, NULL};
static const tyn_picture_hook *const hooks[] = {&hook_false_colour, NULL};

TYN_PLUGIN("diffusion", "a diffusion solver, and false colours", passes, methods, hooks)
