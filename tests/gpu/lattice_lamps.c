// lattice_lamps.c -- unscattered light of lamps and virtual lights in cells of a homogeneous medium, against integrals
// over the cells.
#include "bound.h"
#include "gpu_test.h"
#include "homogeneous.h"
#include "shaders/lattice/lattice_power.h"
#include "passes/lattice_lamps/lattice_lamps.h"
#include "shaders/common/scene_args.h"
#include "shaders/light/shadow_args.h"
#include "numbers.h"
#include <stdlib.h>

enum { CELLS = 8, NX = 8, NY = 6, NZ = 4, N = NX * NY * NZ };

static const double pi = 3.14159265358979;

typedef struct setup {
    struct medium_block medium;
    struct radial_block radials;
    tyn_lattice_lamps_params params;
    float scaled[3]; // (1 - f) sigma_s
    bool others, shadows;
} setup;

static setup s; // large

static void start(float thickness)
{
    memset(&s, 0, sizeof s);
    s.params.shape = (tyn_lattice_shape){
        .extent = {2, 1.5f, 1}, .cells = CELLS, .channels = 3, .tint = {1, 1, 1}};
    s.medium.max_density = 1;
    for (int i = 0; i < 3; i++) {
        s.medium.extent[i] = s.medium.voxel[i] = s.params.shape.extent[i];
        s.medium.size[i] = 1;
        s.medium.sigma_s[i] = thickness * (1 + (float)i);
        s.medium.sigma_a[i] = thickness * 0.5f;
        s.medium.phase[i].g = 0.6f;
        s.scaled[i] = 0.64f * s.medium.sigma_s[i];
    }
}

static struct light_block *add_light(float x, float y, float z, float r, float g, float b)
{
    struct light_block light = {.position = {x, y, z},
                                .kind = TYN_LIGHT_KIND_POINT,
                                .color = {r, g, b},
                                .direction = {0, 0, -1},
                                .shadow = TYN_LIGHT_NO_SHADOW};
    struct radial_grid *grid = &s.radials.list[s.radials.count++];
    homogeneous_radial(grid, s.medium.extent, &light);
    return &grid->light;
}

static void add_lamp(float x, float y, float z, float r, float g, float b)
{
    add_light(x, y, z, r, g, b);
    s.radials.num_lamps = ++s.params.num_lamps;
}

static double extinction(int channel)
{
    return (double)(s.scaled[channel] + s.medium.sigma_a[channel]);
}

static const float (*found)[4], (*of_vpls)[4];
static const struct lattice_lamp_power *power;
static float others[3 * N][4];

static void run(gpu_test *t)
{
    const tyn_pass_desc *pass = &tyn_pass_lattice_lamps;
    const uint32_t channels = s.params.shape.channels;
    static float cells[3 * N][4];
    for (uint32_t i = 0; i < channels * N; i++) {
        cells[i][0] = s.scaled[i / N];
        cells[i][1] = s.medium.sigma_a[i / N];
        for (int k = 0; k < 4; k++) {
            others[i][k] = s.others ? (float)(i % 13) - 2 * (float)k : 0;
        }
    }
    static const float one = 1;
    const tyn_extent texel = {1, 1, 1}, size = {NX, NY, NZ * channels};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "medium") = gpu_buffer(t, "medium", &s.medium, sizeof s.medium);
    *gpu_port(pass, refs, "cells") = gpu_image(t, "cells", TYN_IMAGE_3D, size, 4, cells[0]);
    *gpu_port(pass, refs, "density") = gpu_image(t, "density", TYN_IMAGE_3D, texel, 1, &one);
    *gpu_port(pass, refs, "radials") = gpu_buffer(t, "radials", &s.radials, sizeof s.radials);
    *gpu_port(pass, refs, "radial_column") = gpu_image(t, "column", TYN_IMAGE_3D, texel, 1, &one);
    if (s.others) {
        *gpu_port(pass, refs, "others") = gpu_image(t, "others", TYN_IMAGE_3D, size, 4, others[0]);
    }
    if (s.shadows) { // of lamp 0, which looks along +x: what is at its left, 0.1 m off, hides the rest
        enum { MAP = 64 };
        struct shadow_light maps[TYN_SHADOW_MAX] = {{.kind = TYN_SHADOW_NONE}};
        maps[TYN_SHADOW_LAMP(0)] =
            (struct shadow_light){.rows = {{0, 1, 0, -0.75f}, {0, 0, 1, -0.5f}, {1, 0, 0, 1}},
                                  .texels = MAP,
                                  .scale = 1,
                                  .near = 0.05f,
                                  .kind = TYN_SHADOW_CONE};
        static float atlas[MAP][MAP];
        for (int i = 0; i < MAP * MAP; i++) {
            atlas[i / MAP][i % MAP] = i % MAP >= MAP / 2 ? 0.5f : 0;
        }
        *gpu_port(pass, refs, "shadow_atlas") =
            gpu_image(t, "atlas", TYN_IMAGE_2D, (tyn_extent){MAP, MAP, 1}, 1, atlas[0]);
        *gpu_port(pass, refs, "shadows") = gpu_buffer(t, "shadows", maps, sizeof maps);
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s.params, refs), TYN_OK);
    tyn_graph_output(t->graph, "source", *gpu_port(pass, refs, "source"), true);
    tyn_graph_output(t->graph, "power", *gpu_port(pass, refs, "power"), true);
    if (s.params.vpls) {
        tyn_graph_output(t->graph, "vpl_light", *gpu_port(pass, refs, "vpl_light"), true);
    }
    gpu_run(t);
    found = (const float(*)[4])gpu_map(t, "source");
    power = gpu_map(t, "power");
    of_vpls = s.params.vpls ? (const float(*)[4])gpu_map(t, "vpl_light") : NULL;
}

