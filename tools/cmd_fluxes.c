// cmd_fluxes.c -- `tyndall fluxes`: reflectance, transmittance and absorptance under suns and surroundings.
#include "session.h"
#include "stats.h"
#include <stdio.h>

typedef struct fluxes_args {
    scene_options scene;
    method_options method;
    machine_options machine;
    bool json;
} fluxes_args;

static const char *const faces[] = {"-x", "+x", "-y", "+y", "-z", "+z"};

// What is printed: parts of the incident power, but for that itself.
typedef struct row {
    const char *name;
    const float *mean, *se;
} row;

static double part(const row *r, const tyn_flux_values *all, int c, bool error)
{
    const double incident = all->incident[c];
    return incident > 0 ? (double)(error ? r->se[c] : r->mean[c]) / incident : 0;
}

static cJSON *json_parts(const row *r, const tyn_flux_values *all, bool error)
{
    const double v[3] = {part(r, all, 0, error), part(r, all, 1, error), part(r, all, 2, error)};
    return cJSON_CreateDoubleArray(v, 3);
}

static void json_row(cJSON *object, const row *r, const tyn_flux_values *all)
{
    char name[64];
    snprintf(name, sizeof name, "%s_se", r->name);
    cJSON_AddItemToObject(object, r->name, json_parts(r, all, false));
    cJSON_AddItemToObject(object, name, json_parts(r, all, true));
}

static void print_row(const row *r, const char *before, const tyn_flux_values *all)
{
    printf("%s%-*s", before, 18 - (int)(before[0] ? 8 : 0), r->name);
    for (int c = 0; c < 3; c++) {
        printf(" %9.6f +- %-8.2g", part(r, all, c, false), part(r, all, c, true));
    }
    printf("\n");
}

static int print_fluxes(app *a, const tyn_fluxes *f, bool json)
{
    const tyn_flux_values *m = &f->mean, *se = &f->se;
    const row rows[] = {
        {"reflected", m->reflected, se->reflected},
        {"transmitted", m->transmitted, se->transmitted},
        {"direct", m->direct, se->direct},
        {"absorbed_media", m->absorbed_media, se->absorbed_media},
        {"absorbed_surfaces", m->absorbed_surfaces, se->absorbed_surfaces},
        {"arriving_surfaces", m->arriving_surfaces, se->arriving_surfaces},
        {"missing", m->missing, se->missing},
    };
    cJSON *object = json ? cJSON_CreateObject() : NULL;
    cJSON *leaving = json ? cJSON_AddObjectToObject(object, "leaving") : NULL;
    if (json) {
        const double watts[3] = {m->incident[0], m->incident[1], m->incident[2]};
        const double errors[3] = {se->incident[0], se->incident[1], se->incident[2]};
        cJSON_AddItemToObject(object, "incident", cJSON_CreateDoubleArray(watts, 3));
        cJSON_AddItemToObject(object, "incident_se", cJSON_CreateDoubleArray(errors, 3));
    } else {
        printf("%-18s %14.7g         %14.7g         %14.7g W\n", "incident", (double)m->incident[0],
               (double)m->incident[1], (double)m->incident[2]);
    }
    for (size_t i = 0; i < ARRAY_SIZE(rows); i++) {
        json ? json_row(object, &rows[i], m) : print_row(&rows[i], "", m);
    }
    for (size_t i = 0; i < ARRAY_SIZE(faces); i++) {
        const row r = {faces[i], m->leaving[i], se->leaving[i]};
        json ? json_row(leaving, &r, m) : print_row(&r, "leaving ", m);
    }
    return json ? json_write(a, object, NULL) : EXIT_DONE;
}

static int fluxes_of_scene(app *a, const fluxes_args *args, session *s)
{
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_FLUXES};
    tyn_camera_frame_scene(&view.camera, &s->scene);
    method_view(&args->method, &view);
    int code = session_start(a, &args->machine, s);
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &s->renderer, &s->scene, &view, false, "fluxes");
    }
    if (code != EXIT_DONE) {
        return code;
    }
    const tyn_fluxes *fluxes = tyn_offline_output(s->renderer.offline, TYN_OUTPUT_FLUXES);
    if (!fluxes) {
        app_error(a, "the method gave no fluxes");
        return EXIT_FAILED;
    }
    return print_fluxes(a, fluxes, args->json);
}

static int run_fluxes(app *a, const void *arguments)
{
    fluxes_args args = *(const fluxes_args *)arguments;
    a->quiet = args.machine.quiet;
    args.method.method = args.method.method ? args.method.method : tyn_method_reference();
    session s;
    int code = session_open(a, &args.scene, &args.method, TYN_OUTPUT_FLUXES, &s);
    if (code == EXIT_DONE) {
        code = fluxes_of_scene(a, &args, &s);
    }
    session_close(&s);
    return code;
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(fluxes_args, scene)};

#define AT(field) offsetof(fluxes_args, field)
static const option fluxes_table[] = {
    {0, "json", OPT_FLAG, AT(json), NULL, "print JSON"},
};
// Without --method, which has another default elsewhere.
static const opt_group groups[] = {
    {"fluxes", fluxes_table, ARRAY_SIZE(fluxes_table), 0},
    {"method", method_table + 1, METHOD_TABLE_SIZE - 1, AT(method)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_fluxes = {
    .name = "fluxes",
    .summary = "Reflectance, transmittance and absorptance: where incident light goes.",
    .details =
        "Paths from the suns and the environment, uniformly over the lit faces of the media's box\n"
        "(of one period, where it repeats), followed until they leave; a sample (--spp) is 4096\n"
        "of them. incident is in W, the rest parts of it with standard errors, for R, G and B:\n"
        "reflected leaves through faces that its light shone on, transmitted through others\n"
        "(direct: met nothing), both also by face; arriving_surfaces counts light each time it\n"
        "meets a surface; missing = 1 - reflected - transmitted - absorbed (docs/fluxes.md).",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(fluxes_args),
    .run = run_fluxes,
};
