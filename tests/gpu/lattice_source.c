// lattice_source.c -- unscattered sunlight in cells of a homogeneous medium, against integrals over the cells.
#include "bound.h"
#include "gpu_test.h"
#include "homogeneous.h"
#include "shaders/lattice/lattice_power.h"
#include "passes/lattice_source/lattice_source.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "numbers.h"

enum { CELLS = 8, NX = 8, NY = 6, NZ = 4, N = NX * NY * NZ, SUNS = 2 };

typedef struct setup {
    struct medium_block medium;
    struct light_block lights[TYN_LIGHTS_MAX];
    tyn_lattice_source_params params;
    bool shadows;
    float scaled[3]; // (1 - f) sigma_s
} setup;

static setup start(float thickness)
{
    setup s = {
        .params = {
            .shape = {.extent = {2, 1.5f, 1}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}},
            .num_suns = SUNS}};
    s.medium.max_density = 1;
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.medium.voxel[i] = s.params.shape.extent[i];
        s.medium.size[i] = 1;
        s.medium.sigma_s[i] = thickness * (1 + (float)i);
        s.medium.sigma_a[i] = thickness * 0.5f;
        s.medium.phase[i].g = 0.6f;
        s.scaled[i] = 0.64f * s.medium.sigma_s[i];
    }
    s.lights[0] = (struct light_block){.color = {3, 2, 1}, .direction = {0.48f, 0.36f, -0.8f}};
    s.lights[1] = (struct light_block){.color = {0.5f, 1, 2}, .direction = {-1, 0, 0}};
    s.lights[0].mean_cosine = 1;
    s.lights[1].mean_cosine = 0.9f;
    return s;
}

static double extinction(const setup *s, int channel)
{
    return (double)(s->scaled[channel] + s->medium.sigma_a[channel]);
}

static const float (*found)[4];
static const struct lattice_power *power;

static void run(gpu_test *t, const setup *s)
{
    const tyn_pass_desc *pass = &tyn_pass_lattice_source;
    const int channels = (int)s->params.shape.channels;
    static float cells[3 * N][4];
    for (int i = 0; i < channels * N; i++) {
        cells[i][0] = s->scaled[i / N];
        cells[i][1] = s->medium.sigma_a[i / N];
        cells[i][2] = s->medium.phase[i / N].g / (1 + s->medium.phase[i / N].g);
    }
    struct beam_block beams[TYN_BEAM_MAX_SUNS] = {{.light = 0}};
    for (uint32_t n = 0; n < SUNS; n++) {
        homogeneous_beam(&beams[n], s->medium.extent, s->lights[n].direction, n);
    }
    static const float one = 1;
    const tyn_extent texel = {1, 1, 1};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s->medium, sizeof s->medium);
    *gpu_port(pass, refs, "lights") = gpu_buffer(t, "lights", s->lights, sizeof s->lights);
    *gpu_port(pass, refs, "cells") = gpu_image(
        t, "cells", TYN_IMAGE_3D, (tyn_extent){NX, NY, NZ * (uint32_t)channels}, 4, cells[0]);
    *gpu_port(pass, refs, "density") = gpu_image(t, "density", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "beams") = gpu_buffer(t, "beams", beams, sizeof beams);
    *gpu_port(pass, refs, "column") = gpu_image(t, "column", TYN_IMAGE_3D, texel, 1, &one);
    if (s->shadows) { // the second sun's map, over y and z: what hides y > 0.75 is at x = 1
        enum { MAP = 64 };
        struct shadow_light maps[TYN_SHADOW_MAX] = {{.kind = TYN_SHADOW_NONE}};
        maps[1] = (struct shadow_light){
            .rows = {{0, 1, 0, -0.75f}, {0, 0, 1, -0.5f}, {0.25f, 0, 0, 0.25f}},
            .texels = MAP,
            .kind = TYN_SHADOW_SUN};
        static float atlas[MAP][MAP];
        for (int i = 0; i < MAP * MAP; i++) {
            atlas[i / MAP][i % MAP] = i % MAP >= MAP / 2 ? 0.5f : 0;
        }
        *gpu_port(pass, refs, "shadow_atlas") =
            gpu_image(t, "atlas", TYN_IMAGE_2D, (tyn_extent){MAP, MAP, 1}, 1, atlas[0]);
        *gpu_port(pass, refs, "shadows") = gpu_buffer(t, "shadows", maps, sizeof maps);
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s->params, refs), TYN_OK);
    tyn_graph_output(t->graph, "source", *gpu_port(pass, refs, "source"), true);
    tyn_graph_output(t->graph, "power", *gpu_port(pass, refs, "power"), true);
    gpu_run(t);
    found = (const float(*)[4])gpu_map(t, "source");
    power = gpu_map(t, "power");
}

