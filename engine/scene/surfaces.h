// surfaces.h -- what every owner of surfaces needs: freeing, bounds, content hash, checks.
#pragma once
#include <tyndall/scene.h>
#include <tyndall/extend/hash.h>

void tyn_surfaces_free(tyn_surfaces *surfaces); // leaves them empty

// World box of the vertices. False (and zeros) without triangles.
bool tyn_surfaces_bounds(const tyn_surfaces *surfaces, float lo[3], float hi[3]);

// Inline because file formats need it too. `hash`, or one of the whole content if that is 0; 0 without triangles.
static inline uint64_t tyn_surfaces_hash(const tyn_surfaces *s)
{
    if (s->hash || !s->num_triangles) {
        return s->num_triangles ? s->hash : 0;
    }
    uint64_t h = TYN_HASH_SEED;
    h = tyn_hash_bytes(h, s->vertices, s->num_vertices * sizeof *s->vertices);
    h = tyn_hash_bytes(h, s->triangles, s->num_triangles * sizeof *s->triangles);
    h = tyn_hash_bytes(h, s->materials, s->num_materials * sizeof *s->materials);
    h = tyn_hash_bytes(h, s->nodes, s->num_nodes * sizeof *s->nodes);
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        h = tyn_hash_bytes(h, t->size, sizeof t->size);
        h = tyn_hash_bytes(h, t->wrap, sizeof t->wrap);
        h = tyn_hash_bytes(h, t->texels, t->texels ? (size_t)t->size[0] * t->size[1] * 4 : 0);
    }
    return h ? h : 1;
}

// Are the arrays that are to hold something there?
tyn_result tyn_surfaces_check_arrays(const tyn_surfaces *surfaces, const tyn_log *log);
// Everything; the first fault is one log line.
tyn_result tyn_surfaces_check(const tyn_surfaces *surfaces, const tyn_log *log);
