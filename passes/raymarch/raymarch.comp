// raymarch.comp -- one thread a pixel. Built with RAYMARCH_GREY for a medium that is the same in all channels, and for
// coefficients that differ between channels or media.
#extension GL_EXT_control_flow_attributes : require
#include "raymarch_bindings.glsl"
#include "shaders/common/camera.glsl"
#include "shaders/march/background.glsl"
#include "glow.glsl"
#include "shaders/colour/display.glsl"
#include "shaders/march/host_depth.glsl"
#include "shaders/march/surface_samples.glsl"
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/phase/scatter_lut.glsl"
#include "shaders/lattice/lattice.glsl"
#include "shaders/walls/lattice_walls.glsl"
#include "shaders/light/shadow.glsl"
#include "raymarch.glsl"
#include "raymarch_pixel.glsl"
#include "raymarch_sparse.glsl"
#include "raymarch_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec2 at = pixel_of_thread(gl_WorkGroupID.xy, gl_LocalInvocationIndex);
    if (raymarch_has(RAYMARCH_SPARSE_FILL)) {
        fill_cells(ivec2(at));
    } else {
        march_rays(64u * (gl_WorkGroupID.y * RAYMARCH_REST_GROUPS + gl_WorkGroupID.x) + gl_LocalInvocationIndex, ivec2(at));
    }
}
