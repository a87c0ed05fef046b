// toy_passes.h -- passes of tests of the render graph: they do nothing but dispatch and draw.
#pragma once
#include "graph/graph.h"

typedef struct node_params {
    int32_t times; // dispatches
    int32_t value;
    uint32_t spec;
} node_params;

// Reads an image and perhaps a buffer, writes an image through a ping-pong.
enum { BLUR_IN, BLUR_BIAS, BLUR_OUT, BLUR_TMP, BLUR_NUM };
extern const tyn_pass_desc toy_blur;

// Changes a buffer in place.
enum { ADD_SUM, ADD_X, ADD_NUM };
extern const tyn_pass_desc toy_add;

// Counts into a buffer and dispatches as many workgroups.
enum { COUNT_IN, COUNT_GROUPS, COUNT_OUT, COUNT_NUM };
extern const tyn_pass_desc toy_count;

// Triangles into two tiles, then over them, and a depth image that is sampled afterwards.
enum { DRAW_CORNERS, DRAW_TEXTURE, DRAW_COLOR, DRAW_DEPTH, DRAW_NUM };
extern const tyn_pass_desc toy_draw;