static double lobe(const struct light_block *l, const double d[3])
{
    double cosine = 0;
    for (int i = 0; i < 3; i++) {
        cosine += d[i] * (double)l->direction[i];
    }
    const double inner = (double)l->cos_inner, outer = (double)l->cos_outer;
    const double share = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);
    return l->kind == TYN_LIGHT_KIND_POINT    ? 1
           : l->kind == TYN_LIGHT_KIND_COSINE ? fmax(cosine, 0)
                                              : share * share;
}

// Fluence and flux of lights [from, to), means over a cell.
static void light_of(uint32_t from, uint32_t to, int channel, const int c[3], double sum[4])
{
    enum { SIDE = 12 };
    const double dx = 2.0 / CELLS;
    memset(sum, 0, 4 * sizeof *sum);
    for (uint32_t n = from; n < to; n++) {
        const struct light_block *l = &s.radials.list[n].light;
        const double at[3] = {(double)l->position[0], (double)l->position[1],
                              (double)l->position[2]};
        for (int k = 0; k < SIDE * SIDE * SIDE; k++) {
            const int part[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
            double p[3], d[3];
            for (int i = 0; i < 3; i++) {
                p[i] = dx * (c[i] + (part[i] + 0.5) / SIDE);
                d[i] = p[i] - at[i];
            }
            const double inside = homogeneous_length(s.medium.extent, at, p);
            const double r = vector_normalise(d);
            const double light = (double)l->color[channel] * lobe(l, d) / (r * r) *
                                 exp(-extinction(channel) * inside) / (SIDE * SIDE * SIDE);
            const bool dark = s.shadows && n == 0 && c[1] >= NY / 2;
            for (int i = 0; i < 4; i++) {
                sum[i] += dark ? 0 : light * (i ? d[i - 1] : 1);
            }
        }
    }
}

// Cells, but for those that `near` a light: within so many cells' edges of it. Worst of the parts of their fluence, and
// mean of it.
static double compare(double near, double *mean)
{
    const double dx = 2.0 / CELLS;
    double worst = 0, all = 0, right_all = 0;
    for (int i = 0; i < (int)s.params.shape.channels * N; i++) {
        const int n = i % N, ch = i / N, c[3] = {n % NX, n / NX % NY, n / NX / NY};
        double closest = 1e9;
        for (uint32_t k = 0; k < s.radials.count; k++) {
            double away[3];
            for (int a = 0; a < 3; a++) {
                away[a] = dx * (c[a] + 0.5) - (double)s.radials.list[k].light.position[a];
            }
            closest = fmin(closest, vector_length(away) / dx);
        }
        double right[4], only[4];
        light_of(0, s.radials.count, ch, c, right);
        light_of(s.params.num_lamps, s.radials.count, ch, c, only);
        all += (double)(found[i][0] - others[i][0]);
        right_all += right[0];
        for (int k = 0; k < 4 && closest >= near; k++) {
            const double off = fabs((double)(found[i][k] - others[i][k]) - right[k]);
            worst = maximum(worst, relative(off, right[0])); // a shadow has no light
            if (of_vpls && only[0] > 0) {
                worst = maximum(worst, fabs((double)of_vpls[i][k] - only[k]) / right[0]);
            }
        }
    }
    *mean = all / right_all - 1;
    print_message("cells within %.1e of their light, in the mean %.1e\n", worst, *mean);
    return worst;
}

// What lights [from, to), a group, send into the box or in it, and lose there: integrals over all directions.
static void check_power(const char *name, int group, uint32_t from, uint32_t to, double most)
{
    enum { DIRECTIONS = 100000 };
    for (int ch = 0; ch < 3; ch++) {
        double entering = 0, emitted = 0, lost = 0;
        for (uint32_t n = from; n < to; n++) {
            const struct light_block *l = &s.radials.list[n].light;
            const double at[3] = {(double)l->position[0], (double)l->position[1],
                                  (double)l->position[2]};
            double sum[2] = {0, 0};
            for (int k = 0; k < DIRECTIONS; k++) { // Fibonacci's spiral
                const double z = 1 - (2 * k + 1.0) / DIRECTIONS, across = sqrt(1 - z * z);
                const double d[3] = {across * cos(2.399963229728653 * k),
                                     across * sin(2.399963229728653 * k), z};
                const double far[3] = {at[0] + 100 * d[0], at[1] + 100 * d[1], at[2] + 100 * d[2]};
                const double length = homogeneous_length(s.medium.extent, at, far);
                const double light = 4 * pi / DIRECTIONS * (double)l->color[ch] * lobe(l, d);
                sum[0] += length > 0 ? light : 0;
                sum[1] += light * (1 - exp(-extinction(ch) * length));
            }
            *(s.radials.list[n].inside ? &emitted : &entering) += sum[0];
            lost += sum[1];
        }
        const struct lattice_lamp_power *p = &power[3 * group + ch];
        print_message(
            "group %d: %g and %g W, of which %g are lost: within %.1e %.1e %.1e; x %.3f\n", group,
            entering, emitted, lost, entering ? (double)p->entering / entering - 1 : 0,
            emitted ? (double)p->emitted / emitted - 1 : 0, (double)p->lost / lost - 1,
            (double)p->scale);
        assert_true(within(fabs((double)p->entering - entering),
                           (group == 1 ? 1e-3 : 1.6e-3) * entering, NULL, "%s, group %d, entering",
                           name, group));
        assert_true(fabs((double)p->emitted - emitted) <= 1e-5 * emitted);
        assert_true(within(fabs((double)p->lost - lost), most * lost, NULL, "%s, group %d, lost",
                           name, group));
    }
}

// In the box, and outside it; each strong one by itself, further ones together.
static void lamps(void **state)
{
    for (int variant = 0; variant < 3; variant++) {
        start(variant == 2 ? 1.5f : 0.4f);
        add_lamp(0.9f, 0.7f, 0.4f, 3, 2, 1);
        add_lamp(2.6f, 1, 1.3f, 9, 9, 9);
        if (variant) {
            add_lamp(0.2f, 1.3f, 0.9f, 0.5f, 1, 0.2f);
            add_lamp(-0.4f, 0.2f, 0.5f, 1, 1, 1);
        }
        s.params.num_fine = 2;
        s.others = variant == 1;
        run(*state);
        double mean;
        const bool dense = variant == 2;
        assert_true(compare(1.5, &mean) < (dense ? 0.15 : 0.025));
        assert_true(fabs(mean) < (dense ? 0.01 : 0.007));
        const char *name = dense ? "dense" : variant ? "four lamps" : "two lamps";
        check_power(name, 0, 0, 1, dense ? 8e-5 : 1e-4);
        check_power(name, 1, 1, 2, dense ? 1.5e-3 : 7e-4);
        if (variant) {
            check_power(name, 2, 2, 4, dense ? 3e-3 : 1.5e-3);
        }
    }
}

static void spots(void **state)
{
    start(0.4f);
    add_lamp(1, 0.75f, 1.8f, 3, 2, 1);
    s.radials.list[0].light.kind = TYN_LIGHT_KIND_SPOT;
    s.radials.list[0].light.cos_inner = 0.9f;
    s.radials.list[0].light.cos_outer = 0.5f;
    s.params.num_fine = 1;
    run(*state);
    double mean;
    assert_within(compare(1.5, &mean), 0.015, NULL);
    assert_true(fabs(mean) < 1e-4);
}

static void virtual_lights(void **state)
{
    start(0.4f);
    add_lamp(2.6f, 1, 1.3f, 9, 9, 9);
    s.params.num_fine = 1;
    s.params.vpls = 1;
    for (int k = 0; k < 20; k++) { // on the floor
        struct light_block *l =
            add_light(0.05f + 0.1f * (float)k, 0.03f * (float)(k * 17 % 50), 0, 0.1f, 0.2f, 0.05f);
        l->kind = TYN_LIGHT_KIND_COSINE;
        l->direction[2] = 1;
        l->radius = 0.01f;
    }
    run(*state);
    double mean;
    assert_within(compare(1.5, &mean), 0.03, NULL);
    assert_within(fabs(mean), 2e-3, NULL);
}

static void shadows(void **state)
{
    start(0.4f);
    add_lamp(-1, 0.75f, 0.5f, 3, 2, 1);
    s.radials.list[0].light.shadow = TYN_SHADOW_LAMP(0);
    s.params.num_fine = 1;
    s.shadows = true;
    run(*state);
    double mean;
    assert_within(compare(1.5, &mean), 3e-3, NULL);
    assert_within(fabs(mean), 5e-4, NULL);
}

static void too_many_groups(void **state)
{
    gpu_test *t = *state;
    start(0.4f);
    s.params.num_lamps = 6;
    s.params.num_fine = 5;
    s.params.vpls = 1;
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    t->quiet = true;
    assert_int_not_equal(tyn_graph_add(t->graph, &tyn_pass_lattice_lamps, &s.params, refs), TYN_OK);
    t->quiet = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps),           cmocka_unit_test(spots),
        cmocka_unit_test(virtual_lights),  cmocka_unit_test(shadows),
        cmocka_unit_test(too_many_groups),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
