// references.c -- see references.h.
#include "references.h"
#include <tyndall/extend/hash.h>
#include "numbers.h"
#include "registry/registry.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <tyndall/io.h>

// ---- the key ----------------------------------------------------------------------------------

static uint64_t hash_floats(uint64_t h, const float *values, size_t count)
{
    return tyn_hash_bytes(h, values, count * sizeof *values);
}

static uint64_t hash_media(uint64_t h, const tyn_scene *s)
{
    for (uint32_t i = 0; i < s->num_media; i++) {
        const tyn_medium *m = &s->media[i];
        h = hash_floats(h, m->sigma_s, 3);
        h = hash_floats(h, m->sigma_a, 3);
        h = hash_floats(h, m->emission, 3);
        for (int c = 0; c < 3; c++) {
            h = hash_floats(h, &m->phase[c].g, 1);
            h = tyn_hash_u64(h, m->phase[c].table);
        }
        h = hash_floats(h, (float[]){tyn_medium_scale(m)}, 1);
        h = tyn_hash_u64(h, (uint32_t)m->volume);
        h = tyn_hash_u64(h, m->emission_grid);
        h = tyn_hash_u64(h, m->radiance_grid);
        h = tyn_hash_u64(h, m->albedo_grid);
    }
    for (uint32_t i = 0; i < s->num_phase_tables; i++) {
        h = hash_floats(h, s->phase_tables[i].values, TYN_PHASE_NODES);
    }
    return h;
}

static uint64_t hash_grids(uint64_t h, const tyn_scene *s)
{
    for (uint32_t i = 0; i < s->num_volumes; i++) {
        const tyn_volume *v = &s->volumes[i];
        h = tyn_hash_bytes(h, v->size, sizeof v->size);
        h = hash_floats(h, &v->max_density, 1);
        h = hash_floats(h, v->data, (size_t)v->size[0] * v->size[1] * v->size[2]);
    }
    for (uint32_t i = 0; i < s->num_color_grids; i++) {
        const tyn_color_grid *g = &s->color_grids[i];
        h = tyn_hash_bytes(h, g->size, sizeof g->size);
        h = hash_floats(h, g->data, (size_t)g->size[0] * g->size[1] * g->size[2] * g->channels);
    }
    return h;
}

static uint64_t hash_shapes(uint64_t h, const tyn_scene *s)
{
    for (uint32_t i = 0; i < s->num_shapes; i++) {
        const tyn_shape *p = &s->shapes[i];
        h = tyn_hash_u64(h, p->kind);
        h = tyn_hash_u64(h, p->medium);
        h = hash_floats(h, p->to_world, 16);
        for (int a = 0; a < 3; a++) {
            h = tyn_hash_u64(h, p->repeat[a]);
        }
    }
    return h;
}

static uint64_t hash_lights(uint64_t h, const tyn_scene *s)
{
    for (uint32_t i = 0; i < s->num_lights; i++) {
        const tyn_light *l = &s->lights[i];
        h = tyn_hash_u64(h, l->kind);
        h = hash_floats(h, l->color, 3);
        h = hash_floats(h, l->position, 3);
        h = hash_floats(h, l->direction, 3);
        h = hash_floats(h, &l->cos_inner, 1);
        h = hash_floats(h, &l->cos_outer, 1);
    }
    const tyn_environment *e = &s->environment;
    if (e->present) {
        h = tyn_hash_bytes(h, e->size, sizeof e->size);
        h = hash_floats(h, e->data, e->data ? (size_t)e->size[0] * e->size[1] * 3 : 0);
        h = hash_floats(h, e->radiance, 3);
        h = hash_floats(h, e->rotation, 4);
        h = hash_floats(h, (float[]){tyn_environment_strength(e)}, 1);
    }
    return h;
}

// Triangles count in any order: builders of hierarchies sort them.
static uint64_t hash_surfaces(uint64_t h, const tyn_surfaces *s)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        sum += tyn_hash_bytes(TYN_HASH_SEED, &s->triangles[i], sizeof s->triangles[i]);
    }
    h = tyn_hash_u64(h, sum);
    h = tyn_hash_bytes(h, s->vertices, s->num_vertices * sizeof *s->vertices);
    h = tyn_hash_bytes(h, s->materials, s->num_materials * sizeof *s->materials);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        h = tyn_hash_bytes(h, t->size, sizeof t->size);
        h = tyn_hash_u64(h, (uint64_t)t->wrap[0] << 8 | t->wrap[1]);
        h = tyn_hash_bytes(h, t->texels, (size_t)t->size[0] * t->size[1] * 4);
    }
    return h;
}

