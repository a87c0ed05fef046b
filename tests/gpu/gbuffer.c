// gbuffer.c -- the G-buffer, and normals and albedo that pass guides makes of it, against rays through all triangles, in double
// precision.
#include "gpu_test.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/guides/guides.h"
#include "shaders/surfaces/gbuffer_edge_args.h"
#include "shaders/common/scene_args.h"
#include "solids.h"
#include "shaders/surfaces/surface_args.h"
#include "vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 32 };
enum { ROW = 1 }; // workgroup in a row, so that lists have several rows

// ---- the scene --------------------------------------------------------------------------------

static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const float none[3] = {0};
    uint32_t floor = solids_material(scene, (float[]){0.5f, 0.25f, 0.125f}, none);
    uint32_t box = solids_material(scene, (float[]){0.75f, 0.75f, 0.75f}, (float[]){3, 2, 1});
    uint32_t card = solids_material(scene, (float[]){0.1f, 0.9f, 0.3f}, (float[]){0, 5, 0});
    scene->surfaces.materials[card].flags = TYN_SURFACE_EMITS_BOTH_SIDES;
    scene->surfaces.materials[floor].texture = 0;
    // Far larger than what is seen, below and behind the camera.
    solids_quad(scene, (float[]){-300, 0, -300}, (float[]){0, 0, 600}, (float[]){600, 0, 0}, floor);
    solids_box(scene, (float[]){-1, 0.5f, -1}, (float[]){1, 1.5f, 0.5f}, 0.5f, false, box);
    solids_quad(scene, (float[]){0.5f, 0.2f, 0.8f}, (float[]){0, 1.5f, 0.3f},
                (float[]){1.2f, 0.1f, -0.2f},
                card); // its back is seen
    // Normals of the card as of something round.
    tyn_surfaces *s = &scene->surfaces;
    for (uint32_t v = s->num_vertices - 4; v < s->num_vertices; v++) {
        s->vertices[v].normal[0] += 0.3f * ((float)(v & 1) - 0.5f);
        float length = 0;
        for (int c = 0; c < 3; c++) {
            length += s->vertices[v].normal[c] * s->vertices[v].normal[c];
        }
        for (int c = 0; c < 3; c++) {
            s->vertices[v].normal[c] /= sqrtf(length);
        }
    }
    for (uint32_t v = 0; v < 4; v++) { // the floor's texture repeats every metre
        s->vertices[v].u *= 600;
        s->vertices[v].v *= 600;
    }
}

static const float frame_rows[3][4] = {
    {0.8f, 0, 0.6f, 1}, {0, 1, 0, -0.5f}, {-0.6f, 0, 0.8f, 2}}; // world -> M

static struct surface_block make_block(const tyn_scene *scene)
{
    struct surface_block s = {
        .num_triangles = scene->surfaces.num_triangles, .lo = {-300, 0, -300}, .hi = {300, 2, 300}};
    memcpy(s.from_world, frame_rows, sizeof frame_rows);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            s.to_world[r][c] = frame_rows[c][r];
            s.to_world[r][3] -= frame_rows[c][r] * frame_rows[c][3];
        }
    }
    return s;
}

static void turn(const float v[3], float out[3])
{
    for (int r = 0; r < 3; r++) {
        out[r] = frame_rows[r][0] * v[0] + frame_rows[r][1] * v[1] + frame_rows[r][2] * v[2];
    }
}

// In the world; forward and up need not be normal to each other.
static struct camera_block make_camera(const float at[3], const float forward[3], bool orthographic)
{
    float f[3] = {forward[0], forward[1], forward[2]};
    vector_normalisef(f);
    float r[3] = {-f[2], 0, f[0]}; // f x y
    vector_normalisef(r);
    const float u[3] = {r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2],
                        r[0] * f[1] - r[1] * f[0]};
    struct camera_block c = {.orthographic = orthographic,
                             .half_width = orthographic ? 3 : 0.75f,
                             .half_height = orthographic ? 2 : 0.5f,
                             .size = {WIDTH, HEIGHT},
                             .shift = {0.1f, -0.2f}};
    turn(at, c.origin);
    for (int k = 0; k < 3; k++) {
        c.origin[k] += frame_rows[k][3];
    }
    turn(r, c.right);
    turn(u, c.up);
    turn(f, c.forward);
    return c;
}

