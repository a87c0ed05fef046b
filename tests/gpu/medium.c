// medium.c -- resampled textures, brick ranges and distances against a twin on the CPU.
#include "bound.h"
#include "gpu_test.h"
#include "passes/medium/medium.h"
#include "numbers.h"
#include "point_pass.h"
#include "medium_eval.comp.h"
#include "random_unit.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SHAPES = TYN_SHAPES_MAX };

typedef struct world {
    struct medium_block medium;
    struct shape_block shapes[MAX_SHAPES];
    tyn_extent atlas_size;
    float *atlas;
    const float *colors; // RGBA, of colors_size; NULL: none
    tyn_extent colors_size;
    bool direct, emissive;
    int32_t samples;
} world;

static world world_make(uint32_t mode, const float extent[3], const uint32_t size[3],
                        tyn_extent atlas)
{
    world w = {.atlas_size = atlas, .samples = 3};
    w.medium.mode = mode;
    w.medium.max_density = w.medium.sigma_t_max = 1;
    for (int i = 0; i < 3; i++) {
        w.medium.extent[i] = extent[i];
        w.medium.size[i] = size[i];
        w.medium.voxel[i] = extent[i] / (float)size[i];
        w.medium.bricks[i] = (size[i] + TYN_BRICK - 1) / TYN_BRICK;
        w.medium.brick_size[i] = w.medium.voxel[i] * TYN_BRICK;
    }
    w.atlas = calloc((size_t)atlas.x * atlas.y * atlas.z, sizeof(float));
    return w;
}

// Adds a shape: centre, edges, turn about z and then x (radians).
static struct shape_block *add_shape(world *w, uint32_t kind, const double centre[3],
                                     const double edges[3], double turn_z, double turn_x)
{
    struct shape_block *s = &w->shapes[w->medium.num_shapes++];
    double cz = cos(turn_z), sz = sin(turn_z), cx = cos(turn_x), sx = sin(turn_x);
    const double axes[3][3] = {{cz, sz * cx, sz * sx}, {-sz, cz * cx, cz * sx}, {0, -sx, cx}};
    for (int i = 0; i < 3; i++) {
        s->rows[i][3] = 0;
        for (int j = 0; j < 3; j++) {
            s->rows[i][j] = (float)(axes[i][j] / edges[i]);
            s->rows[i][3] -= (float)(axes[i][j] / edges[i] * centre[j]);
        }
        s->size[i] = 1;
        s->sigma_s[i] = 1;
    }
    s->kind = kind;
    return s;
}

// ---- twin -----------------------------------------------------------------------------------------

static size_t index3(const uint32_t size[3], int x, int y, int z)
{
    return ((size_t)z * size[1] + (size_t)y) * size[0] + (size_t)x;
}

// Trilinear in a sub-box of an image at texel coordinate t (0 = outer face), clamped to its centres.
static double trilinear(const float *data, int channels, int channel, const uint32_t image[3],
                        const uint32_t offset[3], const uint32_t size[3], const double t[3])
{
    int i0[3], i1[3];
    double f[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        double x = fmin(fmax(t[i] - 0.5, 0), size[i] - 1.0);
        i0[i] = (int)x;
        i1[i] = i0[i] + 1 < (int)size[i] ? i0[i] + 1 : i0[i];
        f[i] = x - i0[i];
        i0[i] += (int)offset[i];
        i1[i] += (int)offset[i];
    }
    for (int c = 0; c < 8; c++) {
        double weight =
            (c & 1 ? f[0] : 1 - f[0]) * (c & 2 ? f[1] : 1 - f[1]) * (c & 4 ? f[2] : 1 - f[2]);
        sum += weight * data[index3(image, c & 1 ? i1[0] : i0[0], c & 2 ? i1[1] : i0[1],
                                    c & 4 ? i1[2] : i0[2]) *
                                 (size_t)channels +
                             (size_t)channel];
    }
    return sum;
}

// By how much a read is off at most of which the coordinate is off by `shift` texels along each axis.
static double trilinear_error(const float *data, int channels, int channel, const uint32_t image[3],
                              const uint32_t offset[3], const uint32_t size[3], const double t[3],
                              double shift)
{
    const double exact = trilinear(data, channels, channel, image, offset, size, t);
    double most = 0;
    for (int k = 0; k < 8 && shift > 0; k++) {
        const double off[3] = {t[0] + (k & 1 ? shift : -shift), t[1] + (k & 2 ? shift : -shift),
                               t[2] + (k & 4 ? shift : -shift)};
        const double value = trilinear(data, channels, channel, image, offset, size, off);
        most = maximum(most, fabs(value - exact));
    }
    return most;
}

