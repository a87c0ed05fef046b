// regime_view.c -- how much of a picture the medium fills, and how deep it is there.
#include "regime_parts.h"

enum { RAYS = 24, RAY_SAMPLES = 64 }; // rays along a picture's side

// Through (x, y) of the picture, both from -1 to 1.
static regime_ray camera_ray(const tyn_camera *c, double x, double y)
{
    const bool perspective = c->projection == TYN_PERSPECTIVE;
    const double half = perspective ? tan(0.5 * c->yfov) : c->ymag;
    const double aspect = c->aspect > 0 ? c->aspect : 16.0 / 9;
    regime_ray r;
    for (int a = 0; a < 3; a++) {
        const double aside = half * (aspect * x * c->right[a] + y * c->up[a]);
        r.from[a] = c->position[a] + (perspective ? 0 : aside);
        r.along[a] = (perspective ? aside : 0) - c->back[a];
    }
    return r;
}

static double depth_along(const regime_media *m, const regime_box *b, const regime_ray *r)
{
    double enter, leave, tau = 0;
    if (!regime_box_cut(b, r, &enter, &leave)) {
        return 0;
    }
    const double step = (leave - enter) / RAY_SAMPLES,
                 metres = sqrt(regime_dot(r->along, r->along));
    for (int i = 0; i < RAY_SAMPLES; i++) {
        double at[3];
        regime_coefficients k;
        for (int a = 0; a < 3; a++) {
            at[a] = r->from[a] + (enter + (i + 0.5) * step) * r->along[a];
        }
        if (regime_media_at(m, at, &k)) {
            tau += (regime_mean(k.sigma_s) + regime_mean(k.sigma_a)) * step * metres;
        }
    }
    return tau;
}

void regime_of_view(const regime_media *m, const regime_box *b, const tyn_camera *camera, regime *r)
{
    const double at[3] = {camera->position[0], camera->position[1], camera->position[2]};
    regime_coefficients k;
    r->camera_inside = camera->projection == TYN_PERSPECTIVE && regime_media_at(m, at, &k);
    int filled = 0;
    for (int i = 0; i < RAYS * RAYS; i++) {
        const double x = (i % RAYS + 0.5) / RAYS * 2 - 1, y = 1 - (i / RAYS + 0.5) / RAYS * 2;
        const regime_ray through = camera_ray(camera, x, y);
        const double tau = depth_along(m, b, &through);
        filled += tau > 0.01;
        r->view_depth += tau > 0.01 ? tau : 0;
    }
    r->view_fill = (double)filled / (RAYS * RAYS);
    r->view_depth /= filled ? filled : 1;
}
