// regime.c -- the regime of a scene from its media, lights and surfaces.
#include "regime.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 64, MIN_SAMPLES = 8, RAYS = 24, RAY_SAMPLES = 64 }; // rays along a picture's side
static const double pi = 3.14159265358979323846;

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

static double mean3(const double v[3])
{
    return (v[0] + v[1] + v[2]) / 3;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// ---- the box ----------------------------------------------------------------------------------

typedef struct box {
    double origin[3], edge[3][3], length[3];
    bool repeat[3];
} box;

// A lone shape's own box if it is not sheared; else that of the world around all shapes, or around all
// surfaces. False: there is nothing.
static bool box_of(const tyn_scene *scene, box *b)
{
    *b = (box){0};
    const float *m = scene->shapes[0].to_world;
    bool own = scene->num_shapes == 1;
    for (int i = 0; i < 3 && own; i++) {
        const double e[3] = {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
        memcpy(b->edge[i], e, sizeof e);
        b->length[i] = sqrt(dot(e, e));
        b->repeat[i] = scene->shapes[0].repeat[i];
        for (int k = 0; k < i; k++) {
            own &= fabs(dot(e, b->edge[k])) <= 1e-5 * b->length[i] * b->length[k];
        }
    }
    if (own) {
        for (int a = 0; a < 3; a++) {
            b->origin[a] = m[12 + a] - 0.5 * (b->edge[0][a] + b->edge[1][a] + b->edge[2][a]);
        }
        return true;
    }
    float lo[3], hi[3];
    *b = (box){0};
    if (!tyn_scene_bounds(scene, lo, hi)) {
        return false;
    }
    for (int a = 0; a < 3; a++) {
        b->origin[a] = lo[a];
        b->edge[a][a] = b->length[a] = (double)hi[a] - lo[a];
    }
    return true;
}

static double longest_side(const box *b)
{
    return fmax(b->length[0], fmax(b->length[1], b->length[2]));
}

// Area across a direction.
static double shadow_of(const box *b, const double direction[3])
{
    double area = 0;
    for (int a = 0; a < 3; a++) {
        double face[3];
        cross(b->edge[(a + 1) % 3], b->edge[(a + 2) % 3], face);
        area += fabs(dot(face, direction));
    }
    return area;
}

static double surface_of(const box *b)
{
    const double *l = b->length;
    return 2 * (l[0] * l[1] + l[1] * l[2] + l[2] * l[0]);
}

// ---- the medium at a point --------------------------------------------------------------------

// Shapes with the inverses of their matrices.
typedef struct media {
    const tyn_scene *scene;
    double to_local[TYN_MAX_SHAPES][3][4];
} media;

typedef struct coefficients {
    double sigma_s[3], sigma_a[3], g_sigma_s[3], emission[3];
} coefficients;

static void media_make(const tyn_scene *scene, media *md)
{
    md->scene = scene;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const float *m = scene->shapes[i].to_world;
        const double c[3][3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
        const double at[3] = {m[12], m[13], m[14]};
        for (int a = 0; a < 3; a++) {
            double *row = md->to_local[i][a];
            cross(c[(a + 1) % 3], c[(a + 2) % 3], row);
            const double determinant = dot(c[a], row);
            for (int k = 0; k < 3; k++) {
                row[k] = determinant != 0 ? row[k] / determinant : 0;
            }
            row[3] = -dot(row, at);
        }
    }
}

// Trilinear between voxel centres, clamped to the edge. `p` in [0, 1]^3.
static double density_at(const tyn_volume *v, const double p[3])
{
    size_t lo[3], hi[3];
    double t[3], sum = 0;
    if (!v->data) {
        return v->max_density;
    }
    for (int a = 0; a < 3; a++) {
        const double x = fmin(fmax(p[a] * v->size[a] - 0.5, 0), v->size[a] - 1.0);
        lo[a] = (size_t)x;
        hi[a] = lo[a] + 1 < v->size[a] ? lo[a] + 1 : lo[a];
        t[a] = x - (double)lo[a];
    }
    for (int k = 0; k < 8; k++) {
        const size_t x = k & 1 ? hi[0] : lo[0], y = k & 2 ? hi[1] : lo[1],
                     z = k & 4 ? hi[2] : lo[2];
        const double weight =
            (k & 1 ? t[0] : 1 - t[0]) * (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
        sum += weight * v->data[(z * v->size[1] + y) * v->size[0] + x];
    }
    return sum;
}

// Density of the medium of shape `i` at a point of the world.
static double shape_density(const media *md, uint32_t i, const double world[3])
{
    const tyn_shape *shape = &md->scene->shapes[i];
    const tyn_medium *medium = &md->scene->media[shape->medium];
    double p[3], r2 = 0;
    for (int a = 0; a < 3; a++) {
        p[a] = dot(md->to_local[i][a], world) + md->to_local[i][a][3];
        p[a] = shape->repeat[a] ? p[a] - floor(p[a] + 0.5) : p[a];
        if (fabs(p[a]) > 0.5 + 1e-9) {
            return 0;
        }
        r2 += p[a] * p[a];
        p[a] += 0.5;
    }
    if (shape->kind == TYN_SHAPE_SPHERE && r2 > 0.25) {
        return 0;
    }
    const double density =
        medium->volume < 0 ? 1 : density_at(&md->scene->volumes[medium->volume], p);
    return density * medium->density_scale;
}

// All shapes add up. False: there is nothing.
static bool media_at(const media *md, const double world[3], coefficients *out)
{
    bool found = false;
    *out = (coefficients){0};
    for (uint32_t i = 0; i < md->scene->num_shapes; i++) {
        const double density = shape_density(md, i, world);
        const tyn_medium *m = &md->scene->media[md->scene->shapes[i].medium];
        for (int c = 0; c < 3 && density > 0; c++) {
            out->sigma_s[c] += density * m->sigma_s[c];
            out->sigma_a[c] += density * m->sigma_a[c];
            out->g_sigma_s[c] += density * m->sigma_s[c] * m->g[c];
            out->emission[c] += density * m->emission[c];
            found |= m->sigma_s[c] + m->sigma_a[c] > 0 || m->emission[c] > 0;
        }
    }
    return found;
}

// ---- sums over the box ------------------------------------------------------------------------

// One column along each axis for every pair of indices along the two others.
typedef struct columns {
    double tau[3][SAMPLES * SAMPLES][3];
    double transport[SAMPLES * SAMPLES * SAMPLES]; // at every point, mean over channels, 1/m
} columns;

typedef struct sums {
    double sigma_s[3], sigma_t[3], g[3], emission[3];
    double collisions;         // of the mean over channels, as those below
    double squared, transport; // weighted by extinction
    double densest;
    size_t inside, all;
} sums;

static void add_point(const coefficients *k, sums *s, double *extinction, double *transport)
{
    double sigma_t[3], sigma_tr[3];
    for (int c = 0; c < 3; c++) {
        sigma_t[c] = k->sigma_s[c] + k->sigma_a[c];
        sigma_tr[c] = sigma_t[c] - k->g_sigma_s[c];
        s->sigma_s[c] += k->sigma_s[c];
        s->sigma_t[c] += sigma_t[c];
        s->g[c] += k->g_sigma_s[c];
        s->emission[c] += k->emission[c];
    }
    *extinction = mean3(sigma_t);
    *transport = mean3(sigma_tr);
    s->collisions += *extinction;
    s->squared += *extinction * *extinction;
    s->transport += *extinction * *transport;
    s->densest = fmax(s->densest, *extinction);
    s->inside += *extinction > 0;
}

static void sample_counts(const box *b, int n[3])
{
    const double longest = longest_side(b);
    for (int a = 0; a < 3; a++) {
        const double share = longest > 0 ? b->length[a] / longest : 0;
        n[a] = (int)fmin(fmax(round(SAMPLES * share), MIN_SAMPLES), SAMPLES);
    }
}

static void sample_box(const media *md, const box *b, const int n[3], columns *col, sums *s)
{
    for (int z = 0; z < n[2]; z++) {
        for (int y = 0; y < n[1]; y++) {
            for (int x = 0; x < n[0]; x++) {
                const double t[3] = {(x + 0.5) / n[0], (y + 0.5) / n[1], (z + 0.5) / n[2]};
                double world[3], extinction, transport;
                for (int a = 0; a < 3; a++) {
                    world[a] = b->origin[a] + t[0] * b->edge[0][a] + t[1] * b->edge[1][a] +
                               t[2] * b->edge[2][a];
                }
                coefficients k;
                s->all++;
                if (!media_at(md, world, &k)) {
                    continue;
                }
                add_point(&k, s, &extinction, &transport);
                col->transport[(z * SAMPLES + y) * SAMPLES + x] = transport;
                const int at[3] = {z * SAMPLES + y, z * SAMPLES + x, y * SAMPLES + x};
                for (int a = 0; a < 3; a++) {
                    for (int c = 0; c < 3; c++) {
                        col->tau[a][at[a]][c] +=
                            (k.sigma_s[c] + k.sigma_a[c]) * b->length[a] / n[a];
                    }
                }
            }
        }
    }
}

static void depths(const box *b, const columns *col, regime *r)
{
    double all[3] = {0};
    size_t num_all = 0;
    for (int a = 0; a < 3; a++) {
        double sum[3] = {0};
        size_t num = 0;
        for (int i = 0; i < SAMPLES * SAMPLES && !b->repeat[a]; i++) {
            const double tau = mean3(col->tau[a][i]);
            for (int c = 0; c < 3 && tau > 0; c++) {
                sum[c] += col->tau[a][i][c];
            }
            num += tau > 0;
            r->depth_deepest = fmax(r->depth_deepest, tau);
        }
        r->depth_axis[a] = num ? mean3(sum) / (double)num : 0;
        r->depth_densest = fmax(r->depth_densest, r->depth_axis[a]);
        for (int c = 0; c < 3; c++) {
            all[c] += sum[c];
        }
        num_all += num;
    }
    for (int c = 0; c < 3; c++) {
        r->depth_rgb[c] = num_all ? all[c] / (double)num_all : 0;
    }
    r->optical_depth = mean3(r->depth_rgb);
}

// Transport extinction of the densest lattice cell: two samples wide.
static double densest_cell(const columns *col, const int n[3])
{
    double densest = 0;
    for (int z = 0; z < n[2]; z += 2) {
        for (int y = 0; y < n[1]; y += 2) {
            for (int x = 0; x < n[0]; x += 2) {
                double sum = 0;
                int num = 0;
                for (int k = 0; k < 8; k++) {
                    const int at[3] = {x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)};
                    if (at[0] < n[0] && at[1] < n[1] && at[2] < n[2]) {
                        sum += col->transport[(at[2] * SAMPLES + at[1]) * SAMPLES + at[0]];
                        num++;
                    }
                }
                densest = fmax(densest, sum / num);
            }
        }
    }
    return densest;
}

static bool all_grey(const tyn_scene *scene)
{
    bool grey = true;
    for (uint32_t i = 0; i < scene->num_media; i++) {
        const tyn_medium *m = &scene->media[i];
        for (int c = 1; c < 3; c++) {
            grey &= m->sigma_s[c] == m->sigma_s[0] && m->sigma_a[c] == m->sigma_a[0] &&
                    m->g[c] == m->g[0];
        }
    }
    return grey;
}

// Is a colour black or a multiple of `tint`? The first that is not black becomes it.
static bool of_tint(const float color[3], float tint[3])
{
    if (tint[0] == 0 && tint[1] == 0 && tint[2] == 0) {
        memcpy(tint, color, 3 * sizeof *tint);
    }
    bool same = true;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3;
        const float p = color[a] * tint[b], q = color[b] * tint[a];
        same &= fabsf(p - q) <= 1e-5f * fabsf(p);
    }
    return same;
}

// One colour of all lights, of media that emit and of the sky; of surfaces that reflect, grey.
static bool one_tint(const tyn_scene *scene)
{
    float tint[3] = {0};
    bool same = !scene->environment.data;
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        same &= of_tint(scene->lights[i].color, tint);
    }
    for (uint32_t i = 0; i < scene->num_media; i++) {
        same &= of_tint(scene->media[i].emission, tint);
    }
    if (scene->environment.present) {
        same &= of_tint(scene->environment.radiance, tint);
    }
    const float white[3] = {1, 1, 1};
    for (uint32_t i = 0; i < scene->surfaces.num_materials; i++) {
        const tyn_surface_material *m = &scene->surfaces.materials[i];
        float of_white[3] = {white[0], white[1], white[2]};
        same &= of_tint(m->albedo, of_white) && m->texture == TYN_NO_TEXTURE &&
                of_tint(m->emission, tint);
    }
    return same;
}

