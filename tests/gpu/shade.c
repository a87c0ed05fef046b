// shade.c -- what surfaces send to the camera, against closed forms and integrals on the CPU.
#include "bound.h"
#include "homogeneous.h"
#include "shade_stage.h"
#include "shaders/walls/rooms.h"
#include "shaders/walls/walls_args.h"
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979;

// Length within the medium's box of the way from a to b.
static double length_in_box(const double a[3], const double b[3])
{
    return homogeneous_length(stage.medium.extent, a, b);
}

// What is left after a way in the medium, of which scattering forward counts as none.
static double left_of(double length, int channel)
{
    const double g = (double)stage.medium.phase[channel].g;
    const double scattering = stage.params.mode == TYN_MEDIUM_DENSITY
                                  ? (1 - g * g) * (double)stage.medium.sigma_s[channel]
                                  : (double)stage.scaled[channel];
    return stage.fog ? exp(-length * (scattering + (double)stage.medium.sigma_a[channel])) : 1;
}

static void of_suns(const double p[3], const double n[3], double irradiance[3])
{
    const double facet[3] = {(double)stage.pieces[0].facet[0], (double)stage.pieces[0].facet[1],
                             (double)stage.pieces[0].facet[2]};
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < stage.params.num_suns; k++) {
        double towards[3], far[3];
        for (int i = 0; i < 3; i++) {
            towards[i] = -(double)stage.suns[k].direction[i];
            far[i] = p[i] + 1e3 * towards[i];
        }
        const double cosine = vector_dot(facet, towards) > 0 ? fmax(vector_dot(n, towards), 0) : 0;
        for (int c = 0; c < 3; c++) {
            irradiance[c] +=
                (double)stage.suns[k].color[c] * cosine * left_of(length_in_box(p, far), c);
        }
    }
}

static void add_sun(float x, float y, float z, float r, float g, float b)
{
    struct light_block *l = &stage.suns[stage.params.num_suns++];
    *l = (struct light_block){.kind = TYN_LIGHT_KIND_DIRECTIONAL, .color = {r, g, b}};
    memcpy(l->direction, (float[]){x, y, z}, sizeof l->direction);
    vector_normalisef(l->direction);
    stage.lights[stage.params.num_directional++] = *l;
}

// ---- suns -------------------------------------------------------------------------------------

static int right_half(double x, double y)
{
    return x + 0.1 * y > WIDTH / 2 ? 0 : -1;
}

static void suns(void **state)
{
    for (int samples = 1; samples <= 2; samples++) {
        shade_start();
        stage.samples = samples;
        shade_piece *on = &stage.pieces[0];
        memcpy(on->normal, (float[]){0.48f, 0, 0.8772685f}, sizeof on->normal);
        memcpy(on->emission, (float[]){0.01f, 0.3f, 2e-4f}, sizeof on->emission);
        shade_triangle(0);
        stage.shown = right_half;
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        add_sun(-0.9f, 0.1f, -0.2f, 0.1f, 0.2f, 5);
        add_sun(-1, 0, 0.1f, 100, 100, 100);  // before the normal, but behind the facet
        add_sun(0.95f, 0, -0.1f, 70, 70, 70); // before the facet, but behind the normal
        shade_draw(*state);
        shade_compare(of_suns, NULL, 1e-5);
    }
}

static void suns_through_the_medium(void **state)
{
    // The floor is within the box, below it, and beside its shadow.
    const float heights[] = {1, -0.5f};
    for (int i = 0; i < 4; i++) {
        shade_start();
        stage.fog = true;
        stage.params.mode = i / 2 ? TYN_MEDIUM_COEFFICIENTS : TYN_MEDIUM_DENSITY;
        for (int c = 0; c < 3; c++) {
            stage.medium.sigma_s[c] = 0.1f + 0.3f * (float)c;
            stage.medium.sigma_a[c] = 0.2f / (1 + (float)c);
            stage.medium.phase[c].g = 0.5f;
            stage.scaled[c] = 0.6f * stage.medium.sigma_s[c];
            stage.mean[c] = i / 2 ? stage.medium.sigma_s[c] : 1;
        }
        stage.pieces[0].at[2] = heights[i % 2];
        shade_look((float[]){2, 2, 9}, (float[]){0.05f, 0, -1}, 4, true);
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        add_sun(-0.9f, 0.1f, -0.4f, 0.5f, 2, 5);
        shade_draw(*state);
        shade_compare(of_suns, NULL, 1e-5);
    }
}

