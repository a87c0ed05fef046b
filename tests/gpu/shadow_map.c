// shadow_map.c -- shadow maps against rays through all triangles, in double precision.
#include "bound.h"
#include "gpu_test.h"
#include "passes/shadow_map/shadow_map.h"
#include "numbers.h"
#include "point_pass.h"
#include "shadow_eval.comp.h"
#include "solids.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- the scene --------------------------------------------------------------------------------

// A floor, a slit between two plates above it, a closed box turned by 30 degrees and a thin pillar.
static void make_scene(tyn_scene *scene)
{
    tyn_scene_init(scene);
    const float grey[3] = {0.5f, 0.5f, 0.5f}, none[3] = {0};
    const uint32_t m = solids_material(scene, grey, none);
    solids_quad(scene, (float[]){-4, 0, -4}, (float[]){0, 0, 8}, (float[]){8, 0, 0}, m);
    solids_quad(scene, (float[]){-3, 3, -3}, (float[]){0, 0, 6}, (float[]){2.7f, 0, 0}, m);
    solids_quad(scene, (float[]){0.1f, 3, -3}, (float[]){0, 0, 6}, (float[]){2.9f, 0.4f, 0}, m);
    solids_box(scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){1.7f, 1.7f, 1.7f}, 0.5236f, false, m);
    solids_box(scene, (float[]){-2, 0, -1}, (float[]){-1.9f, 2.5f, -0.9f}, 0.3f, false, m);
}

// The medium's frame: turned about y and moved; rows world -> M.
static void make_frame(const tyn_scene *scene, struct surface_block *s)
{
    const float c = cosf(0.4f), n = sinf(0.4f);
    const float from[3][4] = {{c, 0, n, 1}, {0, 1, 0, -0.5f}, {-n, 0, c, 2}};
    *s = (struct surface_block){.num_triangles = scene->surfaces.num_triangles};
    memcpy(s->from_world, from, sizeof from);
    for (int a = 0; a < 3; a++) {
        s->lo[a] = INFINITY;
        s->hi[a] = -INFINITY;
        for (uint32_t v = 0; v < scene->surfaces.num_vertices; v++) {
            s->lo[a] = fminf(s->lo[a], scene->surfaces.vertices[v].position[a]);
            s->hi[a] = fmaxf(s->hi[a], scene->surfaces.vertices[v].position[a]);
        }
    }
}

static void rotate(const struct surface_block *s, const float w[3], bool point, float m[3])
{
    for (int r = 0; r < 3; r++) {
        m[r] = point ? s->from_world[r][3] : 0;
        for (int c = 0; c < 3; c++) {
            m[r] += s->from_world[r][c] * w[c];
        }
    }
}

enum { SUNS = 2, LAMPS = 3 };
typedef struct lights {
    struct light_block suns[SUNS], lamps[LAMPS]; // in M
    float from[SUNS + LAMPS][3];                 // towards the sun, or position, in the world
} lights;

static lights make_lights(const struct surface_block *s)
{
    lights l = {
        .from = {
            {0.1f, 1, 0.05f}, {-0.7f, 0.6f, 0.4f}, {0, 5, 0}, {-0.6f, 1.5f, 0.3f}, {3, 1, -3}}};
    for (int i = 0; i < SUNS; i++) {
        float travel[3] = {-l.from[i][0], -l.from[i][1], -l.from[i][2]};
        rotate(s, travel, false, l.suns[i].direction);
        float length = sqrtf(travel[0] * travel[0] + travel[1] * travel[1] + travel[2] * travel[2]);
        for (int c = 0; c < 3; c++) {
            l.suns[i].direction[c] /= length;
        }
        l.suns[i].kind = TYN_LIGHT_KIND_DIRECTIONAL;
    }
    for (int i = 0; i < LAMPS; i++) {
        rotate(s, l.from[SUNS + i], true, l.lamps[i].position);
    }
    l.lamps[0].kind = TYN_LIGHT_KIND_SPOT; // downwards
    rotate(s, (float[]){0, -1, 0}, false, l.lamps[0].direction);
    l.lamps[0].cos_outer = cosf(0.7f);
    l.lamps[1].kind = TYN_LIGHT_KIND_POINT;
    l.lamps[2].kind = TYN_LIGHT_KIND_SPOT; // so wide that it gets a cube
    rotate(s, (float[]){-0.6f, 0.1f, 0.79f}, false, l.lamps[2].direction);
    l.lamps[2].cos_outer = cosf(1.5f);
    return l;
}