// Texel coordinate of an M position in a shape's part of the atlas; false outside the shape.
static bool shape_texel(const struct shape_block *s, const double p[3], double t[3])
{
    double q[3], r2 = 0;
    for (int i = 0; i < 3; i++) {
        q[i] = s->rows[i][0] * p[0] + s->rows[i][1] * p[1] + s->rows[i][2] * p[2] + s->rows[i][3];
        t[i] = (q[i] + 0.5) * s->size[i];
        r2 += q[i] * q[i];
    }
    return s->kind == TYN_SHAPE_KIND_SPHERE
               ? r2 <= 0.25
               : fabs(q[0]) <= 0.5 && fabs(q[1]) <= 0.5 && fabs(q[2]) <= 0.5;
}

// Atlas value of a shape at an M position; 0 outside it.
static double exact_value(const world *w, const struct shape_block *s, const double p[3])
{
    const uint32_t image[3] = {w->atlas_size.x, w->atlas_size.y, w->atlas_size.z};
    double t[3];
    return shape_texel(s, p, t) ? trilinear(w->atlas, 1, 0, image, s->offset, s->size, t) : 0;
}

// What texture units may change of it.
static double value_error(const world *w, const struct shape_block *s, const double p[3],
                          double shift)
{
    const uint32_t image[3] = {w->atlas_size.x, w->atlas_size.y, w->atlas_size.z};
    double t[3];
    return shape_texel(s, p, t)
               ? trilinear_error(w->atlas, 1, 0, image, s->offset, s->size, t, shift)
               : 0;
}

static double largest_sigma_t(const world *w, const double p[3])
{
    double sum[3] = {0}, most = 0;
    for (uint32_t i = 0; i < w->medium.num_shapes; i++) {
        double value = exact_value(w, &w->shapes[i], p);
        for (int c = 0; c < 3; c++) {
            sum[c] += value * (w->shapes[i].sigma_s[c] + w->shapes[i].sigma_a[c]);
            most = maximum(most, sum[c]);
        }
    }
    return most;
}

// ---- the pass -------------------------------------------------------------------------------------

typedef struct textures {
    const float *density, *sigma_s, *sigma_a, *g, *emission;
    const float (*bricks)[2];
    const float *distance;
} textures;

static void declare_pass(gpu_test *t, const world *w, tyn_ref refs[MEDIUM_NUM_PORTS])
{
    tyn_medium_params params;
    tyn_pass_defaults(&tyn_pass_medium, &params);
    assert_int_equal(params.samples, 3);
    params.samples = w->samples;
    params.mode = w->medium.mode;
    params.direct = w->direct;
    params.emissive = w->emissive;
    params.colors = w->colors != NULL;
    memcpy(params.size, w->medium.size, sizeof params.size);
    memcpy(params.bricks, w->medium.bricks, sizeof params.bricks);
    memset(refs, 0, MEDIUM_NUM_PORTS * sizeof *refs);
    tyn_graph_begin(t->graph);
    refs[MEDIUM_PORT_ATLAS] = gpu_image(t, "atlas", TYN_IMAGE_3D, w->atlas_size, 1, w->atlas);
    if (w->colors) {
        refs[MEDIUM_PORT_COLORS] =
            gpu_image(t, "colors", TYN_IMAGE_3D, w->colors_size, 4, w->colors);
    }
    refs[MEDIUM_PORT_SHAPES] = gpu_buffer(t, "shapes", w->shapes, sizeof w->shapes);
    refs[MEDIUM_PORT_MEDIUM] = gpu_buffer(t, "medium", &w->medium, sizeof w->medium);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_medium, &params, refs), TYN_OK);
}

static textures run(gpu_test *t, const world *w)
{
    tyn_ref refs[MEDIUM_NUM_PORTS];
    declare_pass(t, w, refs);
    for (uint32_t p = MEDIUM_PORT_DENSITY; p <= MEDIUM_PORT_DISTANCE; p++) {
        if (refs[p].resource) {
            tyn_graph_output(t->graph, tyn_pass_medium.ports[p].name, refs[p], true);
        }
    }
    gpu_run(t);
    textures out = {.bricks = (const float(*)[2])gpu_map(t, "bricks"),
                    .distance = gpu_map(t, "distance")};
    assert_int_equal(refs[MEDIUM_PORT_DENSITY].resource != 0,
                     w->medium.mode == TYN_MEDIUM_COEFFICIENTS || !w->direct);
    if (w->medium.mode == TYN_MEDIUM_COEFFICIENTS) {
        out.sigma_s = gpu_map(t, "density");
        out.sigma_a = gpu_map(t, "sigma_a");
        out.g = gpu_map(t, "g");
        out.emission = w->emissive ? gpu_map(t, "emission") : NULL;
    } else if (!w->direct) {
        out.density = gpu_map(t, "density");
    }
    return out;
}