// ---- the twin ---------------------------------------------------------------------------------

// A ray of the camera through sample position (x, y) in pixels, in the world.
static void make_ray(const struct camera_block *c, double x, double y, double o[3], double d[3])
{
    double m[2][3], s = 2 * x / WIDTH - 1 + (double)c->shift[0],
                    t = 1 - 2 * y / HEIGHT + (double)c->shift[1];
    for (int k = 0; k < 3; k++) {
        double across =
            s * (double)(c->half_width * c->right[k]) + t * (double)(c->half_height * c->up[k]);
        m[0][k] = (double)c->origin[k] - (double)frame_rows[k][3] + (c->orthographic ? across : 0);
        m[1][k] = (double)c->forward[k] + (c->orthographic ? 0 : across);
    }
    double length = sqrt(vector_dot(m[1], m[1]));
    for (int k = 0; k < 3; k++) { // the inverse of the turn
        o[k] = d[k] = 0;
        for (int j = 0; j < 3; j++) {
            o[k] += (double)frame_rows[j][k] * m[0][j];
            d[k] += (double)frame_rows[j][k] * m[1][j] / length;
        }
    }
}

// ---- the device -------------------------------------------------------------------------------

enum { NONE, WHOLE, SEVERAL }; // what a pixel shows
// gbuffer.glsl
static const uint32_t several_bit = 0x80000000u, mixed_bit = 0x40000000u, second_bit = 0x20000000u,
                      index_bits = 0x1fffffffu;

typedef struct images {
    const uint32_t *seen;
    const float (*albedo)[4], (*normal)[4]; // means over pixels; the world's normal
} images;

static images draw(gpu_test *t, const tyn_scene *scene, const struct camera_block *camera,
                   const struct surface_texture *texture, const uint32_t *texels, size_t count,
                   int32_t samples)
{
    const tyn_surfaces *s = &scene->surfaces;
    const struct surface_block block = make_block(scene);
    tyn_gbuffer_params params;
    tyn_pass_defaults(&tyn_pass_gbuffer, &params);
    params.samples = samples;
    params.size[0] = WIDTH;
    params.size[1] = HEIGHT;
    params.num_triangles = s->num_triangles;
    params.row = ROW;
    tyn_graph_begin(t->graph);
    tyn_ref refs[GBUFFER_NUM_PORTS] = {
        [GBUFFER_PORT_CAMERA] = gpu_buffer(t, "camera", camera, sizeof *camera),
        [GBUFFER_PORT_SURFACES] = gpu_buffer(t, "surfaces", &block, sizeof block),
        [GBUFFER_PORT_TRIANGLES] =
            gpu_buffer(t, "triangles", s->triangles, s->num_triangles * sizeof *s->triangles),
        [GBUFFER_PORT_VERTICES] =
            gpu_buffer(t, "vertices", s->vertices, s->num_vertices * sizeof *s->vertices),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_gbuffer, &params, refs), TYN_OK);
    const tyn_guides_params guides = {{WIDTH, HEIGHT}, 1};
    tyn_ref out[GUIDES_NUM_PORTS] = {
        [GUIDES_PORT_CAMERA] = refs[GBUFFER_PORT_CAMERA],
        [GUIDES_PORT_SURFACES] = refs[GBUFFER_PORT_SURFACES],
        [GUIDES_PORT_TRIANGLES] = refs[GBUFFER_PORT_TRIANGLES],
        [GUIDES_PORT_VERTICES] = refs[GBUFFER_PORT_VERTICES],
        [GUIDES_PORT_MATERIALS] =
            gpu_buffer(t, "materials", s->materials, s->num_materials * sizeof *s->materials),
        [GUIDES_PORT_TEXTURES] = gpu_buffer(t, "textures", texture, sizeof *texture),
        [GUIDES_PORT_TEXELS] = gpu_buffer(t, "texels", texels, count * sizeof *texels),
        [GUIDES_PORT_SEEN] = refs[GBUFFER_PORT_SEEN],
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_guides, &guides, out), TYN_OK);
    tyn_graph_output(t->graph, "seen", refs[GBUFFER_PORT_SEEN], true);
    tyn_graph_output(t->graph, "albedo", out[GUIDES_PORT_ALBEDO], true);
    tyn_graph_output(t->graph, "normal", out[GUIDES_PORT_NORMAL], true);
    gpu_run(t);
    return (images){gpu_map(t, "seen"), (const float(*)[4])gpu_map(t, "albedo"),
                    (const float(*)[4])gpu_map(t, "normal")};
}

