// photon_cells.glsl -- the medium in a cell of the cache. Included where `cells` is that of lattice_cells.
#include "shaders/phase/phase.glsl"

float mean3(vec3 v)
{
    return (v.x + v.y + v.z) * (1.0 / 3.0);
}

// Mean extinction of a cell, 1/m; `scaled`: forward scattering counts as none. `slices` along z for each of `channels`.
float photon_extinction(ivec3 c, uint slices, uint channels, bool scaled)
{
    float sum = 0.0;
    for (uint ch = 0u; ch < channels; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(ch * slices)), 0);
        sum += cell.x / (scaled ? 1.0 : 1.0 - delta_fraction(phase_of_delta_cosine(cell.z))) + cell.y;
    }
    return sum / float(channels);
}
