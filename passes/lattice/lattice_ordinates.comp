// lattice_ordinates.comp -- unscattered light of the principal ordinates in a cell: sum of E T' and of
// a E T' direction, a the mean cosine of an ordinate's region.
//
// T' is the mean along the light over the cell. E may be negative: ordinates carry what the sky has more
// or less than its mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "ordinate_args.h"
#include "lattice_args.h"
#define MEDIUM_BLOCK 0
#define MEDIUM_DENSITY 3 // the medium itself is not read
#define COLUMNS_BUFFER 2
#include "medium.glsl"
#include "columns.glsl"
#include "lattice.glsl"
#include "lattice_sweep.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(push_constant, scalar) uniform push
{
    lattice_ordinates_args args;
};
layout(binding = 1, scalar) uniform ordinates_uniform
{
    ordinates_block ordinates;
};
layout(binding = 3) uniform sampler3D cells;
layout(binding = 4) uniform sampler3D sunlight;
layout(binding = 5, rgba32f) uniform writeonly image3D source;

layout(constant_id = 1) const uint num_transmittances = 3; // 1: all channels have the same

void main()
{
    uvec3 cell = gl_GlobalInvocationID;
    ivec3 dims = ivec3(args.dims);
    if (any(greaterThanEqual(cell, args.dims))) {
        return;
    }
    float dx = lattice_box_of(medium.extent, dims).dx;
    vec3 half_depth = vec3(0.0); // along an axis
    for (int ch = 0; ch < int(args.channels); ch++) {
        vec4 c = texelFetch(cells, ivec3(cell) + ivec3(0, 0, ch * dims.z), 0);
        half_depth[ch] = 0.5 * dx * (c.x + c.y);
    }
    vec3 tint = args.tint / dot(args.tint, args.tint);
    vec3 fluence = vec3(0.0), flux_x = vec3(0.0), flux_y = vec3(0.0), flux_z = vec3(0.0);
    uint count = min(ordinates.count, args.count);
    for (uint n = 0; n < count; n++) {
        vec3 d = ordinates.list[n].direction, e = ordinates.list[n].irradiance;
        e = args.channels == 1 ? vec3(dot(e, tint)) : e;
        beam_tau tau = columns_tau(n, cell, args.dims);
        vec3 centre = tau.a + tau.p;
        vec3 x = half_depth / max(abs(d.x), max(abs(d.y), abs(d.z)));
        vec3 t = vec3(mean_transmittance(centre.r, x.r));
        if (num_transmittances == 3) {
            t.g = mean_transmittance(centre.g, x.g);
            t.b = mean_transmittance(centre.b, x.b);
        }
        vec3 light = e * t;
        d *= ordinates.list[n].mean_cosine;
        fluence += light;
        flux_x += light * d.x;
        flux_y += light * d.y;
        flux_z += light * d.z;
    }
    for (int ch = 0; ch < int(args.channels); ch++) {
        ivec3 texel = ivec3(cell) + ivec3(0, 0, ch * dims.z);
        vec4 sum = lattice_fetch_source(sunlight, cells, texel);
        imageStore(source, texel, sum + vec4(fluence[ch], flux_x[ch], flux_y[ch], flux_z[ch]));
    }
}
