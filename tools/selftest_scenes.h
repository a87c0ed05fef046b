// selftest_scenes.h -- small scenes whose answers are known, made in memory.
#pragma once
#include <tyndall/scene.h>

// The unit cube [0, 1]^3 of sigma_s 4/m. With `furnace` in a uniform environment of radiance 1, else
// under a sun of 1 W/m^2 along +x.
void selftest_cube(tyn_scene *scene, float g, bool furnace);

// A slab of 1 m that goes on for ever along x and z, of optical thickness 1, albedo 0.9 and g 0.5,
// under a sun of 1 W/m^2 straight above.
void selftest_slab(tyn_scene *scene);

// Orthographic, looking at the middle of the cube along `direction`; the picture's half height in m.
void selftest_camera(tyn_camera *camera, float x, float y, float z, float half_height);
