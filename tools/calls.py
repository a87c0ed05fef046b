#!/usr/bin/env python3
"""calls.py -- writes tyndall/extend/calls.h: what a plugin may call, as one list, from the headers that declare it.

    calls.py OUTPUT HEADERS...

All functions with TYN_API that these headers declare, but for OTHERS; of three headers those in SHARED.
"""
import os
import re
import sys

# Of hosts and of the loader, not of what a pass or a method does.
OTHERS = {"tyn_method_register", "tyn_picture_hook_register", "tyn_pass_register", "tyn_num_passes", "tyn_pass_at"}
SHARED = {
    "context.h": {"tyn_output_name"},
    "registry.h": {"tyn_settings_params", "tyn_settings_get"},
    "scene.h": {"tyn_phase_mean_cosine", "tyn_phase_delta_fraction", "tyn_light_solid_angle", "tyn_surfaces_emit", "tyn_scene_bounds"},
}
BEFORE = """\
// calls.h -- what a plugin may call, as one list: the table that the loader hands over, and the plugin's own functions
// that go through it, are made of it. Tier 11. Made by the build from the headers of this folder (tools/calls.py).
//
// A plugin links nothing: the host that loads it may have the library as a shared one, as a static one, or privately
// (dlopen with RTLD_LOCAL), and the plugin calls the copy that loads it. The functions below have their ordinary names
// in a plugin, declared by the headers of this folder, so the same source compiles inside the library and outside.
//
// X(result, name, parameters, arguments); V for those without a result.
#pragma once
#include <tyndall/extend/method.h>
#include <tyndall/extend/path_scene.h>

// clang-format off
#define TYN_CALLS(X, V) \\
"""
AFTER = """\

#define TYN_CALL_MEMBER(type, name, params, args) type (*name) params;
#define TYN_CALL_MEMBER_VOID(name, params, args) void (*name) params;
typedef struct tyn_calls {
    TYN_CALLS(TYN_CALL_MEMBER, TYN_CALL_MEMBER_VOID)
} tyn_calls;
// clang-format on
"""


def name_of(parameter):
    """const float (*colors)[3], float lo[3], tyn_graph *g"""
    return re.search(r"\(\*(\w+)\)|(\w+)(?:\[[^\]]*\])*$", parameter).group(1, 2)


def call_of(result, name, parameters):
    parts = [part.strip() for part in re.split(r",(?![^()]*\))", parameters)]
    arguments = "" if parts == ["void"] else ", ".join(inside or plain for inside, plain in map(name_of, parts))
    head = f"V({name}" if result == "void" else f"X({result}, {name}"
    return f"    {head}, ({parameters}), ({arguments}))"


def calls_of(header):
    wanted = SHARED.get(os.path.basename(header))
    with open(header) as file:
        text = " ".join(re.sub(r"//[^\n]*", "", file.read()).split())
    for result, name, parameters in re.findall(r"TYN_API ([^;{}]*?)(tyn_\w+)\(((?:[^()]|\([^()]*\))*)\)", text):
        if "..." not in parameters and name not in OTHERS and (wanted is None or name in wanted):
            yield call_of(result.strip(), name, parameters)


def main():
    calls = [call for header in sys.argv[2:] for call in calls_of(header)]
    with open(sys.argv[1], "w") as file:
        file.write(BEFORE + " \\\n".join(calls) + "\n" + AFTER)


main()
