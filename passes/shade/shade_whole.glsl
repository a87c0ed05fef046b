// shade_whole.glsl -- the point that a pixel on one piece of surface is shaded at.
#include "shade.glsl"

shade_point shade_whole(ivec2 pixel, const gbuffer_facing seen)
{
    ivec2 corner = pixel * shade_samples;
    // In the middle of the samples, but on the plane of the one whose facet is to be in a shadow or not.
    vec3 at = shade_position(corner, shade_distance(corner)), off = vec3(0.0);
    for (int k = 1; k < shade_samples * shade_samples; k++) {
        ivec2 texel = shade_texel(corner, k);
        off += shade_position(texel, shade_distance(texel)) - at;
    }
    off = (off - dot(off, seen.facet) * seen.facet) / float(shade_samples * shade_samples);
    return shade_point(at + off, seen.normal, seen.facet);
}