// Distances by the definition.
static void check_distance(const world *w, const textures *out)
{
    const uint32_t *n = w->medium.bricks;
    for (int z = 0; z < (int)n[2]; z++) {
        for (int y = 0; y < (int)n[1]; y++) {
            for (int x = 0; x < (int)n[0]; x++) {
                int best = 255;
                for (int q = 0; q < (int)(n[0] * n[1] * n[2]); q++) {
                    if (!(out->bricks[q][1] > 0)) {
                        continue;
                    }
                    int d[3] = {abs(q % (int)n[0] - x), abs(q / (int)n[0] % (int)n[1] - y),
                                abs(q / (int)(n[0] * n[1]) - z)};
                    for (int i = 0; i < 3; i++) {
                        int around = (int)n[i] - d[i] - (w->medium.size[i] % TYN_BRICK != 0);
                        d[i] = w->medium.repeat[i] && d[i] > 0 && around < d[i] ? around : d[i];
                    }
                    int far = d[0] > d[1] ? d[0] : d[1];
                    far = far > d[2] ? far : d[2];
                    best = far < best ? far : best;
                }
                assert_int_equal((int)out->distance[index3(n, x, y, z)], best);
            }
        }
    }
}

// Random points of every brick: the exact media and the interpolated textures are within its range.
static void check_bricks(const world *w, const textures *out, uint32_t *seed)
{
    const struct medium_block *m = &w->medium;
    const uint32_t none[3] = {0};
    double slack = 0;
    for (uint32_t q = 0; q < m->bricks[0] * m->bricks[1] * m->bricks[2]; q++) {
        uint32_t brick[3] = {q % m->bricks[0], q / m->bricks[0] % m->bricks[1],
                             q / (m->bricks[0] * m->bricks[1])};
        double most = 0;
        for (int k = 0; k < 60; k++) {
            double p[3], texel[3];
            for (int i = 0; i < 3; i++) {
                double u = random_unit(seed);
                u = k % 4 == 0 ? (u < 0.3 ? 0 : u > 0.7 ? 1 : u) : u;
                p[i] = fmin((brick[i] + u) * m->brick_size[i], m->extent[i]);
                texel[i] = p[i] / m->voxel[i];
            }
            double exact = largest_sigma_t(w, p), texture = exact;
            if (out->density) {
                texture = trilinear(out->density, 1, 0, m->size, none, m->size, texel);
            } else if (out->sigma_s) {
                texture = 0;
                for (int c = 0; c < 3; c++) {
                    texture = fmax(
                        texture, trilinear(out->sigma_s, 4, c, m->size, none, m->size, texel) +
                                     trilinear(out->sigma_a, 4, c, m->size, none, m->size, texel));
                }
            }
            double low = fmin(exact, texture), high = fmax(exact, texture);
            assert_true(out->bricks[q][0] <= low * (1 + 1e-5) + 1e-6);
            assert_true(out->bricks[q][1] >= high * (1 - 1e-5) - 1e-6);
            most = maximum(most, high);
        }
        slack += out->bricks[q][1] - most;
    }
    printf("majorants are %.3f above what was found, on average\n",
           slack / (m->bricks[0] * m->bricks[1] * m->bricks[2]));
}

// ---- tests ----------------------------------------------------------------------------------------

static void fill_lumps(world *w, uint32_t *seed)
{
    for (int k = 0; k < 5; k++) {
        uint32_t at[3] = {(uint32_t)(random_unit(seed) * w->atlas_size.x),
                          (uint32_t)(random_unit(seed) * w->atlas_size.y),
                          (uint32_t)(random_unit(seed) * w->atlas_size.z)};
        w->atlas[((size_t)at[2] * w->atlas_size.y + at[1]) * w->atlas_size.x + at[0]] =
            (float)(0.5 + random_unit(seed));
    }
}

