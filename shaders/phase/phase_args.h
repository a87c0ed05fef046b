// phase_args.h -- the phase function of one colour channel. Included by C and GLSL; scalar layout.
#ifndef TYN_PHASE_ARGS_H
#define TYN_PHASE_ARGS_H

#ifdef __STDC__
#include <tyndall/scene.h> // tyn_phase
#else
struct phase { // as tyn_phase of <tyndall/scene.h>
    float g;
    uint table;
    float delta, forward, backward;
    uint key;
};
#define tyn_phase phase
#define TYN_PHASE_NODES 2048
#endif

#endif
