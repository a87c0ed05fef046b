// merge_read.glsl -- which cells a picture reads. Include after merge.glsl, with the buffer field.
// Does the picture read this cell? It does so around every cell that scatters.

bool merge_is_read(ivec3 c, ivec3 dims, uint channels)
{
    ivec3 lo = max(c - 1, ivec3(0)), hi = min(c + 1, dims - 1);
    float most = 0.0;
    for (int z = lo.z; z <= hi.z; z++) {
        for (int y = lo.y; y <= hi.y; y++) {
            for (int x = lo.x; x <= hi.x; x++) {
                most = max(most, field[merge_index(ivec3(x, y, z), channels)]);
            }
        }
    }
    return most > 0.0;
}
