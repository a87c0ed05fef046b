// ordinates.h -- principal ordinates: the directions from which the surroundings light the medium.
//
// The sphere is cut into regions of about equal light x importance, each an ordinate that carries the
// exact integral of its region, in units of the map: directions do not change when the sky is dimmed.
// Pass sky_light gives the ordinates the light of the scene. The cuts form a tree whose shape depends on the number of regions alone
// and whose axes depend on the map alone, in the map's own frame: when the map turns or importance
// changes, every region moves a little and keeps its place in the list.
#pragma once
#include <tyndall/pass.h>
#include "shaders/light/ordinate_args.h"

// Of `spread`, without `split`. Less the mean of the sky, ordinates carry its contrast, and of that dark regions have as much
// as bright ones; all its light is worth to be followed closer.
#define ORDINATES_SPREAD_OF_ALL 0.25f

typedef struct tyn_ordinates_params {
    int32_t count; // regions, 1..256, or 0 if the method has nothing but fixed ones; fewer if there
                   // are too many of those
    uint32_t split; // 1: the mean of the sky (env_block.sky) is not in them
    float spread;   // see ordinates_args.h
    // Set by the method, 1 or a power of two: `count` is of regions that are cut into so many parts each, which are ordinates.
    uint32_t fan;
    float rows[3][4];   // set by the method: env_block.rows
    uint32_t num_fixed; // set by the method: ready-made ordinates that come first
    struct ordinate fixed[TYN_ORDINATES_MAX_FIXED];
} tyn_ordinates_params;

// clang-format off
#define ORDINATES_PORTS(X) \
    X(ORDINATES, SKY, sky, OPTIONAL, IMAGE_2D, "of env_importance; not for a constant environment"), \
    X(ORDINATES, SUMS, sums, OPTIONAL, BUFFER, "of env_importance; with `sky`"), \
    X(ORDINATES, IMPORTANCE, importance, OPTIONAL, IMAGE_2D, "by the direction light comes from, frame M, mean 1"), \
    X(ORDINATES, ORDINATES, ordinates, OUT, BUFFER, "struct ordinates_block, for a radiance of 1"), \
    X(ORDINATES, WEIGHTS, weights, SCRATCH, BUFFER, "sums of luminance x importance over rectangles"), \
    X(ORDINATES, REGIONS, regions, SCRATCH, BUFFER, "vec4[TYN_ORDINATES_MAX]: corners on the map")
// clang-format on
TYN_PASS(ORDINATES, ordinates);
