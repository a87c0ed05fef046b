// columns_march.glsl -- a column of an ordinate's grid: the medium integrated from slice to slice, since
// the column entered the medium's box.
//
// The includer defines COLUMNS_VALUE (float or mat3), columns_value(vec3 uvw) = the medium at a texture
// coordinate, clamped to the edge, and columns_store(uint node, COLUMNS_VALUE).
#ifndef TYN_COLUMNS_MARCH_GLSL
#define TYN_COLUMNS_MARCH_GLSL

void columns_march(columns_grid grid, ivec2 column, uint base)
{
    int samples = columns_samples(grid);
    vec2 origin = vec2(column) - 0.5; // place in slice 0
    ivec2 last = grid.count - 1 - column; // shift beyond which the column goes on at the near side
    uint node = base + uint(column.y * grid.count.x + column.x);
    uint layer = uint(grid.count.x * grid.count.y);
    vec3 uvw = columns_uvw(grid, origin, 0.0);
    float longest = -grid.front; // segment, slices; the first begins at the front face

    COLUMNS_VALUE sum = COLUMNS_VALUE(0.0);
    for (int slice = 0; slice < grid.size.z; slice++) {
        vec2 offset = grid.shear * float(slice);
        bvec2 around = greaterThan(ivec2(offset), last);
        if (any(around)) {
            vec2 moved = mix(vec2(0.0), vec2(grid.count), around);
            last += ivec2(moved);
            origin -= moved;
            uvw -= moved.x * grid.step_u + moved.y * grid.step_v;
            sum = COLUMNS_VALUE(0.0);
        }
        vec2 crossed = (origin + offset - grid.low) * grid.per_cell;
        float part = clamp(min(crossed.x, crossed.y), 0.0, longest);
        COLUMNS_VALUE mean = COLUMNS_VALUE(0.0);
        for (int i = 0; i < samples; i++) {
            float back = part * (1.0 - (float(i) + 0.5) / float(samples));
            mean += columns_value(uvw - back * grid.per_slice);
        }
        sum += mean * (part / float(samples));
        columns_store(node, sum * grid.spacing);
        node += layer;
        uvw += grid.per_slice;
        longest = 1.0;
    }
}

#endif
