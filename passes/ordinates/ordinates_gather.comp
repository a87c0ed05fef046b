// ordinates_gather.comp -- the ordinate of each region, under a radiance of 1; a thread per region.
#include "shaders/common/uniform_branch.glsl"
#include "shaders/light/ordinate_args.h"
#include "ordinates_args.h"
#include "ordinates_region.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(ordinates_args args);
TYN_READ(0, sums, sky_sum sums[]);
TYN_READ(1, regions, vec4 regions[]); // from, to
TYN_WRITE(2, ordinates, uint count; uint num_fixed; uvec2 pad; ordinate list[]);

// All of it: xyz power, w luminance; and the moment.
void add_corner(vec2 p, float sign, inout vec4 power, inout vec3 moment)
{
    vec2 f;
    uint e = ordinates_entry(p, f);
    vec4 share = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    for (uint k = 0u; k < 4u; k++) {
        sky_sum s = sums[e + (k & 1u) + (k >> 1) * ORDINATES_ROW];
        power += sign * share[k] * vec4(s.power, s.luminance);
        moment += sign * share[k] * s.moment;
    }
}

// Where the light that an ordinate carries comes from; all in means of the sky. `outwards`: the integral
// of the direction.
//
// All light: the luminance and its moment, and a trace of even light, so that in the black the
// region's middle counts. Split: the light less the mean, whose moment is exact as long as it has
// nearly one sign (r near 1 or -1). Where lighter and darker parts cancel, that moment may point anywhere, and
// the sum of light and mean decides.
vec3 direction_of_light(float luminance, vec3 moment, float solid_angle, vec3 outwards)
{
    if (args.split == 0u) {
        return moment + 1e-3 * outwards;
    }
    float r = (luminance - solid_angle) / (luminance + solid_angle);
    return r * (moment - outwards) + (1.0 - r * r) * (moment + outwards);
}

// The direction of a moment; where there is none, any.
vec3 middle_of(vec3 moment)
{
    float size = length(moment);
    return size > 0.0 ? moment / size : vec3(0.0, 1.0, 0.0);
}

void main()
{
    const uint n = gl_GlobalInvocationID.x;
    if (n >= args.regions) {
        return;
    }
    const ordinates_region r = ordinates_region(regions[n].xy, regions[n].zw);
    const float solid_angle = ordinates_solid_angle(r);
    const vec3 outwards = ordinates_vector(r);
    vec4 power = vec4(0.0);
    vec3 moment = vec3(0.0);
    if (uniform_branch(args.mapped == 0u)) {
        power.rgb = vec3(solid_angle);
        moment = outwards;
    } else {
        add_corner(r.to, 1.0, power, moment);
        add_corner(vec2(r.from.x, r.to.y), -1.0, power, moment);
        add_corner(vec2(r.to.x, r.from.y), -1.0, power, moment);
        add_corner(r.from, 1.0, power, moment);
        float mean = sums[(SKY_SUMS_HEIGHT + 1) * ORDINATES_ROW - 1u].luminance / (4.0 * SKY_PI);
        moment = direction_of_light(power.w / max(mean, 1e-30), moment / max(mean, 1e-30),
                                    solid_angle, outwards);
    }
    const mat3 to_m = mat3(args.rows[0].xyz, args.rows[1].xyz, args.rows[2].xyz);
    ordinate o;
    o.irradiance = power.rgb;
    o.direction = to_m * -middle_of(moment);
    o.solid_angle = solid_angle;
    o.even = solid_angle;
    o.even_flux = to_m * -outwards;
    o.mean_cosine = clamp(1.0 - solid_angle / (4.0 * SKY_PI), 0.0, 1.0);
    list[args.num_fixed + n] = o;
}
