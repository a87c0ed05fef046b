// wisps.c -- volumes of thin curls of smoke with many holes, of the sizes of Table 1 of Navarro et al. 2008, as scenes.
//
// usage: wisps X Y Z COVER FILE.gltf
// X x Y x Z voxels (the longest side is 1 m) of curls, as many as cover the share COVER of the face along z; beside FILE.gltf
// its densities, FILE.raw. The camera sees the box on half of a square picture. The same bytes on every machine.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint32_t seed = 20;

static double random_unit(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) * 0x1p-24;
}

typedef struct grid {
    int size[3];
    uint8_t *voxels;
    uint8_t *seen; // of the face along z
    size_t covered;
} grid;

// A ball of smoke that is thinner outside.
static void puff(grid *g, const double at[3], double radius)
{
    int lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = (int)fmax(ceil(at[a] - radius), 0);
        hi[a] = (int)fmin(floor(at[a] + radius), g->size[a] - 1);
    }
    for (int z = lo[2]; z <= hi[2]; z++) {
        for (int y = lo[1]; y <= hi[1]; y++) {
            for (int x = lo[0]; x <= hi[0]; x++) {
                const double d[3] = {x - at[0], y - at[1], z - at[2]};
                const double r2 = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / (radius * radius);
                const int value = r2 < 1 ? (int)(255 * (1 - r2)) : 0;
                uint8_t *v = &g->voxels[((size_t)z * g->size[1] + y) * g->size[0] + x];
                *v = value > *v ? (uint8_t)value : *v;
                uint8_t *s = &g->seen[(size_t)y * g->size[0] + x];
                g->covered += value > 0 && !*s;
                *s = *s || value > 0;
            }
        }
    }
}

// A thread of smoke from a random place on, that bends at random.
static void curl(grid *g, size_t wanted)
{
    double at[3], way[3];
    for (int a = 0; a < 3; a++) {
        at[a] = g->size[a] * (0.1 + 0.8 * random_unit());
        way[a] = random_unit() - 0.5;
    }
    const double radius = 2 + 3 * random_unit();
    for (int step = 0; step < 300 && g->covered < wanted; step++) {
        puff(g, at, radius * (1 + 0.3 * sin(0.1 * step)));
        double length = 0;
        for (int a = 0; a < 3; a++) {
            way[a] += 0.25 * (random_unit() - 0.5);
            length += way[a] * way[a];
        }
        for (int a = 0; a < 3; a++) {
            way[a] /= sqrt(length);
            at[a] += way[a];
            way[a] = at[a] < 6 || at[a] > g->size[a] - 7 ? -way[a] : way[a];
        }
    }
}

static int write_scene(const grid *g, const char *path, const char *raw)
{
    const char *base = strrchr(raw, '/');
    const double most = fmax(g->size[0], fmax(g->size[1], g->size[2]));
    const double side[3] = {g->size[0] / most, g->size[1] / most, g->size[2] / most};
    // From 2.5 m before the face, which is the square root of half of the picture's height.
    const double yfov = 2 * atan(0.5 * side[1] / sqrt(0.5) / 2.5);
    FILE *f = fopen(path, "wb");
    if (!f) {
        return 1;
    }
    fprintf(f,
            "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": "
            "[\"TYN_participating_media\"],\n"
            "\"extensions\": {\"TYN_participating_media\": {\"media\": [{\"name\": \"wisps\",\n"
            " \"scattering\": [40, 40, 40], \"absorption\": [4, 4, 4], \"anisotropy\": 0,\n"
            " \"density\": {\"uri\": \"%s\", \"size\": [%d, %d, %d], \"type\": \"u8\"}}]}},\n"
            "\"cameras\": [{\"name\": \"view\", \"type\": \"perspective\", \"perspective\": "
            "{\"aspectRatio\": 1, \"yfov\": %.9g, \"znear\": 0.01}}],\n"
            "\"nodes\": [{\"name\": \"wisps\", \"scale\": [%.9g, %.9g, %.9g], \"extensions\": "
            "{\"TYN_participating_media\": {\"medium\": 0, \"shape\": \"box\"}}},\n"
            " {\"name\": \"view\", \"camera\": 0, \"translation\": [0, 0, %.9g]}],\n"
            "\"scene\": 0, \"scenes\": [{\"nodes\": [0, 1]}]}\n",
            base ? base + 1 : raw, g->size[0], g->size[1], g->size[2], yfov, side[0], side[1],
            side[2], 2.5 + 0.5 * side[2]);
    return fclose(f) != 0;
}

int main(int argc, char **argv)
{
    if (argc != 6) {
        return fprintf(stderr, "usage: %s X Y Z COVER FILE.gltf\n", argv[0]), 2;
    }
    grid g = {.size = {atoi(argv[1]), atoi(argv[2]), atoi(argv[3])}};
    const double cover = atof(argv[4]);
    for (int a = 0; a < 3; a++) {
        if (g.size[a] < 16 || g.size[a] > 1024) {
            return fprintf(stderr, "%s voxels: 16 to 1024 along a side\n", argv[1 + a]), 2;
        }
    }
    if (!(cover > 0 && cover < 0.95)) {
        return fprintf(stderr, "COVER is %s: more than 0 and less than 0.95\n", argv[4]), 2;
    }
    const size_t face = (size_t)g.size[0] * g.size[1], count = face * g.size[2];
    g.voxels = calloc(count, 1);
    g.seen = calloc(face, 1);
    char raw[4096];
    snprintf(raw, sizeof raw, "%s", argv[5]);
    char *dot = strrchr(raw, '.');
    snprintf(dot ? dot : raw + strlen(raw), 5, ".raw");
    if (!g.voxels || !g.seen) {
        return fprintf(stderr, "no memory for %zu voxels\n", count), 1;
    }
    const size_t wanted = (size_t)(cover * face);
    while (g.covered < wanted) {
        curl(&g, wanted);
    }
    size_t filled = 0;
    for (size_t i = 0; i < count; i++) {
        filled += g.voxels[i] > 0;
    }
    FILE *f = fopen(raw, "wb");
    if (!f || fwrite(g.voxels, 1, count, f) != count || fclose(f) != 0 ||
        write_scene(&g, argv[5], raw)) {
        return fprintf(stderr, "%s: cannot be written\n", argv[5]), 1;
    }
    printf("%s: %.1f %% of its voxels are not empty, %.1f %% of its face\n", argv[5],
           100.0 * filled / count, 100.0 * g.covered / face);
    free(g.voxels);
    free(g.seen);
    return 0;
}
