// uniform_branch.glsl -- branches and loops of compute kernels by a number of a uniform block alone.
//
// Mesa's lavapipe 22.3 makes a kernel anew whenever such a number may have changed, if most of the kernel lies behind the
// branch, and keeps all of them as long as the pipeline. Without this include 36 frames of tests/embed/endurance.c (sequence:
// camera, lights, map and medium change) leave 13.1 MiB, .36 MiB a frame, with it nothing; their processor time is the same
// within the noise (93 and 92 ms a frame, medians of four runs of each in turn, which differ by 3 and 10 ms).
// It does not where the branch also asks for something else, which costs nothing.
#ifndef TYN_UNIFORM_BRANCH_GLSL
#define TYN_UNIFORM_BRANCH_GLSL

bool uniform_branch(bool condition)
{
    return condition && gl_NumWorkGroups.x != 0u;
}

#endif
