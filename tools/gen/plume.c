// plume.c -- a plume of hot smoke that rises into still air: a small fluid simulation.
//
// Velocity and concentration live on a coarse grid: MacCormack advection (Selle et al., "An
// unconditionally stable MacCormack method", 2008), buoyancy, vorticity confinement (Fedkiw, Stam and
// Jensen, "Visual simulation of smoke", 2001) and a pressure projection. The smoke itself is not
// read from that grid, which would be blurred: every fine voxel is traced back through the last
// velocities, and takes the concentration of the place that it came from.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noise.h"
#include "scenes.h"

enum {
    NX = 48,
    NY = 80,
    NZ = 48,
    CELLS = NX * NY * NZ,
    STEPS = 120,
    TRACED = 40, // last steps, even
    RELAXATIONS = 24,
    FINE = 2, // voxels a cell
    SAMPLES = 4,
};

// x, y, z velocity in cells a step, and the concentration of the smoke, which is hot.
typedef float vec4 __attribute__((vector_size(16)));

typedef struct fluid {
    vec4 *state, *forward, *back;
    float *pressure, *divergence;
    vec4 *curl;             // and its length
    vec4 *history;          // state of every second one of the traced steps
    float source[STEPS][2]; // x and z of the source's centre, cells
} fluid;

static inline size_t cell(int x, int y, int z)
{
    return ((size_t)z * NY + (size_t)y) * NX + (size_t)x;
}

static inline float clampf(float v, float lo, float hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

typedef struct stencil {
    size_t base, dx, dy, dz;
    float fx, fy, fz;
} stencil;

static inline stencil locate(float x, float y, float z)
{
    x = clampf(x, 0.0f, NX - 1.001f);
    y = clampf(y, 0.0f, NY - 1.001f);
    z = clampf(z, 0.0f, NZ - 1.001f);
    const int ix = (int)x, iy = (int)y, iz = (int)z;
    return (stencil){cell(ix, iy, iz), 1, NX, (size_t)NX * NY, x - (float)ix, y - (float)iy,
                     z - (float)iz};
}

static inline vec4 sample(const vec4 *field, float x, float y, float z)
{
    const stencil s = locate(x, y, z);
    const vec4 *p = field + s.base;
    const vec4 a = p[0] + (p[s.dx] - p[0]) * s.fx;
    const vec4 b = p[s.dy] + (p[s.dy + s.dx] - p[s.dy]) * s.fx;
    p += s.dz;
    const vec4 c = p[0] + (p[s.dx] - p[0]) * s.fx;
    const vec4 d = p[s.dy] + (p[s.dy + s.dx] - p[s.dy]) * s.fx;
    const vec4 e = a + (b - a) * s.fy, f = c + (d - c) * s.fy;
    return e + (f - e) * s.fz;
}

#define SOURCE 7.5f // radius of the source, cells

// How far inside the source a point is: 1 in its middle, 0 outside. The source wanders a little.
static float source(const fluid *f, float x, float y, float z, int step)
{
    const float dx = x - f->source[step][0];
    const float dy = (y - 0.65f * SOURCE) * 1.7f;
    const float dz = z - f->source[step][1];
    const float r2 = (dx * dx + dy * dy + dz * dz) / (SOURCE * SOURCE);
    return r2 < 1.0f ? 1.0f - r2 * r2 : 0.0f;
}

static void add_source(fluid *f, int step)
{
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < 16; y++) {
            for (int x = 0; x < NX; x++) {
                const float s = source(f, (float)x, (float)y, (float)z, step);
                if (s <= 0.0f) {
                    continue;
                }
                vec4 *u = &f->state[cell(x, y, z)];
                const float t = (float)step * 0.11f;
                const float px = (float)x * 0.21f, py = (float)y * 0.21f, pz = (float)z * 0.21f;
                const vec4 gust = {gen_perlin(px, py + t, pz, 21), gen_perlin(px, py + t, pz, 22),
                                   gen_perlin(px, py + t, pz, 23), 0.0f};
                *u += gust * (0.25f * s);
                (*u)[1] += (0.7f - (*u)[1]) * s * 0.3f;
                const float heat = 0.8f + 0.4f * gen_perlin(px, py, pz + t, 24);
                (*u)[3] += (heat - (*u)[3]) * s * 0.5f;
            }
        }
    }
}