// The map of a sun straight above, over [-2, 2]^2, depths 1 at z = 4 and 0 at z = -4.
static const struct shadow_light sun_map = {
    .rows = {{0.5f, 0, 0, 0}, {0, 0.5f, 0, 0}, {0, 0, 0.125f, 0.5f}},
    .offset = {MAP, 0},
    .texels = MAP,
    .kind = TYN_SHADOW_SUN};

static bool far_from_the_border(const double p[3])
{
    return fabs(p[0]) > 4 * 4.0 / MAP;
}

static void of_suns_on_the_left(const double p[3], const double n[3], double irradiance[3])
{
    of_suns(p, n, irradiance);
    for (int c = 0; p[0] > 0 && c < 3; c++) {
        irradiance[c] = 0;
    }
}

static void dark(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    (void)n;
    memset(irradiance, 0, 3 * sizeof *irradiance);
}

static void shadows_of_suns(void **state)
{
    const shade_light_at right[] = {of_suns, dark, of_suns_on_the_left};
    for (int i = LIT; i <= HALF; i++) {
        shade_start();
        stage.shadows = i;
        stage.maps[0] = sun_map;
        add_sun(0, 0, -1, 3, 2, 1);
        // Steep enough that its depth changes by much more than rounding from texel to texel.
        memcpy(stage.pieces[0].facet, (float[]){0.6f, 0, 0.8f}, sizeof stage.pieces[0].facet);
        memcpy(stage.pieces[0].normal, stage.pieces[0].facet, sizeof stage.pieces[0].normal);
        shade_draw(*state);
        shade_compare(right[i], far_from_the_border, 1e-5);
    }
}

// ---- lamps ------------------------------------------------------------------------------------

static struct light_block *add_lamp(float x, float y, float z, float r, float g, float b)
{
    const uint32_t lamp = stage.params.num_lamps++;
    struct light_block *l = &stage.lights[stage.params.num_directional + lamp];
    *l = (struct light_block){.kind = TYN_LIGHT_KIND_POINT,
                              .color = {r, g, b},
                              .position = {x, y, z},
                              .shadow = TYN_SHADOW_LAMP(lamp)};
    return l;
}

// Irradiance at a point.
static void of_lamps(const double p[3], const double n[3], double irradiance[3])
{
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < stage.params.num_lamps; k++) {
        const struct light_block *l = &stage.lights[stage.params.num_directional + k];
        double towards[3], at[3], cone = 0;
        for (int i = 0; i < 3; i++) {
            at[i] = (double)l->position[i];
            towards[i] = at[i] - p[i];
        }
        const double r = vector_normalise(towards);
        for (int i = 0; i < 3; i++) {
            cone -= towards[i] * (double)l->direction[i];
        }
        const double inner = (double)l->cos_inner, outer = (double)l->cos_outer;
        const double share = fmin(fmax((cone - outer) / (inner - outer), 0), 1);
        const double lobe = l->kind == TYN_LIGHT_KIND_SPOT ? share * share : 1;
        for (int c = 0; c < 3; c++) {
            irradiance[c] += (double)l->color[c] * lobe * fmax(vector_dot(n, towards), 0) /
                             (r * r) * left_of(length_in_box(p, at), c);
        }
    }
}

// The mean over the pixel: of the picture, not of the floor.
static void of_lamps_in_pixel(const double p[3], const double n[3], double irradiance[3])
{
    enum { SIDE = 100 };
    (void)p;
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (int k = 0; k < SIDE * SIDE; k++) {
        double q[3], e[3];
        shade_meet(&stage.pieces[0], shade_x + (k % SIDE + 0.5) / SIDE,
                   shade_y + (k / SIDE + 0.5) / SIDE, q);
        of_lamps(q, n, e);
        for (int c = 0; c < 3; c++) {
            irradiance[c] += e[c] / (SIDE * SIDE);
        }
    }
}

