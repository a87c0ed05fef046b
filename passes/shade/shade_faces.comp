// shade_faces.comp -- what leaves the medium's box, for the surfaces outside it: into the image of shade_faces.h.
//
// A thread a patch. Light that a cell at the box's face sends out is the net flux there, on the line through the
// fluxes of the last two cells; so what the box takes of the sky behind it is in it, too. Its directions are those of
// radiance that is linear in direction, (phi + 3 w.F) / 4 pi, scaled to that flux.
#include "shade_args.h"
#include "shade_faces.h"
#include "shaders/common/scene_args.h"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/walls_links.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 1) const uint shade_features = 0u;
TYN_ARGS(shade_args args);

TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, environment, env_block environment);
layout(binding = 2) uniform sampler3D moments_tex;
layout(binding = 3) uniform usamplerBuffer wall_links_words; // wall_links
layout(binding = 4, rgba32f) uniform writeonly image2D faces_image;

const float PI = 3.14159265358979;

// A macro: its value is a specialization constant, and engine/gpu/specialize.c drops what is off.
#define has(feature) ((shade_features & (feature)) != 0u)

void main()
{
    int n = int(gl_GlobalInvocationID.x), face = n / SHADE_FACE_PATCHES, number = n % SHADE_FACE_PATCHES;
    int side = number < 1 ? 1 : number < 5 ? 2 : 4, k = number - (side * side - 1) / 3;
    if (face >= 6) {
        return;
    }
    int channels = has(SHADE_ONE_CHANNEL) ? 1 : 3;
    ivec3 dims = textureSize(moments_tex, 0);
    dims.z /= channels;
    lattice_box box = lattice_box_of(medium.extent, dims);
    int axis = face / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    bool upper = (face & 1) != 0;
    ivec2 sides = ivec2(dims[u], dims[v]), at = ivec2(k % side, k / side);
    ivec2 from = at * sides / side, to = (at + 1) * sides / side;
    ivec3 outwards = ivec3(0);
    outwards[axis] = upper ? 1 : -1;
    uint link = walls_link(outwards);

    ivec2 first = to, last = from;
    vec3 net = vec3(0.0);
    vec2 aim = 0.5 * vec2(from + to), centre = aim;
    float off = 1e30; // of `aim` from the patch's centre, squared
    vec4 mean = vec4(0.0); // of the channels, without the light of the sky
    for (int j = from.y; j < to.y; j++) {
        for (int i = from.x; i < to.x; i++) {
            ivec3 c;
            c[u] = i;
            c[v] = j;
            c[axis] = upper ? dims[axis] - 1 : 0;
            int index = (c.z * dims.y + c.y) * dims.x + c.x;
            uint links = has(SHADE_LATTICE) ? texelFetch(wall_links_words, index).x : 0u;
            ivec3 behind = c - (dims[axis] > 1 ? outwards : ivec3(0));
            uint back = walls_link(-outwards);
            behind = (links >> back & 1u) != 0u ? c : behind;
            bool open = (links >> link & 1u) == 0u, lit = false;
            for (int ch = 0; ch < channels && open; ch++) {
                ivec3 shift = ivec3(0, 0, ch * dims.z);
                vec4 m = texelFetch(moments_tex, c + shift, 0), inner = texelFetch(moments_tex, behind + shift, 0);
                m.yzw += 0.5 * (m.yzw - inner.yzw);
                float phi = max(m.x + 0.5 * (m.x - inner.x), 0.0);
                lit = lit || m.x > 0.0;
                float out_flux = dot(m.yzw, vec3(outwards));
                vec3 tint = channels == 1 ? args.tint : vec3(ch == 0, ch == 1, ch == 2);
                net += out_flux * tint;
                float sky = has(SHADE_SKY) ? 4.0 * PI * dot(environment.sky, tint) / dot(tint, tint) : 0.0;
                mean += dot(tint, vec3(1.0)) * vec4(m.x - sky, m.yzw);
            }
            if (lit) {
                first = min(first, ivec2(i, j));
                last = max(last, ivec2(i, j) + 1);
                vec2 here = vec2(i, j) + 0.5;
                float away = dot(here - centre, here - centre);
                aim = away < off ? here : aim;
                off = min(off, away);
            }
        }
    }
    bool any_lit = all(lessThan(first, last));
    // As many cells as the rectangle has share what all of them send out.
    ivec2 cells = max(last - first, ivec2(1));
    net /= PI * float(cells.x * cells.y);
    float flux = dot(mean.yzw, vec3(outwards)), all_out = mean.x + 2.0 * flux;
    vec4 shape = vec4(1.0, vec3(0.0));
    if (abs(all_out) > abs(flux) && all_out * flux > 0.0) {
        shape.yzw = 3.0 / all_out * (mean.yzw - flux * vec3(outwards));
    }
    if (side == SHADE_FACE_SIDE) {
        imageStore(faces_image, ivec2(face * SHADE_FACE_SIDE, 6) + at, vec4(any_lit ? net : vec3(0.0), 1.0));
        return;
    }
    vec2 origin = vec2(box.origin[u], box.origin[v]);
    ivec2 texel = ivec2(number * SHADE_FACE_ENTRIES, face);
    imageStore(faces_image, texel + ivec2(SHADE_FACE_RECT, 0),
               vec4(origin + box.dx * vec2(first), origin + box.dx * vec2(last)));
    imageStore(faces_image, texel + ivec2(SHADE_FACE_LIGHT, 0), any_lit ? vec4(net, 1.0) : vec4(0.0));
    imageStore(faces_image, texel + ivec2(SHADE_FACE_SHAPE, 0), shape);
    vec3 target;
    target[u] = origin.x + box.dx * aim.x;
    target[v] = origin.y + box.dx * aim.y;
    target[axis] = box.origin[axis] + (upper ? box.dx * float(dims[axis]) : 0.0);
    imageStore(faces_image, texel + ivec2(SHADE_FACE_AIM, 0), vec4(target, 0.0));
}
