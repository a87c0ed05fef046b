// settings.c -- values of pass parameters, by "pass.param".
#include "registry/registry.h"
#include "base/given.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    const tyn_pass_desc *pass;
    const tyn_param *param;
    double value;
} entry;

struct tyn_settings {
    entry *entries;
    uint32_t count;
};

tyn_result tyn_settings_create(tyn_settings **out)
{
    if (!out) {
        return TYN_ERR_PARAMS;
    }
    *out = calloc(1, sizeof **out);
    return *out ? TYN_OK : TYN_ERR_MEMORY;
}

void tyn_settings_destroy(tyn_settings **settings)
{
    if (settings && *settings) {
        free((*settings)->entries);
        free(*settings);
        *settings = NULL;
    }
}

tyn_result tyn_settings_copy(const tyn_settings *from, tyn_settings **out)
{
    tyn_result result = tyn_settings_create(out);
    if (result == TYN_OK && from && from->count) {
        (*out)->entries = malloc(from->count * sizeof *from->entries);
        if (!(*out)->entries) {
            tyn_settings_destroy(out);
            return TYN_ERR_MEMORY;
        }
        memcpy((*out)->entries, from->entries, from->count * sizeof *from->entries);
        (*out)->count = from->count;
    }
    return result;
}

static tyn_result put(tyn_settings *settings, const tyn_pass_desc *pass, const tyn_param *param,
                      double value)
{
    for (uint32_t i = 0; i < settings->count; i++) {
        if (settings->entries[i].param == param) {
            settings->entries[i].value = value;
            return TYN_OK;
        }
    }
    entry *grown = realloc(settings->entries, (settings->count + 1) * sizeof *grown);
    if (!grown) {
        return TYN_ERR_MEMORY;
    }
    settings->entries = grown;
    settings->entries[settings->count++] = (entry){pass, param, value};
    return TYN_OK;
}

// ---- parsing ----------------------------------------------------------------------------------

