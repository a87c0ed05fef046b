// sky_scene.c -- see sky_scene.h. The world is M, turned about the vertical axis and moved.
#include "sky_scene.h"
#include <math.h>
#include <string.h>

static const double turn = 0.4;
static const double move[3] = {1, -0.5, 2}; // world -> M

// Towards the light at the height z.
static void put(struct ordinate *o, double z, double angle, float even)
{
    const double r = sqrt(1 - z * z);
    o->direction[0] = (float)(-r * cos(angle));
    o->direction[1] = (float)-z;
    o->direction[2] = (float)(-r * sin(angle));
    o->solid_angle = even;
    o->mean_cosine = 1 - even / (float)(4 * M_PI);
    o->even = even;
}

void sky_scene_make(sky_scene *s, uint32_t count, uint32_t fixed, uint32_t fan)
{
    memset(s, 0, sizeof *s);
    tyn_scene_init(&s->scene);
    const float grey[3] = {0.5f, 0.5f, 0.5f}, none[3] = {0};
    const uint32_t m = solids_material(&s->scene, grey, none);
    solids_quad(&s->scene, (float[]){-4, 0, -4}, (float[]){0, 0, 8}, (float[]){8, 0, 0}, m);
    solids_quad(&s->scene, (float[]){-1, 0, -2}, (float[]){0, 3, 0}, (float[]){0, 0, 4}, m);
    solids_box(&s->scene, (float[]){0.5f, 0.5f, 0.5f}, (float[]){1.7f, 1.7f, 1.7f}, 0, false, m);
    struct surface_block *b = &s->surfaces;
    b->num_triangles = s->scene.surfaces.num_triangles;
    const float cosine = (float)cos(turn), sine = (float)sin(turn);
    const float from[3][4] = {{cosine, 0, sine, (float)move[0]},
                              {0, 1, 0, (float)move[1]},
                              {-sine, 0, cosine, (float)move[2]}};
    memcpy(b->from_world, from, sizeof from);
    for (int a = 0; a < 3; a++) {
        b->lo[a] = INFINITY;
        b->hi[a] = -INFINITY;
    }
    // Made in M, kept in the world.
    for (uint32_t i = 0; i < s->scene.surfaces.num_vertices; i++) {
        float *p = s->scene.surfaces.vertices[i].position, w[3];
        for (int a = 0; a < 3; a++) {
            w[a] = 0;
            for (int r = 0; r < 3; r++) {
                w[a] += from[r][a] * (p[r] - from[r][3]);
            }
        }
        for (int a = 0; a < 3; a++) {
            p[a] = w[a];
            b->lo[a] = fminf(b->lo[a], w[a]);
            b->hi[a] = fmaxf(b->hi[a], w[a]);
        }
    }
    s->medium = (struct medium_block){.max_density = 1};
    s->ordinates.count = count;
    for (uint32_t k = 0; k < 3; k++) {
        s->medium.extent[k] = 2;
        s->medium.size[k] = 1;
    }
    s->directions.count = fixed + (count - fixed) * fan;
    s->ordinates.num_fixed = s->directions.num_fixed = fixed;
    for (uint32_t n = 0; n < count; n++) {
        const double z = 0.9 - 1.5 * n / count, angle = 2.4 * n + 0.3;
        const bool sun = n < fixed;
        struct ordinate *o = &s->ordinates.list[n];
        put(o, z, angle, sun ? 0 : 0.3f);
        for (uint32_t k = 0; k < (sun ? 1 : fan); k++) {
            struct ordinate *d = &s->directions.list[sun ? n : fixed + (n - fixed) * fan + k];
            put(d, sun ? z : z - 0.08 * k, angle + (k % 2 ? 0.5 : 0), sun ? 0 : 0.3f / (float)fan);
            for (int c = 0; c < 3; c++) { // of which the first has most of the light
                d->irradiance[c] = k == 0 ? 2.0f : 1.0f;
                o->irradiance[c] += d->irradiance[c];
            }
        }
    }
}

void sky_scene_free(sky_scene *s)
{
    tyn_scene_finish(&s->scene);
}

void sky_scene_upload(gpu_test *t, const sky_scene *s, tyn_ref *refs,
                      const tyn_sky_shadows_params *params)
{
    const tyn_surfaces *m = &s->scene.surfaces;
    refs[SKY_SHADOWS_PORT_SURFACES] = gpu_buffer(t, "surfaces", &s->surfaces, sizeof s->surfaces);
    refs[SKY_SHADOWS_PORT_TRIANGLES] =
        gpu_buffer(t, "triangles", m->triangles, m->num_triangles * sizeof m->triangles[0]);
    refs[SKY_SHADOWS_PORT_VERTICES] =
        gpu_buffer(t, "vertices", m->vertices, m->num_vertices * sizeof m->vertices[0]);
    refs[SKY_SHADOWS_PORT_ORDINATES] =
        gpu_buffer(t, "directions", &s->directions, sizeof s->directions);
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_sky_shadows, params, refs), TYN_OK);
}

static void to_world(const sky_scene *s, const double p[3], bool point, double w[3])
{
    for (int a = 0; a < 3; a++) {
        w[a] = 0;
        for (int r = 0; r < 3; r++) {
            const double moved = point ? p[r] - (double)s->surfaces.from_world[r][3] : p[r];
            w[a] += (double)s->surfaces.from_world[r][a] * moved;
        }
    }
}

sky_ray sky_scene_ray(const sky_scene *s, const double p[3], const double towards[3], double around)
{
    const int axis = fabs(towards[0]) < 0.6 ? 0 : 1;
    double u[3], v[3], size = 0, d[3];
    for (int a = 0; a < 3; a++) {
        u[a] = (a == axis) - towards[axis] * towards[a];
        size += u[a] * u[a];
    }
    for (int a = 0; a < 3; a++) {
        u[a] /= sqrt(size);
    }
    for (int a = 0; a < 3; a++) {
        v[a] = towards[(a + 1) % 3] * u[(a + 2) % 3] - towards[(a + 2) % 3] * u[(a + 1) % 3];
    }
    to_world(s, towards, false, d);
    int met = 0;
    for (int k = 0; k < 9; k++) {
        double from[3], w[3];
        for (int a = 0; a < 3; a++) {
            from[a] = p[a] + around * ((k % 3 - 1) * u[a] + (k / 3 - 1) * v[a]);
        }
        to_world(s, from, true, w);
        met += solids_ray(&s->scene.surfaces, w, d).triangle >= 0;
    }
    return met == 0 ? SKY_RAY_FREE : met == 9 ? SKY_RAY_BLOCKED : SKY_RAY_DOUBTFUL;
}
