// llc_twin.c -- the CPU twin of the lattice itself: its multigrid against relaxation carried to the
// end, its transport against closed forms.
#include "llc_twin.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>

enum { HOMOGENEOUS, DENSE, CHECKER, BLOCKS, RANDOM, HALF, NUM_MEDIA };

static double sigma_of(int medium, int x, int y, int z, uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    switch (medium) {
    case DENSE:
        return 1e3;
    case CHECKER:
        return (x + y + z) & 1 ? 1e4 : 0;
    case BLOCKS:
        return (x / 2 + y / 2 + z / 2) & 1 ? 1e4 : 0;
    case RANDOM:
        return pow(10, 6 * (*seed >> 8) / 16777216.0);
    case HALF:
        return z < 8 ? 1e3 : 0.1;
    default:
        return 4;
    }
}

// Errors of the diffusion correction fall by 2.5 and more with each V-cycle, whatever the contrast
// and the size: 0.25 is left after one, 1e-3 after eight.
static void multigrid_converges(void **state)
{
    (void)state;
    static const int sizes[][3] = {{16, 16, 16}, {13, 16, 9}, {20, 3, 1}};
    for (int s = 0; s < 3; s++) {
        for (int medium = 0; medium < NUM_MEDIA; medium++) {
            const int *n = sizes[s];
            int cells = n[0] * n[1] * n[2];
            uint32_t seed = 1;
            llc_twin t;
            llc_twin_init(&t, n[0], n[1], n[2], 1.0 / 16);
            double *b = malloc((size_t)cells * sizeof *b),
                   *exact = malloc((size_t)cells * sizeof *b);
            double *e = malloc((size_t)cells * sizeof *b);
            for (int i = 0; i < cells; i++) {
                t.sigma_s[i] = sigma_of(medium, i % n[0], i / n[0] % n[1], i / n[0] / n[1], &seed);
                b[i] = (seed >> 8) / 16777216.0;
            }
            llc_twin_diffusion_sor(&t, b, 1e-10, exact);
            double left[2];
            for (int k = 0; k < 2; k++) {
                double off = 0, sum = 0;
                llc_twin_diffusion(&t, b, k ? 8 : 1, e);
                for (int i = 0; i < cells; i++) {
                    off += (e[i] - exact[i]) * (e[i] - exact[i]);
                    sum += exact[i] * exact[i];
                }
                left[k] = sqrt(off / sum);
            }
            printf("size %d, medium %d: %.1e after 1 cycle, %.1e after 8\n", s, medium, left[0],
                   left[1]);
            assert_true(left[0] < 0.25);
            assert_true(left[1] < 1e-3);
            free(b);
            free(exact);
            free(e);
            llc_twin_finish(&t);
        }
    }
}

// A medium that only absorbs, lit by the environment: e^-tau along each of the 14 lines.
static void absorption(void **state)
{
    (void)state;
    enum { N = 9 };
    llc_twin t;
    llc_twin_init(&t, N, N, N, 1.0);
    t.boundary = 1;
    for (int i = 0; i < N * N * N; i++) {
        t.sigma_a[i] = 0.3;
    }
    llc_twin_solve(&t, 1);
    double phi = 0; // at the centre: mean over the middle cell of a line
    for (int diagonal = 0; diagonal < 2; diagonal++) {
        double tau = 0.3 * (diagonal ? sqrt(3.0) : 1), weight = diagonal ? 0.7 : 0.3;
        phi += 4 * 3.14159265358979 * weight * exp(-tau * 4) * -expm1(-tau) / tau;
    }
    assert_true(fabs(t.m[(4 * N + 4) * N + 4][0] / phi - 1) < 1e-12);
    assert_true(fabs(t.m[(4 * N + 4) * N + 4][2]) < 1e-12);
    llc_twin_finish(&t);
}

// tau <mean psi> = psi_in - psi_out + Q s on every line, so energy is kept to rounding once
// converged.
static void conserves(void **state)
{
    (void)state;
    llc_twin t;
    llc_twin_init(&t, 7, 6, 5, 0.2);
    uint32_t seed = 3;
    for (int i = 0; i < 7 * 6 * 5; i++) {
        t.sigma_s[i] = 0.5 * log(sigma_of(RANDOM, 0, 0, 0, &seed));
        t.sigma_a[i] = i % 3 ? 0 : 0.5;
        t.g[i] = 0.4;
        t.emission[i] = i % 5 ? 0 : 0.1;
        t.beam[i][0] = i % 7;
        t.beam[i][2] = -t.beam[i][0];
    }
    t.boundary = 0.3;
    llc_twin_solve(&t, 40);
    assert_true(fabs(llc_twin_imbalance(&t)) < 1e-9);
    llc_twin_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(multigrid_converges),
        cmocka_unit_test(absorption),
        cmocka_unit_test(conserves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
