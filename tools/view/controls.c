// controls.c -- what the panel holds: method, picture, lights, media, times, memory, warnings.
#include "view/panel.h"
#include "view/viewer.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tyndall/registry.h>

static const char *const curves[] = {"filmic", "linear", "Reinhard"};
enum { MAX_METHODS = 32 };

// ---- method and picture -----------------------------------------------------------------------

static void method_controls(viewer *v)
{
    const char *names[MAX_METHODS];
    const uint32_t count = tyn_num_methods() < MAX_METHODS ? tyn_num_methods() : MAX_METHODS;
    for (uint32_t i = 0; i < count; i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        names[i] = info.name;
    }
    int chosen = (int)v->method_index, quality = (int)v->quality;
    if (panel_choice("method", &chosen, names, (int)count)) {
        viewer_set_method(v, (uint32_t)chosen);
    }
    if (panel_choice("quality", &quality, viewer_qualities, 3)) {
        viewer_set_quality(v, (uint32_t)quality);
    }
}

static void picture_controls(viewer *v)
{
    const char *names[NUM_PICTURE_LAYERS];
    uint32_t layers[NUM_PICTURE_LAYERS];
    int count = 0, chosen = 0;
    for (uint32_t i = 0; i < NUM_PICTURE_LAYERS; i++) {
        if (pictures_has_layer(v, i)) {
            chosen = i == v->layer ? count : chosen;
            names[count] = picture_layers[i].title;
            layers[count++] = i;
        }
    }
    if (panel_choice("layer", &chosen, names, count)) {
        viewer_set_layer(v, layers[chosen]);
    }
    panel_slider("exposure, EV", &v->exposure, -10, 10, false);
    panel_choice("tone curve", &v->curve, curves, (int)ARRAY_SIZE(curves));
}

// ---- lights -----------------------------------------------------------------------------------

static bool sun_controls(tyn_light *light)
{
    const float degrees = 57.29578f;
    float height = degrees * asinf(fminf(fmaxf(-light->direction[1], -1), 1));
    float azimuth = degrees * atan2f(-light->direction[0], -light->direction[2]);
    const bool changed = panel_slider("elevation", &height, -89.9f, 89.9f, false) |
                         panel_slider("azimuth", &azimuth, -180, 180, false);
    if (changed) {
        const float up = height / degrees, around = azimuth / degrees;
        light->direction[0] = -cosf(up) * sinf(around);
        light->direction[1] = -sinf(up);
        light->direction[2] = -cosf(up) * cosf(around);
    }
    return changed;
}

static bool light_controls(viewer *v, uint32_t i)
{
    tyn_light *light = &v->scene.lights[i];
    char title[128];
    snprintf(title, sizeof title, "%s %s", tyn_light_traits_of(light->kind)->name,
             light->name ? light->name : "");
    panel_text(title);
    bool changed = panel_slider("strength", &v->light_strength[i], 0, 100, true);
    for (int c = 0; changed && c < 3; c++) {
        light->color[c] = v->light_strength[i] * v->loaded.lights[i].color[c];
    }
    if (light->kind == TYN_LIGHT_DIRECTIONAL) {
        changed |= sun_controls(light);
    }
    return changed;
}

// The rotation by v->environment_turn about +Y after that of the file.
static void turn_environment(viewer *v)
{
    const float half = v->environment_turn * 0.00872665f, s = sinf(half), c = cosf(half);
    const float *q = v->loaded.environment.rotation;
    const float w = q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0 ? 1 : q[3];
    const float turned[4] = {c * q[0] + s * q[2], c * q[1] + s * w, c * q[2] - s * q[0],
                             c * w - s * q[1]};
    memcpy(v->scene.environment.rotation, turned, sizeof turned);
}

static bool environment_controls(viewer *v)
{
    tyn_environment *env = &v->scene.environment;
    panel_text("environment");
    const bool stronger = panel_slider("strength", &v->environment_strength, 0.001f, 100, true);
    const bool turned = panel_slider("turned", &v->environment_turn, -180, 180, false);
    if (stronger) {
        env->strength = v->environment_strength * tyn_environment_strength(&v->loaded.environment);
    }
    if (turned) {
        turn_environment(v);
    }
    return stronger || turned;
}

// ---- media ------------------------------------------------------------------------------------

static bool medium_controls(viewer *v, uint32_t i)
{
    tyn_medium *medium = &v->scene.media[i];
    const tyn_medium *loaded = &v->loaded.media[i];
    panel_text(medium->name ? medium->name : "medium");
    bool changed = false;
    if (panel_slider("density", &v->density[i], 0.01f, 100, true)) {
        medium->density_scale = v->density[i] * tyn_medium_scale(loaded);
        changed = true;
    }
    if (panel_color("albedo", v->albedo[i])) {
        for (int c = 0; c < 3; c++) {
            const float sigma_t = loaded->sigma_s[c] + loaded->sigma_a[c];
            v->albedo[i][c] = fminf(v->albedo[i][c], 1);
            medium->sigma_s[c] = v->albedo[i][c] * sigma_t;
            medium->sigma_a[c] = sigma_t - medium->sigma_s[c];
        }
        changed = true;
    }
    for (const tyn_phase_parameter *p = tyn_phase_parameters(); p->name; p++) {
        float values[3];
        tyn_phase_get(medium->phase, p, values);
        const float margin = 1e-3f * (p->hi - p->lo);
        if (panel_slider(p->name, &values[0], p->lo + margin, p->hi - margin, false)) {
            values[1] = values[2] = values[0];
            tyn_phase_set(medium->phase, p, values);
            changed = true;
        }
    }
    return changed;
}

