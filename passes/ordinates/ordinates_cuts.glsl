// ordinates_cuts.glsl -- where to cut a region of the sky so that the parts share its light as wanted.
//
// Include after the declarations of `sums` and `weights`.
#include "ordinates_region.glsl"

// What a cut shares out: light from a table, and `uniform_part` per sr.
#define ORDINATES_NO_TABLE 0u
#define ORDINATES_SUMS 1u    // luminance
#define ORDINATES_WEIGHTS 2u // luminance x importance
struct ordinates_density {
    uint table;
    float uniform_part;
};

float ordinates_scalar(uint entry, uint table)
{
    if (table == ORDINATES_NO_TABLE) {
        return 0.0;
    }
    return table == ORDINATES_WEIGHTS ? weights[entry] : sums[entry].luminance;
}

// Light between the map's first corner and p.
float ordinates_corner(vec2 p, uint table)
{
    vec2 f;
    uint e = ordinates_entry(p, f);
    return mix(mix(ordinates_scalar(e, table), ordinates_scalar(e + 1u, table), f.x),
               mix(ordinates_scalar(e + ORDINATES_ROW, table),
                   ordinates_scalar(e + ORDINATES_ROW + 1u, table), f.x),
               f.y);
}

float ordinates_light(const ordinates_region r, uint table)
{
    return ordinates_corner(r.to, table) - ordinates_corner(vec2(r.from.x, r.to.y), table) -
           ordinates_corner(vec2(r.to.x, r.from.y), table) + ordinates_corner(r.from, table);
}

float ordinates_mass(const ordinates_region r, const ordinates_density density)
{
    return ordinates_light(r, density.table) + density.uniform_part * ordinates_solid_angle(r);
}

// Where `part` of the mass lies to the left of (axis 0) or above (axis 1) the cut.
float ordinates_cut(const ordinates_region r, uint axis, float part, const ordinates_density density)
{
    float target = part * ordinates_mass(r, density);
    // The bracket shrinks to a piece of one texel, in which mass grows linearly.
    vec2 at = vec2(r.from[axis], r.to[axis]), mass = vec2(0.0, target / part);
    for (int i = 0; i < 8; i++) {
        float middle = max(floor(0.5 * (at.x + at.y)), floor(at.x) + 1.0);
        bool between = middle < at.y;
        ordinates_region piece = r;
        piece.to[axis] = between ? middle : at.y;
        float m = ordinates_mass(piece, density);
        bool left = m < target;
        at = !between ? at : left ? vec2(middle, at.y) : vec2(at.x, middle);
        mass = !between ? mass : left ? vec2(m, mass.y) : vec2(mass.x, m);
    }
    float rise = mass.y - mass.x;
    return mix(at.x, at.y, rise > 0.0 ? clamp((target - mass.x) / rise, 0.0, 1.0) : 0.5);
}

void ordinates_divide(const ordinates_region r, uint axis, float cut, out ordinates_region lower,
                      out ordinates_region upper)
{
    lower = r;
    upper = r;
    lower.to[axis] = cut;
    upper.from[axis] = cut;
}

// The axis whose cut leaves the more compact pieces: 0 across, 1 down. `cut` is where.
uint ordinates_axis(const ordinates_region r, float part, const ordinates_density density, out float cut)
{
    vec2 cuts, width;
    for (uint axis = 0u; axis < 2u; axis++) {
        ordinates_region lower, upper;
        cuts[axis] = ordinates_cut(r, axis, part, density);
        ordinates_divide(r, axis, cuts[axis], lower, upper);
        width[axis] = ordinates_width(lower) + ordinates_width(upper);
    }
    // Even maps must not depend on rounding: of the cuts of an even sky the widths' ratio is 1, or 0.99893 and less.
    uint axis = width.y < 0.9995 * width.x ? 1u : 0u;
    cut = cuts[axis];
    return axis;
}