// ---- rays -------------------------------------------------------------------------------------

static void sub(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++) {
        out[c] = a[c] - b[c];
    }
}

static double triple(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Does the segment from `a` along `d` to a + d, but for its first thousandth, meet a triangle?
static bool blocked(const tyn_surfaces *s, const double a[3], const double d[3], double first)
{
    for (uint32_t t = 0; t < s->num_triangles; t++) {
        double v[3][3], e1[3], e2[3], r[3];
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < 3; c++) {
                v[k][c] = (double)s->vertices[s->triangles[t].vertices[k]].position[c];
            }
        }
        sub(v[1], v[0], e1);
        sub(v[2], v[0], e2);
        sub(a, v[0], r);
        const double minus[3] = {-d[0], -d[1], -d[2]};
        const double det = triple(minus, e1, e2);
        if (fabs(det) < 1e-15) {
            continue;
        }
        const double x = triple(r, e1, e2) / det, u = triple(minus, r, e2) / det,
                     w = triple(minus, e1, r) / det;
        if (x > first && x < 1 && u >= 0 && w >= 0 && u + w <= 1) {
            return true;
        }
    }
    return false;
}

static bool sees(const tyn_surfaces *s, const lights *l, int light, const double p[3], double first)
{
    double d[3];
    for (int c = 0; c < 3; c++) {
        d[c] = light < SUNS ? 100 * (double)l->from[light][c] : (double)l->from[light][c] - p[c];
    }
    return !blocked(s, p, d, first);
}

// ---- points -----------------------------------------------------------------------------------

typedef struct point { // as the shader has it
    float p[3];
    uint32_t light;
    float normal[3];
} point;

typedef struct probe {
    double world[3], normal[3];
    int light;
    bool surface;
    double cosine; // of light and surface
} probe;

static double uniform(void)
{
    return (double)rand() / RAND_MAX;
}

static uint32_t index_of(int light)
{
    return light < SUNS ? (uint32_t)light : TYN_SHADOW_LAMP((uint32_t)light - SUNS);
}

// Size of a texel at a point.
static double texel_size(const tyn_shadow_map_params *p, const lights *l, const probe *q)
{
    const struct shadow_light *s = &p->lights[index_of(q->light)];
    if (q->light < SUNS) {
        double largest = 0;
        for (int r = 0; r < 2; r++) {
            double n = sqrt((double)(s->rows[r][0] * s->rows[r][0] + s->rows[r][1] * s->rows[r][1] +
                                     s->rows[r][2] * s->rows[r][2]));
            largest = maximum(largest, 2 / n / (double)s->texels);
        }
        return largest;
    }
    double d2 = 0;
    for (int c = 0; c < 3; c++) {
        d2 += (q->world[c] - (double)l->from[q->light][c]) *
              (q->world[c] - (double)l->from[q->light][c]);
    }
    return 2 * sqrt(d2) / (double)(s->scale * s->texels) * 1.2;
}

// 1 or 0 if the light sees, or does not see, all of the neighbourhood that may count; -1: it is not sure.
static int expected(const tyn_scene *scene, const tyn_shadow_map_params *params, const lights *l,
                    const probe *q)
{
    // A texel seen from the light covers more of a surface that it grazes.
    const double size = texel_size(params, l, q) / (q->surface ? fmax(q->cosine, 0.02) : 1);
    int seen = 0, count = 0;
    for (int x = -2; x <= 2; x++) {
        for (int y = -2; y <= 2; y++) {
            for (int z = -2; z <= 2; z++) {
                double p[3] = {q->world[0] + 0.9 * x * size, q->world[1] + 0.9 * y * size,
                               q->world[2] + 0.9 * z * size};
                if (q->surface) { // neighbours on the plane
                    double h = 0;
                    for (int c = 0; c < 3; c++) {
                        h += (p[c] - q->world[c]) * q->normal[c];
                    }
                    for (int c = 0; c < 3; c++) {
                        p[c] -= (h - 1e-6) * q->normal[c];
                    }
                }
                seen += sees(&scene->surfaces, l, q->light, p, q->surface ? 1e-7 : 0);
                count++;
            }
        }
    }
    return seen == count ? 1 : seen == 0 ? 0 : -1;
}