static void add_forces(fluid *f)
{
    const float buoyancy = 0.03f, confinement = 0.1f;
    const size_t sx = 1, sy = NX, sz = (size_t)NX * NY;
    for (int z = 1; z < NZ - 1; z++) {
        for (int y = 1; y < NY - 1; y++) {
            for (int x = 1; x < NX - 1; x++) {
                const vec4 *u = &f->state[cell(x, y, z)];
                const vec4 dx = u[sx] - *(u - sx), dy = u[sy] - *(u - sy), dz = u[sz] - *(u - sz);
                const float wx = 0.5f * (dy[2] - dz[1]), wy = 0.5f * (dz[0] - dx[2]);
                const float wz = 0.5f * (dx[1] - dy[0]);
                f->curl[cell(x, y, z)] = (vec4){wx, wy, wz, sqrtf(wx * wx + wy * wy + wz * wz)};
            }
        }
    }
    for (int z = 1; z < NZ - 1; z++) {
        for (int y = 1; y < NY - 1; y++) {
            for (int x = 1; x < NX - 1; x++) {
                const vec4 *w = &f->curl[cell(x, y, z)];
                const float nx = w[sx][3] - (*(w - sx))[3], ny = w[sy][3] - (*(w - sy))[3];
                const float nz = w[sz][3] - (*(w - sz))[3];
                const float k = confinement / (sqrtf(nx * nx + ny * ny + nz * nz) + 1e-5f);
                vec4 *u = &f->state[cell(x, y, z)];
                const vec4 push = {ny * (*w)[2] - nz * (*w)[1], nz * (*w)[0] - nx * (*w)[2],
                                   nx * (*w)[1] - ny * (*w)[0], 0.0f};
                *u += push * k;
                (*u)[1] += buoyancy * (*u)[3];
            }
        }
    }
}

static void advect(fluid *f)
{
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < NY; y++) {
            for (int x = 0; x < NX; x++) {
                const vec4 u = f->state[cell(x, y, z)];
                f->forward[cell(x, y, z)] =
                    sample(f->state, (float)x - u[0], (float)y - u[1], (float)z - u[2]);
            }
        }
    }
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < NY; y++) {
            for (int x = 0; x < NX; x++) {
                const size_t i = cell(x, y, z);
                const vec4 u = f->state[i];
                const vec4 returned =
                    sample(f->forward, (float)x + u[0], (float)y + u[1], (float)z + u[2]);
                vec4 v = f->forward[i] + (u - returned) * 0.5f;
                // No new extrema: stay within the values that the first sweep interpolated.
                const stencil s = locate((float)x - u[0], (float)y - u[1], (float)z - u[2]);
                vec4 lo = f->state[s.base], hi = lo;
                for (int k = 1; k < 8; k++) {
                    const vec4 c = f->state[s.base + (k & 1 ? s.dx : 0) + (k & 2 ? s.dy : 0) +
                                            (k & 4 ? s.dz : 0)];
                    for (int a = 0; a < 4; a++) {
                        lo[a] = c[a] < lo[a] ? c[a] : lo[a];
                        hi[a] = c[a] > hi[a] ? c[a] : hi[a];
                    }
                }
                for (int a = 0; a < 4; a++) {
                    v[a] = clampf(v[a], lo[a], hi[a]);
                }
                f->back[i] = v;
            }
        }
    }
    vec4 *old = f->state;
    f->state = f->back;
    f->back = old;
}

// Velocity on the face between a cell and its neighbour; the floor is solid, the rest is open.
static inline float face(const fluid *f, int x, int y, int z, int axis)
{
    const int n[3] = {NX, NY, NZ}, at[3] = {x, y, z};
    if (axis == 1 && y == 0) {
        return 0.0f;
    }
    const float here = at[axis] < n[axis] ? f->state[cell(x, y, z)][axis] : 0.0f;
    const float before =
        at[axis] > 0 ? f->state[cell(x - (axis == 0), y - (axis == 1), z - (axis == 2))][axis]
                     : here;
    return 0.5f * ((at[axis] < n[axis] ? here : before) + before);
}

static void relax(fluid *f, int color)
{
    const float over = 1.75f;
    const size_t sx = 1, sy = NX, sz = (size_t)NX * NY;
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < NY; y++) {
            for (int x = (y + z + color) & 1; x < NX; x += 2) {
                float *p = &f->pressure[cell(x, y, z)];
                float sum = 0.0f; // outside the open sides the pressure is 0
                sum += x > 0 ? *(p - sx) : 0.0f;
                sum += x < NX - 1 ? p[sx] : 0.0f;
                sum += y > 0 ? *(p - sy) : 0.0f;
                sum += y < NY - 1 ? p[sy] : 0.0f;
                sum += z > 0 ? *(p - sz) : 0.0f;
                sum += z < NZ - 1 ? p[sz] : 0.0f;
                const float neighbours = y > 0 ? 6.0f : 5.0f;
                *p += over * ((sum - f->divergence[cell(x, y, z)]) / neighbours - *p);
            }
        }
    }
}

static void project(fluid *f)
{
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < NY; y++) {
            for (int x = 0; x < NX; x++) {
                f->divergence[cell(x, y, z)] = face(f, x + 1, y, z, 0) - face(f, x, y, z, 0) +
                                               face(f, x, y + 1, z, 1) - face(f, x, y, z, 1) +
                                               face(f, x, y, z + 1, 2) - face(f, x, y, z, 2);
            }
        }
    }
    for (int i = 0; i < RELAXATIONS; i++) {
        relax(f, 0);
        relax(f, 1);
    }
    const size_t sx = 1, sy = NX, sz = (size_t)NX * NY;
    for (int z = 0; z < NZ; z++) {
        for (int y = 0; y < NY; y++) {
            for (int x = 0; x < NX; x++) {
                const float *p = &f->pressure[cell(x, y, z)];
                const vec4 slope = {
                    (x < NX - 1 ? p[sx] : 0.0f) - (x > 0 ? *(p - sx) : 0.0f),
                    (y < NY - 1 ? p[sy] : 0.0f) - (y > 0 ? *(p - sy) : *p),
                    (z < NZ - 1 ? p[sz] : 0.0f) - (z > 0 ? *(p - sz) : 0.0f),
                    0.0f,
                };
                f->state[cell(x, y, z)] -= slope * 0.5f;
            }
        }
    }
}