void controls_reset(viewer *v)
{
    v->environment_strength = 1;
    v->environment_turn = 0;
    for (uint32_t i = 0; i < v->scene.num_lights; i++) {
        v->light_strength[i] = 1;
    }
    for (uint32_t i = 0; i < v->scene.num_media; i++) {
        const tyn_medium *m = &v->scene.media[i];
        v->density[i] = 1;
        for (int c = 0; c < 3; c++) {
            const float sigma_t = m->sigma_s[c] + m->sigma_a[c];
            v->albedo[i][c] = sigma_t > 0 ? m->sigma_s[c] / sigma_t : 0;
        }
    }
}

static void scene_controls(viewer *v)
{
    bool changed = false;
    const bool lit = v->scene.num_lights || v->scene.environment.present;
    if (lit && panel_section("lights", false)) {
        for (uint32_t i = 0; i < v->scene.num_lights; i++) {
            panel_push((int)i);
            changed |= light_controls(v, i);
            panel_pop();
        }
        if (v->scene.environment.present) {
            changed |= environment_controls(v);
        }
    }
    if (v->scene.num_media && panel_section("media", false)) {
        for (uint32_t i = 0; i < v->scene.num_media; i++) {
            panel_push(1000 + (int)i);
            changed |= medium_controls(v, i);
            panel_pop();
        }
    }
    if (changed) {
        v->edited = true;
        viewer_touch(v);
    }
}

// ---- comparison, probe, sequence ----------------------------------------------------------------

static void comparison_rows(const viewer *v)
{
    const comparison *c = &v->comparison;
    char left[64], right[64];
    if (!c->on) {
        return;
    }
    snprintf(left, sizeof left, "%s, samples", tyn_method_reference());
    snprintf(right, sizeof right, "%u", c->started ? c->rendering.samples : 0);
    panel_row(left, right);
    if (c->measured) {
        snprintf(left, sizeof left, "off over %dx%d", COMPARISON_BLOCK, COMPARISON_BLOCK);
        if (comparison_tells(c)) {
            snprintf(right, sizeof right, "%.2f %% (noise %.2f %%)", 100 * c->error.rel_l1,
                     100 * c->error.n);
        } else {
            snprintf(right, sizeof right, "not known yet (noise %.2f %%)", 100 * c->error.n);
        }
        panel_row(left, right);
    }
}

static void probe_rows(viewer *v)
{
    const probe_point *p = &v->probe;
    char text[96];
    if (p->state == PROBE_OFF || !panel_section("probe", true)) {
        return;
    }
    snprintf(text, sizeof text, "%.3g %.3g %.3g m", p->position[0], p->position[1], p->position[2]);
    panel_row("at", text);
    if (p->state == PROBE_KNOWN) {
        const float *f = p->result.fluence, *e = p->result.fluence_se;
        snprintf(text, sizeof text, "%.4g %.4g %.4g", f[0], f[1], f[2]);
        panel_row("fluence, W/m^2", text);
        if (e[0] > 0) {
            snprintf(text, sizeof text, "%.2g %.2g %.2g", e[0], e[1], e[2]);
            panel_row("standard error", text);
        }
        static const char *const axes[] = {"net flux along x", "along y", "along z"};
        for (int i = 0; i < 3; i++) {
            const float *flux = p->result.flux + 3 * i;
            snprintf(text, sizeof text, "%.3g %.3g %.3g", flux[0], flux[1], flux[2]);
            panel_row(axes[i], text);
        }
    }
    if (panel_button("remove the probe")) {
        probe_remove(v);
    }
}

static void sequence_controls(viewer *v)
{
    if (!v->sequence.numbered) {
        return;
    }
    float number = (float)v->number;
    panel_checkbox("play", &v->playing);
    if (panel_slider("picture", &number, (float)v->sequence.first, (float)v->sequence.last,
                     false)) {
        v->playing = false;
        source_turn_to(v, (uint32_t)lroundf(number));
    }
}

