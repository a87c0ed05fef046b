// peers.c -- the runs of renderers that are not of this library, from their files into a report.
#include "peers.h"
#include "json.h"
#include "measure.h"
#include "plane.h"
#include "stats.h"
#include "suite_reader.h"
#include "times.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

enum { PEER_VERSION = 1 };

// ---- the file ---------------------------------------------------------------------------------

static const cJSON *list_of(const cJSON *object, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

static bool is_block(const bench_suite *suite, double block, int measure)
{
    const uint32_t blocks[BENCH_MEASURES] = {suite->block, 1, 0};
    return block == blocks[measure];
}

// Whether values of the picture are not finite: then nobody knows its errors, by any measure.
static bool has_nan(const cJSON *errors)
{
    bool has = false;
    const cJSON *error;
    cJSON_ArrayForEach(error, errors)
    {
        has = has || json_figure(error, "nan") > 0;
    }
    return has;
}

// In the order of a report: over blocks, per pixel, FLIP.
static void check_errors(suite_reader *r, const cJSON *errors, const bench_suite *suite)
{
    if (cJSON_GetArraySize(errors) != BENCH_MEASURES) {
        suite_fault(r, "errors", "must be a list of three objects");
    }
    for (int i = 0; r->ok && i < BENCH_MEASURES; i++) {
        const cJSON *e = cJSON_GetArrayItem(errors, i);
        if (!is_block(suite, json_figure(e, "block"), i)) {
            suite_fault(r, "errors",
                        "must be over the blocks of the suite, per pixel (1) and FLIP (0)");
        } else if (!has_nan(errors) &&
                   !(json_figure(e, i == BENCH_BLOCKS ? "error" : "rel_l1") >= 0)) {
            suite_fault(r, "errors",
                        i == BENCH_BLOCKS ? "the last needs \"error\", from 0 on"
                                          : "the first two need \"rel_l1\", from 0 on");
        }
    }
}

static void check_run(suite_reader *r, const cJSON *run, const bench_suite *suite)
{
    if (!(json_figure(run, "spp") >= 1) || !(json_figure(run, "ms") > 0)) {
        suite_fault(r, "", "needs \"spp\", from 1 on, and \"ms\", above 0");
    }
    check_errors(r, list_of(run, "errors"), suite);
}

static void check_scenes(suite_reader *r, const cJSON *root, const bench_suite *suite)
{
    const uint32_t num = suite_list(r, root, "scenes", 1, BENCH_MAX_SCENES);
    for (uint32_t i = 0; r->ok && i < num; i++) {
        const cJSON *scene = suite_element(r, root, "scenes", i);
        suite_text(r, scene, "name", true);
        suite_text(r, list_of(scene, "reference"), "hash", true);
        const uint32_t runs = suite_list(r, scene, "runs", 1, BENCH_MAX_RUNS);
        for (uint32_t k = 0; r->ok && k < runs; k++) {
            snprintf(r->where, sizeof r->where, "scenes[%u].runs[%u]", i, k);
            check_run(r, cJSON_GetArrayItem(list_of(scene, "runs"), (int)k), suite);
        }
    }
    r->where[0] = '\0';
}

// A group is a line of error against time: that of a peer is of nothing else.
static void check_group(suite_reader *r, const bench_peer *peer, const bench_suite *suite)
{
    bool taken = false;
    for (uint32_t i = 0; r->ok && i < suite->num_runs; i++) {
        taken = taken || strcmp(suite->runs[i].group, peer->group) == 0;
    }
    for (uint32_t i = 0; r->ok && &suite->peers[i] != peer; i++) {
        taken = taken || strcmp(suite->peers[i].group, peer->group) == 0;
    }
    if (taken) {
        suite_fault(r, "group", "is that of a run or of another peer of the suite");
    }
}

bool peers_load(app *a, char *path, const bench_suite *suite, bench_peer *peer)
{
    void *data = NULL;
    size_t size = 0;
    *peer = (bench_peer){.file = path};
    if (tyn_file_read(path, 16u << 20, &data, &size, &a->log) != TYN_OK) {
        return false;
    }
    suite_reader r = {.a = a, .file = path, .ok = true};
    cJSON *root = peer->root = suite_parse(&r, data, size);
    free(data);
    if (r.ok && (strcmp(json_text(root, "schema"), "tyndall-peer") != 0 ||
                 json_figure(root, "version") != PEER_VERSION)) {
        suite_fault(&r, "", "is not a tyndall-peer of version 1");
    }
    if (r.ok) {
        peer->name = suite_text(&r, root, "name", true);
        peer->group = suite_text(&r, root, "group", true);
        check_scenes(&r, root, suite);
        check_group(&r, peer, suite);
    }
    return r.ok;
}

// ---- a scene ----------------------------------------------------------------------------------

// As those of a run of this library: the noise and the standard error of the bias are the reference's, which is the same.
static cJSON *json_error(const bench_case *c, const cJSON *measured, int i, bool known)
{
    static const char *const same[] = {"rel_l1", "rmse", "rel_rmse", "rel_mse",
                                       "smape",  "bias", "p95",      "nan"};
    const bench_reference *r = &c->reference;
    cJSON *error = cJSON_CreateObject();
    cJSON_AddNumberToObject(error, "block", c->blocks[i]);
    if (i == BENCH_BLOCKS) {
        json_add_float(error, "error", known ? json_figure(measured, "error") : NAN);
        json_add_float(error, "n", r->known_noise ? r->flip_noise : NAN);
        return error;
    }
    const double n = r->noise[i], rel_l1 = json_figure(measured, "rel_l1");
    const double value = known ? sqrt(fmax(0, rel_l1 * rel_l1 - n * n)) : NAN;
    json_add_float(error, "error", value);
    json_add_float(error, "n", r->known_noise ? n : NAN);
    json_add_float(error, "bias_se", r->known_noise ? r->bias_se : NAN);
    cJSON_AddBoolToObject(error, "vague", value < 2 * n);
    for (size_t k = 0; k < ARRAY_SIZE(same); k++) {
        json_add_float(error, same[k], json_figure(measured, same[k]));
    }
    return error;
}

// What is not known of it is null: nodes, memory, times of frames in which something else has changed.
static cJSON *json_run(const bench_case *c, const bench_peer *peer, const cJSON *measured)
{
    static const char *const unknown[] = {"key",       "preset",       "failed",  "setup_ms",
                                          "imbalance", "imbalance_se", "flicker", "picture"};
    cJSON *run = cJSON_CreateObject();
    const double spp = json_figure(measured, "spp");
    char *name = text_format("%s, %.0f spp", peer->name, spp);
    cJSON_AddStringToObject(run, "name", name ? name : "");
    free(name);
    cJSON_AddStringToObject(run, "method", peer->group);
    cJSON_AddStringToObject(run, "group", peer->group);
    cJSON_AddBoolToObject(run, "peer", true);
    cJSON_AddBoolToObject(run, "sampling", true);
    cJSON_AddBoolToObject(run, "baseline", false);
    cJSON_AddBoolToObject(run, "swept", true);
    cJSON_AddBoolToObject(run, "shown", false);
    cJSON_AddNumberToObject(cJSON_AddObjectToObject(run, "settings"), "spp", spp);
    cJSON *errors = cJSON_AddArrayToObject(run, "errors");
    for (int i = 0; i < BENCH_MEASURES; i++) {
        const cJSON *error = cJSON_GetArrayItem(list_of(measured, "errors"), i);
        cJSON_AddItemToArray(errors,
                             json_error(c, error, i, !has_nan(list_of(measured, "errors"))));
    }
    cJSON *frame = cJSON_AddObjectToObject(run, "frame_ms");
    cJSON *frames = cJSON_AddObjectToObject(run, "frames");
    for (int i = 0; i < NUM_TIMES; i++) {
        const bool light = i == TIME_LIGHT;
        json_add_float(frame, bench_time_names[i], light ? json_figure(measured, "ms") : NAN);
        cJSON_AddNumberToObject(frames, bench_time_names[i],
                                light ? fmax(1, json_figure(measured, "renderings")) : 0);
    }
    for (size_t i = 0; i < ARRAY_SIZE(unknown); i++) {
        cJSON_AddNullToObject(run, unknown[i]);
    }
    cJSON_AddArrayToObject(run, "nodes");
    cJSON_AddArrayToObject(run, "warnings");
    cJSON_AddStringToObject(run, "date", json_text(peer->root, "date"));
    cJSON_AddStringToObject(run, "device", json_text(peer->root, "device"));
    return run;
}

// A scene of a peer that is in no figure of the report, and why.
static void leave_out(const bench_peer *peer, const char *scene, const char *why, cJSON *left_out)
{
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "peer", peer->group);
    cJSON_AddStringToObject(entry, "name", peer->name);
    cJSON_AddStringToObject(entry, "scene", scene);
    cJSON_AddStringToObject(entry, "why", why);
    cJSON_AddItemToArray(left_out, entry);
}

