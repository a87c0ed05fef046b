// shade_sight.comp -- which patches of the box's faces are seen from places around it: a ray a patch.
//
// Far fewer places than pixels, and between them it is interpolated: light of so large emitters has no sharp shadows.
#include "shaders/surfaces/surface_args.h"
#include "shaders/common/scene_args.h"
#include "shaders/lattice/lattice.glsl"
#include "shade_faces.h"
#include "shade_args.h"

layout(local_size_x = 8, local_size_y = 4) in;
TYN_ARGS(shade_args args);

#define GEOMETRY_AT 0
#include "shaders/surfaces/surfaces.glsl"
TYN_UNIFORM(4, medium, medium_block medium);
layout(binding = 5) uniform sampler2D faces_tex;
layout(binding = 6) uniform sampler3D moments_tex;
layout(binding = 7, rgba32f) uniform writeonly image3D sight_image;
layout(constant_id = 0) const uint channels = 1u;
#include "shaders/surfaces/surface_trace.glsl"

// Is nothing between two places (M)?
bool open_between(vec3 from, vec3 to)
{
    float far = distance(from, to);
    surface_hit hit = surface_hit(0.999 * far, SURFACE_NONE, vec2(0.0));
    surface_ray ray = surface_ray_make(surface_transform(surfaces.to_world, from),
                                       surface_turn(surfaces.to_world, (to - from) / max(far, 1e-30)), SURFACE_NONE);
    return !surface_trace_world(ray, true, hit);
}

// How far one can go from a place along d (unit; M), m; `most` at most.
float way_from(vec3 p, vec3 d, float most)
{
    surface_hit hit = surface_hit(most, SURFACE_NONE, vec2(0.0));
    surface_ray ray =
        surface_ray_make(surface_transform(surfaces.to_world, p), surface_turn(surfaces.to_world, d), SURFACE_NONE);
    return surface_trace_world(ray, false, hit) ? hit.t : most;
}

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = imageSize(sight_image);
    size.z /= SHADE_SIGHT_FIELDS;
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    ivec3 dims = textureSize(moments_tex, 0);
    dims.z /= int(channels);
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec3 lo = box.origin, hi = lattice_to_m(box, vec3(dims));
    vec3 p = args.sight_lo + (vec3(at) + 0.5) * args.sight_edge;
    bool asked = false, sees = false;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        bool upper = (face & 1) != 0;
        float plane = upper ? hi[axis] : lo[axis], before = upper ? p[axis] - plane : plane - p[axis];
        // A place a little behind the face is asked for in front of it: surfaces there lie between it and others, and the
        // place between the face and them.
        vec3 from = p, outwards = vec3(0.0);
        float lift = max(before, 0.25 * args.sight_edge);
        outwards[axis] = upper ? 1.0 : -1.0;
        from[axis] = plane;
        for (bool behind = before > -3.0 * args.sight_edge && before < lift; behind; behind = false) {
            float way = way_from(from, outwards, lift);
            lift = way < lift ? 0.5 * way : lift;
        }
        from += lift * outwards;
        vec4 seen = vec4(1.0);
        for (int k = before > -3.0 * args.sight_edge ? 0 : 4; k < 4; k++) {
            int texel = (1 + k) * SHADE_FACE_ENTRIES;
            bool lit = texelFetch(faces_tex, ivec2(texel + SHADE_FACE_LIGHT, face), 0).a > 0.0;
            for (; lit; lit = false) {
                seen[k] = open_between(from, texelFetch(faces_tex, ivec2(texel + SHADE_FACE_AIM, face), 0).xyz) ? 1.0 : 0.0;
                asked = true;
                sees = sees || seen[k] > 0.0;
            }
        }
        imageStore(sight_image, at + ivec3(0, 0, face * size.z), seen);
    }
    imageStore(sight_image, at + ivec3(0, 0, SHADE_SIGHT_SHARE * size.z), vec4(asked && !sees ? 0.0 : 1.0));
}
