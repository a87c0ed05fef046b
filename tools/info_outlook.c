// info_outlook.c -- what methods are likely to miss and to take in a scene, after measured scenes.
#include "choose.h"
#include "info_scene.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct outlook {
    const char *method;
    uint32_t spp;
    double error, ms;
} outlook;

enum { MAX_OUTLOOKS = 8 };
static const double of_samples = 0.05; // the error whose samples are asked for

static uint32_t look(const fronts *f, const regime *r, uint32_t width, uint32_t height,
                     outlook list[MAX_OUTLOOKS])
{
    uint32_t count = 0;
    if (!(r->optical_depth > 0) && !r->num_triangles) {
        return 0; // nothing is in the picture but the sky
    }
    for (uint32_t i = 0; i < tyn_num_methods() && count < MAX_OUTLOOKS; i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        outlook *o = &list[count];
        *o = (outlook){.method = info.name, .spp = info.progressive ? 64 : 0};
        if (regime_refused(r, &info) ||
            !choose_outlook(f, r, o->method, o->spp, width, height, &o->error, &o->ms)) {
            continue;
        }
        if (o->spp) { // noise falls with the root of the samples
            o->spp =
                (uint32_t)fmin(fmax(ceil(o->spp * pow(o->error / of_samples, 2)), 1), 1u << 20);
            choose_outlook(f, r, o->method, o->spp, width, height, &o->error, &o->ms);
        }
        count++;
    }
    return count;
}

void info_print_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height)
{
    outlook list[MAX_OUTLOOKS];
    const uint32_t count = look(f, r, width, height, list);
    if (count) {
        printf("likely here, from measured scenes like it (%ux%u pixels on %s):\n", width, height,
               f->device.name);
    }
    for (uint32_t i = 0; i < count; i++) {
        const outlook *o = &list[i];
        char samples[32] = "";
        if (o->spp) {
            snprintf(samples, sizeof samples, ", %u samples a pixel", o->spp);
        }
        printf("  %-10s %.*f %% off on 8x8 pixels, %.3g %s%s\n", o->method, o->error < 0.1,
               100 * o->error, o->ms < 1000 ? o->ms : o->ms / 1000, o->ms < 1000 ? "ms" : "s",
               samples);
    }
}

cJSON *info_json_outlook(const fronts *f, const regime *r, uint32_t width, uint32_t height)
{
    outlook list[MAX_OUTLOOKS];
    const uint32_t count = look(f, r, width, height, list);
    cJSON *array = cJSON_CreateArray();
    for (uint32_t i = 0; i < count; i++) {
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "method", list[i].method);
        if (list[i].spp) {
            cJSON_AddNumberToObject(item, "spp", list[i].spp);
        }
        json_add_float(item, "error", list[i].error);
        json_add_float(item, "ms", list[i].ms);
        cJSON_AddItemToArray(array, item);
    }
    return array;
}
