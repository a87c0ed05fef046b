// shdom_lines.comp -- radiance along the lines of a batch of ordinates: a thread follows a line through all slices. y: ordinates.
#include "shdom_args.h"
#include "shdom_lines.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform samplerBuffer directions_texels;
layout(binding = 1) uniform samplerBuffer emitted_words;    // [ordinate of the batch][cell]
layout(binding = 2) uniform samplerBuffer extinction_words; // [cell]
TYN_WRITE(3, lines, float radiance[]);                      // [ordinate of the batch][slice][line]

// Source, W/(m^3 sr), and extinction, 1/m, at a place of a slice: between four cells.
vec2 medium_at(const shdom_lines lines, int first, int slice, vec2 at)
{
    vec2 x = clamp(at - 0.5, vec2(0.0), vec2(lines.size.yz - 1));
    ivec2 lo = ivec2(x), hi = min(lo + 1, lines.size.yz - 1);
    vec2 t = x - vec2(lo), sum = vec2(0.0);
    [[unroll]] for (int k = 0; k < 4; k++) {
        bvec2 far = bvec2((k & 1) != 0, (k & 2) != 0);
        vec2 w = mix(1.0 - t, t, far);
        int c = shdom_cell(lines, ivec3(args.dims), slice, mix(lo, hi, far));
        sum += w.x * w.y * vec2(texelFetch(emitted_words, first + c).x, texelFetch(extinction_words, c).x);
    }
    return sum;
}

// The share of a step to `to` that is within the box, where it comes in at a side.
float share_within(float to, float size, float slope)
{
    return slope > 0.0 ? clamp(to / slope, 0.0, 1.0) : slope < 0.0 ? clamp((to - size) / slope, 0.0, 1.0) : 1.0;
}

// Of thin steps the source per metre is linear along them, of others the source per extinction along the depth: so no
// light is made where the extinction changes by much from cell to cell.
float step_along(float light, vec2 from, vec2 to, float way)
{
    float tau = 0.5 * (from.y + to.y) * way, e = exp(-tau);
    if (tau < 0.03) {
        return light * e + way * (to.x * (0.5 - tau / 6.0) + from.x * (0.5 - tau / 3.0));
    }
    float mean = (1.0 - e) / tau, least = 1e-4 * max(from.y, to.y);
    vec2 source = vec2(from.x, to.x) / max(vec2(from.y, to.y), vec2(least));
    source.x = from.y > least ? source.x : source.y;
    source.y = to.y > least ? source.y : source.x;
    return light * e + source.y * (1.0 - mean) + source.x * (mean - e);
}

void main()
{
    int line = int(gl_GlobalInvocationID.x), n = int(gl_GlobalInvocationID.y);
    int all = int(args.dims.x * args.dims.y * args.dims.z);
    if (n >= int(args.count)) {
        return;
    }
    shdom_lines lines = shdom_lines_of(texelFetch(directions_texels, int(args.first) + n).xyz, ivec3(args.dims), args.dx);
    int across = lines.size.y * lines.size.z;
    if (line >= across) {
        return;
    }
    vec2 start = vec2(line % lines.size.y, line / lines.size.y) + 0.5, size = vec2(lines.size.yz);
    vec2 turn = vec2(0.0), before = vec2(0.0);
    float light = 0.0;
    for (int slice = 0; slice < lines.size.x; slice++) {
        vec2 at = start + float(slice) * lines.slope, turns = floor(at / size);
        at -= turns * size;
        vec2 here = medium_at(lines, n * all, slice, at);
        float way = slice == 0 ? 0.5 : 1.0;
        bool enters = slice == 0 || any(notEqual(turns, turn));
        if (turns.x != turn.x) {
            way = min(way, share_within(at.x, size.x, lines.slope.x));
        }
        if (turns.y != turn.y) {
            way = min(way, share_within(at.y, size.y, lines.slope.y));
        }
        light = enters ? 0.0 : light;
        before = enters ? here : before;
        way *= lines.step;
        light = step_along(light, before, here, way);
        radiance[n * all + slice * across + line] = light;
        before = here;
        turn = turns;
    }
}