// Mean transmittance to a cell: pieces, with the mean along the light in closed form.
static double transmittance(const setup *s, uint32_t sun, int channel, const int c[3])
{
    enum { SIDE = 20 };
    const float *d = s->lights[sun].direction;
    const double dx = 2.0 / CELLS, sigma = extinction(s, channel);
    double sum = 0;
    for (int k = 0; k < SIDE * SIDE * SIDE; k++) {
        const int part[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
        double p[3], far[3];
        for (int i = 0; i < 3; i++) {
            p[i] = dx * (c[i] + (part[i] + 0.5) / SIDE);
            far[i] = p[i] - 100 * (double)d[i];
        }
        sum += exp(-sigma * homogeneous_length(s->medium.extent, p, far));
    }
    return sum / (SIDE * SIDE * SIDE);
}

// What a beam of irradiance 1 loses, W: integral over the faces where it enters.
static double lost(const setup *s, uint32_t sun, int channel, double *entering)
{
    enum { SIDE = 300 };
    const float *d = s->lights[sun].direction, *extent = s->medium.extent;
    double sum = 0;
    *entering = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double area = (double)(extent[u] * extent[v] * fabsf(d[axis])) / (SIDE * SIDE);
        for (int k = 0; k < SIDE * SIDE && area > 0; k++) {
            double p[3], far[3];
            p[axis] = d[axis] > 0 ? 0 : (double)extent[axis];
            p[u] = (double)extent[u] * (k % SIDE + 0.5) / SIDE;
            p[v] = (double)extent[v] * (k / SIDE + 0.5) / SIDE;
            for (int i = 0; i < 3; i++) {
                far[i] = p[i] + 100 * (double)d[i];
            }
            sum += area * (1 - exp(-extinction(s, channel) * homogeneous_length(extent, p, far)));
            *entering += area;
        }
    }
    return sum;
}

// Of each sun fluence E T', and flux along it.
static double compare(const setup *s)
{
    const int channels = (int)s->params.shape.channels;
    double worst = 0;
    for (int i = 0; i < channels * N; i++) {
        const int n = i % N, ch = i / N, c[3] = {n % NX, n / NX % NY, n / NX / NY};
        double right[4] = {0}, most = 0;
        for (uint32_t sun = 0; sun < SUNS; sun++) {
            const struct light_block *l = &s->lights[sun];
            const float *tint = s->params.shape.tint;
            double e = (double)l->color[ch];
            if (channels == 1) { // colours are multiples of the tint
                e = (double)(l->color[0] / tint[0]);
            }
            const bool dark = s->shadows && sun == 1 && c[1] >= NY / 2 && c[0] < NX / 2;
            const double light = dark ? 0 : e * transmittance(s, sun, ch, c);
            most += e * transmittance(s, sun, ch, c);
            right[0] += light;
            for (int a = 0; a < 3; a++) {
                right[1 + a] += light * (double)(l->mean_cosine * l->direction[a]);
            }
        }
        for (int k = 0; k < 4; k++) {
            worst = maximum(worst, fabs((double)found[i][k] - right[k]) / most);
        }
    }
    print_message("cells within %.1e of their light\n", worst);
    return worst;
}

static void light_in_cells(void **state)
{
    const float thickness[] = {0.3f, 1, 3};
    const double tolerance[] = {0.005, 0.035, 0.15};
    for (int i = 0; i < 3; i++) {
        setup s = start(thickness[i]);
        run(*state, &s);
        assert_true(within(compare(&s), tolerance[i], NULL, "thickness %g", (double)thickness[i]));
        for (uint32_t k = 0; k < SUNS * 3; k++) {
            double entering, right = lost(&s, k / 3, (int)k % 3, &entering);
            assert_true(fabs((double)power[k].entering / entering - 1) < 1e-5);
            // The faces that light enters aslant are looked at in 2 x 2 places a cell.
            const double off = fabs((double)power[k].lost / right - 1);
            assert_true(k < 3 ? within(off, 0.015, NULL, "lost, aslant") : off < 1e-4);
            assert_true(fabs((double)(power[k].collided / power[k].lost) - 1) < 1e-4);
        }
    }
}

// Where half a piece of a cell has a depth below 0.01 and next to nothing is before it.
static void thin(void **state)
{
    const float thickness[] = {0.05f, 1e-3f};
    for (int i = 0; i < 2; i++) {
        setup s = start(thickness[i]);
        run(*state, &s);
        // What is left is of what the oblique sun is said to lose, to which its cells are scaled.
        assert_true(within(compare(&s), 0.005, NULL, "thickness %g", (double)thickness[i]));
    }
}

static void one_channel(void **state)
{
    setup s = start(1);
    const float tint[3] = {0.25f, 0.5f, 1};
    s.params.shape.channels = 1;
    memcpy(s.params.shape.tint, tint, sizeof tint);
    for (int c = 0; c < 3; c++) {
        s.medium.sigma_s[c] = s.medium.sigma_s[0];
        s.scaled[c] = s.scaled[0];
        s.lights[0].color[c] = 3 * tint[c];
        s.lights[1].color[c] = 2 * tint[c];
    }
    run(*state, &s);
    assert_within(compare(&s), 0.02, NULL);
}

// Cells behind what casts a shadow are dark; what a beam loses is not asked of shadows.
static void shadows(void **state)
{
    setup s = start(0.3f);
    run(*state, &s);
    struct lattice_power before[SUNS * 3];
    memcpy(before, power, sizeof before);
    s.shadows = true;
    run(*state, &s);
    assert_within(compare(&s), 0.005, NULL);
    assert_memory_equal(before, power, sizeof before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_in_cells),
        cmocka_unit_test(thin),
        cmocka_unit_test(one_channel),
        cmocka_unit_test(shadows),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
