// courtyard.c -- a map of high contrast: a long narrow courtyard under a bright overcast sky, with
// arcades in the dark, windows that mirror the sky, and a few lamps behind them.
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "maps.h"
#include "noise.h"
#include "portable.h"

#define ROOF 17.0 // height of the walls, m; the eye is in the origin, 1.7 m above the paving
#define EYE 1.7
#define BAY 3.6        // of arcade and windows, m
#define SKY_ZENITH 6.0 // radiance, W/(m^2 sr)
#define STONE 0.2      // albedo

// The planes of the yard: their axis and place. The wall towards -Z is far away and half as high,
// the view past it is open.
typedef struct plane {
    int axis;
    double at, top;
} plane;

enum { GROUND = 4, PLANES = 5, GRID = 12 };
static const plane planes[PLANES] = {
    {0, -6.5, ROOF - EYE}, {0, 7.5, ROOF - EYE}, {2, -46.0, 6.0},
    {2, 21.0, ROOF - EYE}, {1, -EYE, 0},
};

typedef struct yard {
    double light[PLANES][GRID][GRID]; // irradiance of the sky by place: see place_on
} yard;

// Radiance of the sky (Moon and Spencer 1942): three times as bright above as at the horizon.
static double sky_light(const double w[3])
{
    return SKY_ZENITH * (1.0 + 2.0 * (w[1] > 0.0 ? w[1] : 0.0)) / 3.0;
}

// The first plane that a ray meets and where; -1 for the sky.
static int hit(const double from[3], const double w[3], double at[3])
{
    double nearest = 1e9;
    int found = -1;
    for (int i = 0; i < PLANES; i++) {
        const double t = (planes[i].at - from[planes[i].axis]) / w[planes[i].axis];
        if (t > 1e-6 && t < nearest) {
            nearest = t;
            found = i;
        }
    }
    for (int k = 0; k < 3; k++) {
        at[k] = from[k] + nearest * w[k];
    }
    return found >= 0 && found != GROUND && at[1] > planes[found].top ? -1 : found;
}

// Coordinates on a plane, 0 to 1: along the yard or across it, and up (on the ground: along).
static void place_on(int i, const double p[3], double uv[2])
{
    const double across = (p[0] + 6.5) / 14.0, along = (p[2] + 46.0) / 67.0;
    uv[0] = planes[i].axis == 0 ? along : across;
    uv[1] = i == GROUND ? along : (p[1] + EYE) / ROOF;
}

static void fill_light(yard *y)
{
    enum { RAYS = 256 };
    for (int i = 0; i < PLANES * GRID * GRID; i++) {
        const plane *p = &planes[i / (GRID * GRID)];
        const double u = (i % GRID + 0.5) / GRID, v = (i / GRID % GRID + 0.5) / GRID;
        double at[3] = {14.0 * u - 6.5, ROOF * v - EYE, 67.0 * (p->axis == 0 ? u : v) - 46.0};
        at[p->axis] = p->at;
        double sum = 0.0;
        for (int n = 0; n < RAYS; n++) {
            const double c = 1.0 - (2.0 * n + 1.0) / RAYS, q = sqrt(1.0 - c * c);
            const double phi = 2.39996322972865332 * n;
            const double w[3] = {q * gen_cos(phi), c, q * gen_sin(phi)};
            const double inwards = p->at > 0.0 ? -w[p->axis] : w[p->axis];
            double end[3];
            if (inwards > 0.0 && hit(at, w, end) < 0 && c > 0.0) {
                sum += sky_light(w) * inwards * 4.0 * GEN_PI / RAYS;
            }
        }
        y->light[i / (GRID * GRID)][i / GRID % GRID][i % GRID] = sum;
    }
}

