// settings.c -- values of pass parameters, by "pass.param".
#include "registry/registry.h"
#include "base/fault.h"
#include "graph/graph.h"
#include "base/given.h"
#include <tyndall/extend/hash.h>
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

uint64_t tyn_settings_hash(const tyn_settings *settings)
{
    uint64_t h = TYN_HASH_SEED;
    for (uint32_t i = 0; i < settings->count; i++) {
        const entry *e = &settings->entries[i];
        h = tyn_hash_string(tyn_hash_string(h, e->pass->name), e->param->name);
        h = tyn_hash_bytes(h, &e->value, sizeof e->value);
    }
    return h;
}

// ---- parsing ----------------------------------------------------------------------------------

// Of the parameters of a pass; NULL: of the passes.
static void list_names(char *text, size_t size, const tyn_pass_desc *pass)
{
    const uint32_t count = pass ? pass->num_params : tyn_num_passes();
    size_t at = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < count && at < size; i++) {
        const char *name = pass ? pass->params[i].name : tyn_pass_at(i)->name;
        at += (size_t)snprintf(text + at, size - at, "%s%s", i ? ", " : "", name);
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
    return number && whole && *value >= param->min && *value <= param->max &&
           (param->least <= 0 || *value == param->min || *value >= param->least);
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
        char apart[32] = "";
        if (param->least > 0) {
            snprintf(apart, sizeof apart, "%g or ", param->min);
        }
        snprintf(text, size, "%s%s from %g to %.7g%s%s", apart,
                 param->type == TYN_PARAM_INT ? "a whole number" : "a number",
                 param->least > 0 ? param->least : param->min, param->max, *param->unit ? " " : "",
                 param->unit);
    }
}

// The parameter "pass.param"; NULL: there is none, which the log has been told.
static const tyn_param *find_param(const char *name, const tyn_pass_desc **pass, const tyn_log *log)
{
    char list[512], pass_name[64];
    const char *dot = strchr(name, '.');
    if (!dot || (size_t)(dot - name) >= sizeof pass_name) {
        return TYN_FAULT(log, NULL, "setting '%s': write pass.param=value, as lattice.cells=32",
                         name);
    }
    memcpy(pass_name, name, (size_t)(dot - name));
    pass_name[dot - name] = 0;
    *pass = tyn_pass_find(pass_name);
    if (!*pass) {
        list_names(list, sizeof list, NULL);
        return TYN_FAULT(log, NULL, "setting '%s': there is no pass '%s'; there are: %s", name,
                         pass_name, list);
    }
    for (uint32_t i = 0; i < (*pass)->num_params; i++) {
        if (!strcmp((*pass)->params[i].name, dot + 1)) {
            return &(*pass)->params[i];
        }
    }
    list_names(list, sizeof list, *pass);
    return TYN_FAULT(log, NULL, "setting '%s': pass '%s' has no such parameter; it has: %s", name,
                     pass_name, *list ? list : "none");
}

tyn_result tyn_settings_set(tyn_settings *settings, const char *name, const char *value,
                            const tyn_log *log)
{
    if (!TYN_GIVEN(log, settings, name, value)) {
        return TYN_ERR_PARAMS;
    }
    double number;
    const tyn_pass_desc *pass;
    const tyn_param *param = find_param(name, &pass, log);
    if (param && !parse_value(param, value, &number)) {
        char range[512];
        describe_range(range, sizeof range, param);
        return TYN_FAULT(log, TYN_ERR_PARAMS, "setting '%s' is '%s'; it must be %s", name, value,
                         range);
    }
    return param ? put(settings, pass, param, number) : TYN_ERR_PARAMS;
}

tyn_result tyn_settings_get(const tyn_settings *settings, const char *name, tyn_setting *setting,
                            const tyn_log *log)
{
    if (!TYN_GIVEN(log, name, setting)) {
        return TYN_ERR_PARAMS;
    }
    const tyn_pass_desc *pass;
    const tyn_param *param = find_param(name, &pass, log);
    *setting = (tyn_setting){.param = param, .value = param ? param->def : 0};
    for (uint32_t i = 0; settings && i < settings->count; i++) {
        if (param && settings->entries[i].param == param) {
            setting->value = settings->entries[i].value;
            setting->given = true;
        }
    }
    if (param && param->type == TYN_PARAM_ENUM) {
        setting->word = param->names[(int)setting->value];
    }
    return param ? TYN_OK : TYN_ERR_PARAMS;
}

