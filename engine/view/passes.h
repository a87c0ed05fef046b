// passes.h -- the passes of views, for methods' tables.
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

#define TYN_GATHER_PASSES &tyn_pass_scatter_lut, &tyn_pass_env_glow, &tyn_pass_merge
#define TYN_SURFACE_PASSES &tyn_pass_gbuffer, &tyn_pass_shade
#define TYN_PICTURE_PASSES &tyn_pass_raymarch, &tyn_pass_composite, &tyn_pass_tonemap
#define TYN_FIELD_PASSES &tyn_pass_probe, &tyn_pass_balance
