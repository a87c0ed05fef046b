// lattice.h -- the solver of method "pop": one lattice for everything that has scattered.
#pragma once
#include <tyndall/extend/field.h>
#include "passes/methods/light/sources.h"
#include "passes/lattice/lattice.h"
#include "passes/lattice_keep/lattice_keep.h"
#include "passes/lattice_recall/lattice_recall.h"
