// camera_control.c -- moves a camera as the user drags and flies.
#include "view/camera_control.h"
#include <math.h>
#include <string.h>

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void move(float v[3], const float along[3], float by)
{
    for (int i = 0; i < 3; i++) {
        v[i] += by * along[i];
    }
}

// Rodrigues' rotation of v about a unit axis.
static void rotate(float v[3], const float axis[3], float angle)
{
    const float c = cosf(angle), s = sinf(angle), k = (1 - c) * dot(axis, v);
    const float turned[3] = {c * v[0] + s * (axis[1] * v[2] - axis[2] * v[1]) + k * axis[0],
                             c * v[1] + s * (axis[2] * v[0] - axis[0] * v[2]) + k * axis[1],
                             c * v[2] + s * (axis[0] * v[1] - axis[1] * v[0]) + k * axis[2]};
    memcpy(v, turned, sizeof turned);
}

static void normalize(float v[3])
{
    const float length = sqrtf(dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

float camera_control_distance(const camera_control *c)
{
    float away[3];
    for (int i = 0; i < 3; i++) {
        away[i] = c->camera.position[i] - c->target[i];
    }
    return sqrtf(dot(away, away));
}

static void aim_at_distance(camera_control *c, float far)
{
    memcpy(c->target, c->camera.position, sizeof c->target);
    move(c->target, c->camera.back, -far);
}

void camera_control_start(camera_control *c, const tyn_camera *camera, const tyn_scene *scene)
{
    float lo[3], hi[3], to_middle[3], size[3];
    *c = (camera_control){.camera = *camera};
    c->camera.name = c->camera.camera_name = NULL; // are the scene's
    tyn_scene_bounds(scene, lo, hi);
    for (int i = 0; i < 3; i++) {
        to_middle[i] = 0.5f * (lo[i] + hi[i]) - camera->position[i];
        size[i] = hi[i] - lo[i];
    }
    c->size = fmaxf(sqrtf(dot(size, size)), 1e-6f);
    aim_at_distance(c, fmaxf(-dot(to_middle, camera->back), 0.05f * c->size));
}

// Turns the three axes; keeps the camera from turning over, and the axes at right angles.
static void turn(tyn_camera *camera, float right, float up)
{
    const float y[3] = {0, 1, 0};
    const float height = asinf(fminf(fmaxf(camera->back[1], -1), 1)), most = 1.55f;
    if (height - up > most || height - up < -most) {
        up = 0;
    }
    rotate(camera->up, camera->right, up);
    rotate(camera->back, camera->right, up);
    rotate(camera->right, y, -right);
    rotate(camera->up, y, -right);
    rotate(camera->back, y, -right);
    normalize(camera->back);
    move(camera->right, camera->back, -dot(camera->right, camera->back));
    normalize(camera->right);
    const float *b = camera->back, *r = camera->right;
    const float across[3] = {b[1] * r[2] - b[2] * r[1], b[2] * r[0] - b[0] * r[2],
                             b[0] * r[1] - b[1] * r[0]};
    memcpy(camera->up, across, sizeof across);
}

void camera_control_orbit(camera_control *c, float right, float up)
{
    const float far = camera_control_distance(c);
    turn(&c->camera, right, up);
    memcpy(c->camera.position, c->target, sizeof c->target);
    move(c->camera.position, c->camera.back, far);
}

void camera_control_look(camera_control *c, float right, float up)
{
    const float far = camera_control_distance(c);
    turn(&c->camera, right, up);
    aim_at_distance(c, far);
}

// Half the height of what is seen at the target, m.
static float half_height(const camera_control *c)
{
    return c->camera.projection == TYN_ORTHOGRAPHIC
               ? c->camera.ymag
               : camera_control_distance(c) * tanf(0.5f * c->camera.yfov);
}

void camera_control_pan(camera_control *c, float right, float up)
{
    const float height = 2 * half_height(c);
    float *moved[] = {c->camera.position, c->target};
    for (int i = 0; i < 2; i++) {
        move(moved[i], c->camera.right, right * height);
        move(moved[i], c->camera.up, up * height);
    }
}

void camera_control_dolly(camera_control *c, float factor)
{
    if (c->camera.projection == TYN_ORTHOGRAPHIC) {
        c->camera.ymag = fminf(fmaxf(c->camera.ymag * factor, 1e-4f * c->size), 100 * c->size);
        return;
    }
    const float far =
        fminf(fmaxf(camera_control_distance(c) * factor, 1e-3f * c->size), 100 * c->size);
    memcpy(c->camera.position, c->target, sizeof c->target);
    move(c->camera.position, c->camera.back, far);
}

void camera_control_fly(camera_control *c, float right, float up, float ahead)
{
    float *moved[] = {c->camera.position, c->target};
    for (int i = 0; i < 2; i++) {
        move(moved[i], c->camera.right, right * c->size);
        move(moved[i], c->camera.up, up * c->size);
        move(moved[i], c->camera.back, -ahead * c->size);
    }
}

void camera_control_point(const camera_control *c, float x, float y, float aspect, float depth,
                          float point[3])
{
    const tyn_camera *camera = &c->camera;
    const bool parallel = camera->projection == TYN_ORTHOGRAPHIC;
    const float half = parallel ? camera->ymag : tanf(0.5f * camera->yfov);
    const float right = (2 * x - 1) * half * aspect, up = (1 - 2 * y) * half;
    float across[3] = {0, 0, 0}, ray[3];
    move(across, camera->right, right);
    move(across, camera->up, up);
    for (int i = 0; i < 3; i++) {
        ray[i] = (parallel ? 0 : across[i]) - camera->back[i];
        point[i] = camera->position[i] + (parallel ? across[i] : 0);
    }
    normalize(ray);
    move(point, ray, depth);
}

bool camera_control_project(const camera_control *c, const float point[3], float aspect, float *x,
                            float *y)
{
    const tyn_camera *camera = &c->camera;
    const bool parallel = camera->projection == TYN_ORTHOGRAPHIC;
    float from[3];
    for (int i = 0; i < 3; i++) {
        from[i] = point[i] - camera->position[i];
    }
    const float ahead = -dot(from, camera->back);
    const float half = parallel ? camera->ymag : ahead * tanf(0.5f * camera->yfov);
    *x = 0.5f + 0.5f * dot(from, camera->right) / (half * aspect);
    *y = 0.5f - 0.5f * dot(from, camera->up) / half;
    return ahead > 0;
}
