// lattice_stencil.glsl -- the equation of one cell of the diffusion grid. No bindings.
//
// -div D grad e + sigma_a e = r, D de/dn = -e/2 at the box, integrated over cells: the sum over the
// six faces of conductance (e - e behind the face), plus absorption e, is the right hand side in W.
// Outside the box e is 0, and the half cell and the Robin condition in series are the conductance
// to there.

struct lattice_stencil {
    vec3 lo, hi;      // conductances to -x, -y, -z and to +x, +y, +z
    float absorption; // sigma_a volume
    float diagonal;   // sum of all
};

lattice_stencil lattice_stencil_of(vec4 lo, vec4 hi)
{
    return lattice_stencil(lo.xyz, hi.xyz, abs(lo.w), abs(hi.w));
}

// Walls may part the eight cells that a coarse one is made of. It stands for those of the largest part
// only; the others, whose sum of conductances is stored with a minus, give it nothing and get nothing from it.
bool lattice_orphan(vec4 hi)
{
    return hi.w < 0.0;
}

// Corrections are not carried through walls: with one about, a cell takes that of the coarse cell around it alone. Its
// absorption, which is not 0 among walls, is stored with a minus.
bool lattice_alone(vec4 lo)
{
    return lo.w < 0.0;
}

// Is no wall in this cell's faces?
bool lattice_open(vec3 lo, vec3 hi)
{
    return all(greaterThan(lo, vec3(0.0))) && all(greaterThan(hi, vec3(0.0)));
}

vec4 lattice_stencil_lo(const lattice_stencil k)
{
    return vec4(k.lo, k.absorption);
}

vec4 lattice_stencil_hi(const lattice_stencil k)
{
    return vec4(k.hi, k.absorption + dot(k.lo + k.hi, vec3(1.0)));
}

// Trilinear interpolation of a correction from the next coarser level: along each axis the coarse
// cell around the fine one counts 3/4 and its neighbour on the near side 1/4; at the box the former
// 1. `repeat`: a bit for each axis along which the grid goes on beyond the box.
struct lattice_interpolation {
    ivec3 near, far;
};

lattice_interpolation lattice_interpolation_of(ivec3 fine, ivec3 coarse_size, uint repeat)
{
    ivec3 near = fine / 2, far = near + 2 * (fine % 2) - 1;
    for (int axis = 0; axis < 3; axis++) {
        bool beyond = far[axis] < 0 || far[axis] >= coarse_size[axis];
        bool wraps = (repeat >> axis & 1u) != 0u;
        far[axis] = !beyond ? far[axis] : !wraps ? near[axis] : far[axis] < 0 ? coarse_size[axis] - 1 : 0;
    }
    return lattice_interpolation(near, far);
}

ivec3 lattice_corner(const lattice_interpolation l, uint corner)
{
    return ivec3((corner & 1) == 0 ? l.near.x : l.far.x, (corner & 2) == 0 ? l.near.y : l.far.y,
                 (corner & 4) == 0 ? l.near.z : l.far.z);
}

float lattice_corner_weight(uint corner)
{
    return ((corner & 1) == 0 ? 0.75 : 0.25) * ((corner & 2) == 0 ? 0.75 : 0.25) *
           ((corner & 4) == 0 ? 0.75 : 0.25);
}
