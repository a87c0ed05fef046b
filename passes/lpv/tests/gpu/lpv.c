// lpv.c -- the propagation against a CPU twin in spherical harmonics, and the power it keeps.
//
// The twin follows the paper: coefficients of two bands, transfer functions projected numerically from the directions closest
// to each neighbour (Billeter et al. 2012, Eq 3). It shares no number with the pass.
#include "bound.h"
#include "gpu_test.h"
#include "passes/lpv/lpv/lpv.h"
#include "passes/lpv/lpv/lpv_args.h"
#include "shaders/common/counters.h"
#include "shaders/common/scene_args.h"
#include "shaders/walls/walls_args.h"
#include "numbers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { LINKS = 26, MOST = 24 * 24 * 24 };

static const double band_0 = 0.28209479177387814, band_1 = 0.4886025119029199; // of the two bands

// ---- transfer functions -----------------------------------------------------------------------

static int steps[LINKS][3];                      // as walls_step
static double transfer[LINKS][4], length[LINKS]; // coefficients of T_j: 1, x, y, z; edges of a cell
static double gamma_of[LINKS], unit_deposit[LINKS][4]; // T_j over its integral

static void set_steps(void)
{
    int n = 0;
    for (int a = 0; a < 3; a++) {
        for (int way = 1; way >= -1; way -= 2) {
            steps[n++][a] = way;
        }
    }
    for (int k = 0; k < 8; k++, n++) {
        for (int a = 0; a < 3; a++) {
            steps[n][a] = k >> a & 1 ? -1 : 1;
        }
    }
    for (int pair = 0; pair < 3; pair++) { // yz, xz, xy
        for (int k = 0; k < 4; k++, n++) {
            steps[n][pair == 0 ? 1 : 0] = k & 1 ? -1 : 1;
            steps[n][pair == 2 ? 1 : 2] = k & 2 ? -1 : 1;
        }
    }
    for (int j = 0; j < LINKS; j++) {
        length[j] =
            sqrt(steps[j][0] * steps[j][0] + steps[j][1] * steps[j][1] + steps[j][2] * steps[j][2]);
    }
}

// Over the sphere by the faces of a turned cube, each direction to the link nearest to it. Links of a length are alike.
static void project(void)
{
    enum { N = 1000 };
    static const double turned[3][3] = {{0.36, 0.48, -0.8},
                                        {-0.8, 0.6, 0},
                                        {0.48, 0.64, 0.6}}; // no edge of a region is along its rows
    static bool done;
    if (done) {
        return;
    }
    done = true;
    set_steps();
    for (int face = 0; face < 6; face++) {
        for (int i = 0; i < N * N; i++) {
            const double u = 2 * (i % N + 0.5) / N - 1, v = 2 * (i / N + 0.5) / N - 1;
            const double r = sqrt(1 + u * u + v * v), area = 4.0 / N / N / (r * r * r);
            double d[3];
            for (int a = 0; a < 3; a++) {
                d[a] = (turned[a][face / 2] * (face % 2 ? -1 : 1) +
                        turned[a][(face / 2 + 1) % 3] * u + turned[a][(face / 2 + 2) % 3] * v) /
                       r;
            }
            int best = 0;
            double most = -2;
            for (int j = 0; j < LINKS; j++) {
                const double c =
                    (d[0] * steps[j][0] + d[1] * steps[j][1] + d[2] * steps[j][2]) / length[j];
                best = c > most ? j : best;
                most = fmax(c, most);
            }
            transfer[best][0] += area * band_0;
            for (int a = 0; a < 3; a++) {
                transfer[best][1 + a] += area * band_1 * d[a];
            }
        }
    }
    double whole[3] = {0, 0, 0}, along[3] = {0, 0, 0};
    for (int j = 0; j < LINKS; j++) {
        const int shell = j < 6 ? 0 : j < 14 ? 1 : 2, count[3] = {6, 8, 12};
        whole[shell] += transfer[j][0] / count[shell];
        for (int a = 0; a < 3; a++) {
            along[shell] += transfer[j][1 + a] * steps[j][a] / length[j] / count[shell];
        }
    }
    for (int j = 0; j < LINKS; j++) {
        const int shell = j < 6 ? 0 : j < 14 ? 1 : 2;
        transfer[j][0] = whole[shell];
        for (int a = 0; a < 3; a++) {
            transfer[j][1 + a] = along[shell] * steps[j][a] / length[j];
        }
    }
    const double one = 1 / band_0; // <f|1> is this times the first coefficient
    double all = 0;
    for (int j = 0; j < LINKS; j++) {
        all += one * transfer[j][0];
    }
    for (int j = 0; j < LINKS; j++) {
        gamma_of[j] = one * transfer[j][0] / all;
        for (int k = 0; k < 4; k++) {
            unit_deposit[j][k] = transfer[j][k] / (one * transfer[j][0]);
        }
    }
    assert_near(all, 4 * PI, 1e-5);
}

