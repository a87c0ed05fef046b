// lattice_tile.glsl -- corrections of colour 1 of a block of cells and of the cells beside it, in shared memory: cells of colour 0
// need no others. A workgroup does two half steps at once so, without another's.
//
// Before including: lattice_inflow.glsl, quotient.glsl, the push constants args and TILE_GROUP, the threads of a workgroup.

const int TILE = LATTICE_TILE, WIDE = TILE + 2;
shared float tile[WIDE * WIDE * WIDE]; // from the cell before the block on, along each axis

layout(local_size_x = TILE_GROUP) in; // workgroups: blocks; channels stacked along z

struct lattice_block {
    ivec3 begin;  // its first cell
    uint channel; // first cell of the channel in the buffers
};

// ch: of the workgroup.
lattice_block lattice_block_of(const lattice_level level)
{
    int deep = (level.size.z + TILE - 1) / TILE, ch = int(gl_WorkGroupID.z) / deep;
    return lattice_block(TILE * (ivec3(gl_WorkGroupID) - ivec3(0, 0, ch * deep)), uint(ch) * args.stride);
}

// Where the cell c of a block or beside it is in the tile.
int tile_index(const lattice_block block, ivec3 c)
{
    ivec3 t = c - block.begin + 1;
    return (t.z * WIDE + t.y) * WIDE + t.x;
}

// The including kernel's: correction of cell c of colour 1, whose index is i. own: it is in the block.
float tile_correction(const lattice_level level, ivec3 c, uint i, bool own);

void fill_tile(const lattice_level level, const lattice_block block)
{
    for (uint n = gl_LocalInvocationIndex; n < WIDE * WIDE * WIDE / 2; n += TILE_GROUP) {
        ivec3 t = quotient_place(n, ivec3(WIDE / 2, WIDE, WIDE));
        t.x = 2 * t.x + (t.y + t.z & 1);
        ivec3 outside = ivec3(equal(t, ivec3(0))) + ivec3(equal(t, ivec3(WIDE - 1)));
        ivec3 c = block.begin + t - 1;
        bool own = outside == ivec3(0) && all(lessThan(c, level.size));
        int at = tile_index(block, c);
        for (int axis = 0; axis < 3; axis++) {
            if (lattice_repeats(axis)) {
                c[axis] = c[axis] < 0 ? level.size[axis] - 1 : c[axis] == level.size[axis] ? 0 : c[axis];
            }
        }
        bool there = outside.x + outside.y + outside.z < 2 && all(greaterThanEqual(c, ivec3(0))) && all(lessThan(c, level.size));
        tile[at] = there ? tile_correction(level, c, block.channel + lattice_index(level, c), own) : 0.0;
    }
    barrier();
}

// lattice_inflow by the tile.
float tile_inflow(float sum, int at, const lattice_stencil k)
{
    sum += k.lo.x * tile[at - 1];
    sum += k.hi.x * tile[at + 1];
    sum += k.lo.y * tile[at - WIDE];
    sum += k.hi.y * tile[at + WIDE];
    sum += k.lo.z * tile[at - WIDE * WIDE];
    sum += k.hi.z * tile[at + WIDE * WIDE];
    return sum;
}
