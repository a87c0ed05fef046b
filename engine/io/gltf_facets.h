// gltf_facets.h -- triangles cut where what a file paints on them varies.
//
// A material of the scene has one emission and one factor of its albedo. Where a file has colours that vary from vertex to
// vertex, an emissive texture or a mask, triangles are cut into facets on which these are constant, as far as is worth it:
// then all methods know of them, also those that send light from surfaces and let it through holes.
#pragma once
#include "io/gltf_picture.h"

// What is painted on a triangle; corners in the order of the triangle.
typedef struct gltf_painted {
    double (*colors)[4];              // of the corners; NULL: 1
    bool reflects;                    // else their red, green and blue change nothing
    const gltf_picture *alpha, *glow; // NULL: 1
    double (*alpha_uv)[2], (*glow_uv)[2];
    double opacity; // factor of alpha
    double cutoff;  // what has less alpha is not there; 0: all is there
} gltf_painted;

typedef struct gltf_facet {
    double corners[3][3];   // weights of the triangle's corners
    bool whole;             // it is the triangle
    float tint[3], glow[3]; // factors of albedo and emission
} gltf_facet;

// Calls `put` for each facet, false ends it. `budget` is of facets and is lowered by what is put beyond one a triangle; with
// none left triangles are not cut, those with a mask only coarsely. False: `put` gave it.
typedef bool (*gltf_facet_fn)(void *user, const gltf_facet *facet);
bool tyn_gltf_cut(const gltf_painted *painted, int64_t *budget, gltf_facet_fn put, void *user);
