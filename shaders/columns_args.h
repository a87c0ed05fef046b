// columns_args.h -- what passes know about the buffer "columns". Included by C and GLSL.
#ifndef TYN_COLUMNS_ARGS_H
#define TYN_COLUMNS_ARGS_H

#define COLUMNS_COMPONENTS 9 // per cell and ordinate where coefficients are textures, else 1

#endif
