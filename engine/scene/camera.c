// camera.c -- cameras that nobody placed by hand.
#include <tyndall/scene.h>
#include "scene/matrix.h"

static void set_frame(tyn_camera *camera, const double right[3], const double up[3],
                      const double back[3])
{
    for (int a = 0; a < 3; a++) {
        camera->right[a] = (float)right[a];
        camera->up[a] = (float)up[a];
        camera->back[a] = (float)back[a];
    }
}

tyn_result tyn_camera_look_at(tyn_camera *camera, const float from[3], const float at[3])
{
    if (!camera || !from || !at) {
        return TYN_ERR_PARAMS;
    }
    double back[3] = {(double)from[0] - at[0], (double)from[1] - at[1], (double)from[2] - at[2]};
    double right[3], up[3] = {0.0, 1.0, 0.0};
    if (!vec_normalize(back)) {
        return TYN_ERR_PARAMS;
    }
    if (back[0] * back[0] + back[2] * back[2] < 1e-12) { // parallel to +Y
        up[1] = 0.0;
        up[2] = -1.0;
    }
    vec_cross(right, up, back);
    vec_normalize(right);
    vec_cross(up, back, right);
    set_frame(camera, right, up, back);
    memcpy(camera->position, from, sizeof camera->position);
    return TYN_OK;
}

void tyn_camera_frame_scene(tyn_camera *camera, const tyn_scene *scene)
{
    if (!camera || !scene) {
        return;
    }
    const double yfov = 40.0 * M_PI / 180.0, elevation = 15.0 * M_PI / 180.0;
    float lo[3], hi[3], at[3], from[3];
    double radius2 = 0.0;
    tyn_scene_bounds(scene, lo, hi);
    for (int a = 0; a < 3; a++) {
        double half = 0.5 * ((double)hi[a] - lo[a]);
        at[a] = (float)(lo[a] + half);
        radius2 += half * half;
    }
    double radius = radius2 > 0.0 ? sqrt(radius2) : 1.0;
    double distance = radius / sin(0.5 * yfov); // the sphere touches the upper and lower edge
    from[0] = at[0];
    from[1] = (float)(at[1] + distance * sin(elevation));
    from[2] = (float)(at[2] + distance * cos(elevation));
    memset(camera, 0, sizeof *camera);
    camera->projection = TYN_PERSPECTIVE;
    camera->yfov = (float)yfov;
    if (tyn_camera_look_at(camera, from, at) != TYN_OK) { // the scene is lost in float rounding
        set_frame(camera, (double[]){1, 0, 0}, (double[]){0, 1, 0}, (double[]){0, 0, 1});
    }
}
