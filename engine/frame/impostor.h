// impostor.h -- pictures that are marched again only where the view has changed enough (Elek et al. 2012, Sec 4.4).
#pragma once
#include "frame/context.h"

// If the user wants that (impostor.on) and the method, the scene and the view allow it: makes job->refs.camera one that sees all of the
// media, from where they were marched last, and job->refs.shown_camera the view's.
void tyn_frame_impostor(tyn_context *ctx, tyn_job *job);
