// stress_scenes.c -- scenes of the stress suite, made in memory, and the half-space's answer.
#include "stress_cases.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const float stress_sun[3] = {0.48f, -0.8f, -0.36f};

// ---- densities --------------------------------------------------------------------------------

// Uniform in [0, 1), of an index (PCG's output function).
static double random_of(uint32_t i)
{
    uint32_t state = i * 747796405u + 2891336453u;
    uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (double)((word >> 22) ^ word) / 4294967296.0;
}

static double shell_of(const uint32_t at[3], const uint32_t size[3])
{
    double r2 = 0;
    for (int a = 0; a < 3; a++) {
        double d = at[a] + 0.5 - 0.5 * size[a];
        r2 += d * d;
    }
    double r = sqrt(r2), outer = 0.45 * size[0];
    return r < outer && r > outer - 2 ? 1 : 0;
}

static double density_of(const stress_case *c, const uint32_t at[3], uint32_t index)
{
    double contrast = c->contrast, wave = 1;
    switch (c->pattern) {
    case STRESS_WAVES:
        for (int a = 0; a < 3; a++) {
            wave *= cos(2 * M_PI * (1 + a) * (at[a] + 0.5) / c->size[a]);
        }
        return 1 + 0.8 * wave;
    case STRESS_CHECKERS:
        return (at[0] / 4 + at[1] / 4 + at[2] / 4) & 1 ? 1 : contrast;
    case STRESS_VOXEL:
        return at[0] == c->size[0] / 2 && at[1] == c->size[1] / 2 && at[2] == c->size[2] / 2
                   ? 1
                   : contrast;
    case STRESS_HALF:
        return at[1] < c->size[1] / 2 ? 1 : contrast;
    case STRESS_DECADES:
        return pow(contrast, random_of(index));
    case STRESS_SHELL:
        return shell_of(at, c->size);
    default:
        return 1;
    }
}

static bool add_grid(const stress_case *c, tyn_scene *scene)
{
    const size_t voxels = (size_t)c->size[0] * c->size[1] * c->size[2];
    tyn_volume *volume = calloc(1, sizeof *volume);
    float *data = malloc(voxels * sizeof *data);
    if (!volume || !data) {
        free(volume);
        free(data);
        return false;
    }
    const double unit = c->unit > 0 ? c->unit : 1;
    uint32_t i = 0, at[3];
    for (at[2] = 0; at[2] < c->size[2]; at[2]++) {
        for (at[1] = 0; at[1] < c->size[1]; at[1]++) {
            for (at[0] = 0; at[0] < c->size[0]; at[0]++, i++) {
                data[i] = (float)(unit * density_of(c, at, i));
                volume->max_density = fmaxf(volume->max_density, data[i]);
            }
        }
    }
    memcpy(volume->size, c->size, sizeof volume->size);
    volume->data = data;
    scene->volumes = volume;
    scene->num_volumes = 1;
    scene->media[0].volume = 0;
    scene->media[0].density_scale = (float)(1 / unit);
    return true;
}

// ---- scenes -----------------------------------------------------------------------------------

static void sides_of(const stress_case *c, float sides[3])
{
    for (int a = 0; a < 3; a++) {
        sides[a] = c->sides[a] > 0 ? c->sides[a] : 1;
    }
}

static void add_box(const stress_case *c, tyn_scene *scene)
{
    float sides[3];
    sides_of(c, sides);
    tyn_shape *shape = &scene->shapes[scene->num_shapes++];
    *shape = (tyn_shape){.kind = TYN_SHAPE_BOX, .to_world = {[15] = 1}};
    for (int a = 0; a < 3; a++) {
        shape->to_world[5 * a] = sides[a];
        shape->to_world[12 + a] = c->offset;
    }
}

static void set_medium(const stress_case *c, tyn_medium *medium)
{
    *medium = (tyn_medium){.density_scale = 1, .volume = -1};
    for (int k = 0; k < 3; k++) {
        float sigma = c->sigma * (c->coloured ? powf(1000, (float)k - 1) : 1);
        medium->sigma_s[k] = sigma * c->albedo;
        medium->sigma_a[k] = c->albedo < 1 ? sigma * (1 - c->albedo) : 0;
        medium->phase[k].g = c->g;
    }
}

