// cmd_render.c -- `tyndall render`: a scene to pictures and stats.
#include "app.h"
#include "layers.h"
#include "choice_setup.h"
#include "crop.h"
#include "exposure.h"
#include "machine.h"
#include "method_setup.h"
#include "output.h"
#include "renderer.h"
#include "resume.h"
#include "scene_setup.h"
#include "sequence.h"
#include "stats.h"
#include "timing.h"
#include "until.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct render_args {
    scene_options scene;
    view_options view;
    method_options method;
    choice_options choice;
    machine_options machine;
    opt_list outputs;
    const char *aov, *stats, *frames, *change, *exposure, *tonemap, *crop, *until;
    bool no_background, full_float, resume;
    uint32_t sample_offset;
} render_args;

// What a volume or a scene without a camera is given to be looked at, chosen for the first picture of
// a sequence and kept for the others: else smoke that thins out would be made denser, and a camera
// that fits what grows would draw back.
typedef struct first_look {
    bool chosen;
    tyn_medium medium;
    tyn_camera camera;
} first_look;

// What stays the same over the pictures of a sequence.
typedef struct render_job {
    const render_args *args;
    const opt_list *outputs;
    bool numbered;
    uint32_t repeat;    // timing frames
    method_options how; // what was asked for, or chosen for the first picture
    chosen chosen;
    method method;
    output_plan plan;
    machine machine; // opened for the first picture, when its scene has been read
    renderer renderer;
    first_look look;
    float exposure_ev;
    float until;        // --until; 0: all samples
    bool find_exposure; // --exposure auto, until the first picture has one
} render_job;

static int open_machine(app *a, render_job *job)
{
    return job->machine.device ? EXIT_DONE
                               : machine_open(a, &job->args->machine, false, &job->machine);
}

static int open_renderer(app *a, render_job *job)
{
    if (job->renderer.offline) {
        return EXIT_DONE;
    }
    int code = open_machine(a, job);
    return code == EXIT_DONE ? renderer_open(a, job->machine.device, &job->method, &job->renderer)
                             : code;
}

// The method, and what it can give of what is to be written.
static int open_method(app *a, render_job *job)
{
    const render_args *args = job->args;
    if (job->until > 0) {
        until_method(job->until, &job->how);
    }
    int code = method_open(a, &job->how, &job->method);
    if (code == EXIT_DONE && job->until > 0 && !until_check(a, &job->method.info, args->until)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE && args->tonemap) {
        code = app_exit_code(
            a, tyn_settings_set(job->method.settings, "tonemap.curve", args->tonemap, &a->log),
            true);
    }
    if (code == EXIT_DONE) {
        code = output_plan_make(a, &job->method.info, job->outputs, args->aov, args->full_float,
                                &job->plan);
    }
    if (code == EXIT_DONE && args->resume && !(job->plan.outputs & OUTPUT_SUMS)) {
        const bool can = job->method.info.outputs & TYN_OUTPUT_LOW;
        app_error(a,
                  can ? "--resume needs an .exr, in which samples are kept; give one with -o"
                      : "--resume: method '%s' does not take samples that could be gone on with; "
                        "'path' does",
                  job->method.info.name);
        code = EXIT_WRONG;
    }
    return code;
}

// --max-error, --budget-ms: the method for the first picture's scene, kept for the others.
static int choose_method(app *a, render_job *job, const tyn_scene *scene)
{
    if (job->method.settings) {
        return EXIT_DONE;
    }
    tyn_view view = {.no_background = job->args->no_background};
    int code = view_setup(a, &job->args->view, scene, &view);
    if (code == EXIT_DONE && !crop_take(a, job->args->crop, &view)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        code = open_machine(a, job);
    }
    if (code == EXIT_DONE) {
        code = choice_make(a, &job->args->choice, &job->args->method, &job->machine, scene, &view,
                           &job->chosen);
    }
    job->how = job->chosen.method;
    return code == EXIT_DONE ? open_method(a, job) : code;
}

// The paths of one picture, with its number in them: new strings.
typedef struct picture_paths {
    opt_list outputs;
    char *scene, *environment, *stats;
} picture_paths;

static char *path_of(const char *path, bool numbered, uint32_t number)
{
    if (!path) {
        return NULL;
    }
    return numbered ? sequence_path(path, number) : text_format("%s", path);
}

