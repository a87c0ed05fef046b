// surfaces.c -- life of a scene's surfaces, their bounds, hash and checks.
#include "scene/surfaces.h"
#include "base/fault.h"
#include "scene/matrix.h"
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define FIELD(name) #name, offsetof(tyn_surface_material, name)
const tyn_material_field tyn_material_fields[TYN_MATERIAL_NUM_FIELDS] = {
    [TYN_MATERIAL_ALBEDO] = {FIELD(albedo), 3, 1, "between 0 and 1", "", "pbrMetallicRoughness",
                             "baseColorFactor", 4, 1},
    [TYN_MATERIAL_EMISSION] = {FIELD(emission), 3, FLT_MAX, ">= 0 and finite", "W/(m^2 sr)", NULL,
                               "emissiveFactor", 3, 0},
};

void tyn_surfaces_free(tyn_surfaces *s)
{
    for (uint32_t i = 0; i < s->num_textures; i++) {
        free(s->textures[i].name);
        free(s->textures[i].texels);
    }
    free(s->vertices);
    free(s->triangles);
    free(s->materials);
    free(s->textures);
    free(s->nodes);
    memset(s, 0, sizeof *s);
}

bool tyn_surfaces_bounds(const tyn_surfaces *s, float lo[3], float hi[3])
{
    bool any = s->num_triangles && s->num_vertices;
    for (int a = 0; a < 3; a++) {
        lo[a] = any ? FLT_MAX : 0.0f;
        hi[a] = any ? -FLT_MAX : 0.0f;
        for (uint32_t i = 0; any && i < s->num_vertices; i++) {
            lo[a] = fminf(lo[a], s->vertices[i].position[a]);
            hi[a] = fmaxf(hi[a], s->vertices[i].position[a]);
        }
    }
    return any;
}

bool tyn_surfaces_emit(const tyn_surfaces *s)
{
    // Every frame asks, and most scenes have no such material.
    bool any = false, used = false;
    for (uint32_t i = 0; i < s->num_materials && !any; i++) {
        any = vec_any(s->materials[i].emission);
    }
    for (uint32_t i = 0; i < s->num_triangles && any && !used; i++) {
        used = vec_any(s->materials[s->triangles[i].material].emission);
    }
    return used;
}

// ---- checks -----------------------------------------------------------------------------------

tyn_result tyn_surfaces_check_arrays(const tyn_surfaces *s, const tyn_log *log)
{
    const struct {
        const char *name;
        const void *data;
        uint32_t count;
    } arrays[] = {{"vertices", s->vertices, s->num_vertices},
                  {"triangles", s->triangles, s->num_triangles},
                  {"materials", s->materials, s->num_materials},
                  {"textures", s->textures, s->num_textures},
                  {"nodes", s->nodes, s->num_nodes}};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        if (arrays[i].count && !arrays[i].data) {
            FAULT("surfaces.%s = NULL, but there are to be %u", arrays[i].name, arrays[i].count);
        }
    }
    return TYN_OK;
}

static tyn_result check_vertices(const tyn_surfaces *s, const tyn_log *log)
{
    for (uint32_t i = 0; i < s->num_vertices; i++) {
        const tyn_surface_vertex *v = &s->vertices[i];
        const float *p = v->position, *n = v->normal;
        if (!vec_finite(p, 3) || fabsf(p[0]) > 1e15f || fabsf(p[1]) > 1e15f ||
            fabsf(p[2]) > 1e15f) {
            FAULT("surfaces.vertices[%u].position = %g, %g, %g: must be finite, metres", i, p[0],
                  p[1], p[2]);
        }
        float length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        if (!(length2 > 0.99f && length2 < 1.01f)) {
            FAULT("surfaces.vertices[%u].normal = %g, %g, %g: must have length 1", i, n[0], n[1],
                  n[2]);
        }
        if (!isfinite(v->u) || !isfinite(v->v)) {
            FAULT("surfaces.vertices[%u]: texture coordinates %g, %g: must be finite", i, v->u,
                  v->v);
        }
    }
    return TYN_OK;
}

static tyn_result check_triangles(const tyn_surfaces *s, const tyn_log *log)
{
    for (uint32_t i = 0; i < s->num_triangles; i++) {
        const tyn_surface_triangle *t = &s->triangles[i];
        for (int k = 0; k < 3; k++) {
            if (t->vertices[k] >= s->num_vertices) {
                FAULT("surfaces.triangles[%u].vertices[%d] = %u: there are %u vertices", i, k,
                      t->vertices[k], s->num_vertices);
            }
        }
        if (t->material >= s->num_materials) {
            FAULT("surfaces.triangles[%u].material = %u: there are %u materials", i, t->material,
                  s->num_materials);
        }
    }
    return TYN_OK;
}

