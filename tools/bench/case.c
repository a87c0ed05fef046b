// case.c -- a scene of a suite, opened with its reference, and the keys of what is measured on it.
#include "measure.h"
#include "record.h"
#include "stats.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// ---- keys -------------------------------------------------------------------------------------

static uint64_t hash_text(const char *text, uint64_t seed)
{
    return text ? text_hash(text, strlen(text), seed) : seed;
}

int bench_key(bench_case *c, const bench_run *run, char key[17])
{
    method m = {0};
    int code = method_open(c->a, &run->method, &m);
    if (code != EXIT_DONE) {
        method_finish(&m);
        return code;
    }
    tyn_view view = c->view;
    method_view(&run->method, &view);
    cJSON *settings = stats_settings(&m, &view);
    char *text = cJSON_PrintUnformatted(settings);
    uint64_t hash = hash_text(text, c->hash);
    free(text);
    cJSON_Delete(settings);
    hash = hash_text(m.info.name, hash);
    hash = hash_text(run->name, hash);
    hash = hash_text(run->group, hash);
    hash = hash_text(c->spec->name, hash);
    hash = hash_text(c->reference.key, hash);
    hash = hash_text(tyn_version_string(), hash);
    hash = hash_text(c->machine->name, hash);
    hash = hash_text(c->machine->driver, hash);
    hash = text_hash(&c->machine->library, sizeof c->machine->library, hash);
    const uint32_t numbers[] = {c->suite->frames, c->suite->block, BENCH_RECORD_VERSION};
    hash = text_hash(numbers, sizeof numbers, hash);
    hash = text_hash(&c->suite->timing_seconds, sizeof c->suite->timing_seconds, hash);
    if (c->suite->warm_seconds > 0) {
        hash = text_hash(&c->suite->warm_seconds, sizeof c->suite->warm_seconds, hash);
    }
    // Without those of the device nodes have no ceilings.
    hash = c->suite->ceilings ? hash : hash_text("no ceilings", hash);
    snprintf(key, 17, "%016llx", (unsigned long long)hash);
    method_finish(&m);
    return EXIT_DONE;
}

// ---- a scene ----------------------------------------------------------------------------------

static int write_reference(const bench_case *c)
{
    char *all = text_format("%s/pictures", c->folder);
    char *below = text_format("%s/pictures/%s", c->folder, c->spec->slug);
    char *name = bench_picture(c->spec, BENCH_REFERENCE_SLUG);
    char *path = name ? text_format("%s/%s", c->folder, name) : NULL;
    int code = EXIT_FAILED;
    if (all && below && path) {
        mkdir(all, 0777);
        mkdir(below, 0777);
        code = bench_picture_write(c->a, &c->reference.image, true, path);
    }
    free(all);
    free(below);
    free(name);
    free(path);
    return code;
}

// The scene and its view.
static int open_scene(app *a, const bench_suite *suite, const bench_scene *spec, bench_case *c)
{
    *c = (bench_case){.a = a,
                      .suite = suite,
                      .spec = spec,
                      .blocks = {suite->block, 1, 0},
                      .view = {.outputs = TYN_OUTPUT_RADIANCE, .no_background = true}};
    int code = scene_open(a, &spec->scene, &c->scene);
    if (code == EXIT_DONE && spec->lights > 0 && spec->lights < c->scene.num_lights) {
        c->scene.num_lights = spec->lights;
    }
    return code == EXIT_DONE ? view_setup(a, &spec->view, &c->scene, &c->view) : code;
}

int bench_case_check(app *a, const bench_suite *suite, const bench_scene *spec)
{
    bench_case c;
    const bool quiet = a->quiet;
    a->quiet = true; // what is not wrong is said when it is measured
    int code = open_scene(a, suite, spec, &c);
    if (code == EXIT_DONE && spec->reference) {
        code = bench_reference_get(a, NULL, suite, spec, &c.scene, &c.view, false, &c.reference);
    }
    a->quiet = quiet;
    bench_case_close(&c);
    return code;
}

int bench_case_open(app *a, const bench_machine *on, const bench_suite *suite,
                    const bench_scene *spec, const char *folder, bool make, bench_case *c)
{
    int code = open_scene(a, suite, spec, c);
    c->machine = on;
    c->folder = folder;
    if (code == EXIT_DONE) { // for the reference
        code = scene_prepare(a, &(tyn_method_info){.traces_rays = true}, &c->scene);
    }
    if (code == EXIT_DONE) {
        c->hash = bench_scene_hash(&c->scene, &c->view);
        code = bench_reference_get(a, on, suite, spec, &c->scene, &c->view, make, &c->reference);
    }
    return code == EXIT_DONE && folder ? write_reference(c) : code;
}

void bench_case_close(bench_case *c)
{
    bench_reference_finish(&c->reference);
    tyn_scene_finish(&c->scene);
}
