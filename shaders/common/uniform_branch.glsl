// uniform_branch.glsl -- branches and loops of compute kernels by a number of a uniform block alone.
//
// Mesa's lavapipe 22.3 makes a kernel anew whenever such a number may have changed, if most of the kernel lies behind the
// branch, and keeps all of them as long as the pipeline: tens of milliseconds and .3 MiB each time (tests/embed/endurance.c).
// It does not where the branch also asks for something else, which costs nothing.
#ifndef TYN_UNIFORM_BRANCH_GLSL
#define TYN_UNIFORM_BRANCH_GLSL

bool uniform_branch(bool condition)
{
    return condition && gl_NumWorkGroups.x != 0u;
}

#endif