static void far_lamps(void **state)
{
    for (int fog = 0; fog < 2; fog++) {
        shade_start();
        stage.fog = fog;
        for (int c = 0; c < 3; c++) {
            stage.medium.sigma_s[c] = 0.1f + 0.1f * (float)c;
            stage.medium.sigma_a[c] = 0.2f;
            stage.medium.phase[c].g = 0.7f;
        }
        stage.pieces[0].at[2] = 0.5f;
        shade_look((float[]){2, 2, 3}, (float[]){0.1f, 0, -1}, 0.3f, false);
        add_lamp(1, 2, 3, 1, 2, 3);
        add_lamp(2, 6, 2, 9, 1, 9);          // outside the box
        add_lamp(1, 2, 0.4f, 500, 500, 500); // below the floor
        struct light_block *spot = add_lamp(3, 3, 4, 20, 30, 10);
        spot->kind = TYN_LIGHT_KIND_SPOT;
        memcpy(spot->direction, (float[]){-0.36f, -0.48f, -0.8f}, sizeof spot->direction);
        spot->cos_inner = 0.99f;
        spot->cos_outer = 0.9f;
        shade_draw(*state);
        shade_compare(of_lamps, NULL, 1e-5);
    }
}

// A lamp as near as a part of a pixel's width: pixels have the mean of their light.
static void near_lamps(void **state)
{
    const double pixel = 2.0 / HEIGHT;
    for (int i = 0; i < 6; i++) {
        shade_start();
        const bool spot = i % 3 == 2, parallel = i < 3;
        const double height = i % 3 == 1 ? 0.2 * pixel : 1.5 * pixel;
        shade_look((float[]){0, parallel ? 0 : -1, parallel ? 3 : 1},
                   (float[]){0, parallel ? 0 : 1, -1}, parallel ? 1 : 0.7f, parallel);
        struct light_block *l = add_lamp(0.31f, 0.22f, (float)height, 1, 2, 3);
        if (spot) {
            l->kind = TYN_LIGHT_KIND_SPOT;
            memcpy(l->direction, (float[]){0.6f, 0, -0.8f}, sizeof l->direction);
            l->cos_inner = 0.9f;
            l->cos_outer = 0.6f;
        }
        shade_draw(*state);
        const double near = i % 3 == 1 ? 3e-4 : 4e-3;
        const double worst = !parallel ? 0.04 : spot ? 0.15 : near;
        const double bounds[6] = {8e-5, 2e-5, 1e-3, 3e-4, 5e-3, 1.2e-3}, bound = bounds[i];
        const double mean = shade_compare(of_lamps_in_pixel, NULL, worst);
        assert_true(bound <= 1e-4 ? mean <= bound
                                  : within(mean, bound, NULL, "near_lamps, %s, %s%s",
                                           parallel ? "parallel" : "perspective",
                                           spot ? "spot" : "point", i % 3 == 1 ? ", low" : ""));
    }
}

static void of_lamps_on_the_left(const double p[3], const double n[3], double irradiance[3])
{
    of_lamps(p, n, irradiance);
    for (int c = 0; p[0] > 0 && c < 3; c++) {
        irradiance[c] = 0;
    }
}

static bool far_from_the_cones_border(const double p[3])
{
    return fabs(p[0]) > 4 * 4.0 / MAP && fabs(p[0]) < 2;
}

// A map of 90 degrees that looks down.
static void shadows_of_lamps(void **state)
{
    const shade_light_at right[] = {of_lamps, dark, of_lamps_on_the_left};
    for (int i = LIT; i <= HALF; i++) {
        shade_start();
        stage.shadows = i;
        stage.maps[TYN_SHADOW_LAMP(0)] =
            (struct shadow_light){.rows = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 2}},
                                  .texels = MAP,
                                  .scale = 1,
                                  .near = 0.01f,
                                  .kind = TYN_SHADOW_CONE};
        add_lamp(0, 0, 2, 1, 2, 3);
        shade_draw(*state);
        shade_compare(right[i], far_from_the_cones_border, 1e-5);
    }
}

// ---- virtual point lights ---------------------------------------------------------------------

