// passes.h -- the passes of views, by their params and ports.
#pragma once
#include "passes/scatter_lut/scatter_lut.h"
#include "passes/env_glow/env_glow.h"
#include "passes/merge/merge.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/shade/shade.h"
#include "passes/raymarch/raymarch.h"
#include "passes/composite/composite.h"
#include "passes/tonemap/tonemap.h"
#include "passes/probe/probe.h"
#include "passes/balance/balance.h"
