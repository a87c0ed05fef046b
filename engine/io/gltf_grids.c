// gltf_grids.c -- the grids of a medium: density, temperature, density of emission, albedo.
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <tyndall/extend/hash.h>
#include "io/gltf_media.h"
#include "io/grid_place.h"
#include "io/raw.h"
#include "io/uri.h"
#include "io/volume.h"

enum { DENSITY, TEMPERATURE, EMISSION, ALBEDO, NUM_GRIDS };

static const struct {
    const char *key,
        *grid; // the grid that is read if none is named; NULL: as tyn_volume_choose does
    tyn_grid_use use;
} kinds[NUM_GRIDS] = {[DENSITY] = {"density", NULL, TYN_GRID_DENSITY},
                      [TEMPERATURE] = {"temperature", "temperature", TYN_GRID_VALUE},
                      [EMISSION] = {"emission_density", "emission", TYN_GRID_COLOR},
                      [ALBEDO] = {"albedo", "Cd", TYN_GRID_COLOR}};

typedef struct grids {
    const cJSON *from[NUM_GRIDS]; // NULL: not there
    tyn_grid_job jobs[NUM_GRIDS];
    bool raw[NUM_GRIDS]; // it has no transform
} grids;

static bool is_raw(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ".raw") == 0;
}

static void warn_once(tyn_scene *scene, const char *line)
{
    for (uint32_t i = 0; i < scene->num_warnings; i++) {
        if (strcmp(scene->warnings[i], line) == 0) {
            return;
        }
    }
    tyn_scene_warn(scene, "%s", line);
}

// ---- files ------------------------------------------------------------------------------------

static tyn_result load_raw(tyn_grid_job *job, const char *path, const json_doc *doc,
                           const cJSON *from)
{
    static const char *const types[] = {"f32", "f16", "u8"};
    double size[3] = {0}, channels = 1;
    const char *name = "";
    int type = 0;
    TYN_TRY(
        tyn_json_numbers(doc, from, "size", 3, 1, 65536, "a number of voxels, 1 to 65536", size));
    TYN_TRY(tyn_json_string(doc, from, "type", &name));
    if (job->use == TYN_GRID_COLOR) {
        TYN_TRY(tyn_json_number(doc, from, "channels", 1, 3, "1 or 3", &channels));
        if (channels != 1 && channels != 3) {
            return tyn_json_fault(doc, tyn_json_member(from, "channels"), "must be 1 or 3");
        }
    }
    while (type < 3 && strcmp(name, types[type]) != 0) {
        type++;
    }
    if (size[0] == 0.0 || type == 3) {
        return tyn_json_fault(doc, from,
                              "a .raw grid needs \"size\": [nx, ny, nz] and \"type\": \"f32\", "
                              "\"f16\" or \"u8\"");
    }
    void *bytes;
    size_t num_bytes;
    TYN_TRY(tyn_file_read(path, TYN_MAX_FILE_BYTES, &bytes, &num_bytes, job->log));
    tyn_result r = tyn_raw_read(job, bytes, num_bytes,
                                (int64_t[]){(int64_t)size[0], (int64_t)size[1], (int64_t)size[2]},
                                (uint32_t)channels, (tyn_raw_type)type, path);
    free(bytes);
    return r;
}

static tyn_result load_grid(grids *g, int kind, const json_doc *doc)
{
    const cJSON *from = g->from[kind], *uri = tyn_json_member(from, "uri");
    tyn_grid_job *job = &g->jobs[kind];
    const char *grid = kinds[kind].grid;
    TYN_TRY(tyn_json_string(doc, from, "grid", &grid));
    if (!uri) {
        return tyn_json_fault(doc, from, "uri is missing: a file, one of .raw" TYN_VOLUME_ENDINGS);
    }
    char *path = tyn_uri_path(doc, uri);
    if (!path) {
        return TYN_ERR_PARAMS;
    }
    tyn_capture capture;
    tyn_capture_init(&capture);
    *job = (tyn_grid_job){.grid = grid, .use = kinds[kind].use, .log = &capture.log};
    for (int k = TEMPERATURE; k < NUM_GRIDS; k++) {
        static const tyn_grid_role roles[] = {
            [TEMPERATURE] = TYN_ROLE_HEAT, [EMISSION] = TYN_ROLE_HEAT, [ALBEDO] = TYN_ROLE_COLOR};
        job->used |= g->from[k] ? 1u << roles[k] : 0;
        job->used |= k == EMISSION && g->from[k] ? 1u << TYN_ROLE_EMISSION : 0;
    }
    g->raw[kind] = is_raw(path);
    tyn_result r = g->raw[kind] ? load_raw(job, path, doc, from) : tyn_grid_read(job, path);
    job->log = NULL; // it ends here
    free(path);
    if (r) {
        return capture.message[0] ? tyn_capture_fault(&capture, doc, uri, r) : r;
    }
    return TYN_OK;
}

