// vpl_disc.c -- light of virtual point lights (VPLs), which stand for discs: on planes against Lambert's integral around
// the disc's contour, cut off at the plane's horizon; in a medium against a sum over the disc.
#include "bound.h"
#include "gpu_test.h"
#include "numbers.h"
#include "point_pass.h"
#include "vpl_eval.comp.h"
#include "vector.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 20000, CORNERS = 2048 };

typedef struct point { // as vpl_eval.comp has it
    float p[3], n[3], position[3], axis[3];
    float radius;
} point;
static point points[POINTS];

typedef struct light { // as vpl_eval.comp has it
    float irradiance, fluence;
} light;

static const light *run(gpu_test *t)
{
    point_pass pass;
    point_pass_init(&pass, vpl_eval_spirv, sizeof vpl_eval_spirv, NULL, 0);
    point_pass_params params = {
        .count = POINTS, .result_size = sizeof(light), .results = pass.results};
    tyn_graph_begin(t->graph);
    tyn_ref refs[POINT_PASS_INPUTS + 2] = {gpu_buffer(t, "points", points, sizeof points)};
    assert_int_equal(tyn_graph_add(t->graph, &pass.desc, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "results", refs[pass.results], true);
    gpu_run(t);
    return gpu_map(t, "results");
}

// Irradiance on the side n at p of a disc of radiance 1 / (pi R^2), all but what is beyond the plane's horizon:
// half the sum over edges of angle times (normal of the edge's plane).n. `cut`: is some of it?
static double irradiance_of(const point *q, bool *cut)
{
    double u[3], v[3], n[3], axis[3], from[3], sum = 0;
    double last[3] = {0}, closing[3] = {0}, first[3] = {0}; // corners
    for (int k = 0; k < 3; k++) {
        n[k] = (double)q->n[k];
        axis[k] = (double)q->axis[k];
        from[k] = (double)q->position[k] - (double)q->p[k];
    }
    const double radius = (double)q->radius;
    *cut = false;
    if (vector_dot(from, axis) >= 0) {
        return 0; // behind it
    }
    const int least = fabs(axis[0]) < 0.6 ? 0 : 1;
    vector_cross(axis, (double[]){least == 0, least == 1, 0}, u);
    const double length = sqrt(vector_dot(u, u));
    for (int k = 0; k < 3; k++) {
        u[k] /= length;
    }
    vector_cross(axis, u, v);
    // As large as the disc, so that the polygon is within a millionth of it.
    const double scale = radius * sqrt(2 * M_PI / CORNERS / sin(2 * M_PI / CORNERS));
    int kept = 0;
    for (int i = 0; i <= CORNERS; i++) {
        double a[3], ends[2][3];
        const double angle = 2 * M_PI * i / CORNERS;
        for (int k = 0; k < 3; k++) {
            a[k] = from[k] + scale * (cos(angle) * u[k] + sin(angle) * v[k]);
        }
        const double ha = vector_dot(a, n), hl = i ? vector_dot(last, n) : ha;
        *cut = *cut || ha < 0;
        // Corners of what is before the plane: where the contour goes through it, and the disc's own.
        int num = 0;
        if (i && (ha > 0) != (hl > 0)) {
            for (int k = 0; k < 3; k++) {
                ends[num][k] = last[k] + (a[k] - last[k]) * hl / (hl - ha);
            }
            num++;
        }
        if (ha > 0) {
            memcpy(ends[num++], a, sizeof a);
        }
        for (int j = 0; j < num; j++) {
            if (kept++ == 0) {
                memcpy(first, ends[j], sizeof first);
            } else {
                double normal[3];
                vector_cross(closing, ends[j], normal);
                const double size = sqrt(vector_dot(normal, normal));
                sum += size > 0 ? atan2(size, vector_dot(closing, ends[j])) *
                                      vector_dot(normal, n) / size
                                : 0;
            }
            memcpy(closing, ends[j], sizeof closing);
        }
        memcpy(last, a, sizeof last);
    }
    if (kept > 2) {
        double normal[3];
        vector_cross(closing, first, normal);
        const double size = sqrt(vector_dot(normal, normal));
        sum +=
            size > 0 ? atan2(size, vector_dot(closing, first)) * vector_dot(normal, n) / size : 0;
    }
    return fabs(sum) / 2 / (M_PI * radius * radius);
}

static double any(double from, double to)
{
    return from + (to - from) * rand() / RAND_MAX;
}

static void any_direction(float out[3])
{
    const double z = any(-1, 1), turn = any(0, 2 * M_PI), r = sqrt(1 - z * z);
    out[0] = (float)(r * cos(turn));
    out[1] = (float)(r * sin(turn));
    out[2] = (float)z;
}

// Discs anywhere, turned and of any size, before planes that see all of them: exact. On the disc's own plane and behind it,
// and on sides that face away, nothing.
static void before_planes(void **state)
{
    srand(5);
    memset(points, 0, sizeof points);
    for (int i = 0; i < POINTS; i++) {
        point *q = &points[i];
        any_direction(q->axis);
        any_direction(q->n);
        q->radius = (float)exp(any(-5, 5));
        double h = exp(any(log(0.01), log(10))) * (double)q->radius * (i % 50 ? 1 : -1);
        float beside[3];
        any_direction(beside);
        const double far = exp(any(-3, 2)) * (double)q->radius;
        double along = 0;
        for (int k = 0; k < 3; k++) {
            along += (double)beside[k] * (double)q->axis[k];
        }
        for (int k = 0; k < 3; k++) {
            q->position[k] = (float)(any(-1, 1) * (double)q->radius);
            q->p[k] = (float)((double)q->position[k] + h * (double)q->axis[k] +
                              far * ((double)beside[k] - along * (double)q->axis[k]));
        }
        if (i % 4) { // most look towards it
            double way[3], length = 0;
            for (int k = 0; k < 3; k++) {
                way[k] = (double)q->position[k] - (double)q->p[k];
                length += way[k] * way[k];
            }
            double size = 0;
            for (int k = 0; k < 3; k++) {
                way[k] = way[k] / sqrt(length) + 0.7 * (double)q->n[k];
                size += way[k] * way[k];
            }
            for (int k = 0; k < 3; k++) {
                q->n[k] = (float)(way[k] / sqrt(size));
            }
        }
    }
    const light *got = run(*state);
    double worst = 0, most = 0;
    int whole = 0, dark = 0;
    for (int i = 0; i < POINTS; i++) {
        bool cut;
        const double expected = irradiance_of(&points[i], &cut);
        if (expected == 0) {
            assert_true(got[i].irradiance == 0.0f);
            dark++;
        } else if (!cut) {
            worst = maximum(worst, fabs((double)got[i].irradiance / expected - 1));
            whole++;
        } else {
            most = maximum(most, (double)got[i].irradiance * (double)points[i].radius *
                                     (double)points[i].radius);
        }
    }
    print_message("%d discs before planes: off by %.1e at most; %d are behind\n", whole, worst,
                  dark);
    print_message("of others %.3f of what the disc has at its surface at most\n", most);
    assert_true(whole > POINTS / 4 && dark > POINTS / 100);
    assert_true(worst < 1e-4 && most <= 1);
}

// Discs of which a plane cuts off some: in the mean over where it does so they send what they should, the farther off the
// more exactly. Nearer than 0.9 radii light is bounded (vpl.glsl), and what they send there is only not too much.
static void cut_by_planes(void **state)
{
    static const double heights[] = {0.01, 0.1, 0.3, 0.9, 1.5, 3, 6, 10};
    enum { ACROSS = 50, ALONG = 10 };
    for (int tilt = -1; tilt <= 1;
         tilt++) { // the plane's normal is at 90 degrees to the disc's axis, or 30 less or more
        const double angle = M_PI / 2 + tilt * M_PI / 6;
        memset(points, 0, sizeof points);
        for (int i = 0; i < 8 * ACROSS * ALONG; i++) {
            // The plane meets the disc's at all distances from its middle at which it cuts the disc.
            const double t = -1 + 2 * (i % ACROSS + 0.5) / ACROSS;
            const double beside = 2 * (i / ACROSS % ALONG + 0.5) / ALONG;
            const double h = heights[i / (ACROSS * ALONG)];
            points[i] = (point){
                .p = {(float)(t + h * cos(angle) / sin(angle)), (float)beside, (float)h},
                .n = {(float)-sin(angle), 0, (float)cos(angle)},
                .axis = {0, 0, 1},
                .radius = 1,
            };
        }
        const light *got = run(*state);
        for (int k = 0; k < 8; k++) {
            double sum = 0, expected = 0;
            for (int i = k * ACROSS * ALONG; i < (k + 1) * ACROSS * ALONG; i++) {
                bool cut;
                sum += (double)got[i].irradiance;
                expected += irradiance_of(&points[i], &cut);
            }
            const double off = sum / expected - 1;
            print_message("cut by a plane at %.0f degrees, %4.2f radii away: %+.1f %%\n",
                          angle * 180 / M_PI, heights[k], 100 * off);
            const double bound = tilt == 0 ? 0.02 : 0.06;
            assert_true(within(heights[k] < 0.9 ? off : fabs(off), bound, NULL, "plane, %s",
                               tilt == 0 ? "across" : "tilted"));
        }
    }
}

// Mean of cos / r^2 over the disc.
static double fluence_of(double h, double beside, double radius)
{
    if (beside == 0) {
        const double rim = sqrt(h * h + radius * radius);
        return 2 / (rim * (rim + h));
    }
    enum { RINGS = 200, TURNS = 200 };
    double sum = 0;
    for (int i = 0; i < RINGS * TURNS; i++) {
        const double ring = radius * sqrt((i / TURNS + 0.5) / RINGS);
        const double turn = 2 * M_PI * (i % TURNS + 0.5) / TURNS;
        const double x = beside - ring * cos(turn), y = ring * sin(turn);
        sum += h * pow(h * h + x * x + y * y, -1.5);
    }
    return sum / (RINGS * TURNS);
}

// A point in a medium sees the disc under an angle, however near it is: exact on the axis.
static void in_media(void **state)
{
    srand(6);
    memset(points, 0, sizeof points);
    enum { ON_AXIS = 100, ALL = 500 };
    for (int i = 0; i < ALL; i++) {
        const double radius = exp(any(-2, 2)), h = radius * exp(any(log(0.1), log(20)));
        const double beside = i < ON_AXIS ? 0 : radius * any(0, 5);
        points[i] = (point){.p = {(float)beside, 0, (float)h},
                            .n = {0, 0, -1},
                            .axis = {0, 0, 1},
                            .radius = (float)radius};
    }
    points[ALL] = (point){.p = {0.1f, 0, -0.1f}, .n = {0, 0, 1}, .axis = {0, 0, 1}, .radius = 1};
    const light *got = run(*state);
    double on_axis = 0, worst = 0, mean = 0;
    for (int i = 0; i < ALL; i++) {
        const point *q = &points[i];
        const double right = fluence_of((double)q->p[2], (double)q->p[0], (double)q->radius);
        const double off = fabs((double)got[i].fluence / right - 1);
        on_axis = i < ON_AXIS ? maximum(on_axis, off) : on_axis;
        worst = maximum(worst, off);
        mean += off / ALL;
    }
    assert_true(on_axis <= 1e-5);
    assert_within(worst, 0.16, NULL);
    assert_within(mean, 0.06, NULL);
    assert_true(got[ALL].fluence == 0.0f); // behind it
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(before_planes),
        cmocka_unit_test(cut_by_planes),
        cmocka_unit_test(in_media),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
