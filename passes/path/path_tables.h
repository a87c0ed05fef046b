// path_tables.h -- what the three passes of the path tracer have in common.
#pragma once
#include "path.h"
#include "path_args.h"

// clang-format off
#define PATH_SCENE_PORT_ROWS                                                                       \
    {"atlas", TYN_IN, TYN_IMAGE_3D, 0, true, "all density grids"},                                 \
    {"medium", TYN_IN, TYN_BUFFER, 0, false, "the medium frame's box and bricks"},                 \
    {"shapes", TYN_IN, TYN_BUFFER, 0, true, "the exact media"},                                    \
    {"bricks", TYN_IN, TYN_IMAGE_3D, 0, true, "least and largest density or extinction of bricks"}, \
    {"lights", TYN_IN, TYN_BUFFER, 0, true, "suns and lamps"},                                     \
    {"environment", TYN_IN, TYN_BUFFER, 0, true, "the surroundings"},                              \
    {"env_map", TYN_IN, TYN_IMAGE_2D, 0, true, "radiance of the surroundings, W/(m^2 sr)"},        \
    {"env_table", TYN_IN, TYN_BUFFER, 0, true, "alias table of the map's brightness"},             \
    TYN_GEOMETRY(TYN_BUNDLE_OPTIONAL, PATH),                                                       \
    TYN_MATERIALS(TYN_BUNDLE_OPTIONAL, PATH),                                                      \
    {"emitters", TYN_IN, TYN_BUFFER, 0, true, "alias table of the emissive triangles' power"}

#define PATH_SCENE_BINDING_ROWS                                                                    \
    {PATH_PORT_ATLAS, TYN_USE_SAMPLED, false},                                                     \
    {PATH_PORT_MEDIUM, TYN_USE_UNIFORM, false},                                                    \
    {PATH_PORT_SHAPES, TYN_USE_STORAGE_READ, false},                                               \
    {PATH_PORT_BRICKS, TYN_USE_SAMPLED, false},                                                    \
    {PATH_PORT_LIGHTS, TYN_USE_STORAGE_READ, false},                                               \
    {PATH_PORT_ENVIRONMENT, TYN_USE_UNIFORM, false},                                               \
    {PATH_PORT_ENV_MAP, TYN_USE_SAMPLED, true},                                                    \
    {PATH_PORT_ENV_TABLE, TYN_USE_STORAGE_READ, false},                                            \
    TYN_GEOMETRY(TYN_BUNDLE_BIND, PATH),                                                           \
    TYN_MATERIALS(TYN_BUNDLE_BIND, PATH),                                                          \
    {PATH_PORT_EMITTERS, TYN_USE_STORAGE_READ, false}
// clang-format on

enum { PATH_NUM_PARAMS = 3 };
extern const tyn_param path_params_table[PATH_NUM_PARAMS];

// Arguments of a tracing kernel but for `first`, `num` and `slots`.
struct path_args path_trace_args(const tyn_path_params *p);
void path_specialise(uint32_t spec[TYN_PATH_NUM_SPEC], const tyn_path_params *p);