// Is the point inside the closed box of make_scene, if only just?
static bool in_box(const double w[3])
{
    const double c = cos(0.5236), n = sin(0.5236), x = w[0] - 1.1, z = w[2] - 1.1;
    return fabs(c * x - n * z) < 0.6 - 1e-5 && fabs(n * x + c * z) < 0.6 - 1e-5 &&
           fabs(w[1] - 1.1) < 0.6 - 1e-5;
}

static void run(gpu_test *t, const tyn_scene *scene, const struct surface_block *s,
                const tyn_shadow_map_params *params, const probe *probes, uint32_t count,
                float *out)
{
    point *points = calloc(count, sizeof *points);
    for (uint32_t i = 0; i < count; i++) {
        float p[3], n[3];
        for (int c = 0; c < 3; c++) {
            p[c] = (float)probes[i].world[c];
            n[c] = (float)probes[i].normal[c];
        }
        rotate(s, p, true, points[i].p);
        rotate(s, n, false, points[i].normal);
        points[i].light = index_of(probes[i].light);
    }
    static point_pass pass;
    const point_input inputs[] = {{"shadow_atlas", TYN_IMAGE_2D, TYN_USE_SAMPLED},
                                  {"shadows", TYN_BUFFER, TYN_USE_STORAGE_READ}};
    point_pass_init(&pass, shadow_eval_spirv, sizeof shadow_eval_spirv, inputs, 2);
    pass.kernel.num_spec = 0;
    const tyn_surfaces *f = &scene->surfaces;
    tyn_graph_begin(t->graph);
    tyn_ref refs[SHADOW_MAP_NUM_PORTS] = {
        [SHADOW_MAP_PORT_TRIANGLES] =
            gpu_buffer(t, "triangles", f->triangles, f->num_triangles * sizeof *f->triangles),
        [SHADOW_MAP_PORT_VERTICES] =
            gpu_buffer(t, "vertices", f->vertices, f->num_vertices * sizeof *f->vertices),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_shadow_map, params, refs), TYN_OK);
    tyn_ref eval[4] = {refs[SHADOW_MAP_PORT_SHADOW_ATLAS], refs[SHADOW_MAP_PORT_SHADOWS],
                       gpu_buffer(t, "points", points, count * sizeof *points)};
    point_pass_params eval_params = {count, sizeof(float), 0, pass.results};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &eval_params, eval), TYN_OK);
    tyn_graph_output(t->graph, "visibility", eval[pass.results], true);
    gpu_run(t);
    memcpy(out, gpu_map(t, "visibility"), count * sizeof *out);
    free(points);
}

static void setup_scene(tyn_scene *scene, struct surface_block *s, lights *l,
                        tyn_shadow_map_params *params)
{
    make_scene(scene);
    make_frame(scene, s);
    *l = make_lights(s);
    tyn_pass_defaults(&tyn_pass_shadow_map, params);
    params->sun_texels = 512;
    params->lamp_texels = 256;
    tyn_shadow_map_plan(params, l->suns, SUNS, l->lamps, LAMPS, s);
}

// ---- tests ------------------------------------------------------------------------------------

static bool in_cone(const lights *l, int light, const double w[3])
{
    if (light != SUNS) {
        return true;
    }
    const double y = (double)l->from[SUNS][1] - w[1];
    return y > 0 && w[0] * w[0] + w[2] * w[2] < y * y * tan(0.7) * tan(0.7);
}