static void medium_figures(const box *b, const int n[3], const columns *col, const sums *s,
                           regime *r)
{
    depths(b, col, r);
    for (int c = 0; c < 3; c++) {
        r->albedo_rgb[c] = s->sigma_t[c] > 0 ? s->sigma_s[c] / s->sigma_t[c] : 0;
        r->g_rgb[c] = s->sigma_s[c] > 0 ? s->g[c] / s->sigma_s[c] : 0;
    }
    const double scattering = mean3(s->sigma_s), extinction = mean3(s->sigma_t);
    r->albedo = extinction > 0 ? scattering / extinction : 0;
    r->g = scattering > 0 ? mean3(s->g) / scattering : 0;
    r->cell = longest_side(b) / REGIME_LATTICE_CELLS;
    r->fill = (double)s->inside / (double)s->all;
    r->box_share = 1;
    for (int a = 0; a < 3; a++) {
        r->box_share *= b->length[a] > 0 ? b->length[a] / longest_side(b) : 1;
    }
    if (s->collisions > 0) {
        const double transport = s->transport / s->collisions;
        r->mean_free_path = s->collisions / s->squared;
        r->transport_mean_free_path = transport > 0 ? 1 / transport : 0;
        r->cell_depth = r->cell * transport;
        r->cell_depth_max = r->cell * densest_cell(col, n);
        r->contrast = s->densest * (double)s->inside / s->collisions;
    }
}

