// shdom_lines.glsl -- the lines along which light of an ordinate is followed through the lattice. No bindings.
//
// Slices of cells stand across the axis that is nearest to the direction. In the first slice that light enters there is a line
// through the middle of each cell. It meets the following slices where the direction takes it; where it leaves the box at a
// side it comes in again at the opposite one, as another line without light. So each slice has as many lines as cells, as far
// apart as those.

struct shdom_lines {
    ivec3 axes;  // along, and the two across
    ivec3 size;  // cells along each of these
    bool back;   // light comes from the last slice
    vec2 slope;  // across per slice, cells; at most 1
    float step;  // length of a line between slices, m
};

shdom_lines shdom_lines_of(vec3 d, ivec3 dims, float dx)
{
    vec3 a = abs(d);
    int w = a.x >= max(a.y, a.z) ? 0 : a.y >= a.z ? 1 : 2;
    shdom_lines lines;
    lines.axes = ivec3(w, (w + 1) % 3, (w + 2) % 3);
    lines.size = ivec3(dims[w], dims[lines.axes.y], dims[lines.axes.z]);
    lines.back = d[w] < 0.0;
    lines.slope = vec2(d[lines.axes.y], d[lines.axes.z]) / a[w];
    lines.step = dx / a[w];
    return lines;
}

// Of the cell (u, v) of a slice, counted as light meets them.
int shdom_cell(const shdom_lines lines, ivec3 dims, int slice, ivec2 at)
{
    ivec3 c;
    c[lines.axes.x] = lines.back ? lines.size.x - 1 - slice : slice;
    c[lines.axes.y] = at.x;
    c[lines.axes.z] = at.y;
    return (c.z * dims.y + c.y) * dims.x + c.x;
}
