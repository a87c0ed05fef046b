// sky_shadows.c -- depth maps of principal ordinates against rays through all triangles, in double precision.
#include "gpu_test.h"
#include "passes/sky_shadows/sky_shadows.h"
#include "random_unit.h"
#include "sky_scene.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

// What the map shows at a place: the depth there, and that of the place; false outside.
static bool look(const struct shadow_light *m, const float *atlas, uint32_t width,
                 const double p[3], double *stored, double *depth)
{
    double q[3];
    for (int r = 0; r < 3; r++) {
        q[r] = (double)m->rows[r][3];
        for (int c = 0; c < 3; c++) {
            q[r] += (double)m->rows[r][c] * p[c];
        }
    }
    const double u = (double)m->offset[0] + (double)m->texels * (0.5 + 0.5 * q[0]);
    const double v = (double)m->offset[1] + (double)m->texels * (0.5 + 0.5 * q[1]);
    *depth = q[2];
    if (fabs(q[0]) >= 1 || fabs(q[1]) >= 1) {
        return false;
    }
    *stored = (double)atlas[(uint32_t)v * width + (uint32_t)u];
    return true;
}

// Every map, at places all around: what a ray towards the light meets is before the place, or nothing is. Where an edge is
// within a texel of the ray nothing is said.
static void maps_see_what_rays_meet(void **state)
{
    gpu_test *t = *state;
    sky_scene scene;
    sky_scene_make(&scene, 5, 0, 1);
    tyn_sky_shadows_params params = {.texels = 256,
                                     .reach = 3,
                                     .near_hi = {2, 2, 2},
                                     .count = 6, // one more than there are
                                     .num_triangles = scene.scene.surfaces.num_triangles};
    tyn_graph_begin(t->graph);
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    sky_scene_upload(t, &scene, refs, &params);
    tyn_graph_output(t->graph, "atlas", refs[SKY_SHADOWS_PORT_SKY_ATLAS], true);
    tyn_graph_output(t->graph, "maps", refs[SKY_SHADOWS_PORT_SKY_MAPS], true);
    gpu_run(t);
    const struct shadow_light *maps = gpu_map(t, "maps");
    const float *atlas = gpu_map(t, "atlas");
    const uint32_t width = 3 * 256; // 6 maps
    uint32_t seed = 3, told = 0, wrong = 0, outside = 0;
    for (uint32_t i = 0; i < 5; i++) {
        double towards[3], mean[3], size = 0;
        for (int c = 0; c < 3; c++) {
            towards[c] = (double)maps[i].rows[2][c];
            size += towards[c] * towards[c];
        }
        double cosine = 0;
        for (int c = 0; c < 3; c++) {
            towards[c] /= sqrt(size);
            mean[c] = -(double)scene.directions.list[i].direction[c];
            cosine += towards[c] * mean[c];
        }
        assert_true(fabs(cosine - 1) < 1e-6);
        for (int k = 0; k < 1600; k++) {
            double p[3], stored, depth;
            for (int c = 0; c < 3; c++) {
                p[c] = 6 * random_unit(&seed) - 3 + (c == 1 ? 1.5 : 0);
            }
            const sky_ray ray = sky_scene_ray(&scene, p, towards, 0.06);
            if (!look(&maps[i], atlas, width, p, &stored, &depth)) {
                outside++;
                continue;
            }
            if (ray != SKY_RAY_DOUBTFUL) {
                told++;
                wrong += (stored > depth) != (ray == SKY_RAY_BLOCKED);
            }
        }
    }
    printf("%u of %u places wrong, %u beside the maps\n", wrong, told, outside);
    assert_true(told > 4000);
    assert_int_equal(wrong, 0);
    sky_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(maps_see_what_rays_meet)};
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