// One box that is its grid: brick ranges are exactly those of the texels that interpolation reads.
static void direct(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 3;
    for (int k = 0; k < 3; k++) {
        world w = world_make(TYN_MEDIUM_DENSITY, (float[3]){2, 1.3f, 0.9f},
                             (uint32_t[3]){40, 27, 18}, (tyn_extent){40, 27, 18});
        struct shape_block *s = add_shape(&w, TYN_SHAPE_KIND_BOX, (double[3]){1, 0.65, 0.45},
                                          (double[3]){2, 1.3, 0.9}, 0, 0);
        memcpy(s->size, w.medium.size, sizeof s->size);
        w.direct = true;
        w.medium.repeat[0] = k == 1;
        w.medium.repeat[1] = k == 1;
        if (k < 2) {
            fill_lumps(&w, &seed);
        }
        w.atlas[7] = k == 0 ? NAN : 0; // counts as empty
        textures out = run(t, &w);
        w.atlas[7] = 0;
        for (uint32_t q = 0; q < 5 * 4 * 3; q++) {
            float least = 1e30f, most = 0;
            int b[3] = {(int)(q % 5), (int)(q / 5 % 4), (int)(q / 20)};
            for (int z = b[2] * 8 - 1; z <= b[2] * 8 + 8; z++) {
                for (int y = b[1] * 8 - 1; y <= b[1] * 8 + 8; y++) {
                    for (int x = b[0] * 8 - 1; x <= b[0] * 8 + 8; x++) {
                        if (x >= 0 && y >= 0 && z >= 0 && x < 40 && y < 27 && z < 18) {
                            float v = w.atlas[index3(w.medium.size, x, y, z)];
                            least = (float)minimum(least, v);
                            most = (float)maximum(most, v);
                        }
                    }
                }
            }
            const double off = gpu_ulps(t, GPU_QUOTIENT); // of a shape's scale, which is a quotient
            assert_true(fabs((double)(out.bricks[q][0] - least)) <= off * (double)least &&
                        fabs((double)(out.bricks[q][1] - most)) <= off * (double)most);
        }
        check_distance(&w, &out);
        free(w.atlas);
    }
}

