// cmd_info.c -- `tyndall info`: what is in a file, what this machine has, what the passes take.
#include "app.h"
#include "devices.h"
#include "info_scene.h"
#include "machine.h"
#include "scene_setup.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include <tyndall/registry.h>

typedef struct info_args {
    scene_options scene;
    view_options view;
    opt_list plugins;
    bool devices, passes, methods, json, quiet;
} info_args;

// ---- the machine ------------------------------------------------------------------------------

// What the device has first, then what it lacks.
static void print_needs(const tyn_device_info *info)
{
    uint32_t count;
    const tyn_need *needs = tyn_needs(&count);
    for (int has = 1; has >= 0; has--) {
        for (uint32_t i = 0; i < count; i++) {
            const tyn_need *n = &needs[i];
            if ((int)(info->met >> i & 1) != has) {
                continue;
            }
            char least[16] = "";
            if (n->least) {
                snprintf(least, sizeof least, " >= %u", n->least);
            }
            printf("   %s %s %s%s: %s%s%s\n", has ? "has  " : "lacks", n->kind, n->name, least,
                   n->use,
                   has           ? ""
                   : n->fallback ? "; instead: "
                                 : "; required",
                   has || !n->fallback ? "" : n->fallback);
        }
    }
}

static int print_devices(app *a)
{
    devices d;
    int code = devices_list(a, &d);
    for (int i = 0; i < d.count; i++) {
        char *text = devices_describe(&d.infos[i]);
        printf("%d  %s\n   %s\n", i, d.infos[i].name, text ? text : "");
        free(text);
        print_needs(&d.infos[i]);
    }
    devices_finish(&d);
    return code;
}

// ---- passes and methods -----------------------------------------------------------------------

static void print_range(const tyn_param *p)
{
    switch (p->type) {
    case TYN_PARAM_BOOL:
        printf("0 or 1, default %g", p->def);
        break;
    case TYN_PARAM_ENUM:
        for (int i = 0; i <= (int)p->max; i++) {
            printf("%s%s", i ? "|" : "", p->names[i]);
        }
        printf(", default %s", p->names[(int)p->def]);
        break;
    case TYN_PARAM_INT:
    case TYN_PARAM_FLOAT:
        if (p->least > 0) {
            printf("%.7g or %.7g to %.7g%s%s, default %.7g", p->min, p->least, p->max,
                   p->unit[0] ? " " : "", p->unit, p->def);
            break;
        }
        printf("%.7g to %.7g%s%s, default %.7g", p->min, p->max, p->unit[0] ? " " : "", p->unit,
               p->def);
        break;
    }
}

static void print_ports(const tyn_pass_desc *pass, tyn_port_dir dir, const char *title)
{
    const char *separator = title;
    for (uint32_t i = 0; i < pass->num_ports; i++) {
        if (pass->ports[i].dir == dir) {
            printf("%s%s%s", separator, pass->ports[i].name, pass->ports[i].optional ? "?" : "");
            separator = ", ";
        }
    }
    if (separator != title) {
        printf("\n");
    }
}

static void print_passes(void)
{
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        printf("%s%s\n    %s\n", i ? "\n" : "", pass->name, pass->summary);
        print_ports(pass, TYN_IN, "    reads    ");
        print_ports(pass, TYN_INOUT, "    changes  ");
        print_ports(pass, TYN_OUT, "    makes    ");
        for (uint32_t k = 0; k < pass->num_params; k++) {
            const tyn_param *p = &pass->params[k];
            printf("    -D %s.%s=  ", pass->name, p->name);
            print_range(p);
            printf("\n        %s\n", p->doc);
        }
        const char *separator = "    counts   ";
        for (const tyn_counter *c = pass->counters; c && c->name; c++) {
            printf("%s%s%s%s%s", separator, c->name, c->unit ? " (" : "", c->unit ? c->unit : "",
                   c->unit ? ")" : "");
            separator = ", ";
        }
        printf("%s", pass->counters ? "\n" : "");
        if (pass->debug_meaning && pass->debug_port < pass->num_ports) {
            printf("    debug view: %s, %s\n", pass->ports[pass->debug_port].name,
                   pass->debug_meaning);
        }
    }
}

static void print_outputs(uint32_t outputs)
{
    for (uint32_t left = outputs; left; left &= left - 1) {
        printf(" %s", tyn_output_name((tyn_output)(left & -left)));
    }
}

