// columns_args.h -- the columns along the principal ordinates. Included by C and GLSL; scalar layout.
#ifndef TYN_COLUMNS_ARGS_H
#define TYN_COLUMNS_ARGS_H
#include "shaders/common/shared.h"

#define COLUMNS_COMPONENTS 9 // per cell and ordinate where coefficients are textures, else 1
#define COLUMNS_GROUP 64     // threads of a workgroup that marches: columns

struct columns_args {
    tyn_uvec3 dims;  // cells of the lattice
    tyn_uint first;  // ordinate of this batch
    tyn_uint stride; // nodes of an ordinate
};

struct columns_average_args {
    tyn_uvec3 size;    // texels of the averaged medium
    tyn_uvec3 samples; // of the medium in each, along the axes
};

#endif
