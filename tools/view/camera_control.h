// camera_control.h -- moves a camera as the user drags and flies.
#pragma once
#include <tyndall/scene.h>

typedef struct camera_control {
    tyn_camera camera;
    float target[3]; // what it turns about, on the axis of view
    float size;      // of the scene, m: the measure of speeds
} camera_control;

float camera_control_distance(const camera_control *c); // to the target, m
// Turns about the point of the axis of view that is nearest to the middle of the scene.
void camera_control_start(camera_control *c, const tyn_camera *camera, const tyn_scene *scene);
// Angles in radians: to the right about +Y, up about the camera's right. It does not turn over.
void camera_control_orbit(camera_control *c, float right, float up);
void camera_control_look(camera_control *c, float right, float up); // turns where it stands
// Moves with the target by parts of the picture's height.
void camera_control_pan(camera_control *c, float right, float up);
void camera_control_dolly(camera_control *c, float factor); // of the distance to the target, > 0
void camera_control_fly(camera_control *c, float right, float up,
                        float ahead); // in parts of the scene's size
// What is `depth` metres along the ray through a point of the picture; x and y in parts of the picture from its upper
// left corner, `aspect` its width over its height.
void camera_control_point(const camera_control *c, float x, float y, float aspect, float depth,
                          float point[3]);
// Where a point is seen, in parts of the picture. False: behind the camera.
bool camera_control_project(const camera_control *c, const float point[3], float aspect, float *x,
                            float *y);
