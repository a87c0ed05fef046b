// shdom_basis.comp -- spherical harmonics in the directions of the quadrature and of the principal ordinates; a thread each.
#include "shdom_args.h"
#include "shaders/light/ordinate_args.h"
#include "../common/delta_bands.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
TYN_READ(0, directions, vec4 directions[]); // xyz; w = weight, sr
TYN_UNIFORM(1, ordinates, ordinates_block ordinates);
TYN_WRITE(2, basis, float basis[]);       // [coefficient][ordinate of the quadrature]
TYN_WRITE(3, weighted, float weighted[]); // [ordinate of the quadrature][coefficient], times the weight
TYN_WRITE(4, sky, float sky[]);           // [principal ordinate][coefficient], averaged over its cone
uint at;
bool of_sky;
float weight;

void visit(int l, int k, float y)
{
    if (of_sky) {
        sky[at * args.coefficients + uint(k)] = y * bands_cone(weight, l);
    } else {
        basis[uint(k) * args.ordinates + at] = y;
        weighted[at * args.coefficients + uint(k)] = y * weight;
    }
}
#define HARMONICS_VISIT visit
#include "../common/harmonics.glsl"

void main()
{
    at = gl_GlobalInvocationID.x;
    of_sky = at >= args.num_ordinates;
    vec3 direction;
    if (of_sky) {
        at -= args.num_ordinates;
        if (at >= min(ordinates.count, args.sky)) {
            return;
        }
        direction = ordinates.list[at].direction;
        weight = ordinates.list[at].mean_cosine;
    } else {
        direction = directions[at].xyz;
        weight = directions[at].w;
    }
    harmonics_visit(direction, int(args.bands));
}
