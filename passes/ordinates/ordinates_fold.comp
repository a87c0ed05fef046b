// ordinates_fold.comp -- the list of ordinates: those with next to no light are folded into others.
//
// One workgroup. The light of a folded ordinate goes to the nearest one that is kept, whose direction
// and size become the means, weighted with light.
#include "shaders/common/scene_args.h"
#include "shaders/light/ordinate_args.h"
#include "ordinates_args.h"
#include "shaders/light/sky.glsl"

layout(local_size_x = TYN_ORDINATES_MAX) in;
TYN_ARGS(ordinates_args args);
TYN_UNIFORM(0, environment, env_block environment);
TYN_READ(1, pieces, ordinates_piece pieces[]);
TYN_WRITE(2, ordinates, uint count; uint folded; uint num_fixed; uint pad; ordinate list[]);

shared float sizes[TYN_ORDINATES_MAX]; // of their light
shared vec3 directions[TYN_ORDINATES_MAX];
shared uint heirs[TYN_ORDINATES_MAX]; // who takes the light of a folded one
shared uint ranks[TYN_ORDINATES_MAX]; // among those that are kept
shared uint folded_ones[TYN_ORDINATES_MAX];
shared uint num_folded;
shared float least; // size of light that is kept

// The direction of a moment; where there is none, any.
vec3 middle_of(vec3 moment)
{
    float size = length(moment);
    return size > 0.0 ? moment / size : vec3(0.0, 1.0, 0.0);
}

// One thread does what is sequential.
void sort_out_folded()
{
    float sum = 0.0;
    for (uint n = 0u; n < args.regions; n++) {
        sum += sizes[n];
    }
    least = args.fold < 0.0 ? -1.0 : args.fold * sum;
    uint kept = 0u, gone = 0u;
    for (uint n = 0u; n < args.regions; n++) {
        bool keep = sizes[n] > least;
        ranks[n] = kept;
        folded_ones[gone] = n;
        kept += keep ? 1u : 0u;
        gone += keep ? 0u : 1u;
    }
    num_folded = gone;
    count = args.num_fixed + kept;
    folded = gone;
    num_fixed = args.num_fixed;
}

uint nearest_kept(vec3 d)
{
    float nearest = -2.0;
    uint found = 0u;
    for (uint i = 0u; i < args.regions; i++) {
        float cosine = dot(d, directions[i]);
        bool nearer = sizes[i] > least && cosine > nearest;
        nearest = nearer ? cosine : nearest;
        found = nearer ? i : found;
    }
    return found;
}

void write(uint n)
{
    const ordinates_piece own = pieces[n];
    // Directions count by light: one of a region whose light and dark cancel must not turn its heir. Of an even sky, of which
    // split regions have none, each has its own.
    float weight = own.size > 0.0 ? own.size : 1.0;
    vec3 light = own.light, moment = weight * directions[n];
    vec2 size = weight * vec2(own.solid_angle, 1.0);
    vec4 even = vec4(own.solid_angle, own.outwards);
    for (uint k = 0u; k < num_folded; k++) {
        const ordinates_piece other = pieces[folded_ones[k]];
        const float mine = heirs[k] == n ? 1.0 : 0.0;
        light += mine * other.light;
        moment += mine * other.size * directions[folded_ones[k]];
        size += mine * other.size * vec2(other.solid_angle, 1.0);
        even += mine * vec4(other.solid_angle, other.outwards);
    }
    const mat3 to_m =
        mat3(environment.rows[0].xyz, environment.rows[1].xyz, environment.rows[2].xyz);
    ordinate o;
    o.irradiance = light;
    o.direction = to_m * -middle_of(moment);
    o.solid_angle = size.x / size.y;
    o.even = even.x;
    o.even_flux = to_m * -even.yzw;
    o.mean_cosine = clamp(1.0 - o.solid_angle / (4.0 * SKY_PI), 0.0, 1.0);
    list[args.num_fixed + ranks[n]] = o;
}

void main()
{
    const uint me = gl_LocalInvocationIndex;
    if (me < args.regions) {
        sizes[me] = pieces[me].size;
        directions[me] = middle_of(pieces[me].moment);
    }
    barrier();
    if (me == 0u) {
        sort_out_folded();
    }
    barrier();
    for (uint k = me; k < num_folded; k += TYN_ORDINATES_MAX) {
        heirs[k] = nearest_kept(directions[folded_ones[k]]);
    }
    barrier();
    if (me < args.regions && sizes[me] > least) {
        write(me);
    }
}