static uint64_t hash_view(uint64_t h, const tyn_view *v)
{
    const tyn_camera *c = &v->camera;
    h = tyn_hash_u64(h, c->projection);
    h = hash_floats(h, c->position, 3);
    h = hash_floats(h, c->right, 3);
    h = hash_floats(h, c->up, 3);
    h = hash_floats(h, c->back, 3);
    h = hash_floats(h, c->projection == TYN_ORTHOGRAPHIC ? &c->ymag : &c->yfov, 1);
    const uint32_t words[] = {v->width,     v->height,      v->whole[0],     v->whole[1],
                              v->corner[0], v->corner[1],   v->outputs,      v->no_background,
                              v->seed,      v->num_samples, v->first_sample, v->sample_offset,
                              v->max_depth, v->rr_depth,    v->num_points,   v->scattered_only};
    h = tyn_hash_bytes(h, words, sizeof words);
    return tyn_hash_bytes(h, v->points, v->num_points * sizeof *v->points);
}

// Of SPIR-V, without names and lines, which change nothing.
static uint64_t hash_kernel(uint64_t h, const tyn_kernel *k)
{
    enum { HEADER = 5, OP_SOURCE = 3, OP_LINE = 8 };
    const size_t words = k->spirv_size / 4;
    for (size_t at = HEADER; at < words; at += k->spirv[at] >> 16) {
        const uint32_t length = k->spirv[at] >> 16, opcode = k->spirv[at] & 0xffff;
        assert_true(length > 0 && at + length <= words);
        if (opcode < OP_SOURCE || opcode > OP_LINE) {
            h = tyn_hash_bytes(h, &k->spirv[at], 4 * (size_t)length);
        }
    }
    return h;
}

static uint64_t hash_pass(uint64_t h, const char *name)
{
    const tyn_pass_desc *pass = tyn_pass_find(name);
    assert_non_null(pass);
    for (uint32_t i = 0; i < pass->num_kernels; i++) {
        h = hash_kernel(h, &pass->kernels[i]);
    }
    return h;
}

// What makes references, with the number that names of its files begin to be hashed from.
static const struct {
    uint32_t output;
    const char *pass;
    uint64_t seed;
} made_by[] = {{TYN_OUTPUT_RADIANCE, "path", 0x80b8f9a85f7996d1ull},
               {TYN_OUTPUT_PROBE, "path_probe", 0x40fc424385ac29a3ull},
               {TYN_OUTPUT_BALANCE, "path_balance", 0x8ec160ef4216eb67ull},
               {TYN_OUTPUT_FLUXES, "path_fluxes", 0x5a8d68e684f79839ull}};

static uint64_t hash_kernels(void)
{
    uint64_t h = hash_pass(TYN_HASH_SEED, "medium");
    for (size_t i = 0; i < sizeof made_by / sizeof *made_by; i++) {
        h = hash_pass(h, made_by[i].pass);
    }
    return h;
}

uint64_t reference_key(const tyn_scene *scene, const tyn_view *view)
{
    uint64_t h = 0;
    for (size_t i = 0; i < sizeof made_by / sizeof *made_by; i++) {
        h ^= view->outputs & made_by[i].output ? made_by[i].seed : 0;
    }
    h = hash_media(h, scene);
    h = hash_grids(h, scene);
    h = hash_shapes(h, scene);
    h = hash_lights(h, scene);
    h = hash_surfaces(h, &scene->surfaces);
    return hash_view(h, view);
}

// ---- files ------------------------------------------------------------------------------------

// What tools/references asks for by TYN_REFERENCES: nothing, or this.
static bool asks_to(const char *what)
{
    const char *mode = getenv("TYN_REFERENCES");
    return mode && !strcmp(mode, what);
}

static const char kernels_name[] = TYN_REFERENCES_DIR "/kernels";

// The hash of the kernels that made all files; 0: there are none.
static uint64_t noted_kernels(void)
{
    FILE *f = fopen(kernels_name, "r");
    unsigned long long noted = 0;
    const bool whole = f && fscanf(f, "%llx", &noted) == 1;
    if (f) {
        fclose(f);
    }
    return whole ? noted : 0;
}

static void note_kernels(void)
{
    FILE *f = fopen(kernels_name, "w");
    assert_non_null(f);
    fprintf(f, "%016llx\n", (unsigned long long)hash_kernels());
    assert_int_equal(fclose(f), 0);
}

static void file_of(uint64_t key, const char *ending, char path[512])
{
    snprintf(path, 512, "%s/%016llx.%s", TYN_REFERENCES_DIR, (unsigned long long)key, ending);
}

static bool exists(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (f) {
        fclose(f);
    }
    return f != NULL;
}

