// shade_forward.comp -- from where sunlight that the medium has scattered forward comes, at the lattice's cells.
//
// Such light comes from around its sun, so that a shadow's edge is as soft as the medium is deep. SHADE_PLACES places
// on the way to the sun, in directions of the forward lobe, are looked up in its shadow map. That is soft
// enough for a lattice to hold; per pixel so few places would show as copies of the shadow. Those beyond a wall of
// the lattice send nothing: a roof that the cell is under is lit from above.
#include "shade_args.h"
#include "shaders/common/scene_args.h"
#define MEDIUM_BLOCK 0
#define BEAMS_AT 1
#define SHADOWS_AT 5
#define SHADOWS_STORAGE
#include "shaders/common/camera.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/light/shadow.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = 2) const uint shade_num_suns = 0u;

TYN_UNIFORM(7, suns, light_block suns[TYN_LIGHTS_MAX]);
// [sun][z][y][x]: mean direction that the light comes from, not of unit length; share of the places that are lit
layout(binding = 8, rgba32f) uniform writeonly image3D forward_image;
layout(binding = 9) uniform usamplerBuffer wall_links_words; // wall_links

// The cell that light comes to from a place that is `way` from the centre of cell c (cell edges): the first beyond it, of those
// along the line, if none of the links next to the line is cut. `near`: a wall is about. False: a wall is between.
// Outside the lattice there are none.
bool reaches(ivec3 dims, ivec3 c, vec3 way, out ivec3 at, out bool near)
{
    vec3 size = abs(way);
    float most = max(size.x, max(size.y, size.z));
    // A step is 1 along the longest axis, 0 or 1 along the others: of four links, five bits each.
    ivec3 along = size.x >= most ? ivec3(1, 0, 0) : size.y >= most ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    ivec3 first = ivec3(1 - along.x, along.x, 0), second = ivec3(0, along.z, 1 - along.z);
    ivec3 towards = mix(ivec3(1), ivec3(-1), lessThan(way, vec3(0.0))), weight = (first + 2 * second) * towards;
    uint step_links = walls_link(towards * along) | walls_link(towards * (along + first)) << 5 |
                      walls_link(towards * (along + second)) << 10 | walls_link(towards) << 15;
    int n = int(ceil(most)), index = c.x + dims.x * (c.y + dims.y * c.z);
    ivec3 row = ivec3(1, dims.x, dims.x * dims.y);
    vec3 by = way / max(most, 1e-20);
    uint links = texelFetch(wall_links_words, index).x, before = 0u;
    bool open = true, inside = true;
    at = c;
    for (int i = 1; i <= n && open && inside; i++) {
        ivec3 next = c + ivec3(floor(by * float(i) + 0.5)), d = next - at, t = d * weight;
        uint link = step_links >> uint(5 * (t.x + t.y + t.z)) & 31u;
        open = (links >> link & 1u) == 0u;
        inside = all(lessThan(uvec3(next), uvec3(dims)));
        d *= row;
        index += d.x + d.y + d.z;
        before = links;
        links = inside ? texelFetch(wall_links_words, index).x : 0u;
        at = next;
    }
    near = inside && ((links | before) & TYN_WALLS_NEAR) != 0u;
    return open;
}

// Any two directions across the unit vector n (Duff et al., "Building an orthonormal basis, revisited", JCGT 2017).
mat3 frame_of(vec3 n)
{
    float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// The lobe of what scatters on the way, by what the scaled depth leaves out.
float lobe_of(const beam_tau tau)
{
    vec3 kept = tau.p / max(tau.s, vec3(1e-20));
    return delta_lobe(clamp(1.0 - (kept.r + kept.g + kept.b) / 3.0, 0.0, 0.98));
}

vec4 forward_light(uint n, const lattice_box box, ivec3 c)
{
    const vec3 shift = vec3(TYN_WALLS_SHIFT_X, TYN_WALLS_SHIFT_Y, TYN_WALLS_SHIFT_Z);
    vec3 p = lattice_to_m(box, vec3(c) + 0.5);
    uint sun = beams[n].light;
    vec3 towards = -suns[sun].direction;
    vec2 way = ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent);
    way.x = max(way.x, 0.0);
    shadow_light map = shadows[sun]; // once: buffers are slow to read
    vec3 at = shadow_frame(map, p);
    if (way.x >= way.y) {
        return vec4(towards, 1.0) * shadow_all_lit(shadow_place_sun(map, at));
    }
    float g = lobe_of(beam_depth(n, p + way.x * towards));
    mat3 frame = frame_of(towards);
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < SHADE_PLACES; k++) {
        float along = (float(k) + 0.5) / float(SHADE_PLACES);
        float turn = 2.399963 * float(k); // the golden angle
        float cosine = delta_lobe_cosine(g, fract(0.5 + 0.618034 * float(k))), sine = sqrt(1.0 - cosine * cosine);
        vec3 from = frame * vec3(sine * cos(turn), sine * sin(turn), cosine);
        float far = mix(way.x, way.y, along);
        vec3 there = at + far * shadow_frame_direction(map, from);
        float lit = shadow_all_lit(shadow_place_sun(map, there));
        if (lit > 0.0) {
            ivec3 cell;
            bool near;
            lit = reaches(box.dims, c, far / box.dx * from, cell, near) ? 1.0 : 0.0;
            // Links are no lines: the place may be just beyond a wall that the cell is not.
            if (lit > 0.0 && near) {
                lit = shadow_all_lit(shadow_place_sun(map, shadow_frame(map, lattice_to_m(box, vec3(cell) + 0.5 + shift))));
            }
        }
        sum += lit * vec4(from, 1.0);
    }
    return sum / float(SHADE_PLACES);
}

void main()
{
    ivec3 c = ivec3(gl_GlobalInvocationID), dims = imageSize(forward_image);
    dims.z /= int(shade_num_suns);
    if (any(greaterThanEqual(c, dims))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    for (uint n = 0u; n < shade_num_suns; n++) {
        imageStore(forward_image, c + ivec3(0, 0, int(n) * dims.z), forward_light(n, box, c));
    }
}
