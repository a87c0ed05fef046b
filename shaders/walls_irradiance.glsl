// walls_irradiance.glsl -- light of the lattice on a surface.
//
// Include after lattice_walls.glsl.
//
// Irradiance on a side n is phi / 4 - F.n / 2, the flux through a plane in radiance that is linear in direction,
// of the cells in front of the surface. Of those around a place a little off it, cells count by trilinear
// interpolation if their centres are in front of the surface's plane and no wall is between; what is left is
// blended. On rough surfaces the planes of some triangle, which go on beyond it, may be between the place and
// every centre. So cells behind walls count as well, a thousandth for every wall, if there is any light in them
// (within solids it is dark exactly); where there are others they do not matter. A place in the dark may be in
// another solid: then one closer to the surface is tried, and cells farther around.
#ifndef TYN_WALLS_IRRADIANCE_GLSL
#define TYN_WALLS_IRRADIANCE_GLSL

const float WALLS_BEHIND = 1e-3;   // what cells behind one wall count
const float WALLS_FEW = 0.02;      // the least share of a place's cells that tells that it is dark

struct walls_spot {
    vec3 p, n;         // on the surface, and its side (M)
    vec3 off;          // the place before it, in the cell `own`
    walls_place own;
    uint behind;       // walls_behind of the place
};

// What cell q counts by itself; negative if it is behind walls.
float walls_share(lattice_box box, walls_spot s, ivec3 q)
{
    vec3 centre = walls_centre(box, q);
    uint index = uint((q.z * box.dims.y + q.y) * box.dims.x + q.x);
    int between = bitCount(walls_behind(s.own.index, centre) ^ s.behind) + bitCount(walls_behind(index, s.off));
    ivec3 d = q - s.own.cell;
    bool next = all(lessThanEqual(abs(d), ivec3(1))); // else there may be walls that neither knows of
    if (s.behind == 0u && d != ivec3(0) && between == 0) {
        between = next ? int(s.own.links >> walls_link(d) & 1u) : 0;
    }
    float share = next ? smoothstep(0.0, 0.2, dot(centre - s.p, s.n) / box.dx) : 0.0;
    return between == 0 ? share : -share * pow(WALLS_BEHIND, float(between));
}

// Irradiance on the side n of a surface at p (M) of the first `channels` channels of `moments`, W/m^2.
vec3 walls_irradiance_at(sampler3D moments, lattice_box box, vec3 p, vec3 n, int channels)
{
    vec4 sum[3];
    float whole = 0.0;
    bool lit = false;
    for (int attempt = 0; attempt < 3 && !lit; attempt++) {
        float lift = attempt == 1 ? 0.15 : 0.5;
        int reach = attempt / 2, side = 2 + 2 * reach;
        walls_spot s;
        s.p = p;
        s.n = n;
        s.off = p + lift * box.dx * n;
        s.own = walls_place_of(box, s.off);
        s.behind = walls_behind(s.own.index, s.off);
        sum = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
        whole = 0.0;
        float seen = 0.0; // no wall between
        ivec3 base = ivec3(floor(s.own.x)) - reach;
        for (int i = 0; i < side * side * side; i++) {
            ivec3 q = base + ivec3(i % side, i / side % side, i / (side * side));
            vec3 t = max(1.0 - abs(vec3(q) - s.own.x) / float(1 + reach), vec3(0.0));
            q = clamp(q, ivec3(0), box.dims - 1);
            float share = t.x * t.y * t.z * walls_share(box, s, q);
            seen += max(share, 0.0);
            vec4 m[3];
            for (int ch = 0; ch < channels; ch++) {
                m[ch] = texelFetch(moments, q + ivec3(0, 0, ch * box.dims.z), 0);
            }
            bool dark = m[0].x <= 0.0 && (channels == 1 || m[1].x + m[2].x <= 0.0);
            lit = lit || share > 0.0 && !dark;
            share = share < 0.0 ? dark ? 0.0 : -share : dark ? 0.1 * share : share; // it may be within a solid
            for (int ch = 0; ch < channels; ch++) {
                sum[ch] += share * m[ch];
            }
            whole += share;
        }
        lit = lit || attempt == 2 && seen < WALLS_FEW && whole > 1e-12;
    }
    vec3 irradiance = vec3(0.0);
    for (int ch = 0; ch < channels && lit; ch++) {
        irradiance[ch] = max(0.25 * sum[ch].x - 0.5 * dot(sum[ch].yzw, n), 0.0) / whole;
    }
    return irradiance;
}

#endif
