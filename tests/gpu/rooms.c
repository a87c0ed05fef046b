// rooms.c -- which cells of the lattice open links join, and in which rooms virtual point lights (VPLs) shine: against
// a flood fill, and rays, on the CPU.
#include "gpu_test.h"
#include "wall_mesh.h"
#include "passes/rooms/rooms.h"
#include "shaders/beams/radial_args.h"
#include "shaders/walls/rooms.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, MAPS = 16 }; // texels of a VPL's map; maps in a row of their atlas
static const double FAR = 1e30;

// ---- what is given ------------------------------------------------------------------------------------

typedef struct lights {
    struct radial_vpls vpls;
    float maps[SIDE][MAPS * SIDE];
} lights;

// The first triangle that a ray meets, m.
static double distance_of(const mesh *m, const double o[3], const double d[3])
{
    double nearest = FAR;
    for (int i = 0; i < m->n; i++) {
        double e[2][3], s[3], n[3];
        for (int a = 0; a < 3; a++) {
            e[0][a] = m->tri[i][1][a] - m->tri[i][0][a];
            e[1][a] = m->tri[i][2][a] - m->tri[i][0][a];
            s[a] = o[a] - m->tri[i][0][a];
        }
        double det = 0, t = 0, u = 0, v = 0;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            n[a] = e[0][b] * e[1][c] - e[0][c] * e[1][b];
            det -= n[a] * d[a];
            t += n[a] * s[a];
        }
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const double across = s[b] * d[c] - s[c] * d[b];
            u += e[1][a] * across;
            v -= e[0][a] * across;
        }
        t /= det, u /= det, v /= det;
        if (fabs(det) > 1e-12 && u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < nearest) {
            nearest = t;
        }
    }
    return nearest;
}

// The direction of a texel of a VPL's map (vpl_visibility.glsl): octahedral, in the frame of Duff et al.
static void direction_of(const float axis[3], int i, int j, double d[3])
{
    const double x = 2.0 * i / (SIDE - 1) - 1, y = 2.0 * j / (SIDE - 1) - 1;
    double p = 0.5 * (x + y), q = 0.5 * (x - y), z = 1 - fabs(p) - fabs(q);
    const double length = sqrt(p * p + q * q + z * z);
    const double *n = (double[]){axis[0], axis[1], axis[2]}, s = n[2] >= 0 ? 1 : -1;
    const double a = -1 / (s + n[2]), b = n[0] * n[1] * a;
    const double u[3] = {1 + s * n[0] * n[0] * a, s * b, -s * n[0]};
    const double v[3] = {b, s + n[1] * n[1] * a, -n[1]};
    for (int c = 0; c < 3; c++) {
        d[c] = (p * u[c] + q * v[c] + z * n[c]) / length;
    }
}

// Where its rays begin.
static void origin_of(const struct radial_light *l, double o[3])
{
    double reach = (double)l->radius;
    for (int a = 0; a < 3; a++) {
        reach = fmax(reach, fabs((double)l->position[a]));
    }
    for (int a = 0; a < 3; a++) {
        o[a] =
            (double)l->position[a] + (0.02 * (double)l->radius + 1e-5 * reach) * (double)l->axis[a];
    }
}

static void add_light(lights *list, const mesh *m, const double p[3], const double axis[3])
{
    const uint32_t k = list->vpls.count++;
    struct radial_light *l = &list->vpls.list[k];
    double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), o[3];
    for (int a = 0; a < 3; a++) {
        l->position[a] = (float)p[a];
        l->axis[a] = (float)(axis[a] / length);
    }
    l->kind = TYN_RADIAL_COSINE;
    l->radius = 0.02f;
    origin_of(l, o);
    for (int j = 0; j < SIDE; j++) {
        for (int i = 0; i < SIDE; i++) {
            double d[3];
            direction_of(l->axis, i, j, d);
            list->maps[j][(int)k * SIDE + i] = (float)distance_of(m, o, d);
        }
    }
}