// False: out of memory.
static bool paths_make(const render_args *args, const opt_list *outputs, bool numbered,
                       uint32_t number, picture_paths *p)
{
    const char *environment = args->scene.env ? args->scene.env : args->scene.environment;
    *p = (picture_paths){.scene = path_of(args->scene.scene, numbered, number),
                         .environment = path_of(environment, numbered, number),
                         .stats = path_of(args->stats, numbered, number)};
    bool whole = p->scene && (p->environment || !environment) && (p->stats || !args->stats);
    for (uint32_t i = 0; i < outputs->count; i++) {
        p->outputs.items[i] = path_of(outputs->items[i], numbered, number);
        p->outputs.count++;
        whole = whole && p->outputs.items[i];
    }
    return whole;
}

static void paths_finish(picture_paths *p)
{
    for (uint32_t i = 0; i < p->outputs.count; i++) {
        free((char *)p->outputs.items[i]);
    }
    free(p->scene);
    free(p->environment);
    free(p->stats);
}

// --frames N: the timing frames after the picture. `scene` is changed by --change light and sky.
static int time_frames(app *a, render_job *job, tyn_scene *scene, const tyn_view *view, stats *s)
{
    const char *change = job->args->change;
    timing_change what = TIMING_COLD;
    double *median = &s->cold_ms;
    if (change && strcmp(change, "camera") == 0) {
        what = TIMING_CAMERA;
        median = &s->camera_moved_ms;
    } else if (change && strcmp(change, "light") == 0) {
        what = TIMING_LIGHT;
        median = &s->light_moved_ms;
    } else if (change && strcmp(change, "sky") == 0) {
        what = TIMING_SKY;
        median = &s->sky_dimmed_ms;
    } else if (change) {
        what = TIMING_UNCHANGED;
        median = &s->unchanged_ms;
    }
    return timing_run(a, &job->renderer, scene, view, what, job->repeat, median);
}

// The picture that --resume takes up; `count` if there is none.
static uint32_t first_exr(const opt_list *files)
{
    uint32_t i = 0;
    while (i < files->count && !text_ends_with(files->items[i], ".exr")) {
        i++;
    }
    return i;
}

// What is written of a picture.
typedef struct picture_state {
    app *a;
    const render_job *job;
    picture_tags tags;
    const opt_list *files;
    uint32_t before; // samples that it was taken up with
    double kept;     // when it was last written meanwhile, s
    double keeping;  // what that took, s
} picture_state;

// All files, or those from which the picture can be gone on with. The first .exr says that a picture is done (take_up): it
// comes last.
static int write_outputs(const picture_state *p, bool sums, bool resumable)
{
    const uint32_t count = p->files->count, first = first_exr(p->files);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = first == count ? k : (first + 1 + k) % count;
        if (resumable && !text_ends_with(p->files->items[i], ".exr")) {
            continue;
        }
        int code = output_write(p->a, &p->job->plan, p->job->renderer.offline, &p->tags, sums,
                                p->files->items[i]);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    return EXIT_DONE;
}

// With --resume the picture is written every few seconds, so that little is lost however the program ends.
static void keep_picture(void *user, uint32_t samples)
{
    enum {
        SECONDS = 4,
        SHARE = 50
    }; // at least so long apart; at most one part in so many of the time
    picture_state *p = user;
    const double now = app_seconds();
    if (now - p->kept > SECONDS && now - p->kept > SHARE * p->keeping) {
        p->tags.samples = p->before + samples;
        write_outputs(p, true, true);
        p->kept = app_seconds();
        p->keeping = p->kept - now;
    }
}

// After Ctrl-C or SIGTERM: what there is, to be gone on with.
static void keep_interrupted(picture_state *p, uint32_t asked)
{
    const uint32_t done = p->job->renderer.samples;
    p->tags.samples = p->before + done;
    if (done == 0 || !p->job->method.info.progressive || write_outputs(p, true, false)) {
        return;
    }
    app_note(p->a, "interrupted after %u of %u samples; %s", p->tags.samples, asked,
             p->job->plan.outputs & OUTPUT_SUMS ? "the same command with --resume goes on"
                                                : "what there is has been written");
}

// Nothing is rendered of a picture that has all its samples: are the other files there?
static int check_written(app *a, const picture_paths *paths, const char *done, uint32_t samples)
{
    for (uint32_t i = 0; i <= paths->outputs.count; i++) {
        const char *file = i < paths->outputs.count ? paths->outputs.items[i] : paths->stats;
        if (file && access(file, F_OK) != 0) {
            app_error(a,
                      "%s: has %u samples already, and '%s' is not made from it: ask for more "
                      "--spp, or leave --resume out",
                      done, samples, file);
            return EXIT_WRONG;
        }
    }
    return EXIT_DONE;
}

