// lattice_inflow.glsl -- what flows into a cell of the diffusion grid from its neighbours, and how it is carried over
// from coarser levels, also through the sides of the box where the medium repeats.
//
// Before including: correction_at(uint index), lattice_stencil.glsl, lattice_levels.glsl, and LATTICE_REPEAT, the
// number of a specialisation constant: a bit for each axis along which the grid goes on beyond the box.

layout(constant_id = LATTICE_REPEAT) const uint lattice_repeat = 0;

bool lattice_repeats(int axis)
{
    return (lattice_repeat >> axis & 1u) != 0u;
}

// Correction of the cell before (way -1) or after (1) cell i, which is number `at` of `size` along an axis; cells along
// it are `step` apart.
float lattice_beside(uint i, int at, int size, int step, int way, int axis)
{
    bool border = at == (way < 0 ? 0 : size - 1);
    if (lattice_repeats(axis)) {
        return correction_at(uint(int(i) + way * (border ? step - size * step : step)));
    }
    return border ? 0.0 : correction_at(uint(int(i) + way * step));
}

// `sum` and what flows in; i: index of cell c of a level, k its equation.
float lattice_inflow(float sum, const lattice_level level, ivec3 c, uint i, const lattice_stencil k)
{
    int step_y = level.size.x, step_z = level.size.x * level.size.y;
    sum += k.lo.x * lattice_beside(i, c.x, level.size.x, 1, -1, 0);
    sum += k.hi.x * lattice_beside(i, c.x, level.size.x, 1, 1, 0);
    sum += k.lo.y * lattice_beside(i, c.y, level.size.y, step_y, -1, 1);
    sum += k.hi.y * lattice_beside(i, c.y, level.size.y, step_y, 1, 1);
    sum += k.lo.z * lattice_beside(i, c.z, level.size.z, step_z, -1, 2);
    sum += k.hi.z * lattice_beside(i, c.z, level.size.z, step_z, 1, 2);
    return sum;
}
