// sky_seen.glsl -- what surfaces leave of the principal ordinates in the lattice's cells.
//
// Define SKY_SEEN_AT as the first binding of the bundle TYN_SKY_SEEN (bundles.h).
//
// The buffer is [plane][z][y][x], a word having two neighbours along x as 16-bit shares; rows are padded to whole words.
// Plane 0 is the share of even light, the others those of the ordinates. Of ordinates that are not in use nothing is written.
//
// Light that is equal from all sides, the sky's mean Lbar, does not come along ordinates, but evenly (lattice_ordinates.comp), as
// if there were no surfaces, times the share v0 of it that passes them. What an ordinate brings beside its own E, v of which
// passes, is what of Lbar comes from its region more than elsewhere: E v + Lbar even (v - v0). Where all is open that is E, where
// all is dark nothing.
#ifndef TYN_SKY_SEEN_GLSL
#define TYN_SKY_SEEN_GLSL
#include "ordinate_args.h"
#include "shaders/common/scene_args.h"

TYN_READ(SKY_SEEN_AT, sky_seen, uint sky_seen_words[]);
TYN_UNIFORM(SKY_SEEN_AT + 1, environment, env_block environment);

uint sky_seen_word(uint plane, uvec3 cell, uvec3 dims)
{
    return ((plane * dims.z + cell.z) * dims.y + cell.y) * ((dims.x + 1u) / 2u) + cell.x / 2u;
}

// Of both cells of a word.
vec2 sky_seen_pair(uint word)
{
    return unpackUnorm2x16(sky_seen_words[word]);
}

float sky_seen_share(uint plane, uvec3 cell, uvec3 dims)
{
    vec2 pair = sky_seen_pair(sky_seen_word(plane, cell, dims));
    return (cell.x & 1u) != 0u ? pair.y : pair.x;
}

// Irradiance across ordinate o where `share` of it is seen and `even` of the mean.
vec3 sky_seen_irradiance(const ordinate o, float share, float even)
{
    return o.irradiance * share + environment.sky * (o.even * (share - even));
}

#endif