static void points_of_the_medium(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    struct surface_block s;
    lights l;
    tyn_shadow_map_params params;
    setup_scene(&scene, &s, &l, &params);
    enum { COUNT = 6000 };
    probe *probes = calloc(COUNT, sizeof *probes);
    float *found = calloc(COUNT, sizeof *found);
    srand(4);
    for (int i = 0; i < COUNT; i++) {
        // Inside the box (a third of them) or anywhere, a little around the surfaces.
        do {
            for (int c = 0; c < 3; c++) {
                probes[i].world[c] =
                    i % 3 ? uniform() * 10 - (c == 1 ? 1 : 5) : 1.1 + (uniform() - 0.5) * 1.7;
            }
        } while (i % 3 == 0 && !in_box(probes[i].world));
        probes[i].light = i / 3 % (SUNS + LAMPS);
    }
    run(t, &scene, &s, &params, probes, COUNT, found);
    int sure = 0, lit = 0, wrong = 0, boxed = 0;
    for (int i = 0; i < COUNT; i++) {
        assert_true(found[i] == 0 || found[i] == 1);
        if (in_box(probes[i].world)) {
            boxed++;
            wrong += found[i] != 0 && in_cone(&l, probes[i].light, probes[i].world);
            continue;
        }
        int right = expected(&scene, &params, &l, &probes[i]);
        if (right >= 0 && in_cone(&l, probes[i].light, probes[i].world)) {
            sure++;
            lit += right;
            wrong += found[i] != (float)right;
        }
    }
    print_message("%d points beside edges, %d of them lit, %d in the box; %d wrong\n", sure, lit,
                  boxed, wrong);
    assert_int_equal(wrong, 0);
    assert_true(sure > COUNT / 3 && lit > sure / 4 && lit < sure * 3 / 4 && boxed >= COUNT / 3);
    free(probes);
    free(found);
    tyn_scene_finish(&scene);
}

static void points_of_the_surfaces(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    struct surface_block s;
    lights l;
    tyn_shadow_map_params params;
    setup_scene(&scene, &s, &l, &params);
    enum { COUNT = 6000 };
    probe *probes = calloc(COUNT, sizeof *probes);
    float *found = calloc(COUNT, sizeof *found);
    const tyn_surfaces *f = &scene.surfaces;
    srand(5);
    for (int i = 0; i < COUNT; i++) {
        probe *q = &probes[i];
        const tyn_surface_triangle *tri = &f->triangles[(uint32_t)i % f->num_triangles];
        double a = uniform(), b = uniform();
        a = a + b > 1 ? 1 - a : a;
        b = a + b > 1 ? 1 - b : b;
        for (int c = 0; c < 3; c++) {
            const double v0 = (double)f->vertices[tri->vertices[0]].position[c];
            q->world[c] = v0 + a * ((double)f->vertices[tri->vertices[1]].position[c] - v0) +
                          b * ((double)f->vertices[tri->vertices[2]].position[c] - v0);
            q->normal[c] = (double)f->vertices[tri->vertices[0]].normal[c];
        }
        q->light = rand() % (SUNS + LAMPS);
        q->surface = true;
        // The side that faces the light.
        double side = 0, length = 0;
        for (int c = 0; c < 3; c++) {
            const double to = q->light < SUNS ? (double)l.from[q->light][c]
                                              : (double)l.from[q->light][c] - q->world[c];
            side += q->normal[c] * to;
            length += to * to;
        }
        for (int c = 0; side < 0 && c < 3; c++) {
            q->normal[c] = -q->normal[c];
        }
        q->cosine = fabs(side) / sqrt(length);
    }
    run(t, &scene, &s, &params, probes, COUNT, found);
    int sure = 0, lit = 0, wrong = 0;
    for (int i = 0; i < COUNT; i++) {
        assert_true(found[i] >= 0 && found[i] <= 1);
        int right = expected(&scene, &params, &l, &probes[i]);
        if (right >= 0 && in_cone(&l, probes[i].light, probes[i].world)) {
            sure++;
            lit += right;
            const bool close = fabsf(found[i] - (float)right) <= 1e-5f;
            wrong += !close;
            if (!close && wrong < 8) {
                const probe *q = &probes[i];
                print_message("light %d at %g %g %g, normal %g %g %g: %g, not %d\n", q->light,
                              q->world[0], q->world[1], q->world[2], q->normal[0], q->normal[1],
                              q->normal[2], (double)found[i], right);
            }
        }
    }
    print_message("%d points beside edges, %d of them lit; %d wrong\n", sure, lit, wrong);
    assert_int_equal(wrong, 0);
    assert_true(sure > COUNT / 3 && lit > sure / 5 && lit < sure * 4 / 5);
    free(probes);
    free(found);
    tyn_scene_finish(&scene);
}

