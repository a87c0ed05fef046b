// distributions.c -- radiance by direction inside a cube, as polar plots: each method beside path tracing.
//
//     distributions FOLDER        writes FOLDER/distributions.svg and FOLDER/convergence.svg
//
// The setting of Figs 12 and 13 of Elek et al. 2014: a unit cube of sigma_s = 4 /m that absorbs nothing,
// in sunlight along an axis; the slice through its middle. What arrives at a point from one direction is
// the picture of an orthographic camera that stands there.
#include <tyndall/offline.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
    POINTS = 5,      // along each side of the slice
    DIRECTIONS = 48, // directions of travel in the slice's plane; the first is the sun's
    PIXELS = 8,      // along each side of a camera's picture, whose mean is taken
    SAMPLES = 256,
};

// radiance[row][column][direction], W/(m^2 sr) for a sun of 1 W/m^2.
typedef struct slice {
    double radiance[POINTS][POINTS][DIRECTIONS];
} slice;

// ---- rendering --------------------------------------------------------------------------------

static void make_cube(tyn_scene *scene, float g)
{
    tyn_scene_init(scene);
    scene->num_media = scene->num_shapes = scene->num_lights = 1;
    scene->media[0] = (tyn_medium){.sigma_s = {4, 4, 4},
                                   .phase = {{.g = g}, {.g = g}, {.g = g}},
                                   .density_scale = 1,
                                   .volume = -1};
    scene->shapes[0] =
        (tyn_shape){.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0.5f, 1}};
    scene->lights[0] = (tyn_light){.color = {1, 1, 1}, .direction = {1, 0, 0}};
}

// Sees what travels along (cos angle, sin angle, 0) through `position`.
static tyn_view view_against(double angle, const float position[3])
{
    const float c = (float)cos(angle), s = (float)sin(angle);
    tyn_view view = {.camera = {.projection = TYN_ORTHOGRAPHIC,
                                .position = {position[0], position[1], position[2]},
                                .right = {s, -c, 0},
                                .up = {0, 0, -1},
                                .back = {c, s, 0},
                                .ymag = 0.02f},
                     .width = PIXELS,
                     .height = PIXELS,
                     .num_samples = SAMPLES}; // of methods that sample
    const float *r = view.camera.right, *b = view.camera.back;
    for (int i = 0; i < 3; i++) { // up = back x right
        int j = (i + 1) % 3, k = (i + 2) % 3;
        view.camera.up[i] = b[j] * r[k] - b[k] * r[j];
    }
    return view;
}

static double mean_radiance(tyn_offline *off, const tyn_scene *scene, const tyn_view *view)
{
    if (tyn_offline_frame(off, scene, view, false) != TYN_OK) {
        fprintf(stderr, "distributions: a picture failed\n");
        exit(1);
    }
    const float *rgba = tyn_offline_output(off, TYN_OUTPUT_RADIANCE);
    double sum = 0;
    for (int i = 0; i < PIXELS * PIXELS; i++) {
        sum += (double)rgba[4 * i];
    }
    return sum / (PIXELS * PIXELS);
}

// The grids of `pop-paper` have 16^3 cells and take 16 iterations if `name` does not say otherwise. Half
// of the slice is rendered, the other half mirrors it. `name` may be NULL.
static slice *render(tyn_device *dev, const char *method, float g, const char *name,
                     const char *value)
{
    tyn_settings *settings;
    tyn_offline *off = NULL;
    tyn_scene *scene = malloc(sizeof *scene);
    slice *out = malloc(sizeof *out);
    if (!scene || !out || tyn_settings_create(&settings) != TYN_OK ||
        tyn_settings_set(settings, "propagate_rect.cells", "16", NULL) != TYN_OK ||
        tyn_settings_set(settings, "propagate_rect.iterations", "16", NULL) != TYN_OK ||
        (name && tyn_settings_set(settings, name, value, NULL) != TYN_OK) ||
        tyn_offline_create(dev, tyn_offline_params(.method = method, .settings = settings), &off) !=
            TYN_OK) {
        fprintf(stderr, "distributions: cannot start method %s\n", method);
        exit(1);
    }
    make_cube(scene, g);
    for (int row = 0; row <= POINTS / 2; row++) {
        for (int column = 0; column < POINTS; column++) {
            for (int d = 0; d < DIRECTIONS; d++) {
                const float position[3] = {((float)column + 0.5f) / POINTS,
                                           ((float)row + 0.5f) / POINTS, 0.5f};
                tyn_view view = view_against(2 * PI * d / DIRECTIONS, position);
                double value_here = mean_radiance(off, scene, &view);
                out->radiance[row][column][d] = value_here;
                out->radiance[POINTS - 1 - row][column][(DIRECTIONS - d) % DIRECTIONS] = value_here;
            }
        }
    }
    tyn_offline_destroy(&off);
    tyn_settings_destroy(&settings);
    tyn_scene_finish(scene);
    free(scene);
    return out;
}

// Sum of |a - b| over the sum of b.
static double rel_l1(const slice *a, const slice *b)
{
    const double *x = &a->radiance[0][0][0], *y = &b->radiance[0][0][0];
    double off = 0, sum = 0;
    for (int i = 0; i < POINTS * POINTS * DIRECTIONS; i++) {
        off += fabs(x[i] - y[i]);
        sum += y[i];
    }
    return off / sum;
}

// ---- drawing ----------------------------------------------------------------------------------

enum { PANEL = 260, MARGIN = 14, TITLE = 44, GAP = 16 };