// What is in the files beside, and what was taken for a density that does not look like one.
static void tell(tyn_scene *scene, const grids *g, int kind)
{
    const tyn_grid_job *job = &g->jobs[kind];
    const char *name = job->volume.name ? job->volume.name : "volume";
    char line[1024];
    if (kind != DENSITY) {
        if (job->clamped) {
            snprintf(line, sizeof line, "%s: %llu negative values were set to 0", name,
                     (unsigned long long)job->clamped);
            warn_once(scene, line);
        }
        return;
    }
    const tyn_grid_role role = job->grid ? tyn_grid_role_of(job->grid) : TYN_ROLE_DENSITY;
    if (!g->raw[kind] && role != TYN_ROLE_DENSITY && role != TYN_ROLE_UNKNOWN) {
        snprintf(line, sizeof line, "%s: is taken for a density, as \"grid\" says", name);
        warn_once(scene, line);
    }
    if (job->guessed) {
        snprintf(line, sizeof line, "%s: is taken for the density: none is called so", name);
        warn_once(scene, line);
    }
    if (job->left_out[0]) {
        snprintf(line, sizeof line, "%s: left out of the file: %s", name, job->left_out);
        warn_once(scene, line);
    }
}

// ---- one box ----------------------------------------------------------------------------------

// Grids with transforms are brought into one box; those without fill it as they are.
static tyn_result align(grids *g, gltf_grids *place, const json_doc *doc)
{
    tyn_placed_grid placed[TYN_PLACED_MAX];
    int of[TYN_PLACED_MAX];
    uint32_t count = 0;
    for (int k = 0; k < NUM_GRIDS; k++) {
        const tyn_volume *v = &g->jobs[k].volume;
        if (g->from[k] && !g->raw[k]) {
            tyn_placed_grid *p = &placed[count];
            *p = (tyn_placed_grid){
                .channels = g->jobs[k].channels, .data = v->data, .edge = k == ALBEDO};
            memcpy(p->size, v->size, sizeof p->size);
            memcpy(p->index_to_world, v->index_to_world, sizeof p->index_to_world);
            of[count++] = k;
        }
    }
    const char *why = NULL;
    uint64_t most = TYN_MAX_VOXELS;
    for (uint32_t i = 0; i < count; i++) {
        most = placed[i].channels == 3 ? TYN_MAX_VOXELS / 3 : most;
    }
    const tyn_result r = count > 1 ? tyn_grids_align(placed, count, most, &why) : TYN_OK;
    for (uint32_t i = 0; i < count; i++) {
        tyn_volume *v = &g->jobs[of[i]].volume;
        const bool moved = v->data != placed[i].data;
        v->data = placed[i].data;
        memcpy(v->size, placed[i].size, sizeof v->size);
        memcpy(v->index_to_world, placed[i].index_to_world, sizeof v->index_to_world);
        if (moved) {
            v->hash = tyn_grid_hash(v->size, placed[i].channels, v->data);
        }
        place->placed = true;
        memcpy(place->index_to_world, v->index_to_world, sizeof place->index_to_world);
        memcpy(place->size, v->size, sizeof place->size);
    }
    return r ? tyn_json_fault(doc, g->from[of[count - 1]], "%s", why) : TYN_OK;
}

