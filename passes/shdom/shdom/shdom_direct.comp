// shdom_direct.comp -- light of a batch of principal ordinates that arrives in the cells unscattered, W/m^2. y: ordinates.
#include "shdom_args.h"
#define MEDIUM_BLOCK 0
#define COLUMNS_AT 1
#include "shaders/medium/medium.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "../common/delta_bands.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 3) uniform sampler3D cells;
TYN_WRITE(4, emitted, float emitted[]); // [ordinate of the batch][cell]

void main()
{
    uint i = gl_GlobalInvocationID.x, n = gl_GlobalInvocationID.y, all = args.dims.x * args.dims.y * args.dims.z;
    if (i >= all || n >= args.count) {
        return;
    }
    uvec3 cell = uvec3(i % args.dims.x, i / args.dims.x % args.dims.y, i / (args.dims.x * args.dims.y));
    float light = 0.0;
    if (args.first + n < ordinates.count) {
        ivec3 texel = ivec3(cell.xy, cell.z + args.ch * args.dims.z);
        bands_medium m = bands_medium_of(texelFetch(cells, texel, 0), args.bands);
        light = lattice_channel(ordinates.list[args.first + n].irradiance, args.channels, args.ch, args.tint) *
                bands_transmittance(columns_tau(args.first + n, cell, args.dims), int(args.ch), m, args.bands, args.dx);
    }
    emitted[n * all + i] = light;
}