// The constants of lpv_args.h are those of the partition of the sphere.
static void constants(void **state)
{
    (void)state;
    project();
    static const double gammas[3] = {LPV_GAMMA_FACE, LPV_GAMMA_CORNER, LPV_GAMMA_EDGE};
    static const double cosines[3] = {LPV_COSINE_FACE, LPV_COSINE_CORNER, LPV_COSINE_EDGE};
    double sum = 0, mean = 0, off = 0;
    for (int j = 0; j < LINKS; j++) {
        const int shell = j < 6 ? 0 : j < 14 ? 1 : 2;
        double along = 0; // mean direction, along the link
        for (int a = 0; a < 3; a++) {
            along += unit_deposit[j][1 + a] * steps[j][a] / length[j] * band_1 * 4 * PI / 3;
        }
        assert_near(gammas[shell], gamma_of[j], 3e-6); // of as many directions
        assert_near(cosines[shell], along, 1e-5);
        sum += gammas[shell];
        off = maximum(off, fabs(gammas[shell] - gamma_of[j]) + fabs(cosines[shell] - along));
        mean += length[j] / LINKS;
    }
    print_message("transfer functions off by %.1e at most\n", off);
    assert_near(sum, 1, 1e-7);
    assert_near(LPV_DISTANCE, mean, 1e-6);
}

// ---- a lattice ---------------------------------------------------------------------------------

typedef struct stage {
    tyn_lpv_params params;
    uint32_t n[3], cells, channels;
    float dx;
    float medium[3 * MOST][4], source[3 * MOST][4], albedo[MOST][16];
    uint32_t links[MOST];
    uint8_t blocked[MOST][28];
    struct {
        float unit;
        uint32_t pad[3];
        int32_t power[3 * MOST][4];
    } reflected;
    struct env_block environment;
    bool lit_from_outside;
} stage;

static stage s; // large

static uint32_t at(int x, int y, int z)
{
    return ((uint32_t)z * s.n[1] + (uint32_t)y) * s.n[0] + (uint32_t)x;
}

static void start(uint32_t x, uint32_t y, uint32_t z, uint32_t channels)
{
    memset(&s, 0, sizeof s);
    tyn_pass_defaults(&tyn_pass_lpv, &s.params);
    const uint32_t n[3] = {x, y, z};
    uint32_t longest = 0;
    for (int a = 0; a < 3; a++) {
        longest = n[a] > longest ? n[a] : longest;
    }
    s.dx = 0.25f;
    for (int a = 0; a < 3; a++) {
        s.n[a] = n[a];
        s.params.shape.extent[a] = s.dx * (float)n[a];
        s.params.shape.tint[a] = 1;
    }
    s.params.shape.cells = (int32_t)longest;
    s.channels = s.params.shape.channels = channels;
    s.cells = x * y * z;
    s.reflected.unit = 1e-6f;
}

static double random_unit(void)
{
    return rand() / (RAND_MAX + 1.0);
}

typedef struct solved {
    const float (*moments)[4];
    const float *leaks, (*wall_power)[2];
} solved;