// ---- into the scene ---------------------------------------------------------------------------

static tyn_result add_volume(tyn_scene *scene, tyn_volume *volume, const json_doc *doc,
                             int32_t *index)
{
    for (uint32_t i = 0; i < scene->num_volumes; i++) { // two media may share a grid
        const tyn_volume *other = &scene->volumes[i];
        if (other->hash == volume->hash &&
            memcmp(other->size, volume->size, sizeof other->size) == 0 &&
            memcmp(other->index_to_world, volume->index_to_world, sizeof other->index_to_world) ==
                0) {
            tyn_volume_finish(volume);
            *index = (int32_t)i;
            return TYN_OK;
        }
    }
    tyn_volume *grown = realloc(scene->volumes, (scene->num_volumes + 1) * sizeof *grown);
    if (!grown) {
        return tyn_json_no_memory(doc, "volumes");
    }
    scene->volumes = grown;
    *index = (int32_t)scene->num_volumes;
    grown[scene->num_volumes++] = *volume;
    memset(volume, 0, sizeof *volume);
    return TYN_OK;
}

// Takes the grid, which is gone after a fault, too.
static tyn_result add_colors(tyn_scene *scene, tyn_color_grid colors, const json_doc *doc,
                             uint32_t *slot)
{
    for (uint32_t i = 0; i < scene->num_color_grids; i++) {
        const tyn_color_grid *other = &scene->color_grids[i];
        if (other->hash == colors.hash && other->channels == colors.channels &&
            memcmp(other->size, colors.size, sizeof other->size) == 0) {
            tyn_color_grid_finish(&colors);
            *slot = i + 1;
            return TYN_OK;
        }
    }
    tyn_color_grid *grown =
        realloc(scene->color_grids, (scene->num_color_grids + 1) * sizeof *grown);
    if (!grown) {
        tyn_color_grid_finish(&colors);
        return tyn_json_no_memory(doc, "volumes");
    }
    scene->color_grids = grown;
    grown[scene->num_color_grids++] = colors;
    *slot = scene->num_color_grids;
    return TYN_OK;
}

static tyn_result add_temperature(tyn_scene *scene, tyn_medium *medium, grids *g,
                                  const json_doc *doc)
{
    const cJSON *from = g->from[TEMPERATURE];
    tyn_volume *v = &g->jobs[TEMPERATURE].volume;
    tyn_temperature how = {.scale = 1, .strength = 1};
    TYN_TRY(
        tyn_json_number(doc, from, "scale", -FLT_MAX, FLT_MAX, "a number, kelvins", &how.scale));
    TYN_TRY(
        tyn_json_number(doc, from, "offset", -FLT_MAX, FLT_MAX, "a number, kelvins", &how.offset));
    TYN_TRY(tyn_json_number(doc, from, "strength", 0, FLT_MAX, "a number >= 0", &how.strength));
    TYN_TRY(
        tyn_json_number(doc, from, "luminance", 0, FLT_MAX, ">= 0, in W/(m^2 sr)", &how.luminance));
    if (how.scale == 0) {
        return tyn_json_fault(doc, tyn_json_member(from, "scale"),
                              "must not be 0: kelvins = value x scale + offset");
    }
    if (how.strength == 0) {
        return TYN_OK; // black
    }
    tyn_capture capture;
    tyn_capture_init(&capture);
    tyn_color_grid colors = {0};
    const tyn_result r =
        tyn_color_grid_of_temperatures(&colors, v->size, v->data, &how, &capture.log);
    if (r) {
        return tyn_capture_fault(&capture, doc, from, r);
    }
    colors.name = v->name;
    v->name = NULL;
    if (colors.max <= 0) {
        tyn_scene_warn(scene, "%s: nothing is hot enough to glow: kelvins = value x scale + offset",
                       colors.name ? colors.name : "temperature");
    }
    return add_colors(scene, colors, doc, &medium->radiance_grid);
}

