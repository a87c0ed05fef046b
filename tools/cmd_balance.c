// cmd_balance.c -- `tyndall balance`: where the energy goes.
#include "session.h"
#include "stats.h"
#include <stdio.h>

typedef struct balance_args {
    scene_options scene;
    method_options method;
    machine_options machine;
    bool json;
} balance_args;

// What a method makes agree with what lights send: least and most factor, 0 where it makes nothing agree.
typedef struct scale_row {
    const char *name;
    const double *range;
} scale_row;

static void print_json(cJSON *object, const char *const names[3], double shares[3][3],
                       const scale_row *scales, size_t num_scales)
{
    cJSON *of_shares = cJSON_AddObjectToObject(object, "shares");
    for (int i = 0; i < 3; i++) {
        cJSON_AddItemToObject(of_shares, names[i], cJSON_CreateDoubleArray(shares[i], 3));
    }
    cJSON *of_scales = cJSON_AddObjectToObject(object, "scales");
    for (size_t i = 0; i < num_scales; i++) {
        cJSON_AddItemToObject(of_scales, scales[i].name,
                              scales[i].range[1] > 0 ? cJSON_CreateDoubleArray(scales[i].range, 2)
                                                     : cJSON_CreateNull());
    }
}

static void print_text(const char *const names[3], double shares[3][3], const scale_row *scales,
                       size_t num_scales)
{
    printf("of what enters and is emitted:\n");
    for (int i = 0; i < 3; i++) {
        printf("%-18s %14.2f %14.2f %14.2f %%\n", names[i], 100 * shares[i][0], 100 * shares[i][1],
               100 * shares[i][2]);
    }
    bool any = false;
    for (size_t i = 0; i < num_scales; i++) {
        if (scales[i].range[1] > 0) {
            printf("%s", any ? "" : "factors that make cells and walls get what lights send:\n");
            printf("%-18s %14.6f to %11.6f\n", scales[i].name, scales[i].range[0],
                   scales[i].range[1]);
            any = true;
        }
    }
}

static int print_balance(app *a, const tyn_balance *balance, bool json)
{
    const struct {
        const char *name;
        const double *values;
    } rows[] = {
        {"entering", balance->entering},
        {"emitted", balance->emitted},
        {"absorbed_media", balance->absorbed_media},
        {"absorbed_surfaces", balance->absorbed_surfaces},
        {"escaped", balance->escaped},
        {"imbalance", balance->imbalance},
        {"imbalance_se", balance->imbalance_se},
    };
    const scale_row scales[] = {
        {"suns", balance->scale_suns},
        {"lamps", balance->scale_lamps},
        {"vpls", balance->scale_vpls},
    };
    enum { FIRST_END = 2 }; // of the rows that say where light ends, three
    const char *names[3];
    double shares[3][3];
    for (int i = 0; i < 3; i++) {
        names[i] = rows[FIRST_END + i].name;
        for (int c = 0; c < 3; c++) {
            const double given = balance->entering[c] + balance->emitted[c];
            shares[i][c] = given > 0 ? rows[FIRST_END + i].values[c] / given : 0;
        }
    }
    cJSON *object = json ? cJSON_CreateObject() : NULL;
    for (size_t i = 0; i < ARRAY_SIZE(rows); i++) {
        const double *v = rows[i].values;
        if (json) {
            cJSON_AddItemToObject(object, rows[i].name, cJSON_CreateDoubleArray(v, 3));
        } else {
            printf("%-18s %14.7g %14.7g %14.7g%s\n", rows[i].name, v[0], v[1], v[2],
                   i < 5 ? " W" : "");
        }
    }
    if (json) {
        print_json(object, names, shares, scales, ARRAY_SIZE(scales));
        return json_write(a, object, NULL);
    }
    print_text(names, shares, scales, ARRAY_SIZE(scales));
    return EXIT_DONE;
}

static int balance_scene(app *a, const balance_args *args, session *s)
{
    tyn_view view = {.width = 1, .height = 1, .outputs = TYN_OUTPUT_BALANCE};
    tyn_camera_frame_scene(&view.camera, &s->scene);
    method_view(&args->method, &view);
    int code = session_start(a, &args->machine, s);
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &s->renderer, &s->scene, &view, false, "balance");
    }
    if (code != EXIT_DONE) {
        return code;
    }
    const tyn_balance *balance = tyn_offline_output(s->renderer.offline, TYN_OUTPUT_BALANCE);
    if (!balance) {
        app_error(a, "the method gave no balance");
        return EXIT_FAILED;
    }
    return print_balance(a, balance, args->json);
}

static int run_balance(app *a, const void *arguments)
{
    const balance_args *args = arguments;
    a->quiet = args->machine.quiet;
    session s;
    int code = session_open(a, &args->scene, &args->method, TYN_OUTPUT_BALANCE, &s);
    if (code == EXIT_DONE) {
        code = balance_scene(a, args, &s);
    }
    session_close(&s);
    return code;
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(balance_args, scene)};

#define AT(field) offsetof(balance_args, field)
static const option balance_table[] = {
    {0, "json", OPT_FLAG, AT(json), NULL, "print JSON"},
};
static const opt_group groups[] = {
    {"balance", balance_table, ARRAY_SIZE(balance_table), 0},
    {"method", method_table, METHOD_TABLE_SIZE, AT(method)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_balance = {
    .name = "balance",
    .summary = "Where the energy goes, in W, for R, G and B.",
    .details =
        "entering: through the surface of the media's shapes together; emitted: by media and by\n"
        "lamps inside; imbalance = 1 - (absorbed + escaped) / (entering + emitted). With\n"
        "--method path a sample (--spp) is some ten thousand paths, and imbalance_se is the\n"
        "standard error of the imbalance. Where there are surfaces the boundary is a box around\n"
        "media, surfaces and lamps. `pop` scales what its cells get of each light to what it\n"
        "sends: the last lines are these factors, least and most (docs/balance.md).",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(balance_args),
    .run = run_balance,
};