// A disc that shines along `axis`, with the intensity I: that of a small one.
static void add_vpl(float x, float y, float z, const float axis[3], float radius, float intensity)
{
    struct light_block *l = &stage.vpls.list[stage.vpls.count++];
    *l = (struct light_block){.position = {x, y, z},
                              .kind = TYN_LIGHT_KIND_COSINE,
                              .color = {intensity, 0.5f * intensity, 2 * intensity},
                              .radius = radius,
                              .shadow = TYN_LIGHT_NO_SHADOW};
    memcpy(l->direction, axis, sizeof l->direction);
}

// Of discs parallel to the floor in closed form, of others as points.
static void of_vpls(const double p[3], const double n[3], double irradiance[3])
{
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t k = 0; k < stage.vpls.count; k++) {
        const struct light_block *l = &stage.vpls.list[k];
        double away[3], axis[3], at[3];
        for (int i = 0; i < 3; i++) {
            at[i] = (double)l->position[i];
            away[i] = p[i] - at[i];
            axis[i] = (double)l->direction[i];
        }
        const double rr = vector_dot(away, away), height = vector_dot(away, axis);
        const double towards = -vector_dot(away, n), RR = (double)(l->radius * l->radius);
        const double d = rr - height * height + height * height - RR;
        const double root = sqrt(d * d + 4 * RR * height * height);
        const double disc = 2 * height * height / (root * (root + d));
        const double share = vector_dot(axis, n) < -0.9999 ? disc : height * towards / (rr * rr);
        const bool lit = height > 0 && towards > 0 && (int)k != stage.hidden_vpl;
        for (int c = 0; c < 3; c++) {
            irradiance[c] += lit ? (double)l->color[c] * share *
                                       left_of(shade_vpl_density(k) * length_in_box(p, at), c)
                                 : 0;
        }
    }
}

static const float down[3] = {0, 0, -1};

// Few lights: every pixel takes all.
static void vpls(void **state)
{
    for (int i = 0; i < 3; i++) {
        shade_start();
        stage.fog = i == 1;
        stage.hidden_vpl = i == 2 ? 3 : -1;
        for (int c = 0; c < 3; c++) {
            stage.medium.sigma_s[c] = 0.1f + 0.1f * (float)c;
            stage.medium.sigma_a[c] = 0.2f;
            stage.medium.phase[c].g = 0.7f;
        }
        stage.pieces[0].at[2] = 0.5f;
        shade_look((float[]){2, 2, 3}, (float[]){0.1f, 0, -1}, 0.5f, false);
        add_lamp(2, 2, 3, 0, 0, 0); // dark, but with a grid
        add_vpl(2, 2, 1.5f, down, 0.5f, 1);
        add_vpl(1, 3, 3.5f, (float[]){0.6f, 0, -0.8f}, 1e-3f, 9);
        add_vpl(2, 2, 3, (float[]){0, 0, 1}, 0.1f, 500); // faces the other way
        add_vpl(3, 1, 2.5f, down, 0.1f, 4);
        add_vpl(3, 1, 0.4f, (float[]){0, 0, 1}, 0.1f, 500); // below the floor
        shade_draw(*state);
        shade_compare(of_vpls, NULL, 1e-4);
    }
}

// Where a place of the picture has all of the pattern around it.
static bool amid_the_pattern(const double p[3])
{
    (void)p;
    const int border = stage.params.pattern * stage.params.step;
    return shade_x >= border && shade_y >= border && shade_x < WIDTH - border &&
           shade_y < HEIGHT - border;
}

// Many: blocks of pixels take a part, and tell each other.
static void many_vpls(void **state)
{
    const struct {
        int pattern, step, count;
        double tolerance;
    } cases[] = {{1, 1, 200, 2e-5},
                 {3, 1, 20, 3e-3},
                 {3, 1, 200, 3e-3},
                 {1, 2, 200, 2e-3},
                 {3, 2, 200, 6e-3}};
    for (int i = 0; i < 5; i++) {
        shade_start();
        stage.params.pattern = cases[i].pattern;
        stage.params.step = cases[i].step;
        for (int k = 0; k < cases[i].count; k++) {
            const float x = (float)(k * 0.618034 - floor(k * 0.618034));
            add_vpl(6 * x - 3, 6 * (float)k / (float)cases[i].count - 3, 2.5f + 0.02f * (float)k,
                    (float[]){0.48f, -0.36f, -0.8f}, 1e-3f, 0.01f + 0.01f * (float)(k % 7));
        }
        shade_draw(*state);
        shade_compare(of_vpls, cases[i].tolerance < 1e-4 ? NULL : amid_the_pattern,
                      cases[i].tolerance);
    }
}

