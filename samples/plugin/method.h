// method.h -- method "diffusion".
#pragma once
#include <tyndall/extend/method.h>

extern const tyn_method method_diffusion;