// ---- lights -----------------------------------------------------------------------------------

static double sun_power(const box *b, const float direction[3], const float color[3])
{
    const double d[3] = {direction[0], direction[1], direction[2]};
    const double e[3] = {color[0], color[1], color[2]};
    return luminance(e) * shadow_of(b, d);
}

// What of a lamp's light meets the sphere around the box.
static double lamp_power(const box *b, const tyn_light *light)
{
    double to[3], radius2 = 0;
    for (int a = 0; a < 3; a++) {
        const double middle = b->origin[a] + 0.5 * (b->edge[0][a] + b->edge[1][a] + b->edge[2][a]);
        to[a] = middle - light->position[a];
        radius2 += 0.25 * b->length[a] * b->length[a];
    }
    const double distance2 = dot(to, to),
                 intensity[3] = {light->color[0], light->color[1], light->color[2]};
    double angle = 4 * pi;
    if (distance2 > radius2) {
        angle = 2 * pi * (1 - sqrt(1 - radius2 / distance2));
    }
    if (light->kind == TYN_LIGHT_SPOT) {
        angle = fmin(angle, 2 * pi * (1 - 0.5 * (light->cos_inner + light->cos_outer)));
    }
    return luminance(intensity) * angle;
}

// Mean luminance over the sphere of directions. Of all texels: a sun is a few of them.
static double mean_of_map(const tyn_environment *env)
{
    double sum[3] = {0}, weights = 0;
    for (uint32_t y = 0; y < env->size[1]; y++) {
        const float *row = env->data + 3 * (size_t)y * env->size[0];
        const double weight = sin(pi * (y + 0.5) / env->size[1]);
        double of_row[3] = {0};
        for (uint32_t x = 0; x < env->size[0]; x++) {
            for (int c = 0; c < 3; c++) {
                of_row[c] += row[3 * (size_t)x + c];
            }
        }
        for (int c = 0; c < 3; c++) {
            sum[c] += weight * of_row[c] * env->radiance[c];
        }
        weights += weight * env->size[0];
    }
    return weights > 0 ? luminance(sum) / weights * env->strength : 0;
}

