// info_grids.c -- every grid of the volume files that a scene is read from, whether it is read or not.
#include "info_scene.h"
#include "stats.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

enum { MAX_FILES = 64 };

struct info_grids {
    uint32_t num_files;
    bool failed;
    struct {
        char *path;
        tyn_volume_grid *grids;
        uint32_t count;
    } files[MAX_FILES];
};

static void found(void *user, const char *path)
{
    info_grids *all = user;
    for (uint32_t i = 0; i < all->num_files; i++) {
        if (strcmp(all->files[i].path, path) == 0) {
            return;
        }
    }
    if (!tyn_is_volume(path) || all->num_files == MAX_FILES || all->failed) {
        return;
    }
    tyn_volume_grid *grids;
    uint32_t count;
    if (tyn_volume_list(path, &grids, &count, NULL) != TYN_OK) {
        all->failed = true;
        return;
    }
    all->files[all->num_files].path = strdup(path);
    all->files[all->num_files].grids = grids;
    all->files[all->num_files++].count = count;
}

info_grids *info_grids_read(const char *scene, const uint32_t *frame)
{
    info_grids *all = calloc(1, sizeof *all);
    if (all) {
        tyn_scene_files(scene, frame, found, all, NULL);
    }
    return all;
}

void info_grids_free(info_grids *all)
{
    for (uint32_t i = 0; all && i < all->num_files; i++) {
        free(all->files[i].path);
        free(all->files[i].grids);
    }
    free(all);
}

bool info_grids_wanted(const char *scene, const info_grids *all)
{
    bool numbers = false;
    if (!all || all->failed || !tyn_is_volume(scene) || !all->num_files) {
        return false;
    }
    for (uint32_t i = 0; i < all->files[0].count; i++) {
        const tyn_volume_grid *g = &all->files[0].grids[i];
        const bool vector = strncmp(g->type, "vec", 3) == 0;
        numbers = numbers || (g->has_range && !vector && strcmp(g->grid_class, "level set") != 0);
    }
    return numbers;
}

bool info_grids_failed(const info_grids *all)
{
    return all && all->failed;
}

static void print_grid(const tyn_volume_grid *g)
{
    printf("  grid '%s': %s, %s, ", g->name, g->type, g->grid_class);
    if (!g->active_voxels) {
        printf("no active voxels\n");
        return;
    }
    printf("%llu active voxels", (unsigned long long)g->active_voxels);
    if (g->has_range) {
        printf(", values %.6g to %.6g", g->least, g->most);
    }
    printf("\n    box %d %d %d to %d %d %d (%lldx%lldx%lld)", g->lo[0], g->lo[1], g->lo[2],
           g->hi[0], g->hi[1], g->hi[2], (long long)g->hi[0] - g->lo[0] + 1,
           (long long)g->hi[1] - g->lo[1] + 1, (long long)g->hi[2] - g->lo[2] + 1);
    if (!g->affine) {
        printf(", no affine transform\n");
        return;
    }
    const double *edge = g->voxel, near = 1e-6 * edge[0];
    if (fabs(edge[1] - edge[0]) <= near && fabs(edge[2] - edge[0]) <= near) {
        printf(", voxels of %.6g", g->voxel[0]);
    } else {
        printf(", voxels of %.6g x %.6g x %.6g", g->voxel[0], g->voxel[1], g->voxel[2]);
    }
    printf("; in the world");
    for (int i = 0; i < 6; i++) { // rounding of the transform is no place
        const double v = i < 3 ? g->world_lo[i] : g->world_hi[i - 3];
        printf("%s %.6g", i == 3 ? " to" : "", fabs(v) < 1e-9 * edge[i % 3] ? 0 : v);
    }
    printf("\n");
}

void info_grids_print(const info_grids *all)
{
    for (uint32_t i = 0; i < all->num_files; i++) {
        const uint32_t count = all->files[i].count;
        printf("file '%s': %u grid%s\n", all->files[i].path, count, count == 1 ? "" : "s");
        for (uint32_t k = 0; k < count; k++) {
            print_grid(&all->files[i].grids[k]);
        }
    }
}

static void add_doubles(cJSON *object, const char *name, const double *values, int count)
{
    cJSON_AddItemToObject(object, name, cJSON_CreateDoubleArray(values, count));
}

static cJSON *json_grid(const tyn_volume_grid *g)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "name", g->name);
    cJSON_AddStringToObject(json, "type", g->type);
    cJSON_AddStringToObject(json, "class", g->grid_class);
    cJSON_AddNumberToObject(json, "active_voxels", (double)g->active_voxels);
    if (g->active_voxels) {
        cJSON_AddItemToObject(json, "index_min", cJSON_CreateIntArray(g->lo, 3));
        cJSON_AddItemToObject(json, "index_max", cJSON_CreateIntArray(g->hi, 3));
        if (g->affine) {
            add_doubles(json, "world_min", g->world_lo, 3);
            add_doubles(json, "world_max", g->world_hi, 3);
        }
        if (g->has_range) {
            json_add_float(json, "least", g->least);
            json_add_float(json, "most", g->most);
        }
    }
    if (g->affine) {
        add_doubles(json, "voxel", g->voxel, 3);
        add_doubles(json, "index_to_world", g->index_to_world, 16);
    }
    return json;
}

void info_grids_json(const info_grids *all, cJSON *root)
{
    cJSON *files = cJSON_AddArrayToObject(root, "files");
    for (uint32_t i = 0; i < all->num_files; i++) {
        cJSON *file = cJSON_CreateObject();
        cJSON_AddStringToObject(file, "path", all->files[i].path);
        cJSON *grids = cJSON_AddArrayToObject(file, "grids");
        for (uint32_t k = 0; k < all->files[i].count; k++) {
            cJSON_AddItemToArray(grids, json_grid(&all->files[i].grids[k]));
        }
        cJSON_AddItemToArray(files, file);
    }
}
