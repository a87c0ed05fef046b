// sources.h -- what shines (tyndall/extend/sources.h), with the passes of the library that make it.
#pragma once
#include <tyndall/extend/sources.h>
#include "light/passes.h"
