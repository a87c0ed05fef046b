// raymarch_stage.c -- see raymarch_stage.h.
#include "raymarch_stage.h"
#include "bound.h"
#include "vector.h"
#include <tyndall/extend/view.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void march_cube(march_scene *s, float sigma_s, float sigma_a, float g)
{
    memset(s, 0, sizeof *s);
    struct medium_block *m = &s->medium;
    for (int i = 0; i < 3; i++) {
        m->extent[i] = m->voxel[i] = 1.0f;
        m->brick_size[i] = TYN_BRICK;
        m->size[i] = m->bricks[i] = 1;
        m->sigma_s[i] = sigma_s;
        m->sigma_a[i] = sigma_a;
        m->phase[i].g = g;
        s->density.size[i] = s->distance.size[i] = s->column.size[i] = 1;
        s->inscatter.size[i] = 3;
        s->light.color[i] = 1.0f;
        s->light.mean_cosine = 1.0f;
        s->shape.rows[i][i] = 1.0f;
        s->shape.rows[i][3] = -0.5f;
    }
    m->num_shapes = 1;
    m->max_density = 1;
    m->sigma_t_max = sigma_s + sigma_a;
    s->density.channels = s->distance.channels = s->column.channels = 1;
    s->inscatter.channels = 4;
    s->density.texels[0] = s->column.texels[0] = 1.0f;
    s->lut.num_rows = s->lut.num_sets = 1;
    s->lut.phase[0].g = g;
    s->lut.theta_1[0] = 0.4f;
    s->sums[0] = -1.5f;
    s->sums[1] = -2.0f;
    s->camera.size[0] = s->camera.size[1] = 16;
    s->camera.half_width = s->camera.half_height = 0.5f;
    s->camera.orthographic = 1;
    tyn_pass_defaults(&tyn_pass_raymarch, &s->params);
    s->params.grey = 1;
    s->params.sparse = 0; // its twin marches every pixel
    s->params.num_suns = 1;
    s->params.width = s->params.height = 16;
    s->params.num_shapes = 1;
    memcpy(s->params.extent, m->extent, sizeof m->extent);
    const tyn_frame_scene frame = {.medium = *m, .majorant = sigma_s + sigma_a};
    s->params.longest_step = tyn_longest_step(&frame, 0);
}

void march_sun(march_scene *s, float x, float y, float z)
{
    float d[3] = {x, y, z};
    vector_normalisef(d);
    for (int i = 0; i < 3; i++) {
        s->light.direction[i] = s->beam.direction[i] = d[i];
        s->beam.even = 1; // `column` holds the mean since the entry
        s->beam.rows[i][i] = 1.0f / s->medium.extent[i];
        s->beam.clip_scale[i] = d[i] != 0 ? 1.0f / d[i] : 0;
        s->beam.clip_offset[i] = d[i] == 0 ? 1e30f : d[i] > 0 ? 0 : -s->medium.extent[i] / d[i];
    }
}

void march_camera(march_scene *s, float x, float y, float z, float distance)
{
    float d[3] = {x, y, z}, up[3] = {0, 0, 1};
    vector_normalisef(d);
    if (fabsf(d[2]) > 0.9f) {
        up[1] = 1;
        up[2] = 0;
    }
    float right[3] = {d[1] * up[2] - d[2] * up[1], d[2] * up[0] - d[0] * up[2],
                      d[0] * up[1] - d[1] * up[0]};
    vector_normalisef(right);
    float true_up[3] = {right[1] * d[2] - right[2] * d[1], right[2] * d[0] - right[0] * d[2],
                        right[0] * d[1] - right[1] * d[0]};
    for (int i = 0; i < 3; i++) {
        s->camera.forward[i] = d[i];
        s->camera.right[i] = right[i];
        s->camera.up[i] = true_up[i];
        s->camera.origin[i] = 0.5f * s->medium.extent[i] - distance * d[i];
    }
}

static tyn_ref upload(gpu_test *t, const char *name, const texture *x)
{
    return gpu_image(t, name, TYN_IMAGE_3D, (tyn_extent){x->size[0], x->size[1], x->size[2]},
                     x->channels, x->texels);
}

