// choice_setup.c -- --max-error and --budget-ms: method and settings that are chosen for a scene.
#include "choice_setup.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const blocks[] = {"8", "1", NULL};

#define AT(field) offsetof(choice_options, field)
const option choice_table[CHOICE_TABLE_SIZE] = {
    {0, "max-error", OPT_TEXT, AT(max_error), "E",
     "choose method and settings: the fastest within this error (5% or 0.05; of compare --block "
     "8)"},
    {0, "budget-ms", OPT_NUMBER, AT(budget_ms), "MS",
     "choose method and settings: the least error within this time of a cold frame", NAN, 1e-3,
     1e9},
    {0, "error-block", OPT_TEXT, AT(blocks), "8|1",
     "what errors are of: blocks of 8x8 pixels (default), or single ones", .names = blocks},
    {0, "fronts", OPT_TEXT, AT(fronts), "FILE",
     "measurements to choose from (bench --write-fronts), else those built in", .file = OPT_READS},
};

bool choice_is_asked(const choice_options *options)
{
    return options->max_error || !isnan(options->budget_ms);
}

// Who asks for all of the light as error means percent. False: said.
static bool check_error(app *a, const char *text)
{
    bool percent = false;
    const double value = text_fraction(text, &percent);
    if (isnan(value)) {
        app_error(a, "--max-error: '%s' is neither a share like 0.05 nor a percentage like 5%%",
                  text);
        return false;
    }
    if (value >= 1 && !percent) {
        app_error(a, "--max-error: '%s' is a share, of %g %%; did you mean %s%%?", text,
                  100 * value, text);
        return false;
    }
    return true;
}

bool choice_check(app *a, const choice_options *options, const method_options *how)
{
    if (!choice_is_asked(options) && (options->fronts || options->blocks)) {
        app_error(a, "--%s needs --max-error or --budget-ms, for which it is",
                  options->fronts ? "fronts" : "error-block");
        return false;
    }
    if (options->max_error && !check_error(a, options->max_error)) {
        return false;
    }
    if (choice_is_asked(options) && how->quality) {
        app_error(a, "--quality %s: --max-error and --budget-ms choose the settings themselves",
                  how->quality);
        return false;
    }
    if (choice_is_asked(options) && how->refine) {
        app_error(a, "--refine %s: --max-error and --budget-ms choose the samples themselves",
                  how->refine);
        return false;
    }
    if (choice_is_asked(options) && how->spp) {
        app_error(a, "--spp %u: --max-error and --budget-ms choose the samples themselves",
                  how->spp);
        return false;
    }
    tyn_method_info info;
    return !choice_is_asked(options) || method_find(a, how->method, &info);
}

// ---- what may be chosen -----------------------------------------------------------------------

// Methods that this build lacks or that refuse the scene, as " a b ". NULL: out of memory.
static char *left_out(const fronts *f, const regime *r)
{
    char *list = text_format(" ");
    for (uint32_t i = 0; i < f->num_scenes; i++) {
        for (uint32_t k = 0; k < f->scenes[i].num_runs && list; k++) {
            const char *name = f->scenes[i].runs[k].method;
            char word[40];
            tyn_method_info info;
            snprintf(word, sizeof word, " %s ", name);
            const bool can = tyn_method_named(name, &info) && !regime_refused(r, &info);
            if (!can && !strstr(list, word)) {
                char *longer = text_format("%s%s ", list, name);
                free(list);
                list = longer;
            }
        }
    }
    return list;
}

// ---- what was chosen --------------------------------------------------------------------------

static bool take_text(chosen *c, char *text)
{
    if (text && c->num_texts < OPT_MAX_LIST) {
        c->texts[c->num_texts++] = text;
        return true;
    }
    free(text);
    return false;
}

// Method, settings and samples into the options; what -D says comes after and stays.
static bool set_method(const choice *best, const method_options *how, chosen *out)
{
    out->method = *how;
    out->method.defines.count = 0;
    char *name = text_format("%s", best->run->method);
    if (!take_text(out, name)) {
        return false;
    }
    out->method.method = name;
    out->method.spp = best->spp ? best->spp : how->spp;
    const cJSON *item;
    cJSON_ArrayForEach(item, best->run->settings)
    {
        if (strcmp(item->string, "quality") == 0 && cJSON_IsString(item)) {
            out->method.quality = text_format("%s", item->valuestring);
            if (!take_text(out, (char *)out->method.quality)) {
                return false;
            }
            continue;
        }
        char *value = cJSON_IsString(item) ? text_format("%s", item->valuestring)
                                           : cJSON_PrintUnformatted(item);
        char *define = value ? text_format("%s=%s", item->string, value) : NULL;
        free(value);
        if (!take_text(out, define)) {
            return false;
        }
        out->method.defines.items[out->method.defines.count++] = define;
    }
    for (uint32_t i = 0; i < how->defines.count; i++) {
        if (out->method.defines.count == OPT_MAX_LIST) {
            return false;
        }
        out->method.defines.items[out->method.defines.count++] = how->defines.items[i];
    }
    return true;
}

