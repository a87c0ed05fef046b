// offline_frame.c -- see offline_frame.h.
#include "offline_frame.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static void check_floats(const char *what, const float *values, size_t count)
{
    assert_non_null(values);
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            fail_msg("%s: value %zu of %zu is %g", what, i, count, (double)values[i]);
        }
    }
}

static void check_counters(tyn_offline *off)
{
    tyn_report report = {0};
    tyn_offline_report(off, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        const tyn_node_report *n = &report.nodes[i];
        for (uint32_t k = 0; k < n->num_work; k++) {
            if (!isfinite(n->work[k].amount)) {
                fail_msg("%s: %s is %g", n->name, n->work[k].name, n->work[k].amount);
            }
            if (!strcmp(n->work[k].name, "non_finite") && n->work[k].amount != 0) {
                fail_msg("%s met %g values that are not finite", n->name, n->work[k].amount);
            }
        }
    }
}

void offline_frame_check(tyn_offline *off, const tyn_view *view)
{
    check_counters(off);
    const size_t pixels = (size_t)view->width * view->height;
    const struct {
        tyn_output output;
        const char *name;
        size_t floats;
    } all[] = {
#define ROW(constant, bit, name, bytes, set)                                                       \
    {TYN_OUTPUT_##constant, name, bytes == 16 && !(1 << bit & TYN_OUTPUT_DEPTH) ? 4 * pixels : 0},
        TYN_OUTPUTS(ROW)
#undef ROW
            {TYN_OUTPUT_PROBE, "probe",
             view->num_points * sizeof(tyn_probe_result) / sizeof(float)},
        {TYN_OUTPUT_FLUXES, "fluxes", sizeof(tyn_fluxes) / sizeof(float)},
    };
    const uint32_t outputs = view->outputs ? view->outputs : TYN_OUTPUT_RADIANCE;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        if (outputs & all[i].output) {
            check_floats(all[i].name, tyn_offline_output(off, all[i].output), all[i].floats);
        }
    }
    if (outputs & TYN_OUTPUT_BALANCE) {
        const tyn_balance *b = tyn_offline_output(off, TYN_OUTPUT_BALANCE);
        for (int c = 0; c < 3; c++) {
            assert_true(isfinite(b->absorbed_media[c] + b->absorbed_surfaces[c] + b->escaped[c]));
            assert_true(isfinite(b->imbalance[c] + b->imbalance_se[c]));
            assert_true(isfinite(b->entering[c] + b->emitted[c]));
        }
        const double *const factors[] = {b->scale_suns, b->scale_lamps, b->scale_vpls};
        for (int k = 0; k < 3; k++) { // least and most, or none
            const double least = factors[k][0], most = factors[k][1];
            assert_true((least == 0 && most == 0) ||
                        (least > 0 && least <= most && isfinite(most)));
        }
    }
}

void offline_frame(tyn_offline *off, const tyn_scene *scene, const tyn_view *view)
{
    assert_int_equal(tyn_offline_frame(off, scene, view, false), TYN_OK);
    offline_frame_check(off, view);
}