static void print_methods(void)
{
    for (uint32_t i = 0; i < tyn_num_methods(); i++) {
        tyn_method_info m;
        tyn_method_at(i, &m);
        printf("%-10s %s%s%s%s\n%-10s passes:", m.name, m.summary, m.plugin ? " (plugin " : "",
               m.plugin ? m.plugin : "", m.plugin ? ")" : "", "");
        for (const tyn_pass_desc *const *pass = m.passes; *pass; pass++) {
            printf(" %s", (*pass)->name);
        }
        printf("\n%-10s outputs:", "");
        print_outputs(m.outputs);
        printf("\n%-10s limits:", "");
        const char *last = "", *separator = "";
        for (const tyn_limit *row = m.limits; row->key; row++) {
            if (strcmp(row->key, last) != 0) {
                printf("%s %s", separator, row->key);
                separator = ",";
            }
            last = row->key;
        }
        printf("\n");
    }
    if (tyn_methods_left_out()[0]) {
        printf("not in this build: %s\n", tyn_methods_left_out());
    }
}

// ---- a scene ----------------------------------------------------------------------------------

// What is in its files, also where no scene can be made of them.
static int print_grids(const info_args *args, const info_grids *grids, app *a)
{
    if (!grids) {
        return EXIT_DONE;
    }
    if (!args->json) {
        info_grids_print(grids);
        return EXIT_DONE;
    }
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "scene", args->scene.scene);
    info_grids_json(grids, json);
    return json_write(a, json, NULL);
}

static int print_scene(app *a, const info_args *args)
{
    tyn_scene scene;
    regime r = {0};
    const uint32_t frame = isnan(args->scene.frame) ? 0 : (uint32_t)args->scene.frame;
    info_grids *grids =
        info_grids_read(args->scene.scene, isnan(args->scene.frame) ? NULL : &frame);
    int code = scene_open(a, &args->scene, &scene);
    if (code != EXIT_DONE) {
        if (info_grids_wanted(args->scene.scene, grids)) {
            print_grids(args, grids, a);
        }
        info_grids_free(grids);
        return code;
    }
    if (grids && info_grids_failed(grids)) { // of the scene's own grids none is
        app_warn(a,
                 "a volume file has a damaged grid beside those that are read: it is not listed");
    }
    tyn_view view = {0};
    if (code == EXIT_DONE) {
        code = view_setup(a, &args->view, &scene, &view);
    }
    if (code == EXIT_DONE) {
        view.camera.aspect = (float)view.width / (float)view.height;
        code = regime_of(&scene, &view.camera, &r) ? EXIT_DONE
                                                   : app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    fronts f = {0};
    if (code == EXIT_DONE) {
        code = fronts_open(a, NULL, &f);
    }
    if (code == EXIT_DONE && args->json) {
        cJSON *json = info_json_scene(args->scene.scene, &scene, &r);
        if (grids) {
            info_grids_json(grids, json);
        }
        cJSON_AddItemToObject(json, "outlook", info_json_outlook(&f, &r, view.width, view.height));
        code = json_write(a, json, NULL);
    } else if (code == EXIT_DONE) {
        print_grids(args, grids, a);
        info_print_scene(&scene);
        info_print_regime(&r);
        info_print_outlook(&f, &r, view.width, view.height);
    }
    fronts_finish(&f);
    info_grids_free(grids);
    tyn_scene_finish(&scene);
    return code;
}

static int run_info(app *a, const void *arguments)
{
    const info_args *args = arguments;
    a->quiet = args->quiet;
    int asked = args->devices + args->passes + args->methods + (args->scene.scene != NULL);
    if (asked != 1) {
        app_error(a, "one of SCENE, --devices, --passes, --methods; %d were given", asked);
        return EXIT_WRONG;
    }
    if (args->devices) {
        return print_devices(a);
    }
    if (args->passes) {
        print_passes();
    } else if (args->methods) {
        print_methods();
    } else {
        return print_scene(a, args);
    }
    return EXIT_DONE;
}

#define AT(field) offsetof(info_args, field)
static const opt_positional positionals[] = {
    {"SCENE", "a scene or a volume: .gltf, .glb" TYN_VOLUME_ENDINGS, false, AT(scene.scene)},
    {"ENVIRONMENT", "a latitude-longitude map (.exr, .hdr), as --env", false,
     AT(scene.environment)},
};
static const option info_table[] = {
    {0, "devices", OPT_FLAG, AT(devices), NULL, "the Vulkan devices of this machine"},
    {0, "passes", OPT_FLAG, AT(passes), NULL, "every pass with its parameters"},
    {0, "methods", OPT_FLAG, AT(methods), NULL, "every method with its passes"},
    {0, "json", OPT_FLAG, AT(json), NULL, "of SCENE: print JSON"},
    PLUGIN_OPTION(AT(plugins)),
    {'q', "quiet", OPT_FLAG, AT(quiet), NULL, "no warnings"},
};
static const opt_group groups[] = {
    {"what", info_table, ARRAY_SIZE(info_table), 0},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"view", view_table, VIEW_TABLE_SIZE, AT(view)},
};

const command cmd_info = {
    .name = "info",
    .summary = "What is in a file and which methods suit it; what this machine has; every pass.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(info_args),
    .run = run_info,
};