void controls_draw_marks(const viewer *v)
{
    float width, height, x, y;
    input_window_size(v, &width, &height);
    if (comparison_seen(v)) {
        char text[64] = "";
        x = v->comparison.split * width;
        panel_line(x, 0, x, height, 0xc0ffffff);
        if (comparison_tells(&v->comparison)) {
            snprintf(text, sizeof text, ", %.2f %% off", 100 * v->comparison.error.rel_l1);
        }
        char line[128];
        snprintf(line, sizeof line, "%s%s", v->method.info.name, text);
        panel_label(x - 9 - 7 * (float)strlen(line), height - 20, line);
        panel_label(x + 8, height - 20, v->comparison.method.info.name);
    }
    if (v->probe.state != PROBE_OFF &&
        camera_control_project(&v->camera, v->probe.position, viewer_aspect(v), &x, &y)) {
        x *= width;
        y *= height;
        panel_line(x - 8, y, x + 8, y, 0xff20e0ff);
        panel_line(x, y - 8, x, y + 8, 0xff20e0ff);
    }
}

// ---- what happened ----------------------------------------------------------------------------

static const rendering *shown_rendering(const viewer *v)
{
    return v->shown ? v->shown : &v->rest;
}

static void report_rows(const viewer *v)
{
    const rendering *r = shown_rendering(v);
    char text[64];
    if (!r->context) {
        return;
    }
    tyn_report report = {0};
    tyn_context_report(r->context, &report);
    if (panel_section("nodes: ms, MB (of it shared)", false)) {
        for (uint32_t i = 0; i < report.num_nodes; i++) {
            const tyn_node_report *n = &report.nodes[i];
            const bool ran = strcmp(n->state, "ran") == 0;
            char ms[32];
            snprintf(ms, sizeof ms, "%.2f", n->gpu_ms);
            snprintf(text, sizeof text, "%s, %.1f (%.1f)", ran ? ms : n->state,
                     1e-6 * (double)n->bytes, 1e-6 * (double)n->shared_bytes);
            panel_row(n->name, text);
        }
    }
    snprintf(text, sizeof text, "%.1f + %.1f MB", 1e-6 * (double)report.persistent_bytes,
             1e-6 * (double)report.transient_bytes);
    panel_row("memory", text);
    const uint32_t warnings = report.num_warnings + v->scene.num_warnings;
    snprintf(text, sizeof text, "warnings: %u###warnings", warnings);
    if (warnings && panel_section(text, false)) {
        for (uint32_t i = 0; i < v->scene.num_warnings; i++) {
            panel_text(v->scene.warnings[i]);
        }
        for (uint32_t i = 0; i < report.num_warnings; i++) {
            panel_text(report.warnings[i]);
        }
    }
}

// One row whatever happens: the widgets below stay where they are.
static void work_row(const viewer *v, const rendering *r)
{
    const uint32_t pending = pictures_pending(v);
    const double whole = ceil(1e-3 * resolution_expected_ms(&v->rest_cost, 1));
    char text[64];
    pictures_say(v, text, sizeof text);
    if (pending) {
        snprintf(text, sizeof text, "%u left", pending);
        panel_row("compiling kernels", text);
    } else if (text[0]) {
        panel_row("now", text);
    } else if (!r->context || !r->frames) {
        panel_row("now", "the first picture");
    } else if (v->sharp && v->rest_shown > 1) {
        snprintf(text, sizeof text, "%ux%u, %.0f ms; all: %.0f s (S)", r->width, r->height, r->ms,
                 whole);
        panel_row("at rest", text);
    } else {
        snprintf(text, sizeof text, "%ux%u, %.1f ms", r->width, r->height, r->ms);
        panel_row(v->sharp ? "at rest" : "moving", text);
    }
}

// Of pictures at rest; the place is kept for it, so that the widgets below stay where they are.
static void estimate_rows(const viewer *v)
{
    static const estimate none;
    const estimate *e = v->sharp ? &v->estimate : &none;
    const uint32_t wanted = pictures_samples_wanted(v);
    const uint32_t most = e->samples > wanted ? e->samples : wanted;
    char text[64] = "of pictures at rest";
    if (e->bias > 0) {
        snprintf(text, sizeof text, "%.2g %% (pop %.2g %%)", 100 * (double)e->error,
                 100 * (double)e->bias);
    } else if (e->samples) {
        snprintf(text, sizeof text, "%.2g %%", 100 * (double)e->error);
    }
    panel_row("estimated error", text);
    snprintf(text, sizeof text, "1 to %u samples", most);
    panel_curve(text, e->curve + 1, (int)estimate_place(most));
}

static void state_rows(const viewer *v)
{
    const rendering *r = shown_rendering(v);
    char text[64];
    work_row(v, r);
    if (r->context && r->method.progressive) {
        snprintf(text, sizeof text, "%u", r->samples);
        panel_row("samples a pixel", text);
    }
    if (estimate_told(v)) {
        estimate_rows(v);
    }
}

void controls_draw(viewer *v)
{
    float width, height;
    input_window_size(v, &width, &height);
    panel_window("tyndall view", 300, height > 40 ? height - 16 : height);
    method_controls(v);
    picture_controls(v);
    sequence_controls(v);
    state_rows(v);
    comparison_rows(v);
    probe_rows(v);
    scene_controls(v);
    report_rows(v);
    if (v->note[0]) {
        panel_text(v->note);
    }
    panel_window_end();
}
