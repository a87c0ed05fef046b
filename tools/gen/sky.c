// sky.c -- a clear sky with its sun: single scattering of air, haze and ozone, integrated along every
// ray (Nishita et al., "Display of the Earth taking into account atmospheric scattering", 1993), plus
// all higher orders as an isotropic source (Hillaire, "A scalable and production ready sky and
// atmosphere rendering technique", 2020, section 5.5).
//
// Lengths in km, coefficients in 1/km at the wavelengths 680, 550, 440 nm that stand for R, G, B.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "maps.h"
#include "portable.h"

#define RADIUS 6360.0 // of the ground
#define TOP 6440.0    // of the atmosphere
#define SUN_RADIUS (0.27 * GEN_PI / 180.0)

enum { VIEW_STEPS = 32, HEIGHTS = 32, ANGLES = 128, COARSE = 20, OFFSETS = 129 };

// Rayleigh scattering with a scale height of 8 km, absorption by ozone in a layer about 25 km
// (both as in Hillaire's table 1), haze with a scale height of 1.2 km that absorbs a tenth.
static const double air[3] = {5.802e-3, 13.558e-3, 33.1e-3};
static const double ozone[3] = {0.650e-3, 1.881e-3, 0.085e-3};
static const double haze_color[3] = {0.759, 1.0, 1.337}; // Angstrom's law, exponent 1.3
#define AIR_SCALE 8.0
#define HAZE_SCALE 1.2
#define HAZE_ALBEDO 0.9
#define HAZE_G 0.76

typedef struct columns { // amounts of air, haze and ozone along a ray: km at the density 1
    double of[3];
} columns;

typedef struct sky {
    gen_sky in;
    double haze[3];                  // extinction on the ground
    double sun[3];                   // towards the sun
    columns to_top[HEIGHTS][ANGLES]; // by height and by angle: see locate
    double psi[COARSE][COARSE][3];   // higher orders by height and by the sun's zenith angle
} sky;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static columns density(double radius)
{
    const double h = radius > RADIUS ? radius - RADIUS : 0.0, layer = 1.0 - fabs(h - 25.0) / 15.0;
    return (columns){
        {gen_exp(-h / AIR_SCALE), gen_exp(-h / HAZE_SCALE), layer > 0.0 ? layer : 0.0}};
}

static double extinction(const sky *s, const columns *amount, int k)
{
    return air[k] * amount->of[0] + s->haze[k] * amount->of[1] + ozone[k] * amount->of[2];
}

// From a point at `radius`, along a ray whose cosine with the upward direction is mu: the distance
// to the sphere of radius `target` around the earth's centre; -1 if it is missed.
static double distance_to(double radius, double mu, double target)
{
    const double d = radius * radius * (mu * mu - 1.0) + target * target;
    if (d < 0.0) {
        return -1.0;
    }
    const double root = sqrt(d);
    if (target < radius) { // from outside: the nearer of the two
        return mu < 0.0 ? -radius * mu - root : -1.0;
    }
    return -radius * mu + root;
}

// ---- light from the sun -------------------------------------------------------------------------

// The table's coordinates (Bruneton and Neyret, "Precomputed atmospheric scattering", 2008): the
// height by the length of the tangent to the ground, the angle by the distance to the top between
// its least (straight up) and its greatest value (past the horizon).
static void fill_columns(sky *s)
{
    const double tangent = sqrt(TOP * TOP - RADIUS * RADIUS);
    for (int i = 0; i < HEIGHTS; i++) {
        const double rho = tangent * i / (HEIGHTS - 1), r = sqrt(rho * rho + RADIUS * RADIUS);
        for (int j = 0; j < ANGLES; j++) {
            const double near = TOP - r, far = rho + tangent;
            const double d = near + (far - near) * j / (ANGLES - 1);
            const double mu = d > 0.0 ? (TOP * TOP - r * r - d * d) / (2.0 * r * d) : 1.0;
            columns sum = {{0, 0, 0}};
            enum { STEPS = 48 };
            for (int n = 0; n < STEPS; n++) {
                // Shorter steps near the start, where the air is densest.
                const double a = (double)n / STEPS, b = (n + 1.0) / STEPS, t = 0.5 * (a + b);
                const double at = t * t * d, length = (b * b - a * a) * d;
                const columns c = density(sqrt(r * r + at * at + 2.0 * r * mu * at));
                for (int k = 0; k < 3; k++) {
                    sum.of[k] += c.of[k] * length;
                }
            }
            s->to_top[i][j] = sum;
        }
    }
}

