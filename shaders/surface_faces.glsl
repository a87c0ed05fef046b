// surface_faces.glsl -- does a surface face anything?
//
// Include after the declaration of `surfaces` (surface_block).
#ifndef TYN_SURFACE_FACES_GLSL
#define TYN_SURFACE_FACES_GLSL

// Is there anything in front of a surface at p (M; `world`: the same place), of the media's box or of other surfaces?
// Light reflected by the outer walls of a house is not seen by what is inside. (Less than a hundredth of the scene
// counts as nothing.)
bool surface_faces_something(vec3 p, vec3 world, vec3 n, vec3 extent)
{
    vec3 size = surfaces.hi - surfaces.lo;
    vec3 m = vec3(dot(surfaces.to_world[0].xyz, n), dot(surfaces.to_world[1].xyz, n),
                  dot(surfaces.to_world[2].xyz, n));
    // How far the boxes reach beyond the plane of the surface.
    float media = extent.x > 0.0 ? dot(max(n, vec3(0.0)), extent) - dot(n, p) : 0.0;
    float others = dot(m, 0.5 * (surfaces.lo + surfaces.hi) - world) + 0.5 * dot(abs(m), size);
    return max(media, others) > 0.01 * max(length(size), length(extent));
}

#endif