// As piece_light.glsl, of whole numbers below 2^17; the words are kept in floats.
static void pack_light(const float of[4], float packed[4])
{
    const float *colour = of;
    const uint32_t c[3] = {(uint32_t)colour[0], (uint32_t)colour[1], (uint32_t)colour[2]};
    const uint32_t words[2] = {c[0] | c[2] << 18, c[1] | c[2] >> 14 << 18 | (127u + 17u) << 22};
    memcpy(packed, words, sizeof words);
    packed[2] = of[3];
    packed[3] = 0;
}

void march_run(gpu_test *t, march_scene *s)
{
    tyn_graph_begin(t->graph);
    texture *table = calloc(1, sizeof *table);
    *table = (texture){.size = {2, 2, 1}, .channels = 2};
    for (int i = 0; i < 4; i++) {
        memcpy(table->texels + 2 * i, s->sums, sizeof s->sums);
    }
    tyn_ref refs[TYN_MAX_PORTS] = {
        [RAYMARCH_PORT_MEDIUM] = gpu_buffer(t, "medium", &s->medium, sizeof s->medium),
        [RAYMARCH_PORT_DENSITY] = upload(t, "density", &s->density),
        [RAYMARCH_PORT_DISTANCE] = upload(t, "distance", &s->distance),
        [RAYMARCH_PORT_SHAPES] = gpu_buffer(t, "shapes", &s->shape, sizeof s->shape),
        [RAYMARCH_PORT_LIGHTS] = gpu_buffer(t, "lights", &s->light, sizeof s->light),
        [RAYMARCH_PORT_BEAMS] = gpu_buffer(t, "beams", &s->beam, sizeof s->beam),
        [RAYMARCH_PORT_COLUMN] = upload(t, "column", &s->column),
        [RAYMARCH_PORT_CAMERA] = gpu_buffer(t, "camera", &s->camera, sizeof s->camera),
        [RAYMARCH_PORT_ENVIRONMENT] = gpu_buffer(t, "environment", &s->env, sizeof s->env),
    };
    if (s->params.kernels) {
        refs[RAYMARCH_PORT_LUT] =
            gpu_image(t, "lut", TYN_IMAGE_2D, (tyn_extent){2, 2, 1}, 2, table->texels);
        refs[RAYMARCH_PORT_LUT_BLOCK] = gpu_buffer(t, "lut_block", &s->lut, sizeof s->lut);
    }
    if (s->inscatter.texels[0] > 0) {
        refs[RAYMARCH_PORT_INSCATTER] = upload(t, "inscatter", &s->inscatter);
    }
    if (s->host_depth) {
        refs[RAYMARCH_PORT_HOST_DEPTH] =
            gpu_image(t, "host_depth", TYN_IMAGE_2D,
                      (tyn_extent){s->params.width, s->params.height, 1}, 1, s->host_depth);
    }
    if (s->surface) {
        const tyn_extent size = {16, 16, 1};
        float packed[16 * 16][4];
        uint32_t seen[16 * 16];
        for (int i = 0; i < 16 * 16; i++) {
            const float *of = s->surface + 4 * i;
            seen[i] = of[3] < INFINITY ? 1 : 0;
            pack_light(of, packed[i]);
        }
        refs[RAYMARCH_PORT_SURFACE] = gpu_image(t, "surface", TYN_IMAGE_2D, size, -4, packed[0]);
        refs[RAYMARCH_PORT_SEEN] =
            gpu_image(t, "seen", TYN_IMAGE_2D, size, -2, (const float *)seen);
    }
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_raymarch, &s->params, refs), TYN_OK);
    for (uint8_t p = RAYMARCH_PORT_RADIANCE; p < RAYMARCH_NUM_PORTS; p++) {
        if (refs[p].resource) {
            tyn_graph_output(t->graph, tyn_pass_raymarch.ports[p].name, refs[p], true);
        }
    }
    gpu_run(t);
    free(table);
}

const float *march_pixel(gpu_test *t, const march_scene *s, const char *name, uint32_t x,
                         uint32_t y)
{
    return (const float *)gpu_map(t, name) + 4 * (y * s->params.width + x);
}

double march_hg(double g, double mu)
{
    return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * mu, 1.5));
}

void march_close(double value, double expected, double relative, const char *what)
{
    const double most = relative * fabs(expected) + 1e-7;
    if (!(relative > 1e-4
              ? within(fabs(value - expected), most, BOUND_FILTER, "%s within %g", what, relative)
              : fabs(value - expected) <= most)) {
        fail_msg("%s: %.8g instead of %.8g", what, value, expected);
    }
}