// ---- edges ------------------------------------------------------------------------------------

// Nothing, then the floor, and on it a bar that is narrower than a pixel, whose middle sample sees the floor.
static int bar_on_floor(double x, double y)
{
    (void)y;
    return x < 7.5 ? -1 : x > 15 && x < 15.5 ? 1 : 0;
}

static void of_suns_and_vpls(const double p[3], const double n[3], double irradiance[3])
{
    double more[3];
    of_vpls(p, n, irradiance);
    of_suns(p, n, more);
    for (int c = 0; c < 3; c++) {
        irradiance[c] += more[c];
    }
}

static void edges_of_surfaces(void **state)
{
    for (int i = 0; i < 3; i++) {
        shade_start();
        stage.samples = 2;
        stage.shown = bar_on_floor;
        stage.params.step = 1 + i / 2;
        stage.pieces[0].emission[1] = 0.1f;
        stage.pieces[1] = (shade_piece){.at = {0, 0, 0.5f},
                                        .facet = {0.6f, 0, 0.8f},
                                        .normal = {0.6f, 0, 0.8f},
                                        .albedo = {0.1f, 0.9f, 0.4f},
                                        .emission = {0, 0, 0.2f}};
        shade_triangle(0);
        shade_triangle(1);
        add_sun(0.3f, -0.5f, -1, 3, 2, 1);
        for (int k = 0; k < (i ? 5 : 0); k++) {
            add_vpl(40 + (float)k, (float)k - 3, 60, down, 1e-3f, 3000 + 500 * (float)k);
        }
        shade_draw(*state);
        shade_compare(of_suns_and_vpls, NULL, i == 2 ? 2e-3 : i == 1 ? 8e-4 : 1e-5);
        for (int y = 0; y < HEIGHT;
             y++) { // how far away they are, for what makes pixels of samples: 12 bits
            double p[3];
            for (int k = 0; k < 2; k++) {
                const double right = shade_meet(&stage.pieces[1 - k], 15.25 + 0.5 * k, y + 0.5, p);
                assert_true(fabs(shade_group_distance(15, y, k) - right) <= ldexp(right, -13));
            }
        }
    }
}

// ---- the sky and the lattice ------------------------------------------------------------------

static void of_sky(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    (void)n;
    for (int c = 0; c < 3; c++) {
        irradiance[c] = pi * (double)stage.environment.sky[c];
    }
}

static void sky(void **state)
{
    shade_start();
    stage.params.sky = 1;
    memcpy(stage.environment.sky, (float[]){0.5f, 1, 2}, sizeof stage.environment.sky);
    shade_draw(*state);
    shade_compare(of_sky, NULL, 1e-5);
}

// Radiance that is linear in direction, (phi + 3 w.F) / 4 pi, on a plane: phi / 4 - F.n / 2.
static void of_moments(const double p[3], const double n[3], double irradiance[3])
{
    (void)p;
    for (int c = 0; c < 3; c++) {
        const float *m = stage.moments[stage.params.one_channel ? 0 : c];
        double flux = 0;
        for (int i = 0; i < 3; i++) {
            flux += (double)m[1 + i] * n[i];
        }
        irradiance[c] = (0.25 * (double)m[0] - 0.5 * flux) *
                        (stage.params.one_channel ? (double)stage.params.tint[c] : 1);
    }
}

static void light_of_the_lattice(void **state)
{
    for (int i = 0; i < 4; i++) {
        shade_start();
        stage.lattice = true;
        stage.params.one_channel = i / 2;
        stage.params.step = 1 + i % 2;
        memcpy(stage.params.tint, (float[]){0.5f, 1, 2}, sizeof stage.params.tint);
        memcpy(stage.moments,
               (float[3][4]){{4, 0.5f, 0, -0.7f}, {3, -0.2f, 0.4f, 0}, {9, 0, 0.5f, 0.5f}},
               sizeof stage.moments);
        stage.pieces[0].at[2] = 1.3f;
        memcpy(stage.pieces[0].facet, (float[]){0.48f, -0.36f, 0.8f}, sizeof stage.pieces[0].facet);
        memcpy(stage.pieces[0].normal, stage.pieces[0].facet, sizeof stage.pieces[0].normal);
        shade_look((float[]){2, 2, 9}, (float[]){0, 0, -1}, 0.5f, true);
        memcpy(stage.pieces[0].at, (float[]){2, 2, 1.3f}, sizeof stage.pieces[0].at);
        shade_draw(*state);
        shade_compare(of_moments, NULL, 2e-5);
    }
}

