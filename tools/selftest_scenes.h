// selftest_scenes.h -- small scenes whose answers are known, made in memory.
#pragma once
#include <tyndall/scene.h>

// The unit cube [0, 1]^3 of sigma_s 4/m. With `furnace` in a uniform environment of radiance 1, else
// under a sun of 1 W/m^2 along +x.
void selftest_cube(tyn_scene *scene, float g, bool furnace);

// A slab from y 0 to 1 m of optical thickness tau that goes on for ever along x and z, under a sun at the
// cosine mu0 with the vertical and of unit flux through a horizontal plane. `ground` > 0: on a diffuse ground
// of this albedo, which repeats with the slab (as `path` wants it) or is `wide` (as `pop` does). False: out of memory.
bool selftest_slab(tyn_scene *scene, float tau, float g, float albedo, float mu0, float ground,
                   bool wide);

// A lamp of 1 W/sr at the origin, in the middle of an isotropic medium in a cube of this side in m.
void selftest_lamp(tyn_scene *scene, float albedo, float extinction, float side);

// Orthographic, looking at the middle of the cube along `direction`; the picture's half height in m.
void selftest_camera(tyn_camera *camera, float x, float y, float z, float half_height);