static tyn_result check_materials(const tyn_surfaces *s, const tyn_log *log)
{
    for (uint32_t i = 0; i < s->num_materials; i++) {
        const tyn_surface_material *m = &s->materials[i];
        for (const tyn_material_field *f = tyn_material_fields;
             f < tyn_material_fields + TYN_MATERIAL_NUM_FIELDS; f++) {
            const float *v = (const float *)((const char *)m + f->offset);
            for (uint32_t c = 0; c < f->count; c++) {
                if (!(v[c] >= 0.0f && v[c] <= f->max)) {
                    FAULT("surfaces.materials[%u].%s[%u] = %g: must be %s%s%s", i, f->name, c, v[c],
                          f->range, *f->unit ? ", " : "", f->unit);
                }
            }
        }
        if (m->flags > TYN_SURFACE_EMITS_BOTH_SIDES) {
            FAULT("surfaces.materials[%u].flags = %u: must be 0 or TYN_SURFACE_EMITS_BOTH_SIDES", i,
                  m->flags);
        }
        if (m->texture != TYN_NO_TEXTURE && m->texture >= s->num_textures) {
            FAULT("surfaces.materials[%u].texture = %u: there are %u textures (TYN_NO_TEXTURE = "
                  "none)",
                  i, m->texture, s->num_textures);
        }
    }
    return TYN_OK;
}

static tyn_result check_textures(const tyn_surfaces *s, const tyn_log *log)
{
    for (uint32_t i = 0; i < s->num_textures; i++) {
        const tyn_texture *t = &s->textures[i];
        for (int a = 0; a < 2; a++) {
            if (t->size[a] < 1 || t->size[a] > TYN_MAX_TEXTURE_SIDE) {
                FAULT("surfaces.textures[%u].size[%d] = %u: must be 1 to %d texels", i, a,
                      t->size[a], TYN_MAX_TEXTURE_SIDE);
            }
            if (t->wrap[a] != TYN_WRAP_REPEAT && t->wrap[a] != TYN_WRAP_CLAMP &&
                t->wrap[a] != TYN_WRAP_MIRROR) {
                FAULT("surfaces.textures[%u].wrap[%d] = %d: must be repeat, clamp or mirror", i, a,
                      (int)t->wrap[a]);
            }
        }
        if (!t->texels) {
            FAULT("surfaces.textures[%u].texels = NULL: required", i);
        }
    }
    return TYN_OK;
}

// What traversal relies on: every index is inside, children follow their parent (so there is no cycle),
// and no branch is longer than its stack.
static tyn_result check_nodes(const tyn_surfaces *s, const tyn_log *log)
{
    uint8_t *depth = calloc((size_t)s->num_nodes + 1, 1);
    tyn_result r = TYN_OK;
    if (!depth) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "no memory to check %u nodes", s->num_nodes);
    }
    for (uint32_t i = 0; !r && i < s->num_nodes; i++) {
        const tyn_surface_node *n = &s->nodes[i];
        const char *fault = NULL;
        if (!vec_finite(n->lo, 3) || !vec_finite(n->hi, 3)) {
            fault = "its box must be finite";
        } else if (n->count) {
            bool inside = n->first < s->num_triangles && n->count <= s->num_triangles - n->first;
            fault = inside ? NULL : "its triangles must be among those there are";
        } else if (n->first <= i || n->first >= s->num_nodes - 1) {
            fault = "its two children must follow it and be among the nodes there are";
        } else if (depth[i] + 1 >= TYN_SURFACE_MAX_DEPTH) {
            fault = "the hierarchy is too deep";
        } else {
            for (uint32_t k = n->first; k <= n->first + 1; k++) {
                depth[k] = depth[i] + 1 > depth[k] ? (uint8_t)(depth[i] + 1) : depth[k];
            }
        }
        if (fault) {
            r = TYN_FAULT(log, TYN_ERR_PARAMS,
                          "surfaces.nodes[%u] (first %u, count %u): %s (%u nodes, %u triangles, at "
                          "most %d levels)",
                          i, n->first, n->count, fault, s->num_nodes, s->num_triangles,
                          TYN_SURFACE_MAX_DEPTH);
        }
    }
    free(depth);
    return r;
}

tyn_result tyn_surfaces_check(const tyn_surfaces *s, const tyn_log *log)
{
    TYN_TRY(tyn_surfaces_check_arrays(s, log));
    TYN_TRY(check_vertices(s, log));
    TYN_TRY(check_triangles(s, log));
    TYN_TRY(check_materials(s, log));
    TYN_TRY(check_textures(s, log));
    return check_nodes(s, log);
}
