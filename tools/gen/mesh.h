// mesh.h -- what stands in a sample scene beside its media: meshes, where they are placed, and lamps.
//
// Fronts are the sides from which triangles run counter-clockwise. Lengths in metres, angles in radians.
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct gen_vertex {
    float position[3], normal[3], uv[2];
} gen_vertex;

typedef struct gen_mesh {
    const char *name;
    uint32_t material; // index into gen_scene.materials
    gen_vertex *vertices;
    uint32_t *indices;
    uint32_t num_vertices, num_indices;
} gen_mesh;

typedef struct gen_part { // a mesh at a place
    uint32_t mesh;
    float translation[3];
    float turn;  // about +Y, right-handed
    float scale; // of all axes
} gen_part;

typedef struct gen_lamp {
    float position[3];
    float direction[3]; // of a spot, any length
    float intensity;    // W/sr
    float color[3];
    float inner, outer; // half angles of a spot; outer 0: a point, which shines all around
} gen_lamp;

enum { GEN_MAX_MESHES = 32, GEN_MAX_PARTS = 96, GEN_MAX_LAMPS = 32 };

typedef struct gen_model {
    gen_mesh meshes[GEN_MAX_MESHES];
    gen_part parts[GEN_MAX_PARTS];
    gen_lamp lamps[GEN_MAX_LAMPS];
    uint32_t num_meshes, num_parts, num_lamps;
} gen_model;

// A new mesh, placed nowhere yet; what is over the limits or the memory ends the program.
gen_mesh *gen_mesh_new(gen_model *model, const char *name, uint32_t material);
// Places the newest mesh. gen_place_here: as it was built.
void gen_place(gen_model *model, float x, float y, float z, float turn, float scale);
void gen_place_here(gen_model *model);
void gen_add_lamp(gen_model *model, const gen_lamp *lamp);
void gen_model_free(gen_model *model);

uint32_t gen_add_vertex(gen_mesh *mesh, const float position[3], const float normal[3],
                        const float uv[2]);
// Leaves out what has two corners in one place.
void gen_add_triangle(gen_mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

// ---- shapes -------------------------------------------------------------------------------------
// `tile`: metres of one repetition of the texture, which lies flat on the plane of two axes that a flat
// face is most nearly parallel to.

// A flat quadrangle a, b, c, d, counter-clockwise seen from its front.
void gen_add_quad(gen_mesh *mesh, const float a[3], const float b[3], const float c[3],
                  const float d[3], float tile);
void gen_add_box(gen_mesh *mesh, const float lo[3], const float hi[3], float tile);
// Upright, over a convex polygon of n corners x, z that is counter-clockwise seen from above.
void gen_add_prism(gen_mesh *mesh, const float (*corners)[2], int n, float bottom, float top,
                   float tile);
// A profile of n points (radius, height), upwards, turned about the axis through x, z. Closed where it starts
// and ends on the axis. Edges of the profile flatter than 40 degrees are smoothed.
void gen_add_lathe(gen_mesh *mesh, const float (*profile)[2], int n, float x, float z, int segments,
                   float tile);
void gen_add_ball(gen_mesh *mesh, const float center[3], float radius, int segments);
// Smooth normals: the mean of the triangles around every place, weighed by their areas.
void gen_smooth(gen_mesh *mesh);

// A wall with a row of openings under round arches. It runs from `from` towards -z; the face towards +x
// goes to `outer` where that is not NULL.
typedef struct gen_arches {
    int bays;
    float bay;             // width of one
    float bottom, top;     // of the wall
    float sill;            // lower end of the openings; that of the wall: they are open below
    float spring;          // where the arches start
    float half;            // half the width of an opening, the arch's radius
    float inside, outside; // x of the two faces, inside < outside
    float from;            // z of its beginning
    int steps;             // of a quarter of the arch, even
    float tile;
} gen_arches;
void gen_add_arches(gen_mesh *mesh, gen_mesh *outer, const gen_arches *wall);