// On triangle i, `edge` of the way from its middle to corner 0, on the side that it is wound for, or on the other.
static void add_light_on(lights *list, const mesh *m, int i, double edge, bool other)
{
    double p[3], n[3], e[2][3];
    for (int a = 0; a < 3; a++) {
        p[a] = (m->tri[i][0][a] + m->tri[i][1][a] + m->tri[i][2][a]) / 3;
        p[a] += edge * (m->tri[i][0][a] - p[a]);
        e[0][a] = m->tri[i][1][a] - m->tri[i][0][a];
        e[1][a] = m->tri[i][2][a] - m->tri[i][0][a];
    }
    double length = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        n[a] = (e[0][b] * e[1][c] - e[0][c] * e[1][b]) * (other ? -1 : 1);
        length += n[a] * n[a];
    }
    for (int a = 0; a < 3; a++) {
        p[a] += 1e-4 * n[a] / sqrt(length);
    }
    add_light(list, m, p, n);
}

static void mesh_join(mesh *to, mesh from)
{
    for (int i = 0; i < from.n; i++) {
        mesh_add(to, from.tri[i][0], from.tri[i][1], from.tri[i][2], 0.5f);
    }
    mesh_free(&from);
}

// ---- the same once more -------------------------------------------------------------------------------

static int cell_of(const grid *g, const int c[3])
{
    for (int a = 0; a < 3; a++) {
        if (c[a] < 0 || c[a] >= g->n[a]) {
            return -1;
        }
    }
    return (c[2] * g->n[1] + c[1]) * g->n[0] + c[0];
}

// The room of every cell is its first element: 0, all that is outside, or 1 + the cell.
static void flood(const grid *g, const uint32_t *links, uint32_t *rooms)
{
    const int total = g->n[0] * g->n[1] * g->n[2];
    int *queue = malloc(total * sizeof *queue);
    memset(rooms, 0xff, total * sizeof *rooms);
    for (int first = 0; first < total; first++) {
        if (rooms[first] != TYN_ROOMS_ANY) {
            continue;
        }
        int found = 0, head = 0;
        bool leaves = false;
        queue[found++] = first;
        rooms[first] = 1 + (uint32_t)first;
        while (head < found) {
            const int i = queue[head++];
            for (int link = 0; link < TYN_WALLS_LINKS; link++) {
                int d[3];
                wall_step(link, d);
                const int c[3] = {i % g->n[0] + d[0], i / g->n[0] % g->n[1] + d[1],
                                  i / g->n[0] / g->n[1] + d[2]};
                const int q = cell_of(g, c);
                const bool open = !(links[i] >> link & 1);
                leaves = leaves || (open && q < 0);
                if (open && q >= 0 && rooms[q] == TYN_ROOMS_ANY) {
                    rooms[q] = 1 + (uint32_t)first;
                    queue[found++] = q;
                }
            }
        }
        for (int k = 0; k < found && leaves; k++) {
            rooms[queue[k]] = TYN_ROOMS_OUTSIDE;
        }
    }
    free(queue);
}

// Is c right beside the lattice, and a wall between it and the cell next to it?
static bool walled(const grid *g, const uint32_t *links, const int c[3])
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        at[a] = c[a] < 0 ? 0 : c[a] >= g->n[a] ? g->n[a] - 1 : c[a];
    }
    for (int link = 0; link < TYN_WALLS_LINKS; link++) {
        int d[3];
        wall_step(link, d);
        if (at[0] + d[0] == c[0] && at[1] + d[1] == c[1] && at[2] + d[2] == c[2]) {
            return links[cell_of(g, at)] >> link & 1;
        }
    }
    return false;
}

// The room that a ray of VPL k tells of: of the places 1.8 cells before its end, and at 0.84 of that, eleven times, the
// first in a cell without walls.
static uint32_t told_by(const grid *g, const uint32_t *links, const uint32_t *rooms,
                        const lights *l, uint32_t k, int i, int j)
{
    double o[3], d[3];
    origin_of(&l->vpls.list[k], o);
    direction_of(l->vpls.list[k].axis, i, j, d);
    double place = fmin((double)l->maps[j][(int)k * SIDE + i], 1e4 * g->dx) - 1.8 * g->dx;
    for (int step = 0; step < 12 && place > 0; step++, place *= 0.84) {
        int c[3];
        for (int a = 0; a < 3; a++) {
            c[a] = (int)floor((o[a] + place * d[a]) / g->dx);
        }
        const int q = cell_of(g, c);
        if (q >= 0 && !(links[q] & TYN_WALLS_NEAR)) {
            return rooms[q];
        }
        if (q < 0 && !walled(g, links, c)) {
            return TYN_ROOMS_OUTSIDE;
        }
    }
    return TYN_ROOMS_ANY;
}

