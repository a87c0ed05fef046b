// planted.c -- a bug for the bench to find: the tool is linked once more with these in front of the library, and
// method "pop" has then 3 % too much light (TYN_PLANT=output), scatters 3 % too little (TYN_PLANT=albedo),
// or leaves a value that is not a number (TYN_PLANT=nan).
#include <tyndall/offline.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// The linker's option --wrap sends the tool's calls here.
tyn_result __real_tyn_offline_create(tyn_device *dev, const tyn_offline_params *params,
                                     tyn_offline **out);
tyn_result __real_tyn_offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view,
                                    bool recompute);
const void *__real_tyn_offline_output(tyn_offline *off, tyn_output output);
tyn_result __wrap_tyn_offline_create(tyn_device *dev, const tyn_offline_params *params,
                                     tyn_offline **out);
tyn_result __wrap_tyn_offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view,
                                    bool recompute);
const void *__wrap_tyn_offline_output(tyn_offline *off, tyn_output output);

static bool is_pop; // what was made last
static size_t num_values;
static float *brighter;

static bool planted(const char *what)
{
    const char *plant = getenv("TYN_PLANT");
    return is_pop && plant && !strcmp(plant, what);
}

tyn_result __wrap_tyn_offline_create(tyn_device *dev, const tyn_offline_params *params,
                                     tyn_offline **out)
{
    is_pop = !strcmp(params->method, "pop");
    return __real_tyn_offline_create(dev, params, out);
}

tyn_result __wrap_tyn_offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view,
                                    bool recompute)
{
    tyn_scene changed = *scene;
    for (uint32_t i = 0; planted("albedo") && i < changed.num_media; i++) {
        for (int c = 0; c < 3; c++) {
            changed.media[i].sigma_a[c] += 0.03f * changed.media[i].sigma_s[c];
            changed.media[i].sigma_s[c] *= 0.97f;
        }
    }
    num_values = (size_t)4 * view->width * view->height;
    return __real_tyn_offline_frame(off, &changed, view, recompute);
}

const void *__wrap_tyn_offline_output(tyn_offline *off, tyn_output output)
{
    const float *values = __real_tyn_offline_output(off, output);
    const bool light = planted("output"), nan = planted("nan");
    if (!values || output != TYN_OUTPUT_RADIANCE || !(light || nan)) {
        return values;
    }
    float *more = realloc(brighter, num_values * sizeof *more);
    if (!more) {
        return values;
    }
    brighter = more;
    for (size_t i = 0; i < num_values; i++) {
        brighter[i] = i % 4 == 3 || nan ? values[i] : 1.03f * values[i];
    }
    brighter[0] = nan ? NAN : brighter[0];
    return brighter;
}