static double clamp(double v, double lo, double hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

// The share of the sun's light that reaches a point, from a direction of cosine mu; black where the
// ground is in the way.
static void sunlight(const sky *s, double radius, double mu, double share[3])
{
    const double r = clamp(radius, RADIUS, TOP - 1e-6);
    memset(share, 0, 3 * sizeof(double));
    if (mu < 0.0 && distance_to(r + 1e-9, mu, RADIUS) >= 0.0) {
        return;
    }
    const double tangent = sqrt(TOP * TOP - RADIUS * RADIUS), rho = sqrt(r * r - RADIUS * RADIUS);
    const double near = TOP - r, far = rho + tangent, d = distance_to(r, mu, TOP);
    const double u = clamp(rho / tangent, 0.0, 1.0) * (HEIGHTS - 1);
    const double v = clamp((d - near) / (far - near), 0.0, 1.0) * (ANGLES - 1);
    const int i = u < HEIGHTS - 2 ? (int)u : HEIGHTS - 2, j = v < ANGLES - 2 ? (int)v : ANGLES - 2;
    const double a = u - i, b = v - j;
    columns c;
    for (int k = 0; k < 3; k++) {
        const double lo = s->to_top[i][j].of[k] * (1.0 - b) + s->to_top[i][j + 1].of[k] * b;
        const double hi = s->to_top[i + 1][j].of[k] * (1.0 - b) + s->to_top[i + 1][j + 1].of[k] * b;
        c.of[k] = lo * (1.0 - a) + hi * a;
    }
    for (int k = 0; k < 3; k++) {
        share[k] = gen_exp(-extinction(s, &c, k));
    }
}

// ---- higher orders ------------------------------------------------------------------------------

// Radiance of a ray per unit of the sun's irradiance above the atmosphere.
typedef struct ray {
    double radiance[3];  // first order only: with isotropic phase functions, else as they are
    double scattered[3]; // integral of T sigma_s: what a uniform source of 1 would send
    double transmittance[3];
    bool ground; // ends on it
} ray;

static void lookup_psi(const sky *s, double radius, double mu, double psi[3])
{
    const double u = clamp((radius - RADIUS) / (TOP - RADIUS), 0.0, 1.0) * (COARSE - 1);
    const double v = clamp(0.5 + 0.5 * mu, 0.0, 1.0) * (COARSE - 1);
    const int i = u < COARSE - 2 ? (int)u : COARSE - 2, j = v < COARSE - 2 ? (int)v : COARSE - 2;
    const double a = u - i, b = v - j;
    for (int k = 0; k < 3; k++) {
        psi[k] = (s->psi[i][j][k] * (1.0 - b) + s->psi[i][j + 1][k] * b) * (1.0 - a) +
                 (s->psi[i + 1][j][k] * (1.0 - b) + s->psi[i + 1][j + 1][k] * b) * a;
    }
}

// Follows a ray from (0, radius, 0). `isotropic`: the first order of the table of higher ones.
static ray follow(const sky *s, double radius, const double w[3], const double sun[3],
                  bool isotropic, int steps)
{
    ray out = {.transmittance = {1, 1, 1}};
    const double to_ground = distance_to(radius, w[1], RADIUS);
    out.ground = to_ground >= 0.0;
    const double length = out.ground ? to_ground : distance_to(radius, w[1], TOP);
    const double mu = dot(w, sun), g = HAZE_G, d = 1.0 + g * g - 2.0 * g * mu;
    const double p_air = isotropic ? 0.25 / GEN_PI : 3.0 / (16.0 * GEN_PI) * (1.0 + mu * mu);
    const double p_haze = isotropic ? 0.25 / GEN_PI : 0.25 / GEN_PI * (1.0 - g * g) / (d * sqrt(d));
    for (int n = 0; n < steps; n++) {
        const double a = (double)n / steps, b = (n + 1.0) / steps, t = 0.5 * (a + b);
        const double step = (b * b - a * a) * length, at = t * t * length;
        const double p[3] = {w[0] * at, radius + w[1] * at, w[2] * at};
        const double r = sqrt(dot(p, p)), mu_sun = dot(p, sun) / r;
        const columns c = density(r);
        double light[3], psi[3] = {0, 0, 0};
        sunlight(s, r, mu_sun, light);
        if (!isotropic) {
            lookup_psi(s, r, mu_sun, psi);
        }
        for (int k = 0; k < 3; k++) {
            const double by_air = air[k] * c.of[0], by_haze = HAZE_ALBEDO * s->haze[k] * c.of[1];
            const double sigma_t = extinction(s, &c, k), through = gen_exp(-sigma_t * step);
            // What a uniform step sends towards the eye.
            const double share = out.transmittance[k] * (1.0 - through) / sigma_t;
            out.radiance[k] += share * (light[k] * (by_air * p_air + by_haze * p_haze) +
                                        psi[k] * (by_air + by_haze));
            out.scattered[k] += share * (by_air + by_haze);
            out.transmittance[k] *= through;
        }
    }
    return out;
}

// Light of second order at a point from all around, and the share of a uniform light that is
// scattered back to it; the orders from the second on are a geometric series.
static void fill_psi(sky *s)
{
    enum { RAYS = 64 };
    for (int i = 0; i < COARSE; i++) {
        const double r = RADIUS + 0.01 + (TOP - RADIUS - 0.02) * i / (COARSE - 1);
        for (int j = 0; j < COARSE; j++) {
            const double mu = 2.0 * j / (COARSE - 1) - 1.0;
            const double sun[3] = {sqrt(1.0 - mu * mu), mu, 0};
            double second[3] = {0, 0, 0}, again[3] = {0, 0, 0}, light[3];
            for (int n = 0; n < RAYS; n++) { // Fibonacci points on the sphere
                const double y = 1.0 - (2.0 * n + 1.0) / RAYS, q = sqrt(1.0 - y * y);
                const double phi = 2.39996322972865332 * n;
                const double w[3] = {q * gen_cos(phi), y, q * gen_sin(phi)};
                const ray a = follow(s, r, w, sun, true, 16);
                const double to_ground = a.ground ? distance_to(r, y, RADIUS) : 0.0;
                const double p[3] = {w[0] * to_ground, r + w[1] * to_ground, w[2] * to_ground};
                const double mu_ground = dot(p, sun) / sqrt(dot(p, p));
                sunlight(s, RADIUS, mu_ground, light);
                for (int k = 0; k < 3; k++) {
                    const double lit = a.ground && mu_ground > 0.0 ? light[k] * mu_ground : 0.0;
                    second[k] +=
                        (a.radiance[k] + a.transmittance[k] * s->in.albedo[k] / GEN_PI * lit) /
                        RAYS;
                    again[k] += a.scattered[k] / RAYS;
                }
            }
            for (int k = 0; k < 3; k++) {
                s->psi[i][j][k] = second[k] / (1.0 - again[k]);
            }
        }
    }
}

// ---- the map ------------------------------------------------------------------------------------

// Adds the disc: every texel has the share of the disc's light that comes through it, so that the
// sum over the map is the irradiance whatever the size of the texels.
static void add_sun(const sky *s, gen_map *map, const double irradiance[3])
{
    enum { SUB = 24 };
    const double edge = gen_cos(SUN_RADIUS);
    const int n = map->width * map->height;
    double *share = calloc((size_t)n, sizeof(double)), total = 0.0;
    if (!share) {
        exit(1);
    }
    const double reach = SUN_RADIUS + 1.5 * GEN_PI / map->height;
    const gen_map fine = {map->width * SUB, map->height * SUB, NULL};
    for (int i = 0; i < n; i++) {
        const int x = i % map->width, y = i / map->width;
        double w[3];
        gen_map_direction(map, x, y, w);
        if (dot(w, s->sun) < gen_cos(reach)) {
            continue;
        }
        for (int j = 0; j < SUB * SUB; j++) {
            gen_map_direction(&fine, x * SUB + j % SUB, y * SUB + j / SUB, w);
            if (dot(w, s->sun) >= edge) {
                share[i] += gen_map_solid_angle(&fine, y * SUB + j / SUB);
            }
        }
        total += share[i];
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; share[i] > 0.0 && k < 3; k++) {
            map->rgb[3 * i + k] += (float)(irradiance[k] * share[i] / total /
                                           gen_map_solid_angle(map, i / map->width));
        }
    }
    free(share);
}