// A VPL lights its own room only.
static void vpls_in_rooms(void **state)
{
    shade_start();
    stage.lattice = true;
    enum { N = CELLS * CELLS * CELLS };
    static uint32_t rooms[TYN_ROOMS_SIZE(N)];
    for (int i = 0; i < N; i++) {
        rooms[TYN_ROOMS_OF_CELL(i)] = 7;
    }
    const uint32_t of_lights[] = {7, TYN_ROOMS_ANY, 8};
    memcpy(rooms + TYN_ROOMS_OF_VPL(N, 0), of_lights, sizeof of_lights);
    stage.rooms = rooms;
    stage.pieces[0].at[2] = 0.5f;
    shade_look((float[]){2, 2, 3}, (float[]){0, 0, -1}, 0.5f, true);
    add_vpl(2, 2, 1.5f, down, 0.5f, 1);
    add_vpl(1, 2, 1.5f, down, 0.5f, 2);
    add_vpl(2, 1, 2.5f, down, 0.5f, 500);
    shade_draw(*state);
    stage.vpls.count = 2;
    shade_compare(of_vpls, NULL, 1e-4);
}

// ---- what leaves the medium's box -------------------------------------------------------------

// The face x = 4 shines with the radiance F / pi: the integral over it; and the sky's mean.
static void of_face(const double p[3], const double n[3], double irradiance[3])
{
    enum { SIDE = 100 };
    double sum = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double cell = (double)stage.medium.extent[0] / SIDE;
        double towards[3] = {(double)stage.medium.extent[0] - p[0], (k % SIDE + 0.5) * cell - p[1],
                             (k / SIDE + 0.5) * cell - p[2]};
        const double r = vector_normalise(towards);
        sum += fmax(vector_dot(n, towards), 0) * fmax(-towards[0], 0) / (r * r) * cell * cell;
    }
    of_sky(p, n, irradiance);
    for (int c = 0; c < 3; c++) {
        const double flux = stage.params.one_channel
                                ? (double)(stage.moments[0][1] * stage.params.tint[c])
                                : (double)stage.moments[c][1];
        irradiance[c] += flux / pi * sum;
    }
}

// Between the face and the wall, or beyond the wall.
static void put_card(float x)
{
    const float corners[6][2] = {{-9, -9}, {13, -9}, {13, 13}, {-9, -9}, {13, 13}, {-9, 13}};
    for (uint32_t v = 0; v < 6; v++) {
        memcpy(stage.vertices[v].position, (float[]){x, corners[v][0], corners[v][1]},
               sizeof stage.vertices[v].position);
        const uint32_t first = v / 3 * 3;
        stage.triangles[v / 3] = (struct surface_triangle){first, first + 1, first + 2, 0};
    }
    stage.node = (struct surface_node){
        .lo = {x - 0.01f, -9, -9}, .hi = {x + 0.01f, 13, 13}, .first = 0, .count = 2};
}

static void light_from_the_box(void **state)
{
    for (int i = 0; i < 5; i++) {
        shade_start();
        stage.params.outside = 1;
        stage.params.one_channel = i == 1;
        stage.params.sky = i == 2 || i == 4;
        stage.params.hidden = i >= 3;
        memcpy(stage.params.tint, (float[]){0.5f, 1, 2}, sizeof stage.params.tint);
        memcpy(stage.moments, (float[3][4]){{9, 3}, {5, 2}, {4, 1}}, sizeof stage.moments);
        if (stage.params.sky) {
            memcpy(stage.environment.sky, (float[]){0.05f, 0.1f, 0.02f},
                   sizeof stage.environment.sky);
        }
        if (stage.params.hidden) {
            put_card(i == 3 ? 9 : 5);
            stage.params.sight_edge = 1;
            for (int k = 0; k < 3; k++) {
                stage.params.sight_places[k] = 10;
                stage.params.sight_lo[k] = k == 0 ? 0 : -3;
            }
        }
        // It faces the box; turned, a part of the face is below its horizon.
        shade_piece *wall = &stage.pieces[0];
        *wall = (shade_piece){
            .at = {7, 2, 2}, .facet = {-0.6f, 0.8f, 0}, .albedo = {0.75f, 0.5f, 0.25f}};
        memcpy(wall->normal, wall->facet, sizeof wall->normal);
        shade_look((float[]){5.5f, 2, 2}, (float[]){1, 0, 0}, 0.5f, true);
        shade_draw(*state);
        shade_compare(i < 4 ? of_face : of_sky, NULL, 1e-4);
    }
}

