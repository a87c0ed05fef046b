// shdom_lamps.comp -- adds the light of lamps that arrives in a cell unscattered, as spherical harmonics.
#include "shdom_args.h"
#define MEDIUM_BLOCK 0
#define RADIALS_AT 1
#define RADIALS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/lattice/lattice_sweep.glsl"
#include "../common/delta_bands.glsl"
#include "../common/bands_lamp.glsl"

layout(local_size_x = 64) in;
TYN_ARGS(shdom_args args);
layout(binding = 5) uniform sampler3D cells;
TYN_UPDATE(6, unscattered, float unscattered[]); // [coefficient][cell]

uint at, all;
bands_lamp lamp;
float light;

void visit(int l, int k, float y)
{
    unscattered[uint(k) * all + at] += light * y * bands_cone(lamp.mean_cosine, l);
}
#define HARMONICS_VISIT visit
#include "../common/harmonics.glsl"

void main()
{
    at = gl_GlobalInvocationID.x;
    all = args.dims.x * args.dims.y * args.dims.z;
    if (at >= all) {
        return;
    }
    ivec3 cell = ivec3(at % args.dims.x, at / args.dims.x % args.dims.y, at / (args.dims.x * args.dims.y));
    lattice_box box = lattice_box_of(medium.extent, ivec3(args.dims));
    bands_medium m = bands_medium_of(texelFetch(cells, cell + ivec3(0, 0, args.ch * args.dims.z), 0), args.bands);
    for (uint n = 0u; n < args.lamps; n++) {
        lamp = bands_lamp_at(n, box, cell);
        light = lattice_channel(radials[n].light.color, args.channels, args.ch, args.tint) * lamp.share *
                bands_transmittance(lamp.tau, int(args.ch), m, args.bands, box.dx);
        harmonics_visit(lamp.direction, int(args.bands));
    }
}