// "pop, lattice.cells=16" or "path, 64 samples": a new string.
static char *name_of(const fronts_run *run, uint32_t spp)
{
    const char *settings = strchr(run->key, ' ');
    if (spp) {
        return text_format("%s, %u sample%s%s%s", run->method, spp, spp == 1 ? "" : "s",
                           settings ? "," : "", settings ? settings : "");
    }
    return text_format("%s%s%s", run->method, settings ? "," : " as it is",
                       settings ? settings : "");
}

static void time_text(char text[32], double ms)
{
    if (ms < 10) {
        snprintf(text, 32, "%.2g ms", ms);
    } else if (ms < 1000) {
        snprintf(text, 32, "%.0f ms", ms);
    } else if (ms < 1e5) {
        snprintf(text, 32, "%.1f s", 1e-3 * ms);
    } else {
        snprintf(text, 32, "%.0f s", 1e-3 * ms);
    }
}

static void percent_text(char text[32], double share)
{
    snprintf(text, 32, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
}

// What is chosen, and what it was chosen from and over. Two new strings.
static bool lines_of(const choose_request *request, const choice *best, char *lines[2])
{
    char ms[32], ms_likely[32], error[32], error_likely[32], near[256] = "", traded[160] = "";
    size_t used = 0;
    time_text(ms, best->ms);
    time_text(ms_likely, best->ms * best->ms_margin);
    percent_text(error, best->error);
    percent_text(error_likely, best->error * best->error_margin);
    char *name = name_of(best->run, best->spp);
    lines[0] = text_format("chosen: %s; error %s about %s, likely below %s; a cold frame about %s, "
                           "likely below %s",
                           name ? name : best->run->method,
                           request->by_pixel ? "by pixel" : "on 8x8 pixels", error, error_likely,
                           ms, ms_likely);
    free(name);
    for (uint32_t i = 0; i < best->num_nearest && i < 3 && used < sizeof near; i++) {
        used += (size_t)snprintf(near + used, sizeof near - used, "%s%s (%.1f)", i ? ", " : "",
                                 best->nearest[i]->name, best->distance[i]);
    }
    if (best->other) {
        time_text(ms, best->other_ms);
        percent_text(error, best->other_error);
        name = name_of(best->other, best->other_spp);
        const char *why = best->other_limit;
        snprintf(traded, sizeof traded, "; instead of %s: %s%s%s%s, %s", name ? name : "", error,
                 why ? " (" : "", why ? why : "", why ? ")" : "", ms);
        free(name);
    }
    lines[1] = text_format("measured scenes nearest in regime (distance): %s%s", near, traded);
    return lines[0] && lines[1];
}

static char *warning_of(const choose_request *request, const choice *best)
{
    const char *with = request->method ? request->method : "any method";
    char likely[32], asked[32];
    if (!best->budget_met) {
        time_text(likely, best->ms * best->ms_margin);
        time_text(asked, request->budget_ms);
        return text_format(
            "--budget-ms: no run measured with %s is likely to take %s here; this is "
            "the fastest, likely below %s",
            with, asked, likely);
    }
    percent_text(likely, best->error * best->error_margin);
    percent_text(asked, request->max_error);
    return text_format("--max-error: %s is not likely here with %s%s; this is the nearest, likely "
                       "below %s",
                       asked, with, isnan(request->budget_ms) ? "" : " within the budget", likely);
}

static cJSON *json_of(const choose_request *request, const choice *best, char *const lines[2])
{
    cJSON *root = cJSON_CreateObject(), *asked = cJSON_AddObjectToObject(root, "asked");
    json_add_float(asked, "max_error", request->max_error);
    json_add_float(asked, "budget_ms", request->budget_ms);
    cJSON_AddNumberToObject(asked, "block", request->by_pixel ? 1 : 8);
    cJSON_AddStringToObject(root, "method", best->run->method);
    cJSON_AddItemToObject(root, "settings", cJSON_Duplicate(best->run->settings, true));
    if (best->spp) {
        cJSON_AddNumberToObject(root, "spp", best->spp);
    }
    cJSON *predicted = cJSON_AddObjectToObject(root, "predicted");
    json_add_float(predicted, "error", best->error);
    json_add_float(predicted, "error_likely", best->error * best->error_margin);
    json_add_float(predicted, "ms", best->ms);
    json_add_float(predicted, "ms_likely", best->ms * best->ms_margin);
    cJSON_AddBoolToObject(root, "error_met", best->error_met);
    cJSON_AddBoolToObject(root, "budget_met", best->budget_met);
    cJSON *nearest = cJSON_AddArrayToObject(root, "nearest");
    for (uint32_t i = 0; i < best->num_nearest; i++) {
        cJSON *scene = cJSON_CreateObject();
        cJSON_AddStringToObject(scene, "name", best->nearest[i]->name);
        json_add_float(scene, "distance", best->distance[i]);
        cJSON_AddItemToArray(nearest, scene);
    }
    cJSON *why = cJSON_AddArrayToObject(root, "why");
    for (int i = 0; i < 2; i++) {
        cJSON_AddItemToArray(why, cJSON_CreateString(lines[i]));
    }
    return root;
}

// Fills `out` and says it. Gives the exit code.
static int take_choice(app *a, const choose_request *request, const choice *best,
                       const method_options *how, chosen *out)
{
    char *lines[2] = {NULL, NULL};
    const bool met = best->error_met && best->budget_met;
    bool whole = set_method(best, how, out) && lines_of(request, best, lines);
    if (whole) {
        out->json = json_of(request, best, lines);
        app_note(a, "%s", lines[0]);
        app_note(a, "%s", lines[1]);
    }
    if (whole && !met) {
        out->warning = warning_of(request, best);
        whole = out->warning != NULL;
        app_warn(a, "%s", whole ? out->warning : "");
    }
    free(lines[0]);
    free(lines[1]);
    return whole ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
}

// ---- choosing ---------------------------------------------------------------------------------

static double ratio_of(double here, double measured)
{
    return here > 0 && measured > 0 ? here / measured : 1;
}

// How much longer than the device of the measurements this one takes, by kind of kernel.
static int slowness_of(app *a, const fronts_device *measured, const machine *mach, paces *slowness)
{
    *slowness = (paces){1, 1, 1};
    const paces *there = &measured->paces;
    if (!(there->solve_ms > 0)) {
        if (strcmp(tyn_device_name(mach->device), measured->name) != 0) {
            app_warn(a, "times are those of %s: its paces were not measured",
                     measured->name[0] ? measured->name : "another device");
        }
        return EXIT_DONE;
    }
    paces here;
    const int code = paces_known(a, mach->device, &here);
    *slowness =
        (paces){ratio_of(here.solve_ms, there->solve_ms), ratio_of(here.pixel_ns, there->pixel_ns),
                ratio_of(here.sample_ns, there->sample_ns)};
    return code;
}

// Longer than that no frame begins that nobody has said a time for; less long one that is not even likely to be
// within the error.
static const double longest_ms = 600e3, longest_in_vain_ms = 60e3;

// False: said.
static bool is_short(app *a, const choose_request *request, const choice *best)
{
    char ms[32], most[32], error[32];
    const double allowed = best->error_met ? longest_ms : longest_in_vain_ms;
    if (!isnan(request->budget_ms) || best->ms <= allowed) {
        return true;
    }
    time_text(ms, best->ms);
    time_text(most, allowed);
    percent_text(error, request->max_error);
    char *name = name_of(best->run, best->spp);
    app_error(
        a,
        "--max-error: %s %s %s here, a frame of about %s; none of more than %s begins unasked: "
        "say with --budget-ms how long it may take",
        error, best->error_met ? "takes" : "is not likely even with",
        name ? name : best->run->method, ms, most);
    free(name);
    return false;
}

int choice_make(app *a, const choice_options *options, const method_options *how,
                const machine *mach, const tyn_scene *scene, const tyn_view *view, chosen *out)
{
    *out = (chosen){0};
    fronts f = {0};
    regime r;
    tyn_camera camera = view->camera;
    camera.aspect = view->whole[0] ? (float)view->whole[0] / (float)view->whole[1]
                                   : (float)view->width / (float)view->height;
    int code = fronts_open(a, options->fronts, &f);
    char *without = NULL;
    if (code == EXIT_DONE) {
        without = regime_of(scene, &camera, &r) ? left_out(&f, &r) : NULL;
        code = without ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    paces slowness = {1, 1, 1};
    if (code == EXIT_DONE) {
        code = slowness_of(a, &f.device, mach, &slowness);
    }
    if (code == EXIT_DONE) {
        bool percent;
        const choose_request request = {
            .max_error = options->max_error ? text_fraction(options->max_error, &percent) : NAN,
            .budget_ms = options->budget_ms,
            .no_background = view->no_background,
            .by_pixel = options->blocks && strcmp(options->blocks, "1") == 0,
            .method = how->method,
            .without = without,
            .width = view->width,
            .height = view->height,
            .slowness = slowness,
        };
        choice best;
        if (choose(&f, &r, &request, &best)) {
            code = is_short(a, &request, &best) ? take_choice(a, &request, &best, how, out)
                                                : EXIT_WRONG;
        } else {
            app_error(a,
                      "--max-error, --budget-ms: no run of %s that can do this scene is among the "
                      "measurements",
                      how->method ? how->method : "a method");
            code = EXIT_WRONG;
        }
    }
    free(without);
    fronts_finish(&f);
    return code;
}

void chosen_finish(chosen *c)
{
    for (uint32_t i = 0; i < c->num_texts; i++) {
        free(c->texts[i]);
    }
    cJSON_Delete(c->json);
    free(c->warning);
    *c = (chosen){0};
}
