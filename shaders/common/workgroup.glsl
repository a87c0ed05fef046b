// workgroup.glsl -- sums over the threads of a workgroup, in a fixed order.
//
// Define WORKGROUP_SIZE, a power of two, and WORKGROUP_SUM, the type of the sums, before. All threads call these together.
#ifndef TYN_WORKGROUP_GLSL
#define TYN_WORKGROUP_GLSL

shared WORKGROUP_SUM workgroup_sums[WORKGROUP_SIZE];

WORKGROUP_SUM workgroup_total(WORKGROUP_SUM v)
{
    uint lane = gl_LocalInvocationIndex;
    barrier();
    workgroup_sums[lane] = v;
    for (uint half_size = WORKGROUP_SIZE / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (lane < half_size) {
            workgroup_sums[lane] += workgroup_sums[lane + half_size];
        }
    }
    barrier();
    return workgroup_sums[0];
}

// workgroup_sums[lane] becomes the sum of the threads up to this one.
void workgroup_cumulate(WORKGROUP_SUM v)
{
    uint lane = gl_LocalInvocationIndex;
    workgroup_sums[lane] = v;
    for (uint step = 1u; step < WORKGROUP_SIZE; step *= 2u) {
        barrier();
        WORKGROUP_SUM before = lane >= step ? workgroup_sums[lane - step] : WORKGROUP_SUM(0.0);
        barrier();
        workgroup_sums[lane] += before;
    }
    barrier();
}

#endif
