// regime_box.c -- the box that a scene's media are in.
#include "regime_parts.h"
#include <string.h>

static bool box_of_shape(const tyn_shape *shape, regime_box *b)
{
    const float *m = shape->to_world;
    bool straight = true;
    *b = (regime_box){0};
    for (int i = 0; i < 3; i++) {
        const double e[3] = {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
        memcpy(b->edge[i], e, sizeof e);
        b->length[i] = sqrt(regime_dot(e, e));
        b->repeat[i] = shape->repeat[i];
        for (int k = 0; k < i; k++) {
            straight &= fabs(regime_dot(e, b->edge[k])) <= 1e-5 * b->length[i] * b->length[k];
        }
    }
    for (int a = 0; a < 3; a++) {
        b->origin[a] = m[12 + a] - 0.5 * (b->edge[0][a] + b->edge[1][a] + b->edge[2][a]);
    }
    return straight;
}

bool regime_box_of(const tyn_scene *scene, regime_box *b)
{
    float lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
    if (scene->num_shapes == 1 && box_of_shape(&scene->shapes[0], b)) {
        return true;
    }
    const bool found = tyn_scene_bounds(scene, lo, hi);
    *b = (regime_box){0};
    for (int a = 0; a < 3; a++) {
        b->origin[a] = found ? lo[a] : 0;
        b->edge[a][a] = b->length[a] = found ? (double)hi[a] - lo[a] : 1;
    }
    return found;
}

double regime_box_longest(const regime_box *b)
{
    return fmax(b->length[0], fmax(b->length[1], b->length[2]));
}

double regime_box_surface(const regime_box *b)
{
    const double *l = b->length;
    return 2 * (l[0] * l[1] + l[1] * l[2] + l[2] * l[0]);
}

double regime_box_shadow(const regime_box *b, const double direction[3])
{
    double area = 0;
    for (int a = 0; a < 3; a++) {
        double face[3];
        regime_cross(b->edge[(a + 1) % 3], b->edge[(a + 2) % 3], face);
        area += fabs(regime_dot(face, direction));
    }
    return area;
}

bool regime_box_cut(const regime_box *b, const regime_ray *r, double *enter, double *leave)
{
    *enter = 0;
    *leave = INFINITY;
    for (int a = 0; a < 3; a++) {
        const double l2 = b->length[a] * b->length[a];
        double from[3];
        for (int k = 0; k < 3; k++) {
            from[k] = r->from[k] - b->origin[k];
        }
        const double at = l2 > 0 ? regime_dot(from, b->edge[a]) / l2 : 0.5;
        const double speed = l2 > 0 ? regime_dot(r->along, b->edge[a]) / l2 : 0;
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