static void expect_near(const float *found, const float *right, float tolerance, const char *what,
                        uint32_t i)
{
    for (int c = 0; c < 3; c++) {
        if (!(fabsf(found[c] - right[c]) <= tolerance)) {
            fail_msg("%s of sample %u: %g %g %g, not %g %g %g", what, i, (double)found[0],
                     (double)found[1], (double)found[2], (double)right[0], (double)right[1],
                     (double)right[2]);
        }
    }
}

typedef struct expected {
    double distance;   // 0: no surface
    uint32_t triangle; // + 1; 0: none
    float facet[3], normal[3], albedo[3];
    bool doubtful; // at an edge, where rounding may decide
    bool textured; // then the albedo is not looked at here
} expected;

static expected expect(const tyn_surfaces *s, const solids_hit *h, const double d[3])
{
    expected right = {.distance = h->triangle < 0 ? 0 : h->distance,
                      .triangle = (uint32_t)(h->triangle + 1)};
    if (h->triangle < 0) {
        return right;
    }
    const tyn_surface_triangle *t = &s->triangles[h->triangle];
    const tyn_surface_material *m = &s->materials[t->material];
    float facet[3], normal[3] = {0}, e[2][3];
    for (int c = 0; c < 3; c++) {
        e[0][c] = s->vertices[t->vertices[1]].position[c] - s->vertices[t->vertices[0]].position[c];
        e[1][c] = s->vertices[t->vertices[2]].position[c] - s->vertices[t->vertices[0]].position[c];
        for (int k = 0; k < 3; k++) {
            normal[c] += (float)h->weights[k] * s->vertices[t->vertices[k]].normal[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        const int j = (c + 1) % 3, k = (c + 2) % 3;
        facet[c] = e[0][j] * e[1][k] - e[0][k] * e[1][j];
    }
    vector_normalisef(facet);
    vector_normalisef(normal);
    const double cosine =
        (double)facet[0] * d[0] + (double)facet[1] * d[1] + (double)facet[2] * d[2];
    const bool front = cosine < 0;
    for (int c = 0; c < 3; c++) {
        facet[c] = front ? facet[c] : -facet[c];
        normal[c] = front ? normal[c] : -normal[c];
    }
    memcpy(right.facet, facet, sizeof facet);
    memcpy(right.normal, normal, sizeof normal);
    memcpy(right.albedo, m->albedo, sizeof right.albedo);
    right.textured = m->texture != TYN_NO_TEXTURE;
    return right;
}

// A pixel of samples[0 .. side^2 - 1], at image.
static void check_pixel(const images *got, uint32_t pixel, const uint32_t *image,
                        const expected *samples, uint32_t count, uint32_t counts[3],
                        uint32_t *num_mixed)
{
    bool doubtful = false, textured = false, mixed = false, several = false, turned = false;
    uint32_t shown = 0;
    float albedo[3] = {0}, normal[3] = {0};
    double nearest = 1e30, farthest = 0;
    for (uint32_t k = 0; k < count; k++) {
        doubtful |= samples[k].doubtful;
        textured |= samples[k].textured;
        mixed |= samples[k].triangle != samples[0].triangle;
        shown += samples[k].distance > 0;
        float cosine = 0;
        for (int c = 0; c < 3; c++) {
            cosine += samples[k].facet[c] * samples[0].facet[c];
            albedo[c] += samples[k].distance > 0 ? samples[k].albedo[c] / (float)count : 0;
            normal[c] += samples[k].normal[c] / (float)count;
        }
        nearest = samples[k].distance > 0 ? fmin(nearest, samples[k].distance) : nearest;
        farthest = fmax(farthest, samples[k].distance);
        turned |= cosine < 0.85f;
        // Its facet is turned, or off the first one's plane.
        several |= cosine < 0.9f ||
                   fabs(samples[k].distance - samples[0].distance) > 1e-3 * samples[0].distance;
    }
    if (doubtful) {
        return;
    }
    const uint32_t first = got->seen[image[0]];
    const int what = !shown ? NONE : first & several_bit ? SEVERAL : WHOLE;
    counts[what]++;
    *num_mixed += mixed;
    assert_true(((first & mixed_bit) != 0) == mixed);
    assert_true(what != WHOLE || shown == count);
    assert_true(what != SEVERAL || shown < count || several);
    assert_true(what == SEVERAL || shown < count || !turned);
    double range[2][2] = {{1e30, 0}, {1e30, 0}}; // of distances in the groups
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t seen = got->seen[image[k]];
        assert_int_equal(seen & index_bits, samples[k].triangle);
        assert_true(k == 0 || !(seen & (several_bit | mixed_bit)));
        assert_true(!(seen & second_bit) || samples[k].distance > 0);
        double *of = range[seen & second_bit ? 1 : 0];
        of[0] = samples[k].distance > 0 ? fmin(of[0], samples[k].distance) : of[0];
        of[1] = fmax(of[1], samples[k].distance);
    }
    // A group spans less than all of them do, if that is much.
    for (int g = 0; mixed && g < 2; g++) {
        assert_true(range[g][1] <= 1.1 * range[g][0] ||
                    range[g][1] <= 1.0001 * sqrt(farthest / nearest) * range[g][0]);
    }
    expect_near(got->normal[pixel], normal, what == WHOLE && count > 1 ? 1e-3f : 1e-4f, "normal",
                pixel);
    if (!textured) {
        expect_near(got->albedo[pixel], albedo, 1e-6f, "albedo", pixel);
    }
    assert_true(fabsf(got->albedo[pixel][3] - (float)shown / (float)count) <= 1e-6f);
}

static void as_rays_find_it(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    make_scene(&scene);
    const struct surface_texture texture = {.levels = 1, .size = {1, 1}};
    const uint32_t white = 0xffffffffu;
    const struct camera_block cameras[] = {
        make_camera((float[]){0.5f, 2, 5}, (float[]){0, -0.2f, -1}, false),
        make_camera((float[]){3, 0.01f, 3}, (float[]){-1, 0.1f, -1}, false),  // close to the floor
        make_camera((float[]){0, 1, -0.2f}, (float[]){0.3f, 0.2f, 1}, false), // within the box
        make_camera((float[]){0.5f, 2, 5}, (float[]){0, -0.3f, -1}, true),
        make_camera((float[]){0, 1, 0}, (float[]){1, -0.3f, 0.2f}, true), // starts within the box
    };
    uint32_t most = 0;
    static const struct {
        size_t camera;
        int32_t samples;
    } cases[] = {{0, 1}, {1, 2}, {2, 1}, {3, 2}, {4, 1}, {0, 3}, {1, 4}, {3, 3}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const struct camera_block *camera = &cameras[cases[k].camera];
        const int32_t samples = cases[k].samples;
        images got = draw(t, &scene, camera, &texture, &white, 1, samples);
        const uint32_t width = WIDTH * (uint32_t)samples;
        uint32_t edges = 0, seen = 0, mixed = 0, counts[3] = {0};
        static expected right[16 * WIDTH * HEIGHT];
        for (uint32_t y = 0; y < HEIGHT * (uint32_t)samples; y++) {
            for (uint32_t x = 0; x < width; x++) {
                double o[3], d[3];
                solids_hit h = {0};
                int triangles[5];
                for (int j = 0; j < 5;
                     j++) { // around, then the middle: rounding may decide at edges
                    const double at[2] = {x + 0.5 + (j == 0) * 0.01 - (j == 1) * 0.01,
                                          y + 0.5 + (j == 2) * 0.01 - (j == 3) * 0.01};
                    make_ray(camera, at[0] / samples, at[1] / samples, o, d);
                    h = solids_ray(&scene.surfaces, o, d);
                    triangles[j] = h.triangle;
                }
                expected *e = &right[y * width + x];
                *e = expect(&scene.surfaces, &h, d);
                for (int j = 0; j < 4; j++) {
                    e->doubtful |= triangles[j] != triangles[4];
                }
                edges += e->doubtful;
                seen += h.triangle >= 0;
            }
        }
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const uint32_t side = (uint32_t)samples;
            uint32_t image[16] = {0};
            expected of[16];
            for (uint32_t j = 0; j < side * side; j++) {
                image[j] = (i / WIDTH * side + j / side) * width + i % WIDTH * side + j % side;
                of[j] = right[image[j]];
            }
            check_pixel(&got, i, image, of, side * side, counts, &mixed);
        }
        most = mixed > most ? mixed : most;
        assert_true(counts[WHOLE] > 100 && (samples == 1) == (counts[SEVERAL] == 0));
        print_message("case %zu: %u pixels of one surface, %u of none, %u of several\n", k,
                      counts[WHOLE], counts[NONE], counts[SEVERAL]);
        print_message("case %zu: %u samples of surfaces, %u at edges\n", k, seen, edges);
        assert_true(seen > 500 && edges < seen / 20);
    }
    assert_true(most > ROW * GBUFFER_EDGES); // else no list went on in a second row
    tyn_scene_finish(&scene);
}

