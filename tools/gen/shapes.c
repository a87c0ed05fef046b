// shapes.c -- the shapes that the sample scenes are built of: all closed, their fronts outwards.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh.h"
#include "portable.h"

void gen_add_box(gen_mesh *mesh, const float lo[3], const float hi[3], float tile)
{
    const float corners[4][2] = {{lo[0], hi[2]}, {hi[0], hi[2]}, {hi[0], lo[2]}, {lo[0], lo[2]}};
    gen_add_prism(mesh, corners, 4, lo[1], hi[1], tile);
}

void gen_add_prism(gen_mesh *mesh, const float (*corners)[2], int n, float bottom, float top,
                   float tile)
{
    for (int i = 0; i < n; i++) {
        const float *p = corners[i], *q = corners[(i + 1) % n];
        gen_add_quad(mesh, (const float[3]){p[0], bottom, p[1]},
                     (const float[3]){q[0], bottom, q[1]}, (const float[3]){q[0], top, q[1]},
                     (const float[3]){p[0], top, p[1]}, tile);
    }
    for (int side = 0; side < 2; side++) {
        const float normal[3] = {0, side ? 1.0f : -1.0f, 0};
        const uint32_t first = mesh->num_vertices;
        for (int i = 0; i < n; i++) {
            const float p[3] = {corners[i][0], side ? top : bottom, corners[i][1]};
            gen_add_vertex(mesh, p, normal, (const float[2]){p[0] / tile, p[2] / tile});
        }
        for (uint32_t i = 1; i + 1 < (uint32_t)n; i++) {
            gen_add_triangle(mesh, first, first + i + !side, first + i + side);
        }
    }
}

// The outward normal of edge i of a profile.
static void edge_normal(const float (*profile)[2], int i, float out[2])
{
    const float r = profile[i + 1][0] - profile[i][0], y = profile[i + 1][1] - profile[i][1];
    const float length = sqrtf(r * r + y * y);
    out[0] = y / length;
    out[1] = -r / length;
}

// The normal of edge i at its end towards edge j: shared with that edge where the bend is slight.
static void shared_normal(const float (*profile)[2], int n, int i, int j, float out[2])
{
    edge_normal(profile, i, out);
    if (j < 0 || j >= n - 1) {
        return;
    }
    float other[2];
    edge_normal(profile, j, other);
    if (out[0] * other[0] + out[1] * other[1] > 0.77f) {
        const float r = out[0] + other[0], y = out[1] + other[1], length = sqrtf(r * r + y * y);
        out[0] = r / length;
        out[1] = y / length;
    }
}

void gen_add_lathe(gen_mesh *mesh, const float (*profile)[2], int n, float x, float z, int segments,
                   float tile)
{
    float widest = 0, length = 0;
    for (int i = 0; i < n; i++) {
        widest = profile[i][0] > widest ? profile[i][0] : widest;
    }
    // A whole number of repetitions around.
    const float around = floorf(2.0f * (float)GEN_PI * widest / tile + 0.5f);
    for (int i = 0; i + 1 < n; i++) {
        const float r = profile[i + 1][0] - profile[i][0], y = profile[i + 1][1] - profile[i][1];
        const uint32_t first = mesh->num_vertices;
        for (int end = 0; end < 2; end++) {
            const float *p = profile[i + end];
            float normal[2];
            shared_normal(profile, n, i, end ? i + 1 : i - 1, normal);
            const float along = length + (end ? sqrtf(r * r + y * y) : 0.0f);
            for (int s = 0; s <= segments; s++) {
                const double turn = 2.0 * GEN_PI * (s % segments) / segments;
                const float c = (float)gen_cos(turn), d = (float)gen_sin(turn);
                const float place[3] = {x + p[0] * c, p[1], z - p[0] * d};
                const float towards[3] = {normal[0] * c, normal[1], -normal[0] * d};
                const float u = (around > 1 ? around : 1) * (float)s / (float)segments;
                gen_add_vertex(mesh, place, towards, (const float[2]){u, -along / tile});
            }
        }
        length += sqrtf(r * r + y * y);
        const uint32_t row = (uint32_t)segments + 1;
        for (uint32_t s = 0; s < (uint32_t)segments; s++) {
            const uint32_t a = first + s;
            gen_add_triangle(mesh, a, a + 1, a + row + 1);
            gen_add_triangle(mesh, a, a + row + 1, a + row);
        }
    }
}

void gen_add_ball(gen_mesh *mesh, const float center[3], float radius, int segments)
{
    float profile[33][2];
    const int rings = segments / 2 < 32 ? segments / 2 : 32;
    for (int i = 0; i <= rings; i++) {
        const double angle = GEN_PI * i / rings;
        // The poles lie on the axis, whatever the last digit of the sine.
        profile[i][0] = i == 0 || i == rings ? 0.0f : radius * (float)gen_sin(angle);
        profile[i][1] = center[1] - radius * (float)gen_cos(angle);
    }
    gen_add_lathe(mesh, (const float(*)[2])profile, rings + 1, center[0], center[2], segments,
                  1.0f);
}