// The distributions of a slice as closed curves. The radius is the cube root of the radiance, `full`
// that of half the distance between points.
static void draw_slice(FILE *file, const slice *s, double full, const char *style)
{
    fprintf(file, "<path %s d=\"", style);
    for (int row = 0; row < POINTS; row++) {
        for (int column = 0; column < POINTS; column++) {
            double pitch = (double)PANEL / POINTS;
            double x = (column + 0.5) * pitch, y = PANEL - (row + 0.5) * pitch;
            for (int d = 0; d < DIRECTIONS; d++) {
                double r = 0.5 * pitch * cbrt(fmax(s->radiance[row][column][d], 0) / full);
                double angle = 2 * PI * d / DIRECTIONS;
                fprintf(file, "%s%.1f %.1f",
                        d == 0   ? "M"
                        : d == 1 ? "L"
                                 : " ",
                        x + r * cos(angle), y - r * sin(angle));
            }
            fprintf(file, "z");
        }
    }
    fprintf(file, "\"/>\n");
}

static double largest(const slice *s)
{
    const double *x = &s->radiance[0][0][0];
    double top = 0;
    for (int i = 0; i < POINTS * POINTS * DIRECTIONS; i++) {
        top = fmax(top, x[i]);
    }
    return top;
}

static void draw_panel(FILE *file, int column, int row, const char *title, const slice *method,
                       const slice *path, const char *colour)
{
    char style[96];
    fprintf(file, "<g transform=\"translate(%d %d)\">\n", MARGIN + column * (PANEL + GAP),
            MARGIN + row * (PANEL + TITLE) + TITLE);
    fprintf(file, "<text y=\"-22\" font-weight=\"bold\">%s</text>\n", title);
    fprintf(file, "<text y=\"-7\" fill=\"#555\">differs from path by %.0f %%</text>\n",
            100 * rel_l1(method, path));
    fprintf(file, "<rect width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"#999\"/>\n", PANEL,
            PANEL);
    double full = largest(path);
    draw_slice(file, path, full, "fill=\"#ddd\" stroke=\"#888\" stroke-width=\"0.5\"");
    snprintf(style, sizeof style, "fill=\"none\" stroke=\"%s\" stroke-width=\"1.2\"", colour);
    draw_slice(file, method, full, style);
    fprintf(file, "</g>\n");
}

static FILE *open_figure(const char *folder, const char *name, int columns, int rows)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "distributions: cannot write %s\n", path);
        exit(1);
    }
    int width = 2 * MARGIN + columns * PANEL + (columns - 1) * GAP;
    int height = 2 * MARGIN + rows * (PANEL + TITLE) + 20;
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n",
            width, height, width, height, width, height);
    fprintf(file,
            "<text x=\"%d\" y=\"%d\">Sunlight enters from the left. Grey: path. Radius: cube "
            "root of the radiance that travels in that direction, without the sun's own.</text>\n",
            MARGIN, height - MARGIN);
    return file;
}

static const char *const colours[2] = {"#c0392b", "#1f5fa8"}; // pop-paper, pop

// Fig 12: three phase functions.
static void draw_distributions(tyn_device *dev, const char *folder)
{
    static const float gs[3] = {0.3f, 0.7f, 0.95f};
    static const char *const methods[2] = {"pop-paper", "pop"};
    FILE *file = open_figure(folder, "distributions.svg", 3, 2);
    for (int i = 0; i < 3; i++) {
        slice *path = render(dev, "path", gs[i], NULL, NULL);
        for (int m = 0; m < 2; m++) {
            slice *s = render(dev, methods[m], gs[i], NULL, NULL);
            char title[64];
            snprintf(title, sizeof title, "%s, g = %.2f", methods[m], (double)gs[i]);
            printf("%-24s rel_l1 %.3f\n", title, rel_l1(s, path));
            draw_panel(file, i, m, title, s, path, colours[m]);
            free(s);
        }
        free(path);
    }
    fprintf(file, "</svg>\n");
    fclose(file);
}

// Fig 13: more and more iterations at g = 0.7.
static void draw_convergence(tyn_device *dev, const char *folder)
{
    static const struct {
        const char *method, *setting, *word, *values[4];
    } rows[2] = {
        {"pop-paper", "propagate_rect.iterations", "iterations", {"4", "8", "16", "64"}},
        {"pop", "lattice.sweeps", "sweeps", {"1", "2", "4", "8"}},
    };
    FILE *file = open_figure(folder, "convergence.svg", 4, 2);
    slice *path = render(dev, "path", 0.7f, NULL, NULL);
    for (int m = 0; m < 2; m++) {
        for (int i = 0; i < 4; i++) {
            slice *s = render(dev, rows[m].method, 0.7f, rows[m].setting, rows[m].values[i]);
            char title[64];
            snprintf(title, sizeof title, "%s, %s %s", rows[m].method, rows[m].values[i],
                     strcmp(rows[m].values[i], "1") ? rows[m].word : "sweep");
            printf("%-24s rel_l1 %.3f\n", title, rel_l1(s, path));
            draw_panel(file, i, m, title, s, path, colours[m]);
            free(s);
        }
    }
    free(path);
    fprintf(file, "</svg>\n");
    fclose(file);
}

int main(int argc, char **argv)
{
    tyn_device *dev;
    if (argc != 2) {
        fprintf(stderr, "usage: distributions FOLDER\n");
        return 2;
    }
    if (tyn_device_open(tyn_device_open_params(.select = NULL), &dev) != TYN_OK) {
        fprintf(stderr, "distributions: no Vulkan device\n");
        return 1;
    }
    draw_distributions(dev, argv[1]);
    draw_convergence(dev, argv[1]);
    tyn_device_destroy(&dev);
    return 0;
}