// Concentration at a point (cells) now: that of the place where it was before the traced steps, and
// what it took up in the source since then.
static float trace(const fluid *f, float x, float y, float z)
{
    float smoke = 0.0f;
    vec4 u = {0};
    for (int i = TRACED / 2 - 1; i >= 0; i--) {
        const vec4 *history = f->history + (size_t)i * CELLS;
        const vec4 a = sample(history, x, y, z);
        u = sample(history, x - a[0], y - a[1], z - a[2]);
        x -= 2.0f * u[0];
        y -= 2.0f * u[1];
        z -= 2.0f * u[2];
        if (y < 2.0f * SOURCE) {
            const float s = source(f, x, y, z, STEPS - TRACED + 2 * i);
            smoke = smoke > s ? smoke : s;
        }
    }
    return smoke > u[3] ? smoke : u[3];
}

// Mean concentration of a fine voxel.
static float voxel(const fluid *f, int x, int y, int z)
{
    // Where the coarse grid has none nearby, there is none.
    const float near = sample(f->state, (float)x / FINE - 0.25f, (float)y / FINE - 0.25f,
                              (float)z / FINE - 0.25f)[3];
    if (near < 0.004f) {
        return 0.0f;
    }
    float sum = 0.0f;
    for (int s = 0; s < SAMPLES; s++) {
        const uint32_t h = gen_hash((uint32_t)x, (uint32_t)y, (uint32_t)z, (uint32_t)s);
        const float px = (float)x + (float)(h & 1023) / 1024.0f;
        const float py = (float)y + (float)(h >> 10 & 1023) / 1024.0f;
        const float pz = (float)z + (float)(h >> 20 & 1023) / 1024.0f;
        sum += trace(f, px / FINE - 0.5f, py / FINE - 0.5f, pz / FINE - 0.5f);
    }
    return clampf(sum / SAMPLES * clampf(near * 10.0f, 0.0f, 1.0f), 0.0f, 1.0f);
}

// 0 at the faces of the grid, 1 from a few voxels inwards.
static float fade(const gen_grid *g, int x, int y, int z)
{
    const int at[3] = {x, y, z};
    float factor = 1.0f;
    for (int a = 0; a < 3; a++) {
        const int left = at[a], right = g->n[a] - 1 - at[a];
        factor *= clampf((float)(left < right ? left : right) / 5.0f, 0.0f, 1.0f);
    }
    return factor;
}

static void *zeroed(size_t count, size_t size)
{
    void *p = calloc(count, size);
    if (!p) {
        fprintf(stderr, "out of memory for the plume\n");
        exit(1);
    }
    return p;
}

gen_grid gen_plume(void)
{
    fluid f = {
        .state = zeroed(CELLS, sizeof(vec4)),
        .forward = zeroed(CELLS, sizeof(vec4)),
        .back = zeroed(CELLS, sizeof(vec4)),
        .curl = zeroed(CELLS, sizeof(vec4)),
        .pressure = zeroed(CELLS, sizeof(float)),
        .divergence = zeroed(CELLS, sizeof(float)),
        .history = zeroed((size_t)CELLS * (TRACED / 2), sizeof(vec4)),
    };
    for (int step = 0; step < STEPS; step++) {
        const float t = (float)step * 0.06f;
        f.source[step][0] = NX * 0.5f + 1.5f * gen_perlin(t, 0.3f, 0.7f, 11);
        f.source[step][1] = NZ * 0.5f + 1.5f * gen_perlin(t, 0.6f, 0.2f, 12);
        add_source(&f, step);
        add_forces(&f);
        project(&f);
        const int traced = step - (STEPS - TRACED);
        if (traced >= 0 && traced % 2 == 0) {
            memcpy(f.history + (size_t)(traced / 2) * CELLS, f.state, CELLS * sizeof(vec4));
        }
        advect(&f);
    }

    gen_grid g = gen_grid_new(NX * FINE, NY * FINE, NZ * FINE);
    for (int z = 0; z < g.n[2]; z++) {
        for (int y = 0; y < g.n[1]; y++) {
            for (int x = 0; x < g.n[0]; x++) {
                g.data[gen_index(&g, x, y, z)] = voxel(&f, x, y, z) * fade(&g, x, y, z);
            }
        }
    }
    free(f.state);
    free(f.forward);
    free(f.back);
    free(f.curl);
    free(f.pressure);
    free(f.divergence);
    free(f.history);
    return g;
}
