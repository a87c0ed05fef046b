// paces.c -- how fast the device at hand runs the library's own kernels, by kind.
#include "paces.h"
#include "method_setup.h"
#include "renderer.h"
#include "stats.h"
#include <math.h>
#include <stdlib.h>

enum { VOXELS = 48, RUNS = 5, SMALL = 128, LARGEST = 2048, MOST_SAMPLES = 16384 };

// ---- the scene --------------------------------------------------------------------------------

// Lumps in a ball: edges, gaps and depth as clouds and smoke have them.
static float density_at(const float p[3])
{
    const float lumps = sinf(9 * p[0]) * sinf(8 * p[1] + 1) * sinf(7 * p[2] + 2);
    const float inside = 1 - 4 * (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return fmaxf(0, fminf(1, 2 * inside + 1.5f * lumps));
}

// False: out of memory.
static bool make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->volumes = calloc(1, sizeof *scene->volumes);
    float *data = calloc((size_t)VOXELS * VOXELS * VOXELS, sizeof *data);
    if (!scene->volumes || !data) {
        free(data);
        return false;
    }
    scene->num_volumes = 1;
    scene->volumes[0] =
        (tyn_volume){.size = {VOXELS, VOXELS, VOXELS}, .data = data, .max_density = 1, .hash = 1};
    for (size_t i = 0; i < (size_t)VOXELS * VOXELS * VOXELS; i++) {
        const float p[3] = {((float)(i % VOXELS) + 0.5f) / VOXELS - 0.5f,
                            ((float)(i / VOXELS % VOXELS) + 0.5f) / VOXELS - 0.5f,
                            ((float)(i / VOXELS / VOXELS) + 0.5f) / VOXELS - 0.5f};
        data[i] = density_at(p);
    }
    scene->num_media = 1;
    tyn_medium *medium = &scene->media[0];
    *medium = (tyn_medium){.density_scale = 1, .volume = 0};
    for (int c = 0; c < 3; c++) {
        medium->sigma_s[c] = 16;
        medium->sigma_a[c] = 0.5f;
        medium->phase[c].g = 0.5f;
    }
    scene->num_shapes = 1;
    scene->shapes[0] = (tyn_shape){.kind = TYN_SHAPE_BOX,
                                   .to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    scene->num_lights = 1;
    scene->lights[0] = (tyn_light){
        .kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 3}, .direction = {-0.6f, -0.64f, 0.48f}};
    return true;
}

static tyn_view view_of(uint32_t side, uint32_t samples)
{
    tyn_view view = {.width = side,
                     .height = side,
                     .outputs = TYN_OUTPUT_RADIANCE,
                     .num_samples = samples,
                     .camera = {.projection = TYN_PERSPECTIVE, .yfov = 0.7f, .aspect = 1}};
    tyn_camera_look_at(&view.camera, (float[3]){0.8f, 0.5f, 1.6f}, (float[3]){0, 0, 0});
    return view;
}

// ---- times ------------------------------------------------------------------------------------

// The least time of cold frames of a view, after one that compiles and allocates: of as many as take long enough.
static int least_ms(app *a, renderer *r, const tyn_scene *scene, const tyn_view *view, double *ms)
{
    static const double enough_ms = 200;
    double spent = 0;
    int code = renderer_frame(a, r, scene, view, true, NULL);
    *ms = INFINITY;
    for (int i = 0; i < RUNS && spent < enough_ms && code == EXIT_DONE; i++) {
        code = renderer_frame(a, r, scene, view, true, NULL);
        spent += r->frame_ms;
        *ms = fmin(*ms, r->frame_ms);
    }
    return code;
}

// A small picture, and one so much larger that its pixels take half as long as all else.
static int time_pictures(app *a, renderer *r, const tyn_scene *scene, paces *p)
{
    double small = 0, large = 0;
    tyn_view view = view_of(SMALL, 1);
    int code = least_ms(a, r, scene, &view, &small);
    uint32_t side = SMALL;
    while (code == EXIT_DONE && side < LARGEST && large < 1.5 * small) {
        side *= 2;
        view = view_of(side, 1);
        code = least_ms(a, r, scene, &view, &large);
    }
    const double few = (double)SMALL * SMALL, more = (double)side * side - few;
    const double pixel_ms = fmax(large - small, 0) / more;
    p->pixel_ns = 1e6 * pixel_ms;
    p->solve_ms = fmax(small - pixel_ms * few, 0);
    return code;
}

// As many samples as take long enough to be timed.
static int time_samples(app *a, renderer *r, const tyn_scene *scene, paces *p)
{
    static const double enough_ms = 50;
    double one = 0, many = 0;
    tyn_view view = view_of(SMALL, 1);
    int code = least_ms(a, r, scene, &view, &one);
    while (code == EXIT_DONE && view.num_samples < MOST_SAMPLES && many < one + enough_ms) {
        view.num_samples *= 4;
        code = least_ms(a, r, scene, &view, &many);
    }
    const double samples = (double)SMALL * SMALL * (view.num_samples - 1);
    p->sample_ns = 1e6 * fmax(many - one, 0) / samples;
    return code;
}

int paces_measure(app *a, tyn_device *device, paces *p)
{
    static const struct {
        const char *method;
        int (*time)(app *, renderer *, const tyn_scene *, paces *);
    } kinds[] = {{"pop", time_pictures}, {"path", time_samples}};
    *p = (paces){0};
    tyn_scene scene;
    int code = make_scene(&scene) ? EXIT_DONE : app_exit_code(a, TYN_ERR_MEMORY, false);
    for (size_t i = 0; i < ARRAY_SIZE(kinds) && code == EXIT_DONE; i++) {
        method m = {0};
        renderer r = {0};
        tyn_method_info info;
        if (!tyn_method_named(kinds[i].method, &info)) {
            continue; // this build lacks it
        }
        code = method_open(a, &(method_options){.method = kinds[i].method}, &m);
        code = code == EXIT_DONE ? renderer_open(a, device, &m, &r) : code;
        code = code == EXIT_DONE ? kinds[i].time(a, &r, &scene, p) : code;
        renderer_close(&r);
        method_finish(&m);
    }
    tyn_scene_finish(&scene);
    return code;
}

// ---- as text ----------------------------------------------------------------------------------

cJSON *paces_json(const paces *p)
{
    cJSON *json = cJSON_CreateObject();
    json_add_float(json, "solve_ms", p->solve_ms);
    json_add_float(json, "pixel_ns", p->pixel_ns);
    json_add_float(json, "sample_ns", p->sample_ns);
    return json;
}
