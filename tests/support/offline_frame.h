// offline_frame.h -- frames of tests, of which every value is a number.
#pragma once
#include <tyndall/offline.h>

// Makes a frame. The test fails on any error; where a kernel met a value that is not finite, which it replaces by 0 and
// counts; and on such a value in an output that `view` asks for.
void offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view);
// The same checks of a frame that was made.
void offline_frame_check(tyn_offline *off, const tyn_view *view);