// A checkerboard of one-metre squares: sharp close by, its mean far away, and sRGB is decoded.
static void textures(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    make_scene(&scene);
    scene.surfaces.num_triangles = 2;
    enum { SIDE = 64 };
    static uint32_t texels[SIDE * SIDE * 2];
    const struct surface_texture texture = {.levels = 7, .size = {SIDE, SIDE}};
    uint32_t count = 0;
    for (uint32_t level = 0; level < 7; level++) {
        const uint32_t side = SIDE >> level;
        for (uint32_t i = 0; i < side * side; i++) {
            bool white = (i % side < side / 2) != (i / side < side / 2);
            texels[count++] = side == 1 ? 0xff0000bcu
                              : white   ? 0xff0000ffu
                                        : 0xff000000u; // 0.5 red
        }
    }
    const struct camera_block above =
        make_camera((float[]){0.5f, 0.3f, 0.5f}, (float[]){0.01f, -1, 0}, false);
    images got = draw(t, &scene, &above, &texture, texels, count, 1);
    uint32_t white = 0, black = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *albedo = got.albedo[i];
        white += fabsf(albedo[0] - 0.5f) < 1e-4f;
        black += albedo[0] < 1e-4f;
        assert_true(albedo[1] == 0);
    }
    print_message("%u white, %u black of %d\n", white, black, WIDTH * HEIGHT);
    assert_true(white > WIDTH * HEIGHT / 4 && black > WIDTH * HEIGHT / 4 &&
                white + black > WIDTH * HEIGHT * 8 / 10);
    const struct camera_block far =
        make_camera((float[]){0, 150, 0}, (float[]){0.01f, -1, 0}, false);
    got = draw(t, &scene, &far, &texture, texels, count, 1);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *albedo = got.albedo[i];
        if (!(fabsf(albedo[0] - 0.25f) < 2e-3f)) {
            fail_msg("far away, sample %u: %g", i, (double)albedo[0]);
        }
    }
    tyn_scene_finish(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_rays_find_it),
        cmocka_unit_test(textures),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