static tyn_result add_emission(tyn_scene *scene, tyn_medium *medium, grids *g, const json_doc *doc,
                               bool given)
{
    double scale = 1;
    TYN_TRY(tyn_json_number(doc, g->from[EMISSION], "scale", 0, FLT_MAX, "a number >= 0", &scale));
    for (int c = 0; c < 3; c++) {
        medium->emission[c] =
            (float)fmin((given ? (double)medium->emission[c] : 1) * scale, FLT_MAX);
    }
    return add_colors(scene, tyn_grid_take_colors(&g->jobs[EMISSION]), doc, &medium->emission_grid);
}

static tyn_result add_albedo(tyn_scene *scene, tyn_medium *medium, grids *g, const json_doc *doc)
{
    tyn_color_grid colors = tyn_grid_take_colors(&g->jobs[ALBEDO]);
    const size_t count = (size_t)colors.size[0] * colors.size[1] * colors.size[2] * colors.channels;
    uint64_t above = 0;
    for (size_t i = 0; i < count; i++) {
        above += colors.data[i] > 1;
        colors.data[i] = fminf(colors.data[i], 1);
    }
    if (above) {
        tyn_scene_warn(scene, "%s: %llu values of an albedo above 1 were set to 1",
                       colors.name ? colors.name : "albedo", (unsigned long long)above);
        colors.max = 1;
        colors.hash = tyn_hash_bytes(colors.hash, colors.data, count * sizeof *colors.data);
    }
    return add_colors(scene, colors, doc, &medium->albedo_grid);
}

static tyn_result add_density(tyn_scene *scene, tyn_medium *medium, grids *g, const json_doc *doc)
{
    double scale = 1;
    TYN_TRY(tyn_json_number(doc, g->from[DENSITY], "scale", 0, FLT_MAX, "a number >= 0", &scale));
    medium->density_scale = (float)scale;
    if (medium->density_scale == 0.0f) {
        const tyn_medium before = *medium;
        tyn_medium_clear(medium);
        if (g->from[EMISSION]) { // which does not ask for density
            memcpy(medium->emission, before.emission, sizeof medium->emission);
        }
    }
    const uint64_t clamped = g->jobs[DENSITY].clamped;
    const uint32_t before = scene->num_volumes;
    TYN_TRY(add_volume(scene, &g->jobs[DENSITY].volume, doc, &medium->volume));
    if (clamped && scene->num_volumes > before) {
        const char *name = scene->volumes[before].name;
        scene->clamped_negative += clamped;
        tyn_scene_warn(scene, "%s: %llu negative densities were set to 0", name ? name : "volume",
                       (unsigned long long)clamped);
    }
    return TYN_OK;
}

static tyn_result read_all(tyn_scene *scene, tyn_medium *medium, gltf_grids *place, grids *g,
                           const json_doc *doc, const cJSON *from)
{
    for (int k = 0; k < NUM_GRIDS; k++) {
        cJSON *object;
        TYN_TRY(tyn_json_object(doc, from, kinds[k].key, &object));
        g->from[k] = object;
    }
    for (int k = 0; k < NUM_GRIDS; k++) {
        if (g->from[k]) {
            TYN_TRY(load_grid(g, k, doc));
            tell(scene, g, k);
        }
    }
    TYN_TRY(align(g, place, doc));
    if (g->from[DENSITY]) {
        TYN_TRY(add_density(scene, medium, g, doc));
    }
    if (g->from[TEMPERATURE]) {
        TYN_TRY(add_temperature(scene, medium, g, doc));
    }
    if (g->from[EMISSION]) {
        TYN_TRY(add_emission(scene, medium, g, doc, tyn_json_member(from, "emission") != NULL));
    }
    if (g->from[ALBEDO]) {
        TYN_TRY(add_albedo(scene, medium, g, doc));
    }
    return TYN_OK;
}

tyn_result tyn_gltf_read_grids(tyn_scene *scene, tyn_medium *medium, gltf_grids *place,
                               const json_doc *doc, const cJSON *from)
{
    grids g = {0};
    const tyn_result r = read_all(scene, medium, place, &g, doc, from);
    for (int k = 0; k < NUM_GRIDS; k++) {
        tyn_volume_finish(&g.jobs[k].volume);
    }
    return r;
}