// `joined`: of each room the one that it has become a part of, or itself.
static uint32_t room_of(const uint32_t *joined, uint32_t room)
{
    while (room != TYN_ROOMS_ANY && joined[room] != room) {
        room = joined[room];
    }
    return room;
}

// Joins what VPLs see, and tells the room of each; then cells have theirs.
static void see(const grid *g, const uint32_t *links, uint32_t *rooms, const lights *l,
                uint32_t *of_vpls)
{
    const uint32_t total = (uint32_t)(g->n[0] * g->n[1] * g->n[2]);
    uint32_t *joined = malloc((1 + total) * sizeof *joined);
    for (uint32_t i = 0; i <= total; i++) {
        joined[i] = i;
    }
    for (uint32_t k = 0; k < l->vpls.count; k++) {
        of_vpls[k] = TYN_ROOMS_ANY;
        for (int j = 0; j < SIDE; j++) {
            for (int i = 0; i + 1 < SIDE; i += 2) {
                const uint32_t a = told_by(g, links, rooms, l, k, i, j);
                const uint32_t b = told_by(g, links, rooms, l, k, i + 1, j);
                if (a == b && a != TYN_ROOMS_ANY) {
                    const uint32_t x = room_of(joined, a), y = room_of(joined, of_vpls[k]);
                    joined[x > y || y == TYN_ROOMS_ANY ? x : y] = x < y ? x : y;
                    of_vpls[k] = x < y ? x : y;
                }
            }
        }
    }
    for (uint32_t k = 0; k < l->vpls.count; k++) {
        of_vpls[k] = room_of(joined, of_vpls[k]);
    }
    for (uint32_t i = 0; i < total; i++) {
        rooms[i] = room_of(joined, rooms[i]);
    }
    free(joined);
}

