// rsm_sky_places.glsl -- places spread over the surfaces, most of them near the box that pictures are of.
//
// A ground of a kilometre has nearly all of the area that the sky shines on, and what lights the box is the part within a few
// times its size: the density of places falls with the distance d from a box of longest side L as 1 / (1 + (d / L)^2). Within a
// triangle places follow a curve (vpl_elements.glsl: Sierpinski's) that halves it again and again, and of two halves each gets
// its share by where its middle is ("hierarchical sample warping", Clarberg et al. 2005).
#include "shaders/light/near_box.glsl"

const int RSM_SKY_HALVINGS = 20;

// Of a point (M); 1 in the box.
float rsm_sky_near(vec3 p)
{
    float away = near_box_away(p, args.near_lo, args.near_hi);
    return 1.0 / (1.0 + away * away);
}

// A triangle whose longest side goes from `from` to `to`.
struct rsm_sky_piece {
    vec3 apex, from, to;
};

rsm_sky_piece rsm_sky_whole(vec3 a, vec3 b, vec3 c)
{
    vec3 l = vec3(dot(c - b, c - b), dot(a - c, a - c), dot(b - a, b - a));
    bool at_a = l.x >= l.y && l.x >= l.z, at_b = l.y >= l.z;
    return rsm_sky_piece(at_a ? a : at_b ? b : c, at_a ? b : at_b ? c : a, at_a ? c : at_b ? a : b);
}

rsm_sky_piece rsm_sky_half(const rsm_sky_piece t, bool second)
{
    return rsm_sky_piece(0.5 * (t.from + t.to), second ? t.apex : t.from, second ? t.to : t.apex);
}

vec3 rsm_sky_middle(const rsm_sky_piece t)
{
    return (t.apex + t.from + t.to) * (1.0 / 3.0);
}

// Is all of a piece about as near as its middle?
bool rsm_sky_even(const rsm_sky_piece t)
{
    float size = near_box_size(args.near_lo, args.near_hi);
    float away = near_box_away(rsm_sky_middle(t), args.near_lo, args.near_hi);
    return size <= 0.0 || distance(t.from, t.to) < 0.5 * size * (1.0 + away);
}

// What a triangle counts for, m^2: the integral of nearness, halving what is nearest.
float rsm_sky_count(vec3 a, vec3 b, vec3 c)
{
    rsm_sky_piece t = rsm_sky_whole(a, b, c);
    float area = 0.5 * length(cross(b - a, c - a)), sum = 0.0;
    for (int i = 0; i < RSM_SKY_HALVINGS && !rsm_sky_even(t); i++) {
        rsm_sky_piece one = rsm_sky_half(t, false), two = rsm_sky_half(t, true);
        float near_one = rsm_sky_near(rsm_sky_middle(one)), near_two = rsm_sky_near(rsm_sky_middle(two));
        bool second = near_two > near_one;
        area *= 0.5;
        sum += area * (second ? near_one : near_two);
        t = rsm_sky_piece(second ? two.apex : one.apex, second ? two.from : one.from, second ? two.to : one.to);
    }
    return sum + area * rsm_sky_near(rsm_sky_middle(t));
}

// The place at parameter u in [0, 1) of the curve; `density`: of places, over their mean on the triangle.
vec3 rsm_sky_place(vec3 a, vec3 b, vec3 c, float u, out float density)
{
    rsm_sky_piece t = rsm_sky_whole(a, b, c);
    density = 1.0;
    for (int i = 0; i < RSM_SKY_HALVINGS; i++) {
        float near_one = rsm_sky_near(rsm_sky_middle(rsm_sky_half(t, false)));
        float share = near_one / (near_one + rsm_sky_near(rsm_sky_middle(rsm_sky_half(t, true))));
        bool second = u >= share;
        float own = second ? 1.0 - share : share;
        u = clamp((second ? u - share : u) / max(own, 1e-6), 0.0, 0.999999);
        density *= 2.0 * own;
        t = rsm_sky_half(t, second);
    }
    return rsm_sky_middle(t);
}