// A lamp as bright at the box as the sun.
static void add_light(const stress_case *c, tyn_scene *scene)
{
    if (c->light == STRESS_AROUND) {
        scene->environment =
            (tyn_environment){.present = true, .radiance = {1, 1, 1}, .strength = 1};
        return;
    }
    float sides[3];
    sides_of(c, sides);
    tyn_light *light = &scene->lights[scene->num_lights++];
    *light = (tyn_light){.kind = TYN_LIGHT_DIRECTIONAL, .color = {1, 1, 1}};
    memcpy(light->direction, stress_sun, sizeof stress_sun);
    if (c->light == STRESS_LAMP) {
        light->kind = TYN_LIGHT_POINT;
        for (int a = 0; a < 3; a++) {
            light->position[a] = c->offset + (a == 0 ? -0.6f : 0.6f) * sides[a];
            light->color[a] = sides[0] * sides[0];
        }
    }
}

bool stress_scene(const stress_case *c, tyn_scene *scene)
{
    tyn_scene_init(scene);
    scene->num_media = 1;
    set_medium(c, &scene->media[0]);
    add_box(c, scene);
    add_light(c, scene);
    if (c->pattern == STRESS_TWO_MEDIA) {
        scene->num_media = 2;
        set_medium(c, &scene->media[1]);
        for (int k = 0; k < 3; k++) {
            scene->media[1].sigma_s[k] *= c->contrast;
            scene->media[1].sigma_a[k] *= c->contrast;
            scene->media[1].phase[k].g *= 0.5f;
        }
        add_box(c, scene);
        scene->shapes[1].medium = 1;
        for (int a = 0; a < 3; a++) { // the upper front corner, and over it
            scene->shapes[1].to_world[5 * a] *= 0.6f;
            scene->shapes[1].to_world[12 + a] += 0.3f * scene->shapes[1].to_world[5 * a];
        }
        return true;
    }
    return c->pattern == STRESS_HOMOGENEOUS || add_grid(c, scene);
}

// Obliquely from above; on the middle of the upper face where the answer is that of a half-space.
void stress_view(const stress_case *c, tyn_view *view)
{
    float sides[3], at[3], from[3];
    sides_of(c, sides);
    const float longest = fmaxf(sides[0], fmaxf(sides[1], sides[2]));
    const bool above = c->answer == STRESS_BY_TABLE;
    const float toward[3] = {above ? 0 : -0.5f, above ? -1 : -0.7f, above ? 0 : -0.4f};
    for (int a = 0; a < 3; a++) {
        at[a] = c->offset;
        from[a] = at[a] - 3 * longest * toward[a];
    }
    *view = (tyn_view){.width = STRESS_SIZE, .height = STRESS_SIZE, .no_background = true};
    view->no_background = c->answer != STRESS_BY_FURNACE;
    view->camera = (tyn_camera){
        .projection = TYN_ORTHOGRAPHIC, .ymag = (above ? 0.2f : 0.75f) * longest, .aspect = 1};
    tyn_camera_look_at(&view->camera, from, at);
}

// ---- the half-space ---------------------------------------------------------------------------

enum { NODES = 64 };

// Gauss-Legendre on [0, 1]: Newton's method from Chebyshev's points.
static void gauss(double x[NODES], double w[NODES])
{
    for (int i = 0; i < NODES; i++) {
        double z = cos(M_PI * (i + 0.75) / (NODES + 0.5)), slope = 0;
        for (int k = 0; k < 20; k++) {
            double p0 = 1, p1 = z;
            for (int n = 2; n <= NODES; n++) {
                double p2 = ((2 * n - 1) * z * p1 - (n - 1) * p0) / n;
                p0 = p1;
                p1 = p2;
            }
            slope = NODES * (z * p1 - p0) / (z * z - 1);
            z -= p1 / slope;
        }
        x[i] = 0.5 * (1 + z);
        w[i] = 1 / ((1 - z * z) * slope * slope);
    }
}

// 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 int mu' H(mu') / (mu + mu') dmu'
static double next_h(double albedo, double mu, const double x[NODES], const double w[NODES],
                     const double h[NODES])
{
    double sum = 0;
    for (int i = 0; i < NODES; i++) {
        sum += w[i] * x[i] * h[i] / (mu + x[i]);
    }
    return 1 / (sqrt(1 - albedo) + 0.5 * albedo * sum);
}

double stress_half_space(double albedo, double mu, double mu0)
{
    double x[NODES], w[NODES], h[NODES], next[NODES];
    gauss(x, w);
    for (int i = 0; i < NODES; i++) {
        h[i] = 1;
    }
    for (int k = 0; k < 400; k++) {
        for (int i = 0; i < NODES; i++) {
            next[i] = next_h(albedo, x[i], x, w, h);
        }
        for (int i = 0; i < NODES; i++) { // the plain iteration swings about its limit
            h[i] = 0.5 * (h[i] + next[i]);
        }
    }
    const double both = next_h(albedo, mu, x, w, h) * next_h(albedo, mu0, x, w, h);
    return albedo / (4 * M_PI) * mu0 / (mu + mu0) * both;
}