gen_map gen_clear_sky(const gen_sky *in, int width, int height)
{
    sky *s = calloc(1, sizeof(*s));
    if (!s) {
        exit(1);
    }
    s->in = *in;
    for (int k = 0; k < 3; k++) {
        s->haze[k] = (in->turbidity - 1.0) * air[1] * AIR_SCALE / HAZE_SCALE * haze_color[k];
    }
    const double e = in->elevation * GEN_PI / 180.0, a = in->azimuth * GEN_PI / 180.0;
    s->sun[0] = gen_cos(e) * gen_sin(a);
    s->sun[1] = gen_sin(e);
    s->sun[2] = -gen_cos(e) * gen_cos(a);
    fill_columns(s);
    fill_psi(s);

    gen_map map = gen_map_new(width, height);
    const double eye = RADIUS + in->observer * 1e-3;
    double direct[3], down[3] = {0, 0, 0}; // on the ground: of the sun, and of the sky
    sunlight(s, eye, s->sun[1], direct);
    // From above down: when the first ray meets the ground, the sky's light on it is known.
    for (int y = 0; y < height; y++) {
        const double theta = GEN_PI * (y + 0.5) / height, solid = gen_map_solid_angle(&map, y);
        double row[OFFSETS][3]; // the sky is the same on both sides of the sun
        bool ground = false;
        for (int i = 0; i < OFFSETS; i++) {
            const double offset = GEN_PI * i / (OFFSETS - 1), q = gen_sin(theta);
            const double w[3] = {q * gen_sin(offset), gen_cos(theta), -q * gen_cos(offset)};
            const double sun[3] = {0, s->sun[1], -gen_cos(e)};
            const ray r = follow(s, eye, w, sun, false, VIEW_STEPS);
            ground = r.ground;
            for (int k = 0; k < 3; k++) {
                const double lit = direct[k] * (s->sun[1] > 0.0 ? s->sun[1] : 0.0) + down[k];
                row[i][k] = r.radiance[k];
                row[i][k] += ground ? r.transmittance[k] * in->albedo[k] / GEN_PI * lit : 0.0;
            }
        }
        for (int x = 0; x < width; x++) {
            // The texel's angle from the sun's azimuth, 0 to pi.
            double turn = (x + 0.5) / width - 0.5 - in->azimuth / 360.0;
            turn = 2.0 * fabs(turn - floor(turn + 0.5)) * (OFFSETS - 1);
            const int i = turn < OFFSETS - 2 ? (int)turn : OFFSETS - 2;
            for (int k = 0; k < 3; k++) {
                const double radiance = row[i][k] + (row[i + 1][k] - row[i][k]) * (turn - i);
                down[k] += ground ? 0.0 : radiance * gen_cos(theta) * solid;
                map.rgb[3 * (y * width + x) + k] = (float)(radiance * in->irradiance);
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        direct[k] *= in->irradiance;
    }
    add_sun(s, &map, direct);
    free(s);
    return map;
}
