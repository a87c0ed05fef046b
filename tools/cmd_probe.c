// cmd_probe.c -- `tyndall probe`: the light field at points.
#include "output.h"
#include "points.h"
#include "session.h"
#include <stdio.h>
#include <stdlib.h>
#include <tyndall/io.h>

typedef struct probe_args {
    scene_options scene;
    method_options method;
    machine_options machine;
    const char *points, *output;
    bool scattered;
} probe_args;

static const char header[] = "x,y,z,fluence_r,fluence_g,fluence_b,"
                             "flux_x_r,flux_x_g,flux_x_b,flux_y_r,flux_y_g,flux_y_b,"
                             "flux_z_r,flux_z_g,flux_z_b";
static const char header_errors[] = ",fluence_se_r,fluence_se_g,fluence_se_b,"
                                    "flux_x_se_r,flux_x_se_g,flux_x_se_b,"
                                    "flux_y_se_r,flux_y_se_g,flux_y_se_b,"
                                    "flux_z_se_r,flux_z_se_g,flux_z_se_b";

static void print_values(FILE *to, const char *before, const float *values, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(to, "%s%.9g", i ? "," : before, values[i]);
    }
}

static void print_table(FILE *to, const points *p, const tyn_probe_result *results, bool errors)
{
    fprintf(to, "%s%s\n", header, errors ? header_errors : "");
    for (uint32_t i = 0; i < p->count; i++) {
        print_values(to, "", p->xyz[i], 3);
        print_values(to, ",", results[i].fluence, 3);
        print_values(to, ",", results[i].flux, 9);
        if (errors) {
            print_values(to, ",", results[i].fluence_se, 3);
            print_values(to, ",", results[i].flux_se, 9);
        }
        fprintf(to, "\n");
    }
}

static int write_table(app *a, const char *path, const points *p, const tyn_probe_result *results,
                       bool errors)
{
    if (!path) {
        print_table(stdout, p, results, errors);
        return EXIT_DONE;
    }
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    if (!memory) {
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    print_table(memory, p, results, errors);
    fclose(memory);
    int code = app_exit_code(a, tyn_file_write(path, text, size, &a->log), false);
    free(text);
    return code;
}

static int probe_scene(app *a, const probe_args *args, const points *p, session *s)
{
    tyn_view view = {.width = 1,
                     .height = 1,
                     .outputs = TYN_OUTPUT_PROBE,
                     .points = (const float(*)[3])p->xyz,
                     .num_points = p->count,
                     .scattered_only = args->scattered};
    tyn_camera_frame_scene(&view.camera, &s->scene);
    method_view(&args->method, &view);
    int code = session_start(a, &args->machine, s);
    if (code == EXIT_DONE) {
        code = renderer_frame(a, &s->renderer, &s->scene, &view, false, "probe");
    }
    if (code != EXIT_DONE) {
        return code;
    }
    const tyn_probe_result *results = tyn_offline_output(s->renderer.offline, TYN_OUTPUT_PROBE);
    if (!results) {
        app_error(a, "the method gave no light field");
        return EXIT_FAILED;
    }
    return write_table(a, args->output, p, results, s->method.info.outputs & TYN_OUTPUT_ERROR);
}

static int run_probe(app *a, const void *arguments)
{
    const probe_args *args = arguments;
    a->quiet = args->machine.quiet;
    if (!args->points) {
        app_error(a, "--points is missing: the file with x,y,z a line");
        return EXIT_WRONG;
    }
    points p;
    session s;
    int code = session_open(a, &args->scene, &args->method, TYN_OUTPUT_PROBE, &s);
    if (code == EXIT_DONE) {
        code = points_read(a, args->points, &p);
        if (code == EXIT_DONE && args->output && !output_folder_is_writable(a, args->output)) {
            code = EXIT_FAILED;
        }
        if (code == EXIT_DONE) {
            code = probe_scene(a, args, &p, &s);
        }
        points_finish(&p);
    }
    session_close(&s);
    return code;
}

static const opt_positional positionals[] = {SCENE_POSITIONALS(probe_args, scene)};

#define AT(field) offsetof(probe_args, field)
static const option probe_table[] = {
    {0, "points", OPT_TEXT, AT(points), "FILE.csv",
     "required: x,y,z a line in world metres, optional header", .file = OPT_READS},
    {0, "scattered", OPT_FLAG, AT(scattered), NULL, "without the uncollided light"},
    {'o', "output", OPT_TEXT, AT(output), "FILE.csv", "else to stdout", .file = OPT_WRITES},
};
static const opt_group groups[] = {
    {"probe", probe_table, ARRAY_SIZE(probe_table), 0},
    {"method", method_table, METHOD_TABLE_SIZE, AT(method)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_probe = {
    .name = "probe",
    .summary = "The light field at points: fluence and net flux.",
    .details = "Columns, in the order of the points: x,y,z; fluence (integral of radiance over the "
               "sphere,\n"
               "W/m^2) in R, G, B; net flux along +x, +y, +z, signed, W/m^2, in R, G, B each. "
               "Methods that\n"
               "sample append one standard error for each value (fluence_se_r, ... flux_z_se_b).",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(probe_args),
    .run = run_probe,
};