// ---- walls with arches ---------------------------------------------------------------------------

enum { MAX_CONTOUR = 256 };

// Two contours of as many points (distance along the wall, height), paired, clockwise seen from +x: the
// opening's and the bay's.
typedef struct contours {
    float inner[MAX_CONTOUR][2], outer[MAX_CONTOUR][2];
    int count, left_top, right_top,
        right_bottom; // points of `outer` that are corners; 0 is the first
} contours;

static void add_pair(contours *c, float inner_u, float inner_y, float outer_u, float outer_y)
{
    if (c->count == MAX_CONTOUR) {
        fprintf(stderr, "too many points on an arch\n");
        exit(1);
    }
    c->inner[c->count][0] = inner_u;
    c->inner[c->count][1] = inner_y;
    c->outer[c->count][0] = outer_u;
    c->outer[c->count++][1] = outer_y;
}

// From the lower left corner up, over the arch, down and back.
static contours bay_contours(const gen_arches *w, int bay)
{
    contours c = {.count = 0};
    const float left = w->bay * (float)bay, right = w->bay * (float)(bay + 1);
    const float middle = 0.5f * (left + right);
    const int n = w->steps;
    add_pair(&c, middle - w->half, w->sill, left, w->bottom);
    for (int i = 0; i <= 2 * n; i++) { // the arch, from its left springing to its right one
        const double angle = GEN_PI * (1.0 - 0.5 * i / n);
        const float u = i == 0       ? middle - w->half
                        : i == 2 * n ? middle + w->half
                                     : middle + w->half * (float)gen_cos(angle);
        const float y = w->spring + (i == 0 || i == 2 * n ? 0.0f : w->half * (float)gen_sin(angle));
        const int from_end = i <= n ? i : 2 * n - i; // up the side, then along the top
        const float up = from_end < n / 2 ? (float)from_end / (float)(n / 2) : 1.0f;
        const float over = (float)(i - n / 2) / (float)n;
        const float side = i <= n ? left : right;
        if (from_end == n / 2) {
            *(i <= n ? &c.left_top : &c.right_top) = c.count;
        }
        add_pair(&c, u, y, from_end <= n / 2 ? side : left + (right - left) * over,
                 w->spring + (w->top - w->spring) * up);
    }
    c.right_bottom = c.count;
    add_pair(&c, middle + w->half, w->sill, right, w->bottom);
    return c;
}

// Distance along, height and x as a point of the scene.
static void place(const gen_arches *w, const float uy[2], float x, float out[3])
{
    out[0] = x;
    out[1] = uy[1];
    out[2] = w->from - uy[0];
}

// The quadrangle between points i and j of a contour, over the wall's thickness.
static void add_reveal(gen_mesh *mesh, const gen_arches *w, const float p[2], const float q[2],
                       bool inwards)
{
    float a[3], b[3], c[3], d[3];
    place(w, inwards ? q : p, w->inside, a);
    place(w, inwards ? q : p, w->outside, b);
    place(w, inwards ? p : q, w->outside, c);
    place(w, inwards ? p : q, w->inside, d);
    gen_add_quad(mesh, a, b, c, d, w->tile);
}

void gen_add_arches(gen_mesh *mesh, gen_mesh *outer, const gen_arches *wall)
{
    for (int bay = 0; bay < wall->bays; bay++) {
        const contours c = bay_contours(wall, bay);
        const bool open = wall->sill <= wall->bottom;
        for (int i = 0; i < c.count - open; i++) {
            const int j = (i + 1) % c.count;
            float p[4][3];
            place(wall, c.outer[i], wall->outside, p[0]);
            place(wall, c.outer[j], wall->outside, p[1]);
            place(wall, c.inner[j], wall->outside, p[2]);
            place(wall, c.inner[i], wall->outside, p[3]);
            gen_add_quad(outer ? outer : mesh, p[3], p[2], p[1], p[0], wall->tile);
            for (int k = 0; k < 4; k++) {
                p[k][0] = wall->inside;
            }
            gen_add_quad(mesh, p[0], p[1], p[2], p[3], wall->tile);
            add_reveal(mesh, wall, c.inner[i], c.inner[j], true);
            const bool side = i < c.left_top || (i >= c.right_top && i < c.right_bottom);
            const bool end = i < c.left_top ? bay == 0 : bay == wall->bays - 1;
            if (!side || end) { // bays share their sides
                add_reveal(mesh, wall, c.outer[i], c.outer[j], false);
            }
        }
        if (open) { // what the arch stands on
            const int last = c.count - 1;
            add_reveal(mesh, wall, c.inner[0], c.outer[0], false);
            add_reveal(mesh, wall, c.outer[last], c.inner[last], false);
        }
    }
}