// --resume: what the first .exr has of the picture. *whole: all of it.
static int take_up(app *a, const render_job *job, const picture_paths *paths,
                   const picture_tags *tags, uint32_t asked, resumed *r, bool *whole)
{
    const uint32_t first = first_exr(&paths->outputs);
    *whole = false;
    *r = (resumed){0};
    if (!job->args->resume || first == paths->outputs.count) {
        return EXIT_DONE;
    }
    const char *file = paths->outputs.items[first];
    int code = resumed_read(a, file, tags, r);
    *whole = code == EXIT_DONE && r->resume.num_samples >= asked;
    if (*whole) {
        app_note(a, "%s: has %u samples already", file, r->resume.num_samples);
        code = check_written(a, paths, file, r->resume.num_samples);
    }
    return code;
}

// What the run gave, in a line for people.
static void note_result(app *a, const stats *s, double frame_ms, const opt_list *files)
{
    const bool cold = !isnan(s->cold_ms), timed = cold && s->cold_ms != frame_ms;
    const bool compiled = cold && s->pipelines.compiled > s->pipelines.from_cache;
    char time[128] = "";
    int used = 0;
    if (timed || !compiled) { // the frames after the first
        used = snprintf(time, sizeof time, "%.0f ms%s", cold ? s->cold_ms : frame_ms,
                        cold ? " a cold frame" : "");
    }
    if (compiled) { // drivers compile when a kernel is made or when it is first used
        snprintf(time + used, sizeof time - (size_t)used, "%sfirst frame, with compiling, %.1f s",
                 used ? "; " : "", 1e-3 * (frame_ms + s->setup_ms));
    } else {
        snprintf(time + used, sizeof time - (size_t)used, ", %.0f ms set-up", s->setup_ms);
    }
    app_note(a, "%s: %ux%u, %s on %s, %s", files->items[0], s->view->width, s->view->height,
             s->method->info.name, s->device, time);
}

// Gives a picture of a sequence the coefficients and the camera of the first, where they were chosen
// to suit it.
static void keep_look(first_look *look, const char *path, tyn_scene *scene, tyn_camera *camera)
{
    tyn_medium *m = &scene->media[0];
    const bool volume = tyn_is_volume(path);
    float seen = 0;
    for (int c = 0; c < 3; c++) {
        seen += volume ? m->sigma_s[c] + m->sigma_a[c] : 1;
    }
    if (!look->chosen && seen > 0) { // the first with something in it
        *look = (first_look){true, *m, *camera};
        look->camera.name = look->camera.camera_name = NULL; // are the scene's
    }
    if (look->chosen && volume) {
        memcpy(m->sigma_s, look->medium.sigma_s, sizeof m->sigma_s);
        memcpy(m->sigma_a, look->medium.sigma_a, sizeof m->sigma_a);
    }
    if (look->chosen && (volume || scene->num_cameras == 0)) {
        *camera = look->camera;
    }
}

// The picture's samples, or those that it lacks.
static int render_samples(render_job *job, const tyn_scene *scene, const tyn_view *view,
                          picture_state *picture, const tyn_resume *before)
{
    tyn_view rest = *view;
    if (before->num_samples) {
        rest.resume = before;
        rest.first_sample = picture->before = before->num_samples;
        rest.num_samples -= before->num_samples;
    }
    if (job->until > 0) {
        return until_render(picture->a, &job->renderer, scene, &rest, job->until,
                            job->method.info.name, &picture->tags.samples);
    }
    job->renderer.keep = job->args->resume ? keep_picture : NULL;
    job->renderer.keep_user = picture;
    int code =
        renderer_frame(picture->a, &job->renderer, scene, &rest, false, job->method.info.name);
    job->renderer.keep = NULL;
    if (code == EXIT_INTERRUPTED) {
        keep_interrupted(picture, view->num_samples);
    }
    picture->tags.samples = job->method.info.progressive ? view->num_samples : 0;
    return code;
}

