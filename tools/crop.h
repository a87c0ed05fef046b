// crop.h -- --crop: a part of a picture.
#pragma once
#include "app.h"
#include <tyndall/context.h>

// "X,Y,WxH": of the view's width x height pixels those from column X and row Y on (row 0 on top). NULL: all. False: said.
bool crop_take(app *a, const char *text, tyn_view *view);
// The same part of a picture with `shrink` times as many pixels a side, at most 1.
void crop_shrink(tyn_view *view, float shrink);