// ---- edges ------------------------------------------------------------------------------------

// Where a point of the world is on a light's map, in texels; on the face of a cube that `axis` is of, and if that is
// -1 on its own.
static void place_on_map(const tyn_shadow_map_params *p, const struct surface_block *s, int light,
                         const double w[3], int *axis, double out[2])
{
    const struct shadow_light *l = &p->lights[index_of(light)];
    double q[3];
    for (int r = 0; r < 3; r++) {
        q[r] = (double)l->rows[r][3];
        for (int c = 0; c < 3; c++) {
            double m = (double)s->from_world[c][3];
            for (int k = 0; k < 3; k++) {
                m += (double)s->from_world[c][k] * w[k];
            }
            q[r] += (double)l->rows[r][c] * m;
        }
    }
    if (*axis < 0) {
        const int larger = fabs(q[0]) > fabs(q[1]) ? 0 : 1;
        *axis = l->kind != TYN_SHADOW_CUBE || fabs(q[2]) > fabs(q[larger]) ? 2 : larger;
    }
    const double z = l->kind == TYN_SHADOW_SUN ? 1 : fabs(q[*axis]) / (double)l->scale;
    for (int k = 0; k < 2; k++) {
        out[k] = 0.5 * (double)l->texels * q[(*axis + 1 + k) % 3] / z;
    }
}

// Where the light sends the shadow of `e` on the floor y = 0.
static void shadow_of(const lights *l, int light, const double e[3], double out[3])
{
    double d[3];
    for (int c = 0; c < 3; c++) {
        d[c] = (double)l->from[light][c] - (light < SUNS ? 0 : e[c]);
    }
    for (int c = 0; c < 3; c++) {
        out[c] = e[c] - e[1] / d[1] * d[c];
    }
}