// The cell that VPL k shines from, as rooms.h tells it.
static uint32_t cell_before(const grid *g, const uint32_t *rooms, const struct radial_light *l,
                            uint32_t room)
{
    double x[3], nearest = FAR;
    int c[3];
    uint32_t found = TYN_ROOMS_NONE;
    for (int a = 0; a < 3; a++) {
        x[a] = (double)l->position[a] / g->dx + 0.75 * (double)l->axis[a];
    }
    for (int k = 0; k < 27; k++) {
        const int d[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        double away = 0;
        for (int a = 0; a < 3; a++) {
            c[a] = (int)floor(x[a]) + d[a];
            away += (c[a] + 0.5 - x[a]) * (c[a] + 0.5 - x[a]);
        }
        const int q = cell_of(g, c);
        if ((q < 0 ? TYN_ROOMS_OUTSIDE : rooms[q]) != room) {
            continue;
        }
        if (k == 13) {
            return TYN_ROOMS_ANY;
        }
        if (q >= 0 && away < nearest) {
            nearest = away;
            found = (uint32_t)q;
        }
    }
    return found;
}

// ---- tests --------------------------------------------------------------------------------------------

typedef struct outcome {
    int rooms;              // that are not outside
    uint32_t of_vpls[MAPS]; // as the pass has them
    int elsewhere;          // VPLs that shine from another cell than the one before them
} outcome;

// Runs the passes, and compares all that they tell.
static outcome check(gpu_test *t, const grid *g, const mesh *m, const lights *l)
{
    const int total = g->n[0] * g->n[1] * g->n[2];
    tyn_graph_begin(t->graph);
    const wall_refs w = mesh_walls(t, g, m);
    tyn_rooms_params params;
    tyn_pass_defaults(&tyn_pass_rooms, &params);
    for (int a = 0; a < 3; a++) {
        params.extent[a] = (float)g->extent[a];
        params.dims[a] = (uint32_t)g->n[a];
    }
    tyn_ref refs[ROOMS_NUM_PORTS] = {
        [ROOMS_PORT_WALL_LINKS] = w.links,
        [ROOMS_PORT_VPLS] = gpu_buffer(t, "vpls", &l->vpls, sizeof l->vpls),
        [ROOMS_PORT_VPL_DISTANCES] = gpu_image(t, "distances", TYN_IMAGE_2D,
                                               (tyn_extent){MAPS * SIDE, SIDE, 1}, 1, l->maps[0]),
    };
    assert_int_equal(tyn_graph_add(t->graph, &tyn_pass_rooms, &params, refs), TYN_OK);
    tyn_graph_output(t->graph, "rooms", refs[ROOMS_PORT_ROOMS], true);
    tyn_graph_output(t->graph, "links", w.links, true);
    gpu_run(t);
    const uint32_t *links = gpu_map(t, "links"), *rooms = gpu_map(t, "rooms");
    uint32_t *expected = malloc(total * sizeof *expected), of_vpls[MAPS];
    flood(g, links, expected);
    see(g, links, expected, l, of_vpls);
    assert_int_equal(rooms[0], TYN_ROOMS_OUTSIDE);
    assert_memory_equal(rooms + 1, expected, total * sizeof *expected);
    outcome found = {0};
    for (int i = 0; i < total; i++) {
        found.rooms += expected[i] == 1 + (uint32_t)i;
    }
    const uint32_t *told = rooms + TYN_ROOMS_OF_VPL(total, 0);
    const uint32_t *before = rooms + TYN_ROOMS_BEFORE_VPL(total, 0);
    for (uint32_t k = 0; k < TYN_RADIAL_VPLS_MAX; k++) {
        const bool is = k < l->vpls.count;
        assert_int_equal(told[k], is ? of_vpls[k] : TYN_ROOMS_ANY);
        const bool known = is && of_vpls[k] != TYN_ROOMS_ANY;
        const uint32_t cell =
            known ? cell_before(g, expected, &l->vpls.list[k], of_vpls[k]) : TYN_ROOMS_ANY;
        assert_int_equal(before[k], cell);
        found.elsewhere += cell != TYN_ROOMS_ANY;
    }
    memcpy(found.of_vpls, told, sizeof found.of_vpls);
    free(expected);
    return found;
}

static lights some; // large

static double any(double from, double to)
{
    return from + (to - from) * rand() / RAND_MAX;
}

// Closed meshes in each other, through each other and through the lattice's sides, wherever they lie.
static void closed_meshes(void **state)
{
    srand(3);
    int rooms = 0, lit_rooms = 0, unknown = 0, elsewhere = 0;
    for (int k = 0; k < 8; k++) {
        const grid g = grid_of(22 + k, 20, 24, 0.05);
        mesh m = {0};
        for (int i = 0; i < 7; i++) {
            double c[3], h[3];
            for (int a = 0; a < 3; a++) {
                c[a] = any(0.2, 0.8) * g.extent[a];
                h[a] = any(0.1, 0.4);
            }
            mesh_join(&m, i % 2 ? mesh_box(c, h, any(0, 3)) : mesh_sphere(c, h[0], 2));
        }
        memset(&some, 0, sizeof some);
        while (some.vpls.count < MAPS) {
            add_light_on(&some, &m, rand() % m.n, any(0, 0.95), rand() % 2);
        }
        const outcome found = check(*state, &g, &m, &some);
        rooms += found.rooms;
        elsewhere += found.elsewhere;
        for (int i = 0; i < MAPS; i++) {
            unknown += found.of_vpls[i] == TYN_ROOMS_ANY;
            lit_rooms += found.of_vpls[i] - 1 < TYN_ROOMS_NONE - 1;
        }
        mesh_free(&m);
    }
    print_message("8 lattices: %d rooms; of %d VPLs %d shine in one, %d in an unknown one, %d from "
                  "another cell\n",
                  rooms, 8 * MAPS, lit_rooms, unknown, elsewhere);
    assert_true(rooms > 100 && lit_rooms > 16 && unknown < 64 && elsewhere > 2);
}

// VPLs on the insides and outsides of a sealed box in another one that is around the lattice.
static void box_in_a_box(void **state)
{
    const grid g = grid_of(24, 24, 24, 1.0 / 24);
    const double centre[3] = {0.5, 0.5, 0.5}, half[3] = {0.5, 0.5, 0.5};
    mesh m = mesh_box(centre, (double[]){0.23, 0.19, 0.26}, 0.5);
    mesh_join(&m, mesh_box(centre, half, 0));
    memset(&some, 0, sizeof some);
    for (int i = 0; i < 12; i += 4) { // inwards and outwards
        add_light_on(&some, &m, i, 0, false);
        add_light_on(&some, &m, i, 0, true);
    }
    add_light(&some, &m, (double[]){0.1, 0.001, 0.2}, (double[]){0, 1, 0});
    const outcome found = check(*state, &g, &m, &some);
    assert_int_equal(found.rooms, 2);
    const uint32_t middle = (12 * 24 + 12) * 24 + 12;
    const uint32_t inside = ((const uint32_t *)gpu_map(*state, "rooms"))[TYN_ROOMS_OF_CELL(middle)];
    int within = 0;
    for (int i = 0; i < 7; i++) {
        assert_true(found.of_vpls[i] == inside || found.of_vpls[i] == 1);
        within += found.of_vpls[i] == inside;
    }
    assert_true(inside > 1 && within == 3 && found.of_vpls[6] == 1);
    mesh_free(&m);
}

// A sealed box that is larger than the lattice, by less than half a cell: its VPLs shine in it, not outside.
static void box_around_the_lattice(void **state)
{
    const grid g = grid_of(12, 12, 12, 1.0 / 12);
    mesh m = mesh_box((double[]){0.5, 0.5, 0.5}, (double[]){0.535, 0.53, 0.538}, 0);
    memset(&some, 0, sizeof some);
    for (int i = 0; i < 12; i++) {
        const double *corner = m.tri[i][0], *other = m.tri[i][2];
        double p[3], inwards[3];
        for (int a = 0; a < 3; a++) {
            p[a] = 0.5 * (corner[a] + other[a]);
            inwards[a] = fabs(p[a] - 0.5) > 0.5 ? 0.5 - p[a] : 0;
            p[a] += 1e-3 * (0.5 - p[a]);
        }
        add_light(&some, &m, p, inwards);
    }
    const outcome found = check(*state, &g, &m, &some);
    assert_int_equal(found.rooms, 1);
    for (int i = 0; i < 12; i++) {
        assert_int_equal(found.of_vpls[i], 1);
    }
    mesh_free(&m);
}

// A box whose wall has a slit that no link goes through: two rooms, which a VPL joins that sees through it.
static void slit(void **state)
{
    const grid g = grid_of(16, 16, 16, 1.0 / 16);
    const double lo = 0.25, hi = 0.75, from = 8.1 / 16,
                 to = 8.4 / 16; // links go through the wall at 8 and at 8.5
    for (int k = 0; k < 3; k++) {
        mesh m = mesh_box((double[]){0.5, 0.5, 0.5}, (double[]){0.25, 0.25, 0.25}, 0);
        mesh open = {0};
        for (int i = 0; i < m.n; i++) {
            bool upper = true; // the wall at x = 0.75
            for (int v = 0; v < 3; v++) {
                upper = upper && m.tri[i][v][0] > 0.7;
            }
            if (!upper) {
                mesh_add(&open, m.tri[i][0], m.tri[i][1], m.tri[i][2], 0.5f);
            }
        }
        for (int part = 0; part < 2; part++) {
            const double y0 = part ? to : lo, y1 = part ? hi : from;
            const double v[4][3] = {{hi, y0, lo}, {hi, y1, lo}, {hi, y1, hi}, {hi, y0, hi}};
            mesh_add(&open, v[0], v[1], v[2], 0.5f);
            mesh_add(&open, v[0], v[2], v[3], 0.5f);
        }
        memset(&some, 0, sizeof some);
        if (k > 0) { // in the middle before the slit; far from it, whose rays pass it by
            const double y = k == 1 ? 0.5 * (from + to) : lo + 0.05;
            add_light(&some, &open, (double[]){k == 1 ? hi - 0.08 : lo + 0.001, y, 0.5},
                      (double[]){1, 0, 0});
        }
        const outcome found = check(*state, &g, &open, &some);
        print_message("slit, %s: %d rooms\n",
                      k == 0   ? "no VPL"
                      : k == 1 ? "VPL before it"
                               : "VPL far off",
                      found.rooms);
        assert_int_equal(found.rooms, k == 1 ? 0 : 1);
        mesh_free(&m);
        mesh_free(&open);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_meshes),
        cmocka_unit_test(box_in_a_box),
        cmocka_unit_test(box_around_the_lattice),
        cmocka_unit_test(slit),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