// Covered volume: of a box between voxel faces exact, of a sphere and turned boxes to a few per mille.
static void coverage(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 5;
    static const struct {
        uint32_t kind;
        double edges[3], turn_z, turn_x, volume, tolerance;
    } cases[] = {
        {TYN_SHAPE_KIND_BOX, {0.51, 0.333, 0.777}, 0, 0, 0.51 * 0.333 * 0.777, 1e-5},
        {TYN_SHAPE_KIND_BOX, {0.003, 0.5, 0.5}, 0, 0, 0.003 * 0.25, 1e-4},
        {TYN_SHAPE_KIND_SPHERE, {0.8, 0.8, 0.8}, 0, 0, 3.14159265 / 6 * 0.512, 1e-3},
        {TYN_SHAPE_KIND_SPHERE, {0.8, 0.5, 0.3}, 0.4, 1, 3.14159265 / 6 * 0.12, 2e-3},
        {TYN_SHAPE_KIND_BOX, {0.5, 0.4, 0.6}, 0.6, 0.3, 0.12, 1e-5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        world w = world_make(TYN_MEDIUM_DENSITY, (float[3]){1, 1, 1}, (uint32_t[3]){32, 32, 32},
                             (tyn_extent){1, 1, 1});
        w.atlas[0] = 2;
        add_shape(&w, cases[k].kind, (double[3]){0.5, 0.497, 0.51}, cases[k].edges, cases[k].turn_z,
                  cases[k].turn_x);
        textures out = run(t, &w);
        double sum = 0;
        for (int i = 0; i < 32 * 32 * 32; i++) {
            assert_true(out.density[i] >= 0 && out.density[i] <= 2.00001f);
            sum += out.density[i] / (2.0 * 32 * 32 * 32);
        }
        printf("volume %.6f of %.6f\n", sum, cases[k].volume);
        const double off = fabs(sum / cases[k].volume - 1);
        assert_true(cases[k].tolerance > 1e-4
                        ? within(off, cases[k].tolerance, NULL, "volume, shape %zu", k)
                        : off < cases[k].tolerance);
        check_bricks(&w, &out, &seed);
        check_distance(&w, &out);
        free(w.atlas);
    }
}

// Overlapping media of unequal coefficients, one turned and with a grid in the middle of the atlas.
static world two_media(void)
{
    uint32_t seed = 21;
    world w = world_make(TYN_MEDIUM_COEFFICIENTS, (float[3]){2, 1, 1}, (uint32_t[3]){64, 32, 32},
                         (tyn_extent){24, 20, 16});
    for (int i = 0; i < 24 * 20 * 16; i++) {
        w.atlas[i] = random_unit(&seed) < 0.7 ? 0 : (float)random_unit(&seed);
    }
    w.atlas[0] = 3; // of the homogeneous one
    struct shape_block *s = add_shape(&w, TYN_SHAPE_KIND_SPHERE, (double[3]){0.6, 0.5, 0.5},
                                      (double[3]){0.9, 0.9, 0.9}, 0, 0);
    memcpy(s->sigma_s, (float[3]){1, 2, 3}, 12);
    memcpy(s->sigma_a, (float[3]){0.5f, 0, 1}, 12);
    s->phase[0].g = s->phase[1].g = 0.8f;
    s->phase[2].g = -0.2f;
    memcpy(s->emission, (float[3]){0, 0.5f, 1}, 12);
    s = add_shape(&w, TYN_SHAPE_KIND_BOX, (double[3]){1.2, 0.5, 0.5}, (double[3]){1.1, 0.7, 0.5},
                  0.5, 0.4);
    memcpy(s->size, (uint32_t[3]){16, 12, 10}, 12);
    memcpy(s->offset, (uint32_t[3]){5, 6, 3}, 12);
    memcpy(s->sigma_s, (float[3]){20, 10, 5}, 12);
    s->phase[0].g = 0.2f;
    s->phase[1].g = s->phase[2].g = 0.5f;
    w.emissive = true;
    return w;
}

static void coefficients(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 7;
    world w = two_media();
    textures out = run(t, &w);
    check_bricks(&w, &out, &seed);
    check_distance(&w, &out);
    int compared = 0, different = 0;
    for (int i = 0; i < 64 * 32 * 32; i++) {
        double p[3] = {(i % 64 + 0.5) / 32, (i / 64 % 32 + 0.5) / 32, (i / 2048 + 0.5) / 32};
        // Away from all edges the mean over a voxel is its middle. (A cap of the
        // sphere or a corner of the box may still be in a voxel none of whose corners is.)
        double value[2] = {0, 0}, off[2];
        bool edge = false;
        for (int n = 0; n < 2; n++) {
            int hit = 0;
            for (int k = 0; k < 8; k++) {
                double o[3], corner[3];
                for (int a = 0; a < 3; a++) {
                    o[a] = p[a]; // voxels are finer than the texels
                    corner[a] = p[a] + (k >> a & 1 ? 1.0 : -1.0) / 32;
                }
                value[n] += exact_value(&w, &w.shapes[n], o) / 8;
                struct shape_block solid = w.shapes[n];
                memset(solid.offset, 0, sizeof solid.offset);
                memcpy(solid.size, (uint32_t[3]){1, 1, 1}, 12);
                hit += exact_value(&w, &solid, corner) > 0;
            }
            edge = edge || (hit > 0 && hit < 8);
            off[n] = value_error(&w, &w.shapes[n], p, gpu_filter_shift(t));
        }
        const float *s = out.sigma_s + 4 * i, *a = out.sigma_a + 4 * i, *g = out.g + 4 * i;
        assert_true(fabsf(s[3] - (s[0] + s[1] + s[2]) / 3) <= 1e-5f * s[3]);
        assert_true(fabsf(a[3] - (a[0] + a[1] + a[2]) / 3) <= 1e-5f * a[3]);
        if (edge) {
            continue;
        }
        compared++;
        for (int c = 0; c < 3; c++) {
            double sigma_s = 0, sigma_a = 0, weighted = 0, emission = 0;
            double off_s = 0, off_a = 0, off_emission = 0, off_g = 0; // of texture units
            for (int n = 0; n < 2; n++) {
                sigma_s += value[n] * w.shapes[n].sigma_s[c];
                sigma_a += value[n] * w.shapes[n].sigma_a[c];
                weighted += value[n] * w.shapes[n].sigma_s[c] * w.shapes[n].phase[c].g;
                emission += value[n] * w.shapes[n].emission[c];
                off_s += off[n] * w.shapes[n].sigma_s[c];
                off_a += off[n] * w.shapes[n].sigma_a[c];
                off_emission += off[n] * w.shapes[n].emission[c];
            }
            different +=
                !(fabs(s[c] - sigma_s) < 1e-4 * sigma_s + 1e-4 + off_s &&
                  fabs(a[c] - sigma_a) < 1e-4 * sigma_a + 1e-4 + off_a &&
                  fabs(out.emission[4 * i + c] - emission) < 1e-4 * emission + 1e-4 + off_emission);
            // A mean cosine by weights that may be off, most where there is hardly a medium; where there may be none it is 0.
            for (int n = 0; n < 2; n++) {
                off_g += off[n] * w.shapes[n].sigma_s[c] *
                         fabs(w.shapes[n].phase[c].g - weighted / sigma_s) /
                         maximum(sigma_s - off_s, 1e-6);
            }
            assert_true(sigma_s < 1e-3 + off_s ||
                        within(fabs(g[c] - weighted / sigma_s), 1e-2 + off_g, NULL, "g"));
        }
    }
    printf("%d voxels compared, %d values differ\n", compared, different);
    assert_true(compared > 10000 && different < 30);
    free(w.atlas);
}

// Grids of colours: an emission that needs no density, black bodies by the absorption, an albedo of each place.
static void colors(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 31;
    enum { X = 10, Y = 8, EZ = 6, RZ = 5, AZ = 7, Z = EZ + RZ + AZ };
    const uint32_t image[3] = {X, Y, Z}, sizes[3][3] = {{X, 7, EZ}, {9, Y, RZ}, {8, 6, AZ}};
    const uint32_t layers[3] = {0, EZ, EZ + RZ}, none[3] = {0, 0, 0};
    const float scales[3] = {3, 20, 1};
    world w = world_make(TYN_MEDIUM_COEFFICIENTS, (float[3]){2, 1, 1}, (uint32_t[3]){64, 32, 32},
                         (tyn_extent){16, 12, 10});
    for (int i = 0; i < 16 * 12 * 10; i++) { // nothing in the first half
        w.atlas[i] = i % 16 < 8 ? 0 : (float)random_unit(&seed);
    }
    float *texels = calloc((size_t)X * Y * Z * 4, sizeof *texels);
    for (int i = 0; i < X * Y * Z * 4; i++) { // emission in few places
        texels[i] = i < X * Y * EZ * 4 && i / 4 % 7 ? 0 : (float)random_unit(&seed);
    }
    w.colors = texels;
    w.colors_size = (tyn_extent){X, Y, Z};
    w.emissive = true;
    struct shape_block *s =
        add_shape(&w, TYN_SHAPE_KIND_BOX, (double[3]){1, 0.5, 0.5}, (double[3]){2, 1, 1}, 0, 0);
    memcpy(s->size, (uint32_t[3]){16, 12, 10}, 12);
    memcpy(s->sigma_s, (float[3]){1, 2, 3}, 12);
    memcpy(s->sigma_a, (float[3]){0.5f, 0, 1}, 12);
    memcpy(s->emission, (float[3]){2, 0.5f, 1}, 12);
    s->phase[0].g = s->phase[1].g = s->phase[2].g = 0.25f;
    for (int k = 0; k < 3; k++) {
        memcpy(s->colors[k].size, sizes[k], 12);
        s->colors[k].layer = layers[k];
        s->colors[k].scale = scales[k];
    }
    textures out = run(t, &w);
    const double shift = gpu_filter_shift(t);
    double worst = 0; // beyond what texture units may change
    for (int i = 0; i < 64 * 32 * 32; i++) {
        const double p[3] = {(i % 64 + 0.5) / 64, (i / 64 % 32 + 0.5) / 32, (i / 2048 + 0.5) / 32};
        const double m[3] = {2 * p[0], p[1], p[2]};
        const double density = exact_value(&w, s, m), off_density = value_error(&w, s, m, shift);
        for (int c = 0; c < 3; c++) {
            double value[3], off[3];
            for (int k = 0; k < 3; k++) {
                const uint32_t offset[3] = {0, 0, layers[k]};
                const double texel[3] = {p[0] * sizes[k][0], p[1] * sizes[k][1],
                                         p[2] * sizes[k][2]};
                value[k] = scales[k] * trilinear(texels, 4, c, image, offset, sizes[k], texel);
                off[k] = scales[k] *
                         trilinear_error(texels, 4, c, image, offset, sizes[k], texel, shift);
            }
            const double sigma_t = density * (s->sigma_s[c] + s->sigma_a[c]);
            const double sigma_s = sigma_t * value[2], sigma_a = sigma_t - sigma_s;
            const double emission = s->emission[c] * value[0] + sigma_a * value[1];
            // Of products of what is off.
            const double thickest = (density + off_density) * (s->sigma_s[c] + s->sigma_a[c]);
            const double off_t = off_density * (s->sigma_s[c] + s->sigma_a[c]);
            const double off_s = off_t * value[2] + thickest * off[2];
            const double off_a = off_t * (1 - value[2]) + thickest * off[2];
            const double off_emission =
                s->emission[c] * off[0] + off_a * value[1] + (sigma_a + off_a) * off[1];
            worst = maximum(worst, fabs(out.sigma_s[4 * i + c] - sigma_s) - off_s);
            worst = maximum(worst, fabs(out.sigma_a[4 * i + c] - sigma_a) - off_a);
            worst = maximum(worst, (fabs(out.emission[4 * i + c] - emission) - off_emission) / 20);
        }
    }
    assert_true(within(worst, 1e-4, BOUND_ROUNDING, "grids of colours"));
    // A brick is empty only where neither density nor emission reach it.
    int glows = 0;
    for (uint32_t q = 0; q < 8 * 4 * 4; q++) {
        double emission = 0, dense = 0;
        for (int k = 0; k < 9 * 9 * 9; k++) {
            const double p[3] = {(q % 8 + (k % 9) / 8.0) / 8, (q / 8 % 4 + (k / 9 % 9) / 8.0) / 4,
                                 (q / 32 + (k / 81) / 8.0) / 4};
            const double m[3] = {2 * p[0], p[1], p[2]}, texel[3] = {p[0] * X, p[1] * 7, p[2] * EZ};
            dense = maximum(dense, exact_value(&w, s, m));
            for (int c = 0; c < 3; c++) {
                emission = maximum(emission, trilinear(texels, 4, c, image, none, sizes[0], texel));
            }
        }
        assert_true(out.bricks[q][1] > 0 || (emission <= 0 && dense <= 0));
        glows += emission > 0 && dense <= 0;
    }
    assert_true(glows > 10);
    check_distance(&w, &out);
    free(texels);
    free(w.atlas);
}

// medium_sample: inside, on the faces, outside; periodic axes; both modes.
static void lookup(void **state)
{
    gpu_test *t = *state;
    uint32_t seed = 9;
    enum { COUNT = 1000 };
    static point_pass pass;
    static const point_input inputs[] = {
        {"medium", TYN_BUFFER, TYN_USE_UNIFORM},     {"density", TYN_IMAGE_3D, TYN_USE_SAMPLED},
        {"sigma_a", TYN_IMAGE_3D, TYN_USE_SAMPLED},  {"g", TYN_IMAGE_3D, TYN_USE_SAMPLED},
        {"emission", TYN_IMAGE_3D, TYN_USE_SAMPLED},
    };
    point_pass_init(&pass, medium_eval_spirv, sizeof medium_eval_spirv, inputs, 5);
    for (int k = 0; k < 3; k++) {
        world w = k < 2 ? world_make(TYN_MEDIUM_DENSITY, (float[3]){1, 2, 3},
                                     (uint32_t[3]){6, 7, 8}, (tyn_extent){6, 7, 8})
                        : two_media();
        if (k < 2) {
            add_shape(&w, TYN_SHAPE_KIND_BOX, (double[3]){0.5, 1, 1.5}, (double[3]){1, 2, 3}, 0, 0);
            memcpy(w.shapes[0].size, w.medium.size, sizeof w.medium.size);
            w.direct = true;
            for (int i = 0; i < 6 * 7 * 8; i++) {
                w.atlas[i] = (float)random_unit(&seed);
            }
            for (int c = 0; c < 3; c++) {
                w.medium.sigma_s[c] = 1 + (float)c;
                w.medium.sigma_a[c] = 0.5f * (float)c;
                w.medium.phase[c].g = 0.1f * (float)c;
                w.medium.emission[c] = 2;
            }
            w.medium.repeat[0] = w.medium.repeat[2] = k == 1;
        }
        static float points[COUNT][3];
        for (int i = 0; i < COUNT; i++) {
            for (int a = 0; a < 3; a++) {
                double u = 1.6 * random_unit(&seed) - 0.3;
                points[i][a] = i == 0   ? 0
                               : i == 1 ? w.medium.extent[a]
                                        : (float)(u * w.medium.extent[a]);
            }
        }
        tyn_ref refs[MEDIUM_NUM_PORTS], eval[7] = {{0}};
        declare_pass(t, &w, refs);
        eval[0] = refs[MEDIUM_PORT_MEDIUM];
        eval[1] = k < 2 ? refs[MEDIUM_PORT_ATLAS] : refs[MEDIUM_PORT_DENSITY];
        eval[2] = refs[MEDIUM_PORT_SIGMA_A];
        eval[3] = refs[MEDIUM_PORT_G];
        eval[4] = refs[MEDIUM_PORT_EMISSION];
        eval[5] = gpu_buffer(t, "points", points, sizeof points);
        point_pass_params params = {COUNT, 48, w.medium.mode, pass.results};
        assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, eval), TYN_OK);
        tyn_graph_output(t->graph, "results", eval[6], true);
        static const char *names[] = {"sigma_s", "sigma_a", "g", "emission"};
        if (k == 2) {
            for (uint32_t p = 0; p < 4; p++) {
                tyn_graph_output(t->graph, names[p], refs[MEDIUM_PORT_DENSITY + p], true);
            }
        }
        gpu_run(t);
        const float(*got)[4][3] = (const float(*)[4][3])gpu_map(t, "results");
        const uint32_t none[3] = {0};
        // On the far faces (point 1) a quotient decides what is inside, and which end of a period it is.
        const int face = gpu_ulps(t, GPU_QUOTIENT) > 0 ? 1 : -1;
        for (int i = 0; i < COUNT; i++) {
            double texel[3];
            bool inside = true;
            if (i == face) {
                for (int q = 0; q < 4; q++) {
                    for (int c = 0; c < 3; c++) {
                        assert_true(isfinite(got[i][q][c]));
                    }
                }
                continue;
            }
            for (int a = 0; a < 3; a++) {
                double u = points[i][a] / w.medium.extent[a];
                u -= w.medium.repeat[a] ? floor(u) : 0;
                inside = inside && u >= 0 && u <= 1;
                texel[a] = u * w.medium.size[a];
            }
            for (int q = 0; q < 4; q++) {
                for (int c = 0; c < 3; c++) {
                    double want = 0;
                    if (k == 2 && inside) {
                        want = trilinear(gpu_map(t, names[q]), 4, c, w.medium.size, none,
                                         w.medium.size, texel);
                    } else if (k < 2) {
                        double density = inside ? trilinear(w.atlas, 1, 0, w.medium.size, none,
                                                            w.medium.size, texel)
                                                : 0;
                        want = q == 0   ? density * w.medium.sigma_s[c]
                               : q == 1 ? density * w.medium.sigma_a[c]
                               : q == 2 ? w.medium.phase[c].g
                                        : density * w.medium.emission[c];
                    }
                    assert_true(fabs(got[i][q][c] - want) <
                                5e-3 * fabs(want) + 2e-2 * (k == 2) + 5e-3);
                }
            }
        }
        free(w.atlas);
    }
}