static void environment_power(const box *b, const tyn_environment *env, regime *r)
{
    if (!env->present) {
        return;
    }
    if (!env->data) {
        const double rgb[3] = {env->radiance[0], env->radiance[1], env->radiance[2]};
        r->share[REGIME_SKY] = pi * surface_of(b) * luminance(rgb) * env->strength;
        return;
    }
    tyn_environment_sun suns[TYN_MAX_MAP_SUNS];
    const uint32_t num = tyn_environment_suns(env, suns);
    double mean = mean_of_map(env);
    for (uint32_t i = 0; i < num; i++) {
        const double e[3] = {suns[i].irradiance[0], suns[i].irradiance[1], suns[i].irradiance[2]};
        r->share[REGIME_SUN] += sun_power(b, suns[i].direction, suns[i].irradiance);
        mean -= luminance(e) / (4 * pi);
    }
    r->num_suns += num;
    r->share[REGIME_MAP] = pi * surface_of(b) * fmax(mean, 0);
}

static double triangle_area(const tyn_surfaces *s, const tyn_surface_triangle *triangle)
{
    double e[2][3], n[3];
    const float *p = s->vertices[triangle->vertices[0]].position;
    for (int k = 0; k < 2; k++) {
        const float *q = s->vertices[triangle->vertices[k + 1]].position;
        for (int a = 0; a < 3; a++) {
            e[k][a] = (double)q[a] - p[a];
        }
    }
    cross(e[0], e[1], n);
    return 0.5 * sqrt(dot(n, n));
}