// --exposure auto: from a small picture of few samples.
static int find_exposure(app *a, render_job *job, const tyn_scene *scene, tyn_view *view)
{
    enum { SIDE = 128, SAMPLES = 16 };
    tyn_view small = *view;
    const float shrink =
        fminf(1, (float)SIDE / (float)(view->width > view->height ? view->width : view->height));
    crop_shrink(&small, shrink);
    small.num_samples = view->num_samples < SAMPLES ? view->num_samples : SAMPLES;
    small.outputs = TYN_OUTPUT_RADIANCE;
    int code = renderer_frame(a, &job->renderer, scene, &small, false, "exposure");
    if (code == EXIT_DONE) {
        const float *pixels = tyn_offline_output(job->renderer.offline, TYN_OUTPUT_RADIANCE);
        job->exposure_ev = exposure_find(pixels, (size_t)small.width * small.height);
        job->find_exposure = false;
        view->exposure_ev = job->exposure_ev;
        app_note(a, "--exposure %.1f", (double)job->exposure_ev);
    }
    return code;
}

static bool shines(const float color[3])
{
    return color[0] > 0 || color[1] > 0 || color[2] > 0;
}

// A black picture is rarely what was meant.
static void note_darkness(app *a, const tyn_scene *scene)
{
    const tyn_environment *env = &scene->environment;
    bool lit = env->present && shines(env->radiance);
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        lit = lit || shines(scene->lights[i].color);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        lit = lit || shines(scene->media[i].emission) || scene->media[i].radiance_grid;
    }
    for (uint32_t i = 0; i < scene->surfaces.num_materials; i++) {
        lit = lit || shines(scene->surfaces.materials[i].emission);
    }
    if (!lit) {
        app_warn(a, "nothing in the scene shines, the picture is black: it has no lights, no "
                    "environment (--env FILE) and nothing emits");
    }
}

// What a .png does not show.
static void note_clipping(app *a, const render_job *job, const tyn_view *view)
{
    static const double few = 0.05; // part of a picture: a sun, a lamp and what shines of it
    const size_t pixels = (size_t)view->width * view->height;
    if (!(job->plan.outputs & TYN_OUTPUT_DISPLAY)) {
        return;
    }
    const double clipped =
        exposure_clipped(tyn_offline_output(job->renderer.offline, TYN_OUTPUT_DISPLAY), pixels);
    if (clipped > few) {
        const float ev =
            exposure_find(tyn_offline_output(job->renderer.offline, TYN_OUTPUT_RADIANCE), pixels);
        app_warn(a, "%.0f %% of the picture is clipped, try --exposure %.0f", 100 * clipped,
                 (double)floorf(ev));
    }
}

