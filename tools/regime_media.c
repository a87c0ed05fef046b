// regime_media.c -- the media of a scene at a point.
#include "regime_parts.h"

void regime_media_make(const tyn_scene *scene, regime_media *media)
{
    media->scene = scene;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const float *m = scene->shapes[i].to_world;
        const double c[3][3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
        const double at[3] = {m[12], m[13], m[14]};
        for (int a = 0; a < 3; a++) {
            double *row = media->to_local[i][a];
            regime_cross(c[(a + 1) % 3], c[(a + 2) % 3], row);
            const double determinant = regime_dot(c[a], row);
            for (int k = 0; k < 3; k++) {
                row[k] = determinant != 0 ? row[k] / determinant : 0;
            }
            row[3] = -regime_dot(row, at);
        }
    }
}

// Trilinear between voxel centres, clamped to the edge, of one of `channels` values a voxel. `p` in [0, 1]^3.
static double value_at(const uint32_t size[3], const float *data, uint32_t channels,
                       uint32_t channel, const double p[3])
{
    size_t lo[3], hi[3];
    double t[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        const double x = fmin(fmax(p[a] * size[a] - 0.5, 0), size[a] - 1.0);
        lo[a] = (size_t)x;
        hi[a] = lo[a] + 1 < size[a] ? lo[a] + 1 : lo[a];
        t[a] = x - (double)lo[a];
    }
    for (int k = 0; k < 8; k++) {
        const size_t x = k & 1 ? hi[0] : lo[0], y = k & 2 ? hi[1] : lo[1],
                     z = k & 4 ? hi[2] : lo[2];
        const double weight =
            (k & 1 ? t[0] : 1 - t[0]) * (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
        sum += weight * data[((z * size[1] + y) * size[0] + x) * channels + channel];
    }
    return sum;
}

static double density_at(const tyn_volume *v, const double p[3])
{
    return v->data ? value_at(v->size, v->data, 1, 0, p) : v->max_density;
}

static double color_at(const tyn_scene *scene, uint32_t slot, int channel, const double p[3])
{
    const tyn_color_grid *g = &scene->color_grids[slot - 1];
    return value_at(g->size, g->data, g->channels, g->channels == 3 ? (uint32_t)channel : 0, p);
}

// Where in the box of shape `i` a point of the world is, in [0, 1]^3. False: outside of it.
static bool in_shape(const regime_media *media, uint32_t i, const double world[3], double p[3])
{
    const tyn_shape *shape = &media->scene->shapes[i];
    double r2 = 0;
    for (int a = 0; a < 3; a++) {
        p[a] = regime_dot(media->to_local[i][a], world) + media->to_local[i][a][3];
        p[a] = shape->repeat[a] ? p[a] - floor(p[a] + 0.5) : p[a];
        if (fabs(p[a]) > 0.5 + 1e-9) {
            return false;
        }
        r2 += p[a] * p[a];
        p[a] += 0.5;
    }
    return shape->kind != TYN_SHAPE_SPHERE || r2 <= 0.25;
}

bool regime_media_at(const regime_media *media, const double world[3], regime_coefficients *out)
{
    bool found = false;
    const tyn_scene *scene = media->scene;
    *out = (regime_coefficients){.least_g = 1, .most_g = -1};
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        double p[3];
        if (!in_shape(media, i, world, p)) {
            continue;
        }
        const double density =
            tyn_medium_scale(m) * (m->volume < 0 ? 1 : density_at(&scene->volumes[m->volume], p));
        for (int c = 0; c < 3 && (density > 0 || m->emission_grid); c++) {
            const double g = tyn_phase_mean_cosine(m->phase[c]);
            const double forward = tyn_phase_delta_fraction(m->phase[c]);
            double sigma_s = density * m->sigma_s[c], sigma_a = density * m->sigma_a[c];
            if (m->albedo_grid) {
                const double sigma_t = sigma_s + sigma_a;
                sigma_s = sigma_t * color_at(scene, m->albedo_grid, c, p);
                sigma_a = sigma_t - sigma_s;
            }
            double emission =
                m->emission[c] *
                (m->emission_grid ? color_at(scene, m->emission_grid, c, p) : density);
            emission += m->radiance_grid ? sigma_a * color_at(scene, m->radiance_grid, c, p) : 0;
            out->sigma_s[c] += sigma_s;
            out->sigma_a[c] += sigma_a;
            out->g_sigma_s[c] += sigma_s * g;
            out->scaled[c] += sigma_a + (1 - forward) * sigma_s;
            out->emission[c] += emission;
            if (sigma_s > 0) {
                const double back = m->phase[c].backward; // of a peak beside a forward one
                out->least_g = fmin(out->least_g, back > 0 ? fmin(g, -back) : g);
                out->most_g = fmax(out->most_g, g);
            }
            found |= density > 0 ? m->sigma_s[c] + m->sigma_a[c] > 0 || m->emission[c] > 0
                                 : emission > 0;
        }
    }
    return found;
}
