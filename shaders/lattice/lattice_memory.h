// lattice_memory.h -- what lattice_recall and lattice_keep have in common: parameters, and what their kernels are told.
#pragma once
#include <tyndall/extend/lattice_shape.h>
#include "shaders/lattice/lattice_args.h"
#include <string.h>

typedef struct tyn_lattice_recall_params { // of both
    tyn_lattice_shape shape;
    float world[3][4]; // rows of the matrix from M to the world
} tyn_lattice_recall_params;

static inline struct lattice_recall_args lattice_memory_args(const tyn_lattice_recall_params *p)
{
    const tyn_lattice_shape *s = &p->shape;
    const tyn_extent dims = tyn_lattice_dims(s->extent, s->cells);
    struct lattice_recall_args args = {.dims = {dims.x, dims.y, dims.z}, .channels = s->channels};
    memcpy(args.world, p->world, sizeof args.world);
    memcpy(args.extent, s->extent, sizeof args.extent);
    memcpy(args.tint, s->tint, sizeof args.tint);
    return args;
}

static inline tyn_extent lattice_memory_texels(const struct lattice_recall_args *args)
{
    return (tyn_extent){args->dims[0], args->dims[1], args->dims[2] * args->channels};
}