// Renders, writes and times one picture. `scene` has been loaded.
static int render_picture(app *a, render_job *job, tyn_scene *scene, uint64_t number,
                          const picture_paths *paths)
{
    tyn_view view = {.outputs = job->plan.outputs,
                     .no_background = job->args->no_background,
                     .exposure_ev = job->exposure_ev,
                     .sample_offset = job->args->sample_offset,
                     .time_index = number};
    method_view(&job->how, &view);
    // Later pictures of a sequence recompute only what differs: they are not cold.
    bool first = !job->renderer.offline;
    int code = view_setup(a, &job->args->view, scene, &view);
    if (code == EXIT_DONE && !crop_take(a, job->args->crop, &view)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        keep_look(&job->look, paths->scene, scene, &view.camera);
        code = open_renderer(a, job);
    }
    if (code == EXIT_DONE && job->find_exposure) {
        first = false; // what does not depend on the view is there by then
        code = find_exposure(a, job, scene, &view);
    }
    picture_state picture = {
        a, job, {&job->method, scene, &view, 0}, &paths->outputs, 0, app_seconds(), 0};
    resumed before = {0};
    bool whole = false;
    if (code == EXIT_DONE) {
        code = take_up(a, job, paths, &picture.tags, view.num_samples, &before, &whole);
    }
    if (code == EXIT_DONE && !whole) {
        code = render_samples(job, scene, &view, &picture, &before.resume);
    }
    resumed_finish(&before);
    if (code != EXIT_DONE || whole) {
        return code;
    }
    const double frame_ms = job->renderer.frame_ms;
    note_clipping(a, job, &view);
    code = app_interrupted() ? EXIT_INTERRUPTED : write_outputs(&picture, job->args->resume, false);
    stats s = {.device = tyn_device_name(job->machine.device),
               .method = &job->method,
               .scene = scene,
               .view = &view,
               .setup_ms = job->renderer.setup_ms,
               .cold_ms = first ? frame_ms : NAN,
               .camera_moved_ms = NAN,
               .light_moved_ms = NAN,
               .sky_dimmed_ms = NAN,
               .unchanged_ms = NAN,
               .inputs = {paths->scene, paths->environment}};
    if (code == EXIT_DONE && job->repeat > 0) {
        code = time_frames(a, job, scene, &view, &s);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    tyn_device_pipelines(job->machine.device, &s.pipelines);
    note_result(a, &s, frame_ms, &paths->outputs);
    if (paths->stats) {
        tyn_report report = {0};
        tyn_offline_report(job->renderer.offline, &report);
        s.report = &report;
        s.warnings[0] = job->renderer.warnings[0];
        s.warnings[1] = job->renderer.warnings[1];
        s.warnings[2] = job->chosen.warning;
        s.choice = job->chosen.json;
        code = json_write(a, stats_make(&s), paths->stats);
    }
    return code;
}

static int load_and_render(app *a, render_job *job, const opt_list *outputs, bool numbered,
                           uint32_t number)
{
    picture_paths p;
    if (!paths_make(job->args, outputs, numbered, number, &p)) {
        paths_finish(&p);
        return app_exit_code(a, TYN_ERR_MEMORY, false);
    }
    scene_options options = job->args->scene;
    options.scene = p.scene;
    if (options.env) {
        options.env = p.environment;
    } else {
        options.environment = p.environment;
    }
    options.number = numbered ? &number : NULL;
    tyn_scene scene;
    int code = scene_open(a, &options, &scene);
    if (code == EXIT_DONE && !job->renderer.offline) { // the first picture
        note_darkness(a, &scene);
    }
    if (code == EXIT_DONE) {
        code = choose_method(a, job, &scene);
    }
    if (code == EXIT_DONE) {
        code = scene_prepare(a, &job->method.info, &scene);
    }
    if (code == EXIT_DONE) {
        code = render_picture(a, job, &scene, number, &p);
    }
    tyn_scene_finish(&scene);
    paths_finish(&p);
    return code;
}

static int check_sequence(app *a, const render_args *args, const opt_list *outputs, sequence *s)
{
    if (!sequence_parse(args->frames, s)) {
        app_error(a, "--frames: '%s' is neither a number of frames N nor a range A-B, up to 100000",
                  args->frames);
        return EXIT_WRONG;
    }
    if (args->change && !s->repeat) {
        app_error(a, "--change needs --frames N, the number of frames to time");
        return EXIT_WRONG;
    }
    if (args->resume && s->repeat) {
        app_error(a, "--resume and --frames %s: what is timed is rendered from its first sample on",
                  args->frames);
        return EXIT_WRONG;
    }
    if (args->until && (args->resume || s->repeat || choice_is_asked(&args->choice))) {
        app_error(a,
                  "--until %s goes with none of --resume, --frames N, --max-error and --budget-ms",
                  args->until);
        return EXIT_WRONG;
    }
    for (uint32_t i = 0; s->numbered && i <= outputs->count; i++) {
        const char *path = i < outputs->count ? outputs->items[i] : args->stats;
        if (path && !sequence_has_number(path)) {
            app_error(a, "'%s' holds no %%04d or #### for the numbers of --frames %s", path,
                      args->frames);
            return EXIT_WRONG;
        }
    }
    return EXIT_DONE;
}

static int render_all(app *a, const render_args *args, const opt_list *outputs)
{
    sequence s;
    int code = check_sequence(a, args, outputs, &s);
    render_job job = {.args = args, .outputs = outputs, .how = args->method};
    if (code == EXIT_DONE &&
        !exposure_parse(args->exposure, &job.exposure_ev, &job.find_exposure)) {
        app_error(a, "--exposure: '%s' is neither a number from -64 to 64 nor 'auto'",
                  args->exposure);
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE && args->until && !until_parse(a, args->until, &job.until)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE && !choice_check(a, &args->choice, &args->method)) {
        code = EXIT_WRONG;
    }
    if (code == EXIT_DONE) {
        job.numbered = s.numbered;
        job.repeat = s.repeat;
        code = choice_is_asked(&args->choice) ? EXIT_DONE : open_method(a, &job);
    }
    if (code == EXIT_DONE && args->stats && !output_folder_is_writable(a, args->stats)) {
        code = EXIT_FAILED;
    }
    uint32_t first = s.numbered ? s.first : 0, last = s.numbered ? s.last : 0;
    for (uint32_t number = first; code == EXIT_DONE && number <= last; number++) {
        code = load_and_render(a, &job, outputs, s.numbered, number);
    }
    renderer_close(&job.renderer);
    machine_close(&job.machine);
    method_finish(&job.method);
    chosen_finish(&job.chosen);
    return code;
}

static int run_render(app *a, const void *arguments)
{
    const render_args *args = arguments;
    a->quiet = args->machine.quiet;
    opt_list outputs = args->outputs;
    char *stem = text_stem(args->scene.scene);
    char *by_name = text_format("%s.png", stem ? stem : "out");
    if (outputs.count == 0) {
        outputs.items[outputs.count++] = by_name;
    }
    int code = render_all(a, args, &outputs);
    free(stem);
    free(by_name);
    return code;
}

static const char *const curves[] = {"filmic", "linear", NULL};
static const char *const changes[] = {"none", "camera", "light", "sky", NULL};
static const opt_positional positionals[] = {SCENE_POSITIONALS(render_args, scene)};

#define AT(field) offsetof(render_args, field)
static const option output_table[] = {
    {'o', "output", OPT_LIST, AT(outputs), "FILE",
     ".exr or .png, repeatable; else the scene's name with .png", .file = OPT_WRITES},
    {0, "aov", OPT_TEXT, AT(aov), "LIST",
     "layers of the .exr, with commas between them:" LAYER_AOV_NAMES "; with "
     "depth, depth_t50, single or multiple every pixel is marched, none upsampled: the picture "
     "changes by up to 1 %"},
    {0, "crop", OPT_TEXT, AT(crop), "X,Y,WxH",
     "only these pixels, from column X and row Y on: by default settings those of the whole "
     "picture, but for the noise of 'path' and rounding at edges of surfaces "
     "(docs/surfaces.md). Up to 63 more on a side are rendered for that. Of an .exr they are the "
     "data window in the whole's display window. Parts of one picture by 'path' want a --seed "
     "each"},
    {0, "no-background", OPT_FLAG, AT(no_background), NULL,
     "the medium alone, premultiplied; A = 1 - mean transmittance"},
    {0, "exposure", OPT_TEXT, AT(exposure), "EV|auto",
     "of the .png, stops from -64 to 64, else 0; auto: the brightest hundredth of the first "
     "picture "
     "is beyond white"},
    {0, "tonemap", OPT_TEXT, AT(tonemap), "filmic|linear",
     "of the .png: a curve with shoulder and toe (default), or cut at 1", .names = curves},
    {0, "float", OPT_FLAG, AT(full_float), NULL, "32-bit .exr instead of 16-bit"},
    {0, "resume", OPT_FLAG, AT(resume), NULL,
     "of methods that sample: go on from the .exr of -o, if it is there, and keep in it what that "
     "takes (32-bit colours and sums)"},
    {0, "until", OPT_TEXT, AT(until), "ERROR",
     "add samples until the picture's own estimate of its error is as small, \"1%\": of pop "
     "refined "
     "(--refine N: N samples a pixel at most, else 4096), or of 'path'"},
    {0, "sample-offset", OPT_UINT, AT(sample_offset), "N",
     "begin with this sample of the seed: parts that 'merge' adds up to one picture", 0, 0,
     2147483647},
    {0, "stats", OPT_TEXT, AT(stats), "FILE.json", "times, memory and work of every node",
     .file = OPT_WRITES},
    {0, "frames", OPT_TEXT, AT(frames), "N|A-B",
     "N: time N frames that recompute every node; A-B: a sequence, %04d or #### in names"},
    {0, "change", OPT_TEXT, AT(change), "none|camera|light|sky",
     "with --frames N: time frames in which only this changes; light: suns and maps turn, lamps "
     "get 1 % darker; sky: gets 1 % darker",
     .names = changes},
};

static const opt_group groups[] = {
    {"output", output_table, ARRAY_SIZE(output_table), 0},
    {"method", method_table, METHOD_TABLE_SIZE, AT(method)},
    {"choice", choice_table, CHOICE_TABLE_SIZE, AT(choice)},
    {"view", view_table, VIEW_TABLE_SIZE, AT(view)},
    {"scene", scene_table, SCENE_TABLE_SIZE, AT(scene)},
    {"machine", machine_table, MACHINE_TABLE_SIZE, AT(machine)},
};

const command cmd_render = {
    .name = "render",
    .summary = "Render a scene, or a bare volume, to .exr and .png.",
    .positionals = positionals,
    .num_positionals = ARRAY_SIZE(positionals),
    .groups = groups,
    .num_groups = ARRAY_SIZE(groups),
    .args_size = sizeof(render_args),
    .run = run_render,
};
