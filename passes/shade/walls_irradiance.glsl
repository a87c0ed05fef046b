// walls_irradiance.glsl -- light of the lattice on a surface.
//
// Include after lattice_walls.glsl, with LATTICE_ROOMS, and define WALLS_OTHERS: at most so many other fields are asked
// for.
//
// Irradiance on a side n is phi / 4 - F.n / 2, the flux through a plane in radiance that is linear in direction,
// of the cells in front of the surface. Of those around a place a little off it, cells count by trilinear
// interpolation if their centres are in front of the surface's plane and no wall is between; what is left is
// blended. On rough surfaces the planes of some triangle, which go on beyond it, may be between the place and
// every centre. So cells behind walls count as well, a thousandth for every wall, if there is any light in them
// (within solids it is dark exactly); where there are others they do not matter. A place in the dark may be in
// another solid: then one closer to the surface is tried, and cells farther around. Where it is known which room
// (rooms.h) the surface is in, cells of other rooms do not count.
// Measured: docs/measurements.md, "Constants".

const float WALLS_BEHIND = 1e-3;   // what cells behind one wall count
const float WALLS_FEW = 0.02;      // the least share of a place's cells that tells that it is dark
const float WALLS_RISE = 0.2;      // cell edges in front of the surface's plane over which a cell comes to count

struct walls_spot {
    vec3 p, n;     // on the surface, and its side (M)
    vec3 off;      // the place before it
    vec3 x;        // the same in cell edges; centres are at whole numbers
    ivec3 cell;    // that the place is in
    walls_planes planes; // of this cell
    uint links;
    uint behind;   // bit k: the place is behind plane k as seen from the cell's centre
};

walls_spot walls_spot_of(const lattice_box box, vec3 p, vec3 n, float lift)
{
    walls_spot s;
    s.p = p;
    s.n = n;
    s.off = p + lift * box.dx * n;
    s.x = lattice_from_m(box, s.off) - 0.5;
    s.cell = clamp(ivec3(floor(s.x + 0.5)), ivec3(0), box.dims - 1);
    uint index = lattice_index(box, s.cell);
    s.planes = walls_planes_of(index);
    s.links = walls_links_of(index);
    s.behind = walls_behind(s.planes, s.off);
    return s;
}

// What cell q counts by itself; negative if it is behind walls.
float walls_share(const lattice_box box, const walls_spot s, ivec3 q)
{
    vec3 centre = walls_centre(box, q);
    int between = bitCount(walls_behind(s.planes, centre) ^ s.behind) +
                  bitCount(walls_behind(walls_planes_of(lattice_index(box, q)), s.off));
    ivec3 d = q - s.cell;
    bool next = all(lessThanEqual(abs(d), ivec3(1))); // else there may be walls that neither knows of
    uint link = walls_link(next && d != ivec3(0) ? d : ivec3(1, 0, 0));
    bool cut = s.behind == 0u && d != ivec3(0) && (s.links >> link & 1u) != 0u;
    between = max(between, int(cut));
    float share = next ? smoothstep(0.0, WALLS_RISE, dot(centre - s.p, s.n) / box.dx) : 0.0;
    return between == 0 ? share : -share * pow(WALLS_BEHIND, float(between));
}

// Irradiance on the side n of a surface at p (M) of the first `channels` channels of `moments`, W/m^2: below 0 where more
// light goes away from the surface than four moments can tell. `others`: the
// same cells' mean of `num_others` fields that are behind each other along z; 0 where no cell has light. `room` of the
// surface, or TYN_ROOMS_ANY.
vec3 walls_irradiance_at(sampler3D moments, const lattice_box box, vec3 p, vec3 n, int channels, sampler3D fields,
                         uint num_others, uint room, out vec4 others[WALLS_OTHERS])
{
    vec3 irradiance = vec3(0.0);
    bool lit = false;
    for (int attempt = 0; attempt < 3 && !lit; attempt++) {
        walls_spot s = walls_spot_of(box, p, n, attempt == 1 ? 0.15 : 0.5);
        int reach = attempt / 2, side = 2 + 2 * reach;
        ivec3 base = ivec3(floor(s.x)) - reach;
        vec3 sum = vec3(0.0);
        [[unroll]] for (uint k = 0u; k < num_others; k++) {
            others[k] = vec4(0.0);
        }
        float whole = 0.0, seen = 0.0; // of all; without walls between
        ivec3 d = ivec3(0); // counts; divisions are slow on a CPU device
        for (int i = side * side * side; i > 0; i--) {
            ivec3 q = base + d;
            d.x++;
            d.y += d.x == side ? 1 : 0;
            d.x = d.x == side ? 0 : d.x;
            d.z += d.y == side ? 1 : 0;
            d.y = d.y == side ? 0 : d.y;
            vec3 t = max(1.0 - abs(vec3(q) - s.x) / float(1 + reach), vec3(0.0));
            q = clamp(q, ivec3(0), box.dims - 1);
            float share = t.x * t.y * t.z * walls_share(box, s, q);
            seen += max(share, 0.0);
            vec3 light = vec3(0.0);
            float fluence = 0.0;
            for (int ch = 0; ch < channels; ch++) {
                vec4 m = texelFetch(moments, q + ivec3(0, 0, ch * box.dims.z), 0);
                light[ch] = 0.25 * m.x - 0.5 * dot(m.yzw, n);
                fluence += max(m.x, 0.0);
            }
            bool other = !walls_in_room(box, q, room), dark = other || fluence <= 0.0;
            lit = lit || share > 0.0 && !dark;
            share = share < 0.0 ? dark ? 0.0 : -share : share;
            share = other ? 0.0 : share;
            sum += dark ? vec3(0.0) : share * light;
            [[unroll]] for (uint k = 0u; k < num_others; k++) {
                others[k] += share * texelFetch(fields, q + ivec3(0, 0, int(k) * box.dims.z), 0);
            }
            whole += share;
        }
        lit = lit || attempt == 2 && seen < WALLS_FEW && whole > 1e-12;
        float scale = lit ? 1.0 / whole : 0.0;
        irradiance = scale * sum;
        [[unroll]] for (uint k = 0u; k < num_others; k++) {
            others[k] *= scale;
        }
    }
    return irradiance;
}
