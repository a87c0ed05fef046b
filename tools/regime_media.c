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
static double shape_density(const regime_media *media, uint32_t i, const double world[3])
{
    const tyn_shape *shape = &media->scene->shapes[i];
    const tyn_medium *medium = &media->scene->media[shape->medium];
    double p[3], r2 = 0;
    for (int a = 0; a < 3; a++) {
        p[a] = regime_dot(media->to_local[i][a], world) + media->to_local[i][a][3];
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
        medium->volume < 0 ? 1 : density_at(&media->scene->volumes[medium->volume], p);
    return density * tyn_medium_scale(medium);
}

bool regime_media_at(const regime_media *media, const double world[3], regime_coefficients *out)
{
    bool found = false;
    *out = (regime_coefficients){.least_g = 1, .most_g = -1};
    for (uint32_t i = 0; i < media->scene->num_shapes; i++) {
        const double density = shape_density(media, i, world);
        const tyn_medium *m = &media->scene->media[media->scene->shapes[i].medium];
        for (int c = 0; c < 3 && density > 0; c++) {
            const double g = tyn_phase_mean_cosine(m->phase[c]);
            const double forward = tyn_phase_delta_fraction(m->phase[c]);
            out->sigma_s[c] += density * m->sigma_s[c];
            out->sigma_a[c] += density * m->sigma_a[c];
            out->g_sigma_s[c] += density * m->sigma_s[c] * g;
            out->scaled[c] += density * (m->sigma_a[c] + (1 - forward) * m->sigma_s[c]);
            out->emission[c] += density * m->emission[c];
            if (m->sigma_s[c] > 0) {
                out->least_g = fmin(out->least_g, g);
                out->most_g = fmax(out->most_g, g);
            }
            found |= m->sigma_s[c] + m->sigma_a[c] > 0 || m->emission[c] > 0;
        }
    }
    return found;
}
