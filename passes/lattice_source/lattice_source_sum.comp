// lattice_source_sum.comp -- the factor that makes the cells lose what the beam loses.
//
// One workgroup per sun and channel. What the beam loses is the integral of 1 - e^-tau' over the
// faces where it leaves the box. Sums have a fixed order: every thread its own terms, then
// pairwise.
#include "shaders/lattice/lattice_args.h"
#define MEDIUM_BLOCK 0
#define BEAMS_AT 1
#define BEAMS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/lattice/lattice.glsl"

layout(local_size_x = LATTICE_SUN_GROUP) in;
#define WORKGROUP_SIZE LATTICE_SUN_GROUP
#define WORKGROUP_SUM vec2
#include "shaders/common/workgroup.glsl"
TYN_ARGS(lattice_source_args args);
layout(binding = 5) uniform sampler3D cells;
layout(binding = 6) uniform sampler3D sunlit;
TYN_WRITE(7, power, lattice_power power[]);

const uint FACE_SAMPLES = 2; // per cell along each axis

float lost_through_exit_faces(uint sun, uint ch)
{
    float lost = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        int u = (axis + 1) % 3, v = (axis + 2) % 3;
        float cosine = beams[sun].direction[axis];
        uint nu = FACE_SAMPLES * args.dims[u], nv = FACE_SAMPLES * args.dims[v];
        float area = medium.extent[u] * medium.extent[v] / float(nu * nv) * abs(cosine);
        if (area == 0.0 || medium.repeat[axis] != 0u) {
            continue;
        }
        vec3 p;
        p[axis] = cosine > 0.0 ? medium.extent[axis] : 0.0;
        for (uint i = gl_LocalInvocationIndex; i < nu * nv; i += LATTICE_SUN_GROUP) {
            p[u] = (float(i % nu) + 0.5) / float(nu) * medium.extent[u];
            p[v] = (float(i / nu) + 0.5) / float(nv) * medium.extent[v];
            beam_tau tau = beam_depth(sun, p);
            float t = tau.a[ch] + tau.p[ch];
            lost += area * (t < 0.01 ? t * (1.0 - 0.5 * t * (1.0 - t / 3.0)) : 1.0 - exp(-t));
        }
    }
    return lost;
}

float collided_in_cells(uint sun, uint ch, float volume)
{
    float collided = 0.0;
    uint plane = args.dims.x * args.dims.y, n = plane * args.dims.z;
    int z_cells = int(ch * args.dims.z), z_sun = int(sun * args.dims.z);
    for (uint i = gl_LocalInvocationIndex; i < n; i += LATTICE_SUN_GROUP) {
        ivec3 c = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / plane);
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, z_cells), 0);
        collided += volume * (cell.x + cell.y) * texelFetch(sunlit, c + ivec3(0, 0, z_sun), 0)[ch];
    }
    return collided;
}

void main()
{
    uint sun = gl_WorkGroupID.x, ch = gl_WorkGroupID.y, me = gl_LocalInvocationIndex;
    float dx = lattice_box_of(medium.extent, ivec3(args.dims)).dx;
    vec2 lost = workgroup_total(vec2(lost_through_exit_faces(sun, ch), collided_in_cells(sun, ch, dx * dx * dx)));
    if (me == 0) {
        vec3 extent = medium.extent, d = abs(beams[sun].direction);
        vec3 faces = vec3(extent.y * extent.z, extent.z * extent.x, extent.x * extent.y) *
                     vec3(equal(medium.repeat, uvec3(0)));
        // Close to 1 where the sub-samples resolve the beam; large where it is lost within a
        // fraction of one, or where the depth of the cells is bounded.
        float scale = lost.y > 0.0 ? min(lost.x / lost.y, 1e6) : 1.0;
        power[sun * args.channels + ch] =
            lattice_power(dot(faces, d), lost.x, lost.y * scale, scale);
    }
}