// The light on a floor, summed across the edges of a plate's shadow, is that of a shadow as large as it is, for suns, spots
// and lamps: in the mean within a tenth of the map's texels.
static void edges_of_shadows(void **state)
{
    gpu_test *t = *state;
    static const float corner[3] = {-1.3f, 0.5f, -0.9f},
                       sides[2][3] = {{0.4f, 0.05f, 1.7f}, {1.5f, -0.03f, -0.2f}};
    enum { LINES = 64, STEPS = 48, EACH = 4 * LINES * STEPS, REACH = 3 };
    tyn_scene scene;
    tyn_scene_init(&scene);
    const uint32_t m = solids_material(&scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){0, 0, 0});
    solids_quad(&scene, (float[]){-7, 0, -7}, (float[]){0, 0, 14}, (float[]){14, 0, 0}, m);
    solids_quad(&scene, corner, sides[0], sides[1], m);
    struct surface_block s;
    make_frame(&scene, &s);
    lights l = make_lights(&s);
    l.from[SUNS + 2][1] = 2;
    rotate(&s, l.from[SUNS + 2], true, l.lamps[2].position);
    tyn_shadow_map_params params;
    tyn_pass_defaults(&tyn_pass_shadow_map, &params);
    params.sun_texels = 1024;
    params.lamp_texels = 512;
    tyn_shadow_map_plan(&params, l.suns, SUNS, l.lamps, LAMPS, &s);
    probe *probes = calloc((SUNS + LAMPS) * EACH, sizeof *probes), *next = probes;
    float *found = calloc((SUNS + LAMPS) * EACH, sizeof *found);
    srand(8);
    for (int light = 0; light < SUNS + LAMPS; light++) {
        for (int line = 0; line < 4 * LINES; line++) {
            // A place on an edge, and where the edge goes on from there.
            const int along = line % 2, far = line / 2 % 2;
            int axis = -1;
            double e[3], on[3], p[3], q[3], a[2], b[2], middle[3], centre[3];
            const double x = 0.4 + 0.2 * uniform();
            for (int c = 0; c < 3; c++) {
                e[c] = (double)corner[c] + x * (double)sides[along][c] +
                       far * (double)sides[1 - along][c];
                on[c] = e[c] + 0.01 * (double)sides[along][c];
                middle[c] = (double)corner[c] + 0.5 * (double)(sides[0][c] + sides[1][c]);
            }
            shadow_of(&l, light, e, p);
            shadow_of(&l, light, on, q);
            shadow_of(&l, light, middle, centre);
            double across[3] = {q[2] - p[2], 0, p[0] - q[0]};
            const double side = across[0] * (p[0] - centre[0]) + across[2] * (p[2] - centre[2]);
            const double length = copysign(hypot(across[0], across[2]), side);
            place_on_map(&params, &s, light, p, &axis, a);
            for (int c = 0; c < 3; c++) {
                across[c] /= length;
                q[c] = p[c] + 0.01 * across[c];
            }
            place_on_map(&params, &s, light, q, &axis, b);
            const double texel = 0.01 / hypot(b[0] - a[0], b[1] - a[1]);
            for (int k = 0; k < STEPS; k++) {
                const double at = REACH * texel * ((2 * k + 1.0) / STEPS - 1);
                *next = (probe){.light = light, .surface = true, .normal = {0, 1, 0}};
                for (int c = 0; c < 3; c++) {
                    next->world[c] = p[c] + at * across[c];
                }
                assert_true(fabs(next->world[0]) < 7 && fabs(next->world[2]) < 7);
                next++;
            }
        }
    }
    run(t, &scene, &s, &params, probes, (SUNS + LAMPS) * EACH, found);
    static const double most[SUNS + LAMPS] = {0.05, 0.05, 0.01, 0.06, 0.1};
    for (int light = 0; light < SUNS + LAMPS; light++) {
        double sum = 0, dark = 0, lit = 0;
        for (int i = 0; i < EACH; i++) {
            const double f = (double)found[light * EACH + i];
            sum += f * 2 * REACH / EACH * STEPS;
            dark += i % STEPS == 0 ? f : 0;
            lit += i % STEPS == STEPS - 1 ? f : 0;
        }
        const double off = sum / STEPS - REACH;
        print_message("light %d: edges %+.3f texels\n", light, off);
        assert_true(dark == 0 && lit == 4 * LINES);
        assert_true(within(fabs(off), most[light], NULL, "edges, light %d", light));
    }
    free(probes);
    free(found);
    tyn_scene_finish(&scene);
}

// Nothing lights the insides of a closed box, but for a tenth of a texel along its edges: there the wall that stands
// on a surface is as near as the surface itself. Two of its walls are seen edge-on.
static void insides_of_a_box(void **state)
{
    gpu_test *t = *state;
    enum { COUNT = 60000 };
    tyn_scene scene;
    struct surface_block s;
    lights l;
    tyn_shadow_map_params params;
    setup_scene(&scene, &s, &l, &params);
    probe *probes = calloc(COUNT, sizeof *probes);
    float *found = calloc(COUNT, sizeof *found);
    srand(9);
    const double c = cos(0.5236), n = sin(0.5236);
    for (int i = 0; i < COUNT; i++) {
        probe *q = &probes[i];
        double p[3], normal[3] = {0}, edge, texel;
        const int axis = i % 3, beside = (axis + 1 + i / 3 % 2) % 3;
        q->light = i / 6 % (SUNS + LAMPS);
        q->surface = true;
        do { // on a face, beside one of its edges
            for (int k = 0; k < 3; k++) {
                p[k] = 0.6 * (2 * uniform() - 1);
            }
            normal[axis] = p[axis] > 0 ? -1 : 1;
            p[axis] = -0.6 * normal[axis];
            edge = 0.08 * uniform();
            p[beside] = copysign(0.6 - edge, p[beside]);
            edge = fmin(edge, 0.6 - fabs(p[3 - axis - beside]));
            q->world[0] = 1.1 + c * p[0] + n * p[2];
            q->world[1] = 1.1 + p[1];
            q->world[2] = 1.1 - n * p[0] + c * p[2];
            q->normal[0] = c * normal[0] + n * normal[2];
            q->normal[1] = normal[1];
            q->normal[2] = -n * normal[0] + c * normal[2];
            double side = 0, length = 0;
            for (int k = 0; k < 3; k++) {
                const double from = (double)l.from[q->light][k];
                const double to = q->light < SUNS ? from : from - q->world[k];
                side += q->normal[k] * to;
                length += to * to;
            }
            q->cosine = side / sqrt(length);
            texel = texel_size(&params, &l, q);
        } while (edge < 0.1 * texel / fmax(q->cosine, 0.1));
    }
    run(t, &scene, &s, &params, probes, COUNT, found);
    int lit = 0, sides = 0;
    for (int i = 0; i < COUNT; i++) {
        const probe *q = &probes[i];
        if (q->cosine > 0.02 && in_cone(&l, q->light, q->world)) {
            sides++;
            lit += found[i] > 0;
        }
    }
    print_message("%d points inside a box, %d of them lit\n", sides, lit);
    assert_true(sides > COUNT / 4 && lit == 0);
    free(probes);
    free(found);
    tyn_scene_finish(&scene);
}

