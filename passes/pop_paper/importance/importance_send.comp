// importance_send.comp -- what leaves the medium along each direction of the map: parallel rays through
// the box, marched from where the importance leaves.
#include "shaders/common/uniform_branch.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/phase/hg.glsl"
#include "importance.glsl"

layout(local_size_x = TYN_IMPORTANCE_RAYS, local_size_y = 8) in;
TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, grid, importance_grid grid);
layout(set = 0, binding = 2) uniform sampler3D field;
TYN_WRITE(3, sent, float sent[]);
TYN_ARGS(importance_args args);

// The map cannot show narrower lobes than its texels: they are widened to those with half their height
// at 3 degrees.
const float NARROWEST = 0.9;

shared float rows[8][TYN_IMPORTANCE_RAYS];

// Along one ray, per area across it, 1/(m^2 sr).
float march(vec3 origin, vec3 w)
{
    vec2 span = ray_box(origin, ray_inverse(w), vec3(0.0), medium.extent);
    float way = max(span.y - span.x, 0.0) / float(TYN_IMPORTANCE_STEPS);
    vec3 start = importance_camera_vector(grid, origin - grid.origin);
    vec3 heading = importance_camera_vector(grid, w);
    float seen = 1.0, sum = 0.0;
    for (int i = 0; i < TYN_IMPORTANCE_STEPS; i++) {
        vec3 p = start + heading * (span.y - (float(i) + 0.5) * way);
        vec3 at = importance_from_camera(grid, p);
        vec4 here = textureLod(field, at, 0.0);
        bool inside = p.z >= grid.near && all(greaterThanEqual(at.xy, vec2(0.0))) &&
                      all(lessThanEqual(at.xy, vec2(1.0)));
        vec3 axis = grid.orthographic != 0u ? vec3(0.0, 0.0, 1.0) : p / max(length(p), 1e-20);
        float cosine = clamp(here.y / max(here.x, 1e-30), -NARROWEST, NARROWEST);
        float depth = here.z * way;
        float lost = propagate_loss(depth);
        float passed = depth > 1e-6 ? lost / depth : 1.0; // mean transmittance within the step
        sum += inside ? seen * passed * here.x * hg(cosine, dot(axis, heading)) : 0.0;
        seen *= 1.0 - lost;
    }
    return sum * way;
}

void main()
{
    uvec2 local = gl_LocalInvocationID.xy;
    uint texel = gl_GlobalInvocationID.y;
    vec3 w = importance_direction(texel);
    vec3 start = abs(w.y) < 0.7 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 u = normalize(cross(start, w));
    vec3 v = cross(w, u);
    vec2 side = vec2(dot(abs(u), medium.extent), dot(abs(v), medium.extent)); // of the box seen from w
    float sum = 0.0;
    if (uniform_branch(grid.empty == 0u)) {
        for (int i = 0; i < TYN_IMPORTANCE_RAYS; i++) {
            vec2 at = (vec2(local.x, i) + 0.5) / float(TYN_IMPORTANCE_RAYS) - 0.5;
            sum += march(0.5 * medium.extent + u * (at.x * side.x) + v * (at.y * side.y), w);
        }
    }
    rows[local.y][local.x] = sum;
    barrier();
    if (local.x == 0u) {
        float total = 0.0;
        for (int i = 0; i < TYN_IMPORTANCE_RAYS; i++) {
            total += rows[local.y][i];
        }
        sent[texel] = total * side.x * side.y / float(TYN_IMPORTANCE_RAYS * TYN_IMPORTANCE_RAYS);
    }
}