static solved run(gpu_test *t)
{
    const tyn_pass_desc *pass = &tyn_pass_lpv;
    const tyn_extent size = {s.n[0], s.n[1], s.n[2] * s.channels};
    tyn_ref refs[TYN_MAX_PORTS] = {{0}};
    tyn_graph_begin(t->graph);
    *gpu_port(pass, refs, "cells") = gpu_image(t, "cells", TYN_IMAGE_3D, size, 4, s.medium[0]);
    *gpu_port(pass, refs, "source") = gpu_image(t, "source", TYN_IMAGE_3D, size, 4, s.source[0]);
    *gpu_port(pass, refs, "reflected") =
        gpu_buffer(t, "reflected", &s.reflected, 16 + 16 * s.cells * s.channels);
    if (s.lit_from_outside) {
        *gpu_port(pass, refs, "environment") =
            gpu_buffer(t, "environment", &s.environment, sizeof s.environment);
    }
    if (s.params.blockers == LPV_BLOCKERS_EXACT) {
        *gpu_port(pass, refs, "wall_links") = gpu_buffer(t, "links", s.links, 4 * s.cells);
        *gpu_port(pass, refs, "wall_cells") = gpu_buffer(t, "walls", s.albedo, 64 * s.cells);
    } else if (s.params.blockers == LPV_BLOCKERS_FUZZY) {
        *gpu_port(pass, refs, "blocking") = gpu_buffer(t, "blocking", s.blocked, 28 * s.cells);
    }
    assert_int_equal(tyn_graph_add(t->graph, pass, &s.params, refs), TYN_OK);
    static const char *const names[] = {"moments", "leaks", "wall_power", "counters"};
    for (int i = 0; i < 4; i++) {
        tyn_graph_output(t->graph, names[i], *gpu_port(pass, refs, names[i]), true);
    }
    gpu_run(t);
    assert_int_equal(gpu_non_finite(t), 0);
    return (solved){(const float(*)[4])gpu_map(t, "moments"), gpu_map(t, "leaks"),
                    (const float(*)[2])gpu_map(t, "wall_power")};
}

// ---- the twin ---------------------------------------------------------------------------------

typedef struct exits {
    double leaks, walls;
} exits;

