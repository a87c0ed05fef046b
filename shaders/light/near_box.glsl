// near_box.glsl -- how far a point is from the box that pictures are of: the media's, or without media that of most triangles.
#ifndef TYN_NEAR_BOX_GLSL
#define TYN_NEAR_BOX_GLSL

float near_box_size(vec3 lo, vec3 hi)
{
    return max(hi.x - lo.x, max(hi.y - lo.y, hi.z - lo.z));
}

// Over the box's longest side; 0 where there is no box.
float near_box_away(vec3 p, vec3 lo, vec3 hi)
{
    float size = near_box_size(lo, hi);
    return size > 0.0 ? distance(p, clamp(p, lo, hi)) / size : 0.0;
}

#endif