// What a peer has measured in a scene; NULL: nothing, or not against this reference.
static const cJSON *find_scene(const bench_case *c, const bench_peer *peer, cJSON *left_out)
{
    const cJSON *scene;
    cJSON_ArrayForEach(scene, list_of(peer->root, "scenes"))
    {
        if (strcmp(json_text(scene, "name"), c->spec->name) != 0) {
            continue;
        }
        const bool same =
            strcmp(json_text(list_of(scene, "reference"), "hash"), c->reference.file_key) == 0;
        if (!same) {
            app_warn(c->a, "%s: '%s' is measured against another reference, and left out",
                     peer->file, c->spec->name);
            leave_out(peer, c->spec->name, "measured against another reference", left_out);
        }
        return same ? scene : NULL;
    }
    return NULL;
}

// What is said of a peer in a scene: how its mean agrees, and its times beside those of the baselines and of `pop`.
static cJSON *json_peer(const bench_case *c, const cJSON *runs, const bench_peer *peer,
                        const cJSON *scene)
{
    static const char *const figures[] = {"bias", "se", "reference_se", "renderings", "samples"};
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "peer", peer->group);
    cJSON_AddStringToObject(json, "name", peer->name);
    cJSON *mean = cJSON_AddObjectToObject(json, "mean");
    for (size_t i = 0; i < ARRAY_SIZE(figures); i++) {
        json_add_float(mean, figures[i], json_figure(list_of(scene, "mean"), figures[i]));
    }
    cJSON *list = cJSON_AddArrayToObject(json, "equal_error");
    for (int i = 0; i < BENCH_MEASURES; i++) {
        plane p;
        if (plane_make(&p, runs, i, c->blocks[i], TIME_LIGHT)) {
            plane_add_peer(&p, peer->group, list);
        }
        plane_finish(&p);
    }
    return json;
}