// ---- presets ----------------------------------------------------------------------------------

typedef struct preset_row {
    const char *name;
    struct {
        const char *setting, *value;
    } settings[8];
} preset_row;

// Normal is every pass's default. On the front of error and time over twelve scenes (tools/bench/suites/presets.json), normal
// and high of those settings that solve the lattice to 1.5 % of its light.
static const preset_row presets[] = {
    [TYN_QUALITY_DRAFT] = {"draft",
                           {{"lattice.cells", "20"},
                            {"lattice.sweeps", "3"},
                            {"beam.cells", "48"},
                            {"raymarch.step", "2"}}},
    [TYN_QUALITY_NORMAL] = {"normal", {{NULL, NULL}}},
    [TYN_QUALITY_HIGH] = {"high", {{"lattice.cells", "40"}}},
};

enum { NUM_PRESETS = sizeof presets / sizeof presets[0] };

const char *tyn_quality_name(tyn_quality quality)
{
    return (size_t)quality < NUM_PRESETS ? presets[quality].name : NULL;
}

// What any of the presets sets is as if it had never been set.
static void forget_presets(tyn_settings *settings)
{
    for (size_t i = 0; i < NUM_PRESETS; i++) {
        for (int s = 0; presets[i].settings[s].setting; s++) {
            const tyn_pass_desc *pass;
            const tyn_param *param = find_param(presets[i].settings[s].setting, &pass, NULL);
            for (uint32_t e = 0; e < settings->count; e++) {
                if (settings->entries[e].param == param) {
                    settings->entries[e] = settings->entries[--settings->count];
                    break;
                }
            }
        }
    }
}

tyn_result tyn_settings_quality(tyn_settings *settings, const char *preset, const tyn_log *log)
{
    if (!TYN_GIVEN(log, settings, preset)) {
        return TYN_ERR_PARAMS;
    }
    for (size_t i = 0; i < NUM_PRESETS; i++) {
        if (strcmp(presets[i].name, preset)) {
            continue;
        }
        forget_presets(settings);
        for (int s = 0; presets[i].settings[s].setting; s++) {
            TYN_TRY(tyn_settings_set(settings, presets[i].settings[s].setting,
                                     presets[i].settings[s].value, log));
        }
        return TYN_OK;
    }
    return TYN_FAULT(log, TYN_ERR_PARAMS, "quality '%s' is not known; it is draft, normal or high",
                     preset);
}

tyn_result tyn_settings_copy(const tyn_settings *from, tyn_quality quality, const tyn_log *log,
                             tyn_settings **out)
{
    const char *preset = tyn_quality_name(quality);
    tyn_result result = tyn_settings_create(out);
    if (result == TYN_OK && !preset) {
        result =
            TYN_FAULT(log, TYN_ERR_PARAMS, "quality is %d; it is one of tyn_quality", (int)quality);
    }
    if (result == TYN_OK) {
        result = tyn_settings_quality(*out, preset, log);
    }
    for (uint32_t i = 0; result == TYN_OK && from && i < from->count; i++) {
        const entry *e = &from->entries[i];
        result = put(*out, e->pass, e->param, e->value);
    }
    if (result != TYN_OK) {
        tyn_settings_destroy(out);
    }
    return result;
}

// ---- use --------------------------------------------------------------------------------------

void tyn_settings_params(const tyn_settings *settings, const tyn_pass_desc *pass, void *params)
{
    tyn_pass_defaults(pass, params);
    for (uint32_t i = 0; params && settings && i < settings->count; i++) {
        const entry *e = &settings->entries[i];
        if (e->pass == pass) {
            graph_store_param(e->param, params, e->value);
        }
    }
}
