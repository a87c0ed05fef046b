// impostor_camera.comp -- see impostor_camera.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/common/scene_args.h"

layout(local_size_x = 1) in;
TYN_UNIFORM(0, camera, camera_block camera);
TYN_UPDATE(1, taken, camera_block taken);

void main()
{
    taken = camera;
}