// Lights without maps shine through everything; an atlas for none is still there.
static void no_lights(void **state)
{
    gpu_test *t = *state;
    tyn_scene scene;
    struct surface_block s;
    lights l;
    tyn_shadow_map_params params;
    setup_scene(&scene, &s, &l, &params);
    tyn_shadow_map_plan(&params, l.suns, 0, l.lamps, 0, &s);
    const probe probes[2] = {{.world = {1, 1, 1}, .light = 0}, {.world = {1, 1, 1}, .light = 3}};
    float found[2];
    run(t, &scene, &s, &params, probes, 2, found);
    assert_true(found[0] == 1 && found[1] == 1);
    tyn_scene_finish(&scene);
}

// All lamps that a scene may have, and four suns: tiles apart from each other, inside the atlas.
static void tiles_do_not_overlap(void **state)
{
    (void)state;
    struct light_block suns[4] = {{.direction = {0, -1, 0}},
                                  {.direction = {1, 0, 0}},
                                  {.direction = {0, 0, 1}},
                                  {.direction = {0.6f, 0.8f, 0}}};
    static struct light_block lamps[TYN_SHADOW_LAMPS];
    const struct surface_block s = {.from_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                    .hi = {1, 2, 3},
                                    .num_triangles = 1};
    for (uint32_t i = 0; i < TYN_SHADOW_LAMPS; i++) {
        lamps[i] = (struct light_block){.kind = i % 3 ? TYN_LIGHT_KIND_POINT : TYN_LIGHT_KIND_SPOT,
                                        .direction = {0, -1, 0},
                                        .cos_outer = 0.9f};
    }
    tyn_shadow_map_params p;
    tyn_pass_defaults(&tyn_pass_shadow_map, &p);
    for (uint32_t lamp_count = 0; lamp_count <= TYN_SHADOW_LAMPS; lamp_count += 4) {
        tyn_shadow_map_plan(&p, suns, lamp_count % 5, lamps, lamp_count, &s);
        uint64_t texels = 0;
        for (uint32_t i = 0; i < p.num_views; i++) {
            const tyn_shadow_view *a = &p.views[i];
            texels += (uint64_t)a->texels * a->texels;
            assert_true(a->place[0] + a->texels <= p.size[0]);
            assert_true(a->place[1] + a->texels <= p.size[1]);
            for (uint32_t j = 0; j < i; j++) {
                const tyn_shadow_view *b = &p.views[j];
                bool apart = a->place[0] + a->texels <= b->place[0] ||
                             b->place[0] + b->texels <= a->place[0] ||
                             a->place[1] + a->texels <= b->place[1] ||
                             b->place[1] + b->texels <= a->place[1];
                assert_true(apart);
            }
        }
        assert_true(p.size[0] <= 16384 && p.size[1] <= 16384);
        assert_true((uint64_t)p.size[0] * p.size[1] <= 2 * texels + (1u << 23));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_of_the_medium),
        cmocka_unit_test(points_of_the_surfaces),
        cmocka_unit_test(edges_of_shadows),
        cmocka_unit_test(insides_of_a_box),
        cmocka_unit_test(no_lights),
        cmocka_unit_test(tiles_do_not_overlap),
    };
    cmocka_set_test_filter(getenv("TYN_TEST_FILTER"));
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
