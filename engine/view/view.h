// view.h -- pictures, probes and balances (tyndall/extend/view.h), with the passes of the library that make them.
#pragma once
#include <tyndall/extend/view.h>
#include "light/sources.h"
#include "view/passes.h"
