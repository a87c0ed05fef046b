// columns_march.glsl -- a column of an ordinate's grid: the medium integrated from slice to slice.
//
// The includer defines COLUMNS_VALUE (float or mat3), columns_value(vec3 uvw) = the medium at a texture
// coordinate, clamped to the edge, and columns_store(uint node, COLUMNS_VALUE).
#ifndef TYN_COLUMNS_MARCH_GLSL
#define TYN_COLUMNS_MARCH_GLSL

// Trilinear samples of a segment: one for two voxels, half way between them.
int columns_samples(columns_grid grid, vec3 per_slice)
{
    vec3 voxels = abs(per_slice) * vec3(medium.size);
    return int(clamp(ceil(0.5 * max(voxels.x, max(voxels.y, voxels.z)) - 0.01), 1.0, 64.0));
}

// Beside the box the medium is that of its faces; see columns_gather.glsl.
void columns_march(columns_grid grid, ivec2 column, uint base)
{
    vec3 span = vec3(grid.size) - 2.0 * grid.low; // of the medium's box, cells
    vec3 per_cell;                                // texture coordinate, along u, v, w
    vec3 per_slice;
    per_cell[grid.u] = 1.0 / span.x;
    per_cell[grid.v] = 1.0 / span.y;
    per_cell[grid.w] = 1.0 / span.z;
    per_slice[grid.u] = grid.shear.x;
    per_slice[grid.v] = grid.shear.y;
    per_slice[grid.w] = 1.0;
    vec3 start;
    start[grid.u] = -grid.low.x;
    start[grid.v] = -grid.low.y;
    start[grid.w] = 0.5 - grid.low.z;
    per_slice *= per_cell;
    int samples = columns_samples(grid, per_slice);
    vec3 sign3 = mix(vec3(1.0), vec3(-1.0), grid.reverse);
    vec3 corner = mix(vec3(0.0), vec3(1.0), grid.reverse);

    COLUMNS_VALUE sum = COLUMNS_VALUE(0.0);
    ivec2 place = column, shift = ivec2(0);
    float from = grid.front; // the first segment begins at the front face
    for (int slice = 0; slice < grid.size.z; slice++) {
        vec2 offset = grid.shear * float(slice);
        ivec2 moved = ivec2(floor(offset)) - shift; // 0 or 1
        shift += moved;
        place += moved;
        bvec2 wraps = greaterThanEqual(place, grid.count);
        place = mix(place, place - grid.count, wraps);
        vec2 at = vec2(place) - 1.5 + fract(offset);
        vec3 uvw = start;
        uvw[grid.u] += at.x;
        uvw[grid.v] += at.y;
        uvw[grid.w] += float(slice);
        uvw *= per_cell;
        float length_s = float(slice) - from; // of the segment, slices
        COLUMNS_VALUE part = COLUMNS_VALUE(0.0);
        for (int i = 0; i < samples; i++) {
            float back = length_s * (1.0 - (float(i) + 0.5) / float(samples));
            part += columns_value(corner + sign3 * (uvw - back * per_slice));
        }
        // What lies before a column's first segment is left out: depths are differences along it.
        sum = (any(wraps) ? COLUMNS_VALUE(0.0) : sum) + part * (length_s / float(samples));
        columns_store(base + columns_node(grid, slice, column), sum * grid.spacing);
        from = float(slice);
    }
}

#endif
