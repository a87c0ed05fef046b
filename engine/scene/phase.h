// phase.h -- phase functions in C, beside what <tyndall/scene.h> has of them. Their twin in GLSL is shaders/phase.
#pragma once
#include <tyndall/scene.h>

// A lobe of a greater mean cosine is replaced by one of this, with as much less scattering (similarity_clamp of
// shaders/phase/phase.glsl).
#define TYN_PHASE_NARROWEST 0.995

// Is every parameter in its range? The first fault is one log line: "media[0].g[1] = 2: must be ...".
tyn_result tyn_phase_check(const tyn_phase phase[3], const char *of, const tyn_log *log);

bool tyn_phase_is_grey(const tyn_phase phase[3]); // equal in all channels

// The Henyey-Greenstein phase function.
tyn_phase tyn_phase_of_mean_cosine(float g);

// |g| of the narrowest lobe, forward or backward: the Legendre moments fall as its powers.
double tyn_phase_narrowness(tyn_phase phase);
// With lobes no narrower than TYN_PHASE_NARROWEST. Tables are as they are.
tyn_phase tyn_phase_resolved(tyn_phase phase);

// Is there a forward lobe that is worth splitting off? It holds the part f of delta scaling.
bool tyn_phase_has_lobe(tyn_phase phase);
// Writes the Legendre moments 2 pi int p h P_l dmu of l = 0 .. terms - 1 (the first is f) of the lobe p h and returns
// theta_1, radians: the window h is 1 inside theta_1 / 2, 0 outside 3 theta_1 / 2. Only where there is a lobe; one of a
// greater mean cosine than `narrowest` is taken for that one. `tables`: the scene's.
double tyn_phase_lobe_moments(const tyn_phase_table *tables, tyn_phase phase, double narrowest,
                              double *moments, uint32_t terms);
// ... of all of p; of a Henyey-Greenstein lobe that points backward, those of the lobe as it is seen from behind.
void tyn_phase_moments(const tyn_phase_table *tables, tyn_phase phase, double *moments,
                       uint32_t terms);

// Has a phase function whose numbers are in range a table that is there, of those numbers? The first fault is one log line.
tyn_result tyn_phase_check_tables(const tyn_scene *scene, const tyn_log *log);