static double light_at(const yard *y, int i, const double p[3])
{
    double uv[2];
    int n[2];
    place_on(i, p, uv);
    for (int k = 0; k < 2; k++) {
        const double g = uv[k] * GRID - 0.5;
        const double c = g < 0.0 ? 0.0 : g > GRID - 1.001 ? GRID - 1.001 : g;
        n[k] = (int)c;
        uv[k] = c - n[k];
    }
    const double(*l)[GRID] = y->light[i];
    return (l[n[1]][n[0]] * (1.0 - uv[0]) + l[n[1]][n[0] + 1] * uv[0]) * (1.0 - uv[1]) +
           (l[n[1] + 1][n[0]] * (1.0 - uv[0]) + l[n[1] + 1][n[0] + 1] * uv[0]) * uv[1];
}

static void set(double rgb[3], double r, double g, double b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

// A wall at a height above the paving and a place along it.
static void wall(const yard *y, int i, const double p[3], const double w[3], double rgb[3])
{
    const double height = p[1] + EYE, along = planes[i].axis == 0 ? p[2] : p[0];
    const double bay = floor(along / BAY), x = fabs(along / BAY - bay - 0.5) * BAY;
    const double arch = x < 1.3 ? 3.2 + sqrt(1.69 - x * x) : 0.0;
    const double lit = (light_at(y, i, p) + 0.8) / GEN_PI; // and a little from the other walls
    if (height < arch) { // under the arcade: some light from the paving
        const double glow = 0.04 + 0.03 * height;
        set(rgb, glow, 0.85 * glow, 0.7 * glow);
        return;
    }
    const int storey = height > 6.8 && height < 9.6 ? 0 : height > 11.6 && height < 14.0 ? 1 : -1;
    if (storey >= 0 && x < 0.65 && i != 2) {
        const uint32_t h = gen_hash((uint32_t)(int)(bay + 64.0), (uint32_t)i, (uint32_t)storey, 3);
        double mirrored[3] = {w[0], w[1], w[2]}, end[3];
        mirrored[planes[i].axis] = -w[planes[i].axis];
        const bool sky = hit(p, mirrored, end) < 0 && mirrored[1] > 0.0;
        const double glass = sky ? 0.25 * sky_light(mirrored) : 0.03;
        set(rgb, 0.9 * glass, glass, 1.1 * glass);
        if (h % 9 == 0) { // a lamp is on
            set(rgb, rgb[0] + 5.0, rgb[1] + 3.0, rgb[2] + 1.2);
        }
        return;
    }
    const bool ledge = (height > 5.4 && height < 6.0) || height > ROOF - 0.7;
    const double albedo = STONE * (ledge ? 1.5 : 1.0) *
                          (1.0 + 0.25 * gen_perlin((float)along, (float)height, (float)i, 9));
    set(rgb, 1.1 * albedo * lit, albedo * lit, 0.8 * albedo * lit);
}

gen_map gen_courtyard(int width, int height)
{
    enum { SUB = 3 };
    yard y;
    fill_light(&y);
    gen_map map = gen_map_new(width, height);
    const gen_map fine = {width * SUB, height * SUB, NULL};
    for (int i = 0; i < width * height * SUB * SUB; i++) {
        const int fx = i % fine.width, fy = i / fine.width;
        const double eye[3] = {0, 0, 0};
        double w[3], p[3], rgb[3];
        gen_map_direction(&fine, fx, fy, w);
        const int at = hit(eye, w, p);
        if (at < 0) {
            const double sky = sky_light(w);
            set(rgb, 0.88 * sky, 0.97 * sky, 1.1 * sky);
        } else if (at == GROUND) {
            const double lit = (light_at(&y, at, p) + 0.8) / GEN_PI;
            const double slab =
                0.16 +
                0.05 *
                    gen_random((uint32_t)(int)(floor(p[0]) * 97.0 + floor(p[2] / 2.0) + 9000.0), 4);
            set(rgb, slab * lit, 0.95 * slab * lit, 0.85 * slab * lit);
        } else {
            wall(&y, at, p, w, rgb);
        }
        float *out = map.rgb + 3 * ((size_t)(fy / SUB) * (size_t)width + (size_t)(fx / SUB));
        for (int k = 0; k < 3; k++) {
            out[k] += (float)(rgb[k] / (SUB * SUB));
        }
    }
    return map;
}