static void refuses_wrong_bricks(void **state)
{
    gpu_test *t = *state;
    tyn_medium_params params;
    tyn_pass_defaults(&tyn_pass_medium, &params);
    params.size[0] = params.size[1] = params.size[2] = 9;
    params.bricks[0] = params.bricks[1] = 2;
    params.bricks[2] = 1;
    float zero[34] = {0};
    tyn_ref refs[MEDIUM_NUM_PORTS] = {{0}};
    t->quiet = true;
    tyn_graph_begin(t->graph);
    refs[MEDIUM_PORT_ATLAS] = gpu_image(t, "atlas", TYN_IMAGE_3D, (tyn_extent){1, 1, 1}, 1, zero);
    refs[MEDIUM_PORT_SHAPES] = gpu_buffer(t, "shapes", zero, sizeof zero);
    refs[MEDIUM_PORT_MEDIUM] = gpu_buffer(t, "medium", zero, sizeof zero);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_medium, &params, refs), TYN_ERR_PARAMS);
    t->quiet = false;
}

// Milliseconds of shapes of one size in the same box, n^3 of them on a grid.
static double ms_of_shapes(gpu_test *t, int n)
{
    world w = world_make(TYN_MEDIUM_COEFFICIENTS, (float[3]){1, 1, 1}, (uint32_t[3]){128, 128, 128},
                         (tyn_extent){1, 1, 1});
    w.atlas[0] = 1;
    const double edges[3] = {0.04, 0.04, 0.04};
    for (int i = 0; i < n * n * n; i++) {
        const int at[3] = {i % n, i / n % n, i / (n * n)};
        double centre[3];
        for (int a = 0; a < 3; a++) {
            centre[a] = (at[a] + 0.5) / n;
        }
        add_shape(&w, TYN_SHAPE_KIND_SPHERE, centre, edges, 0, 0);
    }
    double least = 1e30;
    for (int k = 0; k < 3; k++) {
        run(t, &w);
        least = minimum(least, gpu_ms(t, "medium"));
    }
    free(w.atlas);
    return least;
}

// Voxels look at the shapes close by: 64 small ones take little more than 8. Looked at by each voxel they took 8 times as
// long.
static void many_shapes(void **state)
{
    const double few = ms_of_shapes(*state, 2), many = ms_of_shapes(*state, 4);
    print_message("8 shapes %.2f ms, 64 shapes %.2f ms\n", few, many);
    assert_true(many < 4 * few);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(direct),       cmocka_unit_test(coverage),
        cmocka_unit_test(coefficients), cmocka_unit_test(colors),
        cmocka_unit_test(lookup),       cmocka_unit_test(refuses_wrong_bricks),
        cmocka_unit_test(many_shapes),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