static double emitted_by(const tyn_surfaces *s)
{
    double power = 0;
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        const tyn_surface_material *m = &s->materials[s->triangles[i].material];
        const double emission[3] = {m->emission[0], m->emission[1], m->emission[2]};
        const double light = luminance(emission);
        if (light > 0) {
            const int sides = m->flags & TYN_SURFACE_EMITS_BOTH_SIDES ? 2 : 1;
            power += pi * light * triangle_area(s, &s->triangles[i]) * sides;
        }
    }
    return power;
}

static void light_figures(const tyn_scene *scene, const box *b, const sums *s, regime *r)
{
    for (uint32_t i = 0; i < scene->num_lights; i++) {
        const tyn_light *light = &scene->lights[i];
        if (light->kind == TYN_LIGHT_DIRECTIONAL) {
            r->share[REGIME_SUN] += sun_power(b, light->direction, light->color);
            r->num_suns++;
        } else {
            r->share[REGIME_LAMPS] += lamp_power(b, light);
            r->num_lamps++;
        }
    }
    environment_power(b, &scene->environment, r);
    if (s->all) {
        const double volume = b->length[0] * b->length[1] * b->length[2] / (double)s->all;
        r->share[REGIME_EMISSION] = 4 * pi * luminance(s->emission) * volume;
    }
    r->share[REGIME_SURFACES] = emitted_by(&scene->surfaces);
    double all = 0;
    for (int i = 0; i < REGIME_NUM_LIGHTS; i++) {
        all += r->share[i];
    }
    for (int i = 0; i < REGIME_NUM_LIGHTS && all > 0; i++) {
        r->share[i] /= all;
    }
}

// ---- all of it --------------------------------------------------------------------------------

typedef struct ray {
    double from[3], along[3];
} ray;

// Through (x, y) of the picture, both from -1 to 1.
static ray camera_ray(const tyn_camera *c, double x, double y)
{
    const bool perspective = c->projection == TYN_PERSPECTIVE;
    const double half = perspective ? tan(0.5 * c->yfov) : c->ymag;
    const double aspect = c->aspect > 0 ? c->aspect : 16.0 / 9;
    ray r;
    for (int a = 0; a < 3; a++) {
        const double aside = half * (aspect * x * c->right[a] + y * c->up[a]);
        r.from[a] = c->position[a] + (perspective ? 0 : aside);
        r.along[a] = (perspective ? aside : 0) - c->back[a];
    }
    return r;
}