static void list_names(char *text, size_t size, const tyn_pass_desc *pass)
{
    size_t at = 0;
    text[0] = 0;
    if (pass) {
        for (uint32_t i = 0; i < pass->num_params && at < size; i++) {
            at +=
                (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", pass->params[i].name);
        }
    } else {
        for (uint32_t i = 0; i < tyn_num_passes() && at < size; i++) {
            at +=
                (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", tyn_pass_at(i)->name);
        }
    }
}

static bool parse_value(const tyn_param *param, const char *text, double *value)
{
    if (param->type == TYN_PARAM_ENUM) {
        for (int i = 0; i <= (int)param->max; i++) {
            if (!strcmp(param->names[i], text)) {
                *value = i;
                return true;
            }
        }
        return false;
    }
    if (param->type == TYN_PARAM_BOOL) {
        bool on = !strcmp(text, "true") || !strcmp(text, "on") || !strcmp(text, "1");
        bool off = !strcmp(text, "false") || !strcmp(text, "off") || !strcmp(text, "0");
        *value = on;
        return on || off;
    }
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    bool number = *text && !*end && errno == 0 && isfinite(*value);
    bool whole = param->type == TYN_PARAM_FLOAT || *value == floor(*value);
    return number && whole && *value >= param->min && *value <= param->max;
}

static void describe_range(char *text, size_t size, const tyn_param *param)
{
    if (param->type == TYN_PARAM_BOOL) {
        snprintf(text, size, "true or false");
    } else if (param->type == TYN_PARAM_ENUM) {
        size_t at = (size_t)snprintf(text, size, "one of ");
        for (int i = 0; i <= (int)param->max && at < size; i++) {
            at += (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", param->names[i]);
        }
    } else {
        snprintf(text, size, "%s from %g to %g%s%s",
                 param->type == TYN_PARAM_INT ? "a whole number" : "a number", param->min,
                 param->max, *param->unit ? " " : "", param->unit);
    }
}

tyn_result tyn_settings_set(tyn_settings *settings, const char *name, const char *value,
                            const tyn_log *log)
{
    char list[512], pass_name[64];
    if (!TYN_GIVEN(log, settings, name, value)) {
        return TYN_ERR_PARAMS;
    }
    const char *dot = strchr(name, '.');
    if (!dot || (size_t)(dot - name) >= sizeof pass_name) {
        tyn_log_print(log, TYN_LOG_ERROR,
                      "setting '%s': write pass.param=value, as lattice.cells=32", name);
        return TYN_ERR_PARAMS;
    }
    memcpy(pass_name, name, (size_t)(dot - name));
    pass_name[dot - name] = 0;
    const tyn_pass_desc *pass = tyn_pass_find(pass_name);
    if (!pass) {
        list_names(list, sizeof list, NULL);
        tyn_log_print(log, TYN_LOG_ERROR, "setting '%s': there is no pass '%s'; there are: %s",
                      name, pass_name, list);
        return TYN_ERR_PARAMS;
    }
    for (uint32_t i = 0; i < pass->num_params; i++) {
        const tyn_param *param = &pass->params[i];
        if (strcmp(param->name, dot + 1)) {
            continue;
        }
        double number;
        if (!parse_value(param, value, &number)) {
            describe_range(list, sizeof list, param);
            tyn_log_print(log, TYN_LOG_ERROR, "setting '%s' is '%s'; it must be %s", name, value,
                          list);
            return TYN_ERR_PARAMS;
        }
        return put(settings, pass, param, number);
    }
    list_names(list, sizeof list, pass);
    tyn_log_print(log, TYN_LOG_ERROR, "setting '%s': pass '%s' has no such parameter; it has: %s",
                  name, pass_name, *list ? list : "none");
    return TYN_ERR_PARAMS;
}

// ---- presets ----------------------------------------------------------------------------------

typedef struct quality {
    const char *name;
    struct {
        const char *setting, *value;
    } settings[8];
} quality;

// Normal is every pass's default. On the front of error and time over twelve scenes (tools/bench/suites/presets.json), normal
// and high of those settings that solve the lattice to 1.5 % of its light.
static const quality presets[] = {
    {"draft",
     {{"lattice.cells", "20"},
      {"lattice.sweeps", "3"},
      {"beam.cells", "48"},
      {"raymarch.step", "2"}}},
    {"normal", {{NULL, NULL}}},
    {"high", {{"lattice.cells", "40"}}},
};

tyn_result tyn_settings_quality(tyn_settings *settings, const char *preset, const tyn_log *log)
{
    if (!TYN_GIVEN(log, settings, preset)) {
        return TYN_ERR_PARAMS;
    }
    for (size_t i = 0; i < sizeof presets / sizeof presets[0]; i++) {
        if (strcmp(presets[i].name, preset)) {
            continue;
        }
        tyn_result result = TYN_OK;
        for (int s = 0; result == TYN_OK && presets[i].settings[s].setting; s++) {
            result = tyn_settings_set(settings, presets[i].settings[s].setting,
                                      presets[i].settings[s].value, log);
        }
        return result;
    }
    tyn_log_print(log, TYN_LOG_ERROR, "quality '%s' is not known; it is draft, normal or high",
                  preset);
    return TYN_ERR_PARAMS;
}

// ---- use --------------------------------------------------------------------------------------

void tyn_settings_params(const tyn_settings *settings, const tyn_pass_desc *pass, void *params)
{
    tyn_pass_defaults(pass, params);
    for (uint32_t i = 0; params && settings && i < settings->count; i++) {
        const entry *e = &settings->entries[i];
        if (e->pass != pass) {
            continue;
        }
        void *field = (uint8_t *)params + e->param->offset;
        if (e->param->type == TYN_PARAM_FLOAT) {
            *(float *)field = (float)e->value;
        } else {
            *(int32_t *)field = (int32_t)e->value;
        }
    }
}