// The file of a key, if it is to be read.
static bool find(uint64_t key, const char *ending, char path[512])
{
    file_of(key, ending, path);
    if (asks_to("note")) {
        note_kernels();
    }
    return !asks_to("write") && noted_kernels() == hash_kernels() && exists(path);
}

// Is a reference that was rendered anew to be written?
static bool is_written(void)
{
    const uint64_t noted = noted_kernels();
    if (!asks_to("write")) {
        return false;
    }
    if (noted && noted != hash_kernels()) {
        fail_msg("the kernels of path have changed: renew all references (tools/references)");
    }
    note_kernels();
    return true;
}

enum { CHANNELS = 6 };
static const char *const channel_names[CHANNELS] = {"R", "G", "B", "error.R", "error.G", "error.B"};

bool reference_read_picture(uint64_t key, picture *p)
{
    char path[512];
    tyn_image_file file = {0};
    if (!find(key, "exr", path)) {
        return false;
    }
    assert_int_equal(tyn_exr_read(&file, path, NULL), TYN_OK);
    const tyn_attribute *unit = tyn_image_file_attribute(&file, "unit");
    assert_non_null(unit);
    const size_t pixels = (size_t)file.width * file.height;
    *p = (picture){.width = file.width,
                   .height = file.height,
                   .rgb = malloc(3 * pixels * sizeof *p->rgb),
                   .se = malloc(3 * pixels * sizeof *p->se)};
    for (int c = 0; c < CHANNELS; c++) {
        const float *from = tyn_image_file_channel(&file, channel_names[c]);
        assert_non_null(from);
        float *to = (c < 3 ? p->rgb : p->se) + c % 3;
        for (size_t i = 0; i < pixels; i++) {
            to[3 * i] = from[i] * (float)unit->values[0];
        }
    }
    tyn_image_file_finish(&file);
    return true;
}

// A power of two that brings the largest value near the largest half float, so that small standard errors keep their bits.
static double unit_of(const picture *p)
{
    double most = 0;
    for (size_t i = 0; i < 3 * (size_t)p->width * p->height; i++) {
        most = maximum(most, maximum(fabs((double)p->rgb[i]), p->se[i]));
    }
    int exponent = 0;
    frexp(most, &exponent);
    return most > 0 ? ldexp(1, exponent - 15) : 1;
}

void reference_write_picture(uint64_t key, const picture *p)
{
    if (!is_written()) {
        return;
    }
    const size_t pixels = (size_t)p->width * p->height;
    const double unit = unit_of(p);
    tyn_channel channels[CHANNELS] = {0};
    for (int c = 0; c < CHANNELS; c++) {
        snprintf(channels[c].name, sizeof channels[c].name, "%s", channel_names[c]);
        channels[c].data = malloc(pixels * sizeof *channels[c].data);
        const float *from = (c < 3 ? p->rgb : p->se) + c % 3;
        for (size_t i = 0; i < pixels; i++) {
            channels[c].data[i] = (float)(from[3 * i] / unit);
        }
    }
    tyn_attribute attribute = {.name = "unit", .kind = TYN_ATTRIBUTE_NUMBER, .values = {unit}};
    const tyn_image_file file = {.width = p->width,
                                 .height = p->height,
                                 .num_channels = CHANNELS,
                                 .channels = channels,
                                 .num_attributes = 1,
                                 .attributes = &attribute};
    char path[512];
    file_of(key, "exr", path);
    assert_int_equal(tyn_exr_write(&file, path, false, NULL), TYN_OK);
    for (int c = 0; c < CHANNELS; c++) {
        free(channels[c].data);
    }
}

bool reference_read_doubles(uint64_t key, double *values, size_t count)
{
    char path[512];
    if (!find(key, "txt", path)) {
        return false;
    }
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(fscanf(f, "%lf", &values[i]), 1);
    }
    fclose(f);
    return true;
}

void reference_write_doubles(uint64_t key, const double *values, size_t count)
{
    if (!is_written()) {
        return;
    }
    char path[512];
    file_of(key, "txt", path);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (size_t i = 0; i < count; i++) {
        fprintf(f, "%.9g\n", values[i]);
    }
    assert_int_equal(fclose(f), 0);
}

bool reference_read_floats(uint64_t key, float *values, size_t count)
{
    double *wide = malloc(count * sizeof *wide);
    const bool found = reference_read_doubles(key, wide, count);
    for (size_t i = 0; found && i < count; i++) {
        values[i] = (float)wide[i];
    }
    free(wide);
    return found;
}

void reference_write_floats(uint64_t key, const float *values, size_t count)
{
    double *wide = malloc(count * sizeof *wide);
    for (size_t i = 0; i < count; i++) {
        wide[i] = values[i];
    }
    reference_write_doubles(key, wide, count);
    free(wide);
}