// Where a ray is in the box, in units of its direction; false: nowhere.
static bool cut_box(const box *b, const ray *r, double *enter, double *leave)
{
    *enter = 0;
    *leave = INFINITY;
    for (int a = 0; a < 3; a++) {
        const double l2 = b->length[a] * b->length[a];
        double from[3];
        for (int k = 0; k < 3; k++) {
            from[k] = r->from[k] - b->origin[k];
        }
        const double at = l2 > 0 ? dot(from, b->edge[a]) / l2 : 0.5;
        const double speed = l2 > 0 ? dot(r->along, b->edge[a]) / l2 : 0;
        if (speed == 0) {
            if (at < 0 || at > 1) {
                return false;
            }
            continue;
        }
        *enter = fmax(*enter, fmin(-at / speed, (1 - at) / speed));
        *leave = fmin(*leave, fmax(-at / speed, (1 - at) / speed));
    }
    return *enter < *leave && isfinite(*leave);
}

static double depth_along(const media *md, const box *b, const ray *r)
{
    double enter, leave, tau = 0;
    if (!cut_box(b, r, &enter, &leave)) {
        return 0;
    }
    const double step = (leave - enter) / RAY_SAMPLES, metres = sqrt(dot(r->along, r->along));
    for (int i = 0; i < RAY_SAMPLES; i++) {
        double at[3];
        coefficients k;
        for (int a = 0; a < 3; a++) {
            at[a] = r->from[a] + (enter + (i + 0.5) * step) * r->along[a];
        }
        if (media_at(md, at, &k)) {
            tau += (mean3(k.sigma_s) + mean3(k.sigma_a)) * step * metres;
        }
    }
    return tau;
}

static void view_figures(const tyn_scene *scene, const media *md, const box *b,
                         const tyn_camera *camera, regime *r)
{
    tyn_camera framed;
    if (!camera && scene->num_cameras) {
        camera = &scene->cameras[0];
    } else if (!camera) {
        tyn_camera_frame_scene(&framed, scene);
        camera = &framed;
    }
    const double at[3] = {camera->position[0], camera->position[1], camera->position[2]};
    coefficients k;
    r->camera_inside = camera->projection == TYN_PERSPECTIVE && media_at(md, at, &k);
    int filled = 0;
    for (int i = 0; i < RAYS * RAYS; i++) {
        const double x = (i % RAYS + 0.5) / RAYS * 2 - 1, y = 1 - (i / RAYS + 0.5) / RAYS * 2;
        const ray through = camera_ray(camera, x, y);
        const double tau = depth_along(md, b, &through);
        filled += tau > 0.01;
        r->view_depth += tau > 0.01 ? tau : 0;
    }
    r->view_fill = (double)filled / (RAYS * RAYS);
    r->view_depth /= filled ? filled : 1;
}

bool regime_of(const tyn_scene *scene, const tyn_camera *camera, regime *r)
{
    *r = (regime){.channels = all_grey(scene) && one_tint(scene) ? 1 : 3,
                  .num_triangles = scene->surfaces.num_triangles};
    media *md = malloc(sizeof *md);
    columns *col = calloc(1, sizeof *col);
    if (!md || !col) {
        free(md);
        free(col);
        return false;
    }
    box b;
    sums s = {0};
    int n[3];
    media_make(scene, md);
    const bool found = box_of(scene, &b);
    for (int a = 0; a < 3 && !found; a++) { // nothing is lit: shares are those on a cube
        b.edge[a][a] = b.length[a] = 1;
    }
    if (found && scene->num_shapes) {
        sample_counts(&b, n);
        sample_box(md, &b, n, col, &s);
        medium_figures(&b, n, col, &s, r);
    }
    light_figures(scene, &b, &s, r);
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const uint32_t *size = scene->volumes[i].size;
        r->voxels += (uint64_t)size[0] * size[1] * size[2];
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const bool *repeat = scene->shapes[i].repeat;
        r->periodic |= repeat[0] || repeat[1] || repeat[2];
    }
    view_figures(scene, md, &b, camera, r);
    free(md);
    free(col);
    return true;
}

double regime_multiple(const regime *r)
{
    return r->albedo * r->optical_depth / (2 + r->optical_depth);
}