static double dot4(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

// Shares that a cell keeps along a link, and scatters on all links together.
static double kept(const float *m, int j, double *scattered)
{
    const double sigma_t = (double)m[0] + (double)m[1], albedo = (double)m[0] / sigma_t;
    if (s.params.extinction == LPV_EXTINCTION_PAPER) {
        const double lambda = fmin(sigma_t * 1.4164218926549295 * (double)s.dx, 1);
        *scattered = lambda * albedo;
        return 1 - lambda;
    }
    *scattered = 0;
    for (int k = 0; k < LINKS; k++) {
        *scattered += albedo * gamma_of[k] * (1 - exp(-sigma_t * length[k] * (double)s.dx));
    }
    return exp(-sigma_t * length[j] * (double)s.dx);
}

// Power that a cell sends along link j, blockers aside.
static double sent(const double light[4], const float *m, int j)
{
    double scattered;
    const double keep = kept(m, j, &scattered), one[4] = {light[0], 0, 0, 0};
    const double g = (double)m[2], linear[4] = {0, light[1], light[2], light[3]};
    return keep * dot4(light, transfer[j]) +
           scattered * (dot4(one, transfer[j]) + g * dot4(linear, transfer[j]));
}

static void add(double light[4], int j, double power)
{
    for (int k = 0; k < 4; k++) {
        light[k] += power * unit_deposit[j][k];
    }
}

static exits twin(uint32_t ch, double (*moments)[4])
{
    static double light[MOST][4], next[MOST][4], sum[MOST][4];
    const double volume = pow((double)s.dx, 3);
    exits out = {0, 0};
    double mean = 0; // of lengths, by solid angle
    for (int j = 0; j < LINKS; j++) {
        mean += gamma_of[j] * length[j];
    }
    for (uint32_t i = 0; i < s.cells; i++) {
        const float *m = s.medium[ch * s.cells + i], *u = s.source[ch * s.cells + i];
        for (int k = 0; k < 4; k++) {
            const double turn = k == 0 ? 1 : (double)m[2];
            const double once = volume * ((double)m[0] * turn * (double)u[k] +
                                          (k == 0 ? 4 * PI * (double)m[3] : 0));
            const double again = (double)s.reflected.unit * s.reflected.power[ch * s.cells + i][k];
            // Coefficients: of a function with integral P and first moment F.
            const double c = k == 0 ? band_0 : band_1;
            const double part = k == 0 ? 1 : 3;
            light[i][k] = (once + again) * part / (4 * PI) / c;
            sum[i][k] = (again + (double)s.params.own * once) * part / (4 * PI) / c;
        }
    }
    for (int iteration = 0; iteration < s.params.iterations; iteration++) {
        const double outside =
            s.lit_from_outside && iteration == 0
                ? 4 * PI * (double)(s.dx * s.dx) * (double)s.environment.sky[ch] /
                      (s.params.extinction == LPV_EXTINCTION_PAPER ? 1.4164218926549295 : mean)
                : 0;
        memset(next, 0, sizeof next);
        for (int z = 0; z < (int)s.n[2]; z++) {
            for (int y = 0; y < (int)s.n[1]; y++) {
                for (int x = 0; x < (int)s.n[0]; x++) {
                    const uint32_t here = at(x, y, z);
                    for (int j = 0; j < LINKS; j++) { // from here along link j
                        const int q[3] = {x + steps[j][0], y + steps[j][1], z + steps[j][2]};
                        const bool in = q[0] >= 0 && q[1] >= 0 && q[2] >= 0 && q[0] < (int)s.n[0] &&
                                        q[1] < (int)s.n[1] && q[2] < (int)s.n[2];
                        const uint32_t there = in ? at(q[0], q[1], q[2]) : 0;
                        int reverse = 0;
                        for (int k = 0; k < LINKS; k++) {
                            bool back = true;
                            for (int a = 0; a < 3; a++) {
                                back = back && steps[k][a] == -steps[j][a];
                            }
                            reverse = back ? k : reverse;
                        }
                        const double power = sent(light[here], s.medium[ch * s.cells + here], j);
                        double open = 1;
                        if (s.params.blockers == LPV_BLOCKERS_EXACT) {
                            open = s.links[here] >> j & 1 ? 0 : 1;
                        } else if (s.params.blockers == LPV_BLOCKERS_FUZZY) {
                            open =
                                1 - (in ? s.blocked[there][j] : s.blocked[here][reverse]) / 255.0;
                        }
                        const double inwards = in ? 0 : outside * gamma_of[j];
                        if (in) {
                            add(next[there], j, open * power);
                        } else {
                            add(next[here], reverse, open * inwards);
                            out.leaks += open * (power - inwards);
                        }
                        double back = 0;
                        if (s.params.bounces && open == 0 &&
                            s.params.blockers == LPV_BLOCKERS_EXACT) {
                            back = power * (double)s.albedo[here][12 + ch];
                            const double lobe[4] = {1, 2 / 3.0, 2 / 3.0, 2 / 3.0};
                            for (int k = 0; k < 4; k++) {
                                const double way = k ? -steps[j][k - 1] / length[j] * 3 : 1;
                                next[here][k] +=
                                    back * lobe[k] * way / (4 * PI) / (k ? band_1 : band_0);
                            }
                        }
                        out.walls += (1 - open) * power - back;
                    }
                }
            }
        }
        memcpy(light, next, sizeof light);
        for (uint32_t i = 0; i < s.cells; i++) {
            for (int k = 0; k < 4; k++) {
                sum[i][k] += light[i][k];
            }
        }
    }
    double forward = 0; // of lengths, by solid angle and mean cosine with the link
    for (int j = 0; j < LINKS; j++) {
        double along = 0;
        for (int a = 0; a < 3; a++) {
            along += unit_deposit[j][1 + a] * steps[j][a] / length[j] * band_1 * 4 * PI / 3;
        }
        forward += gamma_of[j] * length[j] * along;
    }
    for (uint32_t i = 0; i < s.cells; i++) {
        const float *m = s.medium[ch * s.cells + i];
        const double sigma_t = (double)m[0] + (double)m[1];
        double way = 0, ahead = 0;
        if (s.params.extinction == LPV_EXTINCTION_PAPER) {
            way = fmin(1.4164218926549295 * (double)s.dx, 1 / sigma_t);
            ahead = way * forward / mean;
        } else {
            for (int j = 0; j < LINKS; j++) {
                double along = 0;
                for (int a = 0; a < 3; a++) {
                    along += unit_deposit[j][1 + a] * steps[j][a] / length[j] * band_1 * 4 * PI / 3;
                }
                const double l = (1 - exp(-sigma_t * length[j] * (double)s.dx)) / sigma_t;
                way += gamma_of[j] * l;
                ahead += gamma_of[j] * l * along;
            }
        }
        for (int k = 0; k < 4; k++) {
            const double moment = k == 0 ? 4 * PI * band_0 : 4 * PI / 3 * band_1;
            moments[i][k] = sum[i][k] * moment * (k == 0 ? way : ahead) / volume;
        }
    }
    return out;
}

static void fill_randomly(void)
{
    for (uint32_t i = 0; i < s.channels * s.cells; i++) {
        s.medium[i][0] = (float)(0.01 + 3 * random_unit());
        s.medium[i][1] = (float)random_unit();
        s.medium[i][2] = (float)(random_unit() - 0.5);
        s.medium[i][3] = (float)(0.1 * random_unit());
        s.source[i][0] = (float)random_unit();
        for (int k = 1; k < 4; k++) {
            s.source[i][k] = (float)(random_unit() - 0.5);
        }
        s.reflected.power[i][0] = rand() % 1000;
        for (int k = 1; k < 4; k++) {
            s.reflected.power[i][k] = rand() % 500 - 250;
        }
    }
    for (uint32_t i = 0; i < s.cells; i++) {
        for (int k = 0; k < 26; k++) {
            s.blocked[i][k] = (uint8_t)(rand() % 256);
        }
        for (int ch = 0; ch < 3; ch++) {
            s.albedo[i][12 + ch] = (float)random_unit();
        }
    }
    // Both ends of a link agree.
    for (int z = 0; z < (int)s.n[2]; z++) {
        for (int y = 0; y < (int)s.n[1]; y++) {
            for (int x = 0; x < (int)s.n[0]; x++) {
                for (int j = 0; j < LINKS; j++) {
                    const int q[3] = {x + steps[j][0], y + steps[j][1], z + steps[j][2]};
                    const bool in = q[0] >= 0 && q[1] >= 0 && q[2] >= 0 && q[0] < (int)s.n[0] &&
                                    q[1] < (int)s.n[1] && q[2] < (int)s.n[2];
                    if (rand() % 5) {
                        continue;
                    }
                    s.links[at(x, y, z)] |= 1u << j;
                    for (int k = 0; in && k < LINKS; k++) {
                        if (steps[k][0] == -steps[j][0] && steps[k][1] == -steps[j][1] &&
                            steps[k][2] == -steps[j][2]) {
                            s.links[at(q[0], q[1], q[2])] |= 1u << k;
                        }
                    }
                }
            }
        }
    }
}

// Random lattices, media, masks and light: every blocker, both extinctions.
static void equals_twin(void **state)
{
    static double expected[MOST][4];
    project();
    srand(2);
    double worst = 0, worst_exit = 0;
    for (int k = 0; k < 8; k++) {
        start(7, 5, 6, k % 4 == 3 ? 1 : 3);
        fill_randomly();
        s.params.iterations = 3 + k;
        s.params.extinction = k % 2;
        s.params.blockers = k % 3;
        s.params.bounces = k / 4;
        s.params.own = 0.25f * (float)(k % 3);
        s.params.balance = 1;
        s.lit_from_outside = k % 4 == 1;
        for (int ch = 0; ch < 3; ch++) {
            s.environment.sky[ch] = 0.1f * (float)(1 + ch);
        }
        const solved found = run(*state);
        for (uint32_t ch = 0; ch < s.channels; ch++) {
            const exits out = twin(ch, expected);
            double scale[2] = {0, 0}, leaks = 0, walls = 0;
            for (uint32_t i = 0; i < s.cells; i++) {
                scale[0] = fmax(scale[0], fabs(expected[i][0]));
                leaks += (double)found.leaks[ch * s.cells + i];
                walls += (double)found.wall_power[ch * s.cells + i][0];
            }
            for (uint32_t i = 0; i < s.cells; i++) {
                for (int m = 0; m < 4; m++) {
                    const double off =
                        fabs((double)found.moments[ch * s.cells + i][m] - expected[i][m]);
                    worst = maximum(worst, off / scale[0]);
                }
            }
            const double all = fabs(out.leaks) + fabs(out.walls);
            worst_exit = maximum(worst_exit, fabs(leaks - out.leaks) / all);
            worst_exit = maximum(worst_exit, s.params.blockers ? fabs(walls - out.walls) / all
                                                               : relative(walls, all));
        }
    }
    print_message("moments off by %.1e of the largest, what leaves by %.1e\n", worst, worst_exit);
    assert_true(worst < 4e-5); // of the directions by which the twin integrates
    assert_true(worst_exit < 8e-6);
}

// ---- power ------------------------------------------------------------------------------------

static double power_in(const solved *found)
{
    const double volume = pow((double)s.dx, 3), way = 1.4164218926549295 * (double)s.dx;
    double sum = 0;
    for (uint32_t i = 0; i < s.cells; i++) {
        sum += (double)found->moments[i][0] * volume / way;
    }
    return sum;
}

// Light that starts in the middle of a lattice, in a medium that only scatters: the interior loses less than the paper's
// 1 % an iteration. And with walls and the boundary all that is lost is in the ledger.
static void conserves(void **state)
{
    double worst = 0, before = 1;
    for (int i = 1; i <= 8; i++) {
        start(20, 20, 20, 1);
        for (uint32_t c = 0; c < s.cells; c++) {
            s.medium[c][0] = 1.5f;
        }
        s.reflected.unit = 1;
        const int32_t lobe[4] = {3, 2, 0, 0};
        memcpy(s.reflected.power[at(10, 10, 10)], lobe, sizeof lobe);
        s.params.iterations = i;
        s.params.blockers = LPV_BLOCKERS_NONE;
        s.params.balance = 1;
        const solved found = run(*state);
        const double sum = power_in(&found) / 3;
        double leaks = 0;
        for (uint32_t c = 0; c < s.cells; c++) {
            leaks += (double)found.leaks[c] / 3;
        }
        // Each iteration adds what travels in it, 1 W of which nothing is lost.
        worst = maximum(worst, fabs(sum - before - (1 - leaks)));
        before = sum;
    }
    print_message(
        "lost in the interior: %.1e of the power an iteration; the paper: less than 1e-2\n", worst);
    assert_true(worst < 8e-7);
}

// A sky that is the same all around, in a medium that is hardly there: as bright everywhere inside, by both extinctions.
static void sky_in_nothing(void **state)
{
    for (int extinction = 0; extinction < 2; extinction++) {
        start(9, 7, 8, 1);
        for (uint32_t c = 0; c < s.cells; c++) {
            s.medium[c][1] = 1e-7f;
        }
        s.environment.sky[0] = s.environment.sky[1] = s.environment.sky[2] = 1;
        s.lit_from_outside = true;
        s.params.extinction = extinction;
        s.params.blockers = LPV_BLOCKERS_NONE;
        s.params.iterations = 64; // until hardly any is left inside
        const solved found = run(*state);
        double worst = 0, mean = 0, flux = 0;
        for (uint32_t c = 0; c < s.cells; c++) {
            const double fluence = (double)found.moments[c][0] / (4 * PI);
            worst = maximum(worst, fabs(fluence - 1));
            mean += fluence / s.cells;
            for (int k = 1; k < 4; k++) {
                flux = maximum(flux, fabs((double)found.moments[c][k]) / (4 * PI));
            }
        }
        print_message("%s: mean fluence %.5f of the sky's, off by %.1e at most; net flux %.1e\n",
                      extinction ? "exact" : "paper", mean, worst, flux);
        assert_within(worst, 2e-6, NULL);
    }
}

// Where sigma_t d is above 1 light is bounded, counted, and no more comes out than went in.
static void bounds_thick_cells(void **state)
{
    start(8, 8, 8, 1);
    for (uint32_t c = 0; c < s.cells; c++) {
        s.medium[c][0] = c % 2 ? 40.0f : 0.5f;
    }
    s.source[at(4, 4, 4)][0] = 1;
    s.source[at(3, 4, 4)][0] = 1;
    s.params.iterations = 16;
    const solved found = run(*state);
    const struct counters_block *counters = gpu_map(*state, "counters");
    assert_int_equal(counters->clamped, s.cells / 2);
    for (uint32_t c = 0; c < s.cells; c++) {
        assert_true(isfinite(found.moments[c][0]) && fabsf(found.moments[c][0]) < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants),          cmocka_unit_test(equals_twin),
        cmocka_unit_test(conserves),          cmocka_unit_test(sky_in_nothing),
        cmocka_unit_test(bounds_thick_cells),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
