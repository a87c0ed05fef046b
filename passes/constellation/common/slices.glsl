// slices.glsl -- rays cut by shells about the eye, after Navarro et al. 2008, section 4.2.
//
// Slice i is the sphere of radius i D about the eye (of parallel rays: the plane), D the distance between slices, so that
// neighbouring rays are sampled at the same distances. A ray has the slices iNear to iFar (Eqs 6 and 7); here they are
// counted from iNear = 0, so that half floats hold their numbers however far away the camera is. Each stands for the
// part of the ray halfway to its neighbours, the first and the last one for all up to where the ray enters and leaves;
// a ray that is in the box for less than D and meets no slice has one in the middle.
#include "slices_args.h"

struct slices {
    float start; // where the ray enters the box, m from the eye; what follows is from there
    float end;   // where it leaves the box
    float first; // where slice 0 is
    int count;   // 0: the ray misses the box
};

// `span`: where the ray is in the box, m from the eye.
slices slices_of(const slices_args a, vec2 span)
{
    slices s;
    s.start = span.x;
    s.end = span.y - span.x;
    const float near = span.x / a.distance;
    s.first = (ceil(near) - near) * a.distance;
    s.count = span.x < span.y ? int(floor((s.end - s.first) / a.distance)) + 1 : 0;
    if (span.x < span.y && s.count < 1) {
        s.count = 1;
        s.first = 0.5 * s.end;
    }
    return s;
}

float slice_at(const slices_args a, const slices s, int i)
{
    return s.first + float(i) * a.distance;
}

// The part of the ray that slice i stands for.
vec2 slice_span(const slices_args a, const slices s, int i)
{
    const float at = slice_at(a, s, i);
    return vec2(i == 0 ? 0.0 : at - 0.5 * a.distance, i == s.count - 1 ? s.end : at + 0.5 * a.distance);
}

// How many slices after a sample are empty for sure, in all directions. `away`: the distance to where density begins
// (voxel_distance with `reach`), blended between the centres of eight voxels like the density: so at the sample it is too
// large by half a voxel's diagonal at most, which `margin` is.
int slices_skipped(const slices_args a, float away)
{
    return int(max((away - a.margin) / a.distance, 0.0));
}
