// columns.glsl -- optical depth along the principal ordinates, from where their light enters the
// medium's box to the lattice's cells.
//
// Include after medium.glsl, and define COLUMNS_AT as the first binding of the bundle TYN_COLUMNS (bundles.h), and
// COLUMNS_STORAGE if the ordinates are to be a storage buffer: lavapipe has room for seven uniform ones.
//
// The buffer is [ordinate][component][z][y][x]; components: int density ds (mode DENSITY), or the rgb of
// int sigma_s, int sigma_a and int (1 - f) sigma_s. A value is the square of a half: 3 digits from 1e-9 to
// 1e9. A word has two neighbours along x; rows are padded to whole words. Of ordinates that are not in
// use nothing is written.
#ifndef TYN_COLUMNS_GLSL
#define TYN_COLUMNS_GLSL
#include "beam_tau.glsl"
#include "columns_args.h"
#include "shaders/light/ordinate_args.h"

#ifdef COLUMNS_STORAGE
TYN_READ(COLUMNS_AT, ordinates, ordinates_block ordinates);
#else
TYN_UNIFORM(COLUMNS_AT, ordinates, ordinates_block ordinates);
#endif
TYN_READ(COLUMNS_AT + 1, columns, uint columns_words[]);

// Of component 0 at a cell; the next component and the next ordinate are columns_stride words on.
uint columns_word(uint n, uvec3 cell, uvec3 dims)
{
    uint components = medium_mode == TYN_MEDIUM_DENSITY ? 1u : COLUMNS_COMPONENTS;
    uint plane = n * components * dims.z + cell.z;
    return (plane * dims.y + cell.y) * ((dims.x + 1u) / 2u) + cell.x / 2u;
}

uint columns_stride(uvec3 dims)
{
    return dims.z * dims.y * ((dims.x + 1u) / 2u);
}

// Of both cells of a word.
vec2 columns_pair(uint word)
{
    vec2 roots = unpackHalf2x16(columns_words[word]);
    return roots * roots;
}

float columns_value(uint word, uint x)
{
    vec2 pair = columns_pair(word);
    return (x & 1u) != 0u ? pair.y : pair.x;
}

vec3 columns_value3(uint word, uint stride, uint x)
{
    return vec3(columns_value(word, x), columns_value(word + stride, x),
                columns_value(word + 2u * stride, x));
}

// Mode DENSITY: int density ds, m times texture value.
float columns_density(uint n, uvec3 cell, uvec3 dims)
{
    return columns_value(columns_word(n, cell, dims), cell.x);
}

// Any mode.
beam_tau columns_tau(uint n, uvec3 cell, uvec3 dims)
{
    if (medium_mode == TYN_MEDIUM_DENSITY) {
        return beam_of_column(columns_density(n, cell, dims));
    }
    uint word = columns_word(n, cell, dims), stride = columns_stride(dims);
    return beam_tau(columns_value3(word, stride, cell.x),
                    columns_value3(word + 3u * stride, stride, cell.x),
                    columns_value3(word + 6u * stride, stride, cell.x));
}

#endif