cJSON *peers_add(const bench_case *c, cJSON *runs, cJSON *left_out)
{
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i < c->suite->num_peers; i++) {
        const bench_peer *peer = &c->suite->peers[i];
        const cJSON *scene = find_scene(c, peer, left_out), *run;
        cJSON_ArrayForEach(run, list_of(scene, "runs"))
        {
            cJSON_AddItemToArray(runs, json_run(c, peer, run));
        }
        if (scene) {
            cJSON_AddItemToArray(list, json_peer(c, runs, peer, scene));
        }
    }
    return list;
}

void peers_unknown(app *a, const bench_suite *suite, cJSON *left_out)
{
    for (uint32_t i = 0; i < suite->num_peers; i++) {
        const bench_peer *peer = &suite->peers[i];
        const cJSON *scene;
        cJSON_ArrayForEach(scene, list_of(peer->root, "scenes"))
        {
            const char *name = json_text(scene, "name");
            bool known = false;
            for (uint32_t k = 0; k < suite->num_scenes; k++) {
                known = known || strcmp(suite->scenes[k].name, name) == 0;
            }
            if (!known) {
                app_warn(a, "%s: the suite has no scene '%s', which is left out", peer->file, name);
                leave_out(peer, name, "no scene of the suite", left_out);
            }
        }
    }
}
