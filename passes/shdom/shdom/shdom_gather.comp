// shdom_gather.comp -- radiance at the middle of cells, between the four lines next to it. y: ordinates of the batch.
#include "shdom_args.h"
#include "shdom_lines.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 0) uniform samplerBuffer directions_texels;
layout(binding = 1) uniform samplerBuffer lines_words; // [ordinate of the batch][slice][line]
TYN_WRITE(2, emitted, float emitted[]);                // [ordinate of the batch][cell]

// Lines on both sides of a cell's middle, and what each counts.
struct beside {
    ivec2 line;
    vec2 weight;
};

// `shift`: of the slice's lines. What is beyond a side of the box is another line: the cell has what its own line has, as
// much less as its way from a side that light enters by is shorter.
beside beside_of(int cell, int size, float shift, float slope, float way)
{
    float whole = floor(shift), t = shift - whole, at = float(cell);
    int from = cell - int(whole);
    ivec2 line = ivec2(from - 1, from);
    beside b;
    b.line = line - size * ivec2(floor((vec2(line) + 0.5) / float(size)));
    bool low = at - 0.5 + t > 1e-3, high = at + 0.5 + t < float(size) - 1e-3;
    b.weight = low && high ? vec2(t, 1.0 - t) : low ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    if (!low && slope > 0.0) {
        b.weight.y = min(0.5 / slope, way) / min((0.5 + t) / slope, way);
    } else if (!high && slope < 0.0) {
        b.weight.x = min(0.5 / -slope, way) / min((1.5 - t) / -slope, way);
    }
    return b;
}

void main()
{
    uint i = gl_GlobalInvocationID.x, n = gl_GlobalInvocationID.y;
    int all = int(args.dims.x * args.dims.y * args.dims.z);
    if (int(i) >= all || n >= args.count) {
        return;
    }
    shdom_lines lines = shdom_lines_of(texelFetch(directions_texels, int(args.first + n)).xyz, ivec3(args.dims), args.dx);
    ivec3 c = ivec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / (args.dims.x * args.dims.y));
    int slice = lines.back ? lines.size.x - 1 - c[lines.axes.x] : c[lines.axes.x];
    float way = float(slice) + 0.5; // at most, steps
    vec2 shift = float(slice) * lines.slope;
    beside u = beside_of(c[lines.axes.y], lines.size.y, shift.x, lines.slope.x, way);
    beside v = beside_of(c[lines.axes.z], lines.size.z, shift.y, lines.slope.y, way);
    int first = int(n) * all + slice * lines.size.y * lines.size.z;
    float sum = 0.0;
    [[unroll]] for (int k = 0; k < 4; k++) {
        int line = v.line[k / 2] * lines.size.y + u.line[k % 2];
        sum += u.weight[k % 2] * v.weight[k / 2] * texelFetch(lines_words, first + line).x;
    }
    emitted[n * uint(all) + i] = sum;
}