// ---- sunlight that was scattered forward ------------------------------------------------------

// The mean cosine of the most forward part of Henyey and Greenstein's lobe, g^2 of all that is scattered.
static double mean_cosine_forward(double g)
{
    enum { STEPS = 100000 };
    double share = 0, sum = 0;
    for (int i = 0; i < STEPS && share < g * g; i++) {
        const double mu = 1 - (i + 0.5) * 2 / STEPS, s2 = 1 + g * g - 2 * g * mu;
        const double weight = 0.5 * (1 - g * g) / (s2 * sqrt(s2)) * 2 / STEPS;
        share += weight;
        sum += weight * mu;
    }
    return sum / share;
}

// It comes from around the sun: as from a beam, and as much less directed as its mean direction is shorter than 1.
static void of_forward_light(const double p[3], const double n[3], double irradiance[3])
{
    const double g = (double)stage.medium.phase[0].g, directed = mean_cosine_forward(g);
    of_moments(p, n, irradiance);
    double towards[3], far[3];
    for (int i = 0; i < 3; i++) {
        towards[i] = -(double)stage.suns[0].direction[i];
        far[i] = p[i] + 1e3 * towards[i];
    }
    const double cosine = vector_dot(n, towards), length = length_in_box(p, far);
    const double wide = (0.5 + 0.5 * directed) * directed * cosine + 0.25 * (1 - directed);
    for (int c = 0; c < 3; c++) {
        const double both = left_of(length, c),
                     straight =
                         exp(-length * (double)(stage.medium.sigma_s[c] + stage.medium.sigma_a[c]));
        irradiance[c] +=
            (double)stage.suns[0].color[c] * (cosine * straight + wide * (both - straight));
    }
}

static void forward_light(void **state)
{
    for (int i = LIT; i <= DARK; i++) {
        shade_start();
        stage.fog = stage.lattice = true;
        stage.shadows = i;
        stage.maps[0] = sun_map;
        stage.maps[0].rows[0][0] = stage.maps[0].rows[1][1] =
            0.05f; // wide enough for what comes aslant
        for (int c = 0; c < 3; c++) {
            stage.medium.sigma_s[c] = 0.4f + 0.2f * (float)c;
            stage.medium.sigma_a[c] = 0.1f;
            stage.medium.phase[c].g = 0.8f;
            stage.moments[c][0] = 1e-3f;
        }
        stage.pieces[0].at[2] = 0.5f;
        shade_look((float[]){2, 2, 3}, (float[]){0, 0, -1}, 0.5f, true);
        add_sun(0, 0, -1, 3, 2, 1);
        shade_draw(*state);
        shade_compare(i == LIT ? of_forward_light : of_moments, NULL, i == LIT ? 1e-3 : 2e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(suns),
        cmocka_unit_test(suns_through_the_medium),
        cmocka_unit_test(shadows_of_suns),
        cmocka_unit_test(far_lamps),
        cmocka_unit_test(near_lamps),
        cmocka_unit_test(shadows_of_lamps),
        cmocka_unit_test(vpls),
        cmocka_unit_test(many_vpls),
        cmocka_unit_test(edges_of_surfaces),
        cmocka_unit_test(sky),
        cmocka_unit_test(light_of_the_lattice),
        cmocka_unit_test(vpls_in_rooms),
        cmocka_unit_test(light_from_the_box),
        cmocka_unit_test(forward_light),
    };
    return cmocka_run_group_tests(tests, gpu_setup, gpu_teardown);
}
