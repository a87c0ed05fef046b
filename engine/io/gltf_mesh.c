// gltf_mesh.c -- meshes of a glTF file as triangles in the world.
#include "io/gltf_mesh.h"
#include "base/grow.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/gltf_facets.h"
#include "scene/matrix.h"

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
enum { MAX_VERTICES = 1 << 16, MAX_FACETS = 1 << 12 };
#else
enum { MAX_VERTICES = 1 << 27 }; // and triangles: nodes may show one mesh any number of times
enum { MAX_FACETS = 1 << 21 };   // beyond the file's triangles
#endif

// Triangles without area are looked at and left out: so many vertices and indices are, instances and all.
static const uint64_t MAX_VISITED = 8 * (uint64_t)MAX_VERTICES;

enum { LACK_LINES, LACK_POSITION, LACK_MORPH, LACK_SKIN, LACK_FACETS, LACK_AREA };
enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };

// ---- open, close ------------------------------------------------------------------------------

tyn_result tyn_gltf_meshes_open(gltf_meshes *m, const json_doc *doc, const gltf_model *model,
                                tyn_scene *scene)
{
    memset(m, 0, sizeof *m);
    m->facets = MAX_FACETS;
    m->data = (gltf_data){doc, model};
    m->list = &model->lists[GLTF_MESHES];
    return tyn_gltf_materials_open(&m->materials, &m->data, scene);
}

void tyn_gltf_meshes_close(gltf_meshes *m)
{
    static const char *const what[] = {
        [LACK_LINES] = "points and lines are left out",
        [LACK_POSITION] = "a primitive without POSITION is left out",
        [LACK_MORPH] = "morph targets are left out: its shape is that without them",
        [LACK_SKIN] = "skins are left out: its shape is that without one",
        [LACK_FACETS] =
            "there are too many triangles to be cut where colours, emission or masks vary: means "
            "count",
        [LACK_AREA] = "a primitive whose triangles all have no area is left out",
    };
    tyn_scene *scene = m->materials.scene;
    for (size_t i = 0; scene && i < sizeof what / sizeof what[0]; i++) {
        if (m->lacks[i].count) {
            tyn_scene_warn(scene, "mesh %s%s: %s", m->lacks[i].name,
                           m->lacks[i].count > 1 ? " and others" : "", what[i]);
        }
    }
    if (scene) {
        tyn_gltf_materials_close(&m->materials);
    }
}

static void lack(gltf_meshes *m, int64_t mesh, int which)
{
    tyn_gltf_note(&m->lacks[which], m->list, mesh, "");
}

// ---- a primitive's data -----------------------------------------------------------------------

typedef struct primitive {
    const cJSON *json;
    int64_t mesh;
    gltf_floats positions, normals, texcoords, colors, glow_texcoords; // count 0: none
    uint32_t *indices;                                                 // NULL: 0, 1, 2, ...
    uint32_t num_indices;
    int mode;
    const gltf_material *material;
    bool reflects;           // its albedo is not 0
    bool painted;            // its triangles are cut where what is painted on them varies
    uint32_t material_index; // else: with its colour
} primitive;

static void primitive_finish(primitive *p)
{
    free(p->positions.values);
    free(p->normals.values);
    free(p->texcoords.values);
    free(p->colors.values);
    free(p->glow_texcoords.values);
    free(p->indices);
}

// An attribute that must have as many elements as there are positions.
static tyn_result read_attribute(const gltf_meshes *m, const primitive *p, const char *name,
                                 uint32_t least, uint32_t most, gltf_floats *out)
{
    const cJSON *at = tyn_json_member(tyn_json_member(p->json, "attributes"), name);
    if (!at) {
        return TYN_OK;
    }
    tyn_result r = tyn_gltf_read_floats(&m->data, at, least, most, out);
    if (!r && out->count != p->positions.count) {
        return tyn_json_fault(m->data.doc, at, "has %u elements, POSITION has %u", out->count,
                              p->positions.count);
    }
    return r;
}

static tyn_result read_indices(const gltf_meshes *m, primitive *p)
{
    const cJSON *at = tyn_json_member(p->json, "indices");
    tyn_result r = TYN_OK;
    p->num_indices = p->positions.count;
    if (at) {
        r = tyn_gltf_read_indices(&m->data, at, p->positions.count, &p->indices, &p->num_indices);
    }
    if (!r && (p->num_indices < 3 || (p->mode == MODE_TRIANGLES && p->num_indices % 3))) {
        return tyn_json_fault(
            m->data.doc, at ? at : p->json,
            "has %u vertices: triangles need a multiple of 3, strips and fans 3 or "
            "more",
            p->num_indices);
    }
    return r;
}

// COLOR_0 multiplies the material's colour: here if it is the same everywhere.
static tyn_result apply_colors(gltf_meshes *m, primitive *p)
{
    static const float one[3] = {1, 1, 1};
    const gltf_floats *colors = &p->colors;
    bool equal = true;
    for (uint32_t i = 1; i < colors->count; i++) {
        equal = equal && !memcmp(colors->values + (size_t)i * colors->components, colors->values,
                                 colors->components * sizeof(float));
    }
    const float *albedo = p->material->surface.albedo;
    p->reflects = vec_any(albedo);
    p->painted = (!equal && p->reflects) || p->material->cutoff > 0 || p->material->glow;
    return p->painted ? TYN_OK
                      : tyn_gltf_material_paint(&m->materials, p->material,
                                                colors->count ? colors->values : one, one,
                                                &p->material_index);
}

// Texture coordinates that a texture wants.
static tyn_result read_texcoords(const gltf_meshes *m, const primitive *p,
                                 const gltf_texture_place *place, gltf_floats *out)
{
    char name[16];
    snprintf(name, sizeof name, "TEXCOORD_%u", place->texcoord);
    return read_attribute(m, p, name, 2, 2, out);
}

static tyn_result read_primitive(gltf_meshes *m, primitive *p)
{
    const json_doc *doc = m->data.doc;
    int64_t mode = MODE_TRIANGLES, material = -1;
    tyn_result r = tyn_json_integer(doc, p->json, "mode", 0, 6, "0 to 6", &mode);
    if (r) {
        return r;
    }
    p->mode = (int)mode;
    if (mode < MODE_TRIANGLES) {
        lack(m, p->mesh, LACK_LINES);
        return TYN_OK;
    }
    const cJSON *position = tyn_json_member(tyn_json_member(p->json, "attributes"), "POSITION");
    if (!position) {
        lack(m, p->mesh, LACK_POSITION);
        return TYN_OK;
    }
    if (tyn_json_member(p->json, "targets")) {
        lack(m, p->mesh, LACK_MORPH);
    }
    const cJSON *index = tyn_json_member(p->json, "material");
    material = index ? (int64_t)index->valuedouble : -1;
    r = tyn_gltf_material_get(&m->materials, material, &p->material);
    r = r ? r : tyn_gltf_read_floats(&m->data, position, 3, 3, &p->positions);
    r = r ? r : read_attribute(m, p, "NORMAL", 3, 3, &p->normals);
    r = r ? r : read_attribute(m, p, "COLOR_0", 3, 4, &p->colors);
    if (!r && p->material->surface.texture != TYN_NO_TEXTURE) {
        r = read_texcoords(m, p, &p->material->color, &p->texcoords);
    }
    if (!r && p->material->glow) {
        r = read_texcoords(m, p, &p->material->glow_place, &p->glow_texcoords);
    }
    r = r ? r : apply_colors(m, p);
    return r ? r : read_indices(m, p);
}

// ---- into the scene ---------------------------------------------------------------------------

// A node's matrix as meshes need it. Normals turn with the inverse transpose; that is the matrix of
// cofactors over the determinant, whose sign alone matters.
typedef struct placement {
    const double *m;
    double normal[9]; // column-major
    bool mirrored;    // triangles run the other way round
} placement;

static placement place(const double m[16])
{
    placement p = {.m = m, .mirrored = mat_det3(m) < 0};
    for (int c = 0; c < 3; c++) {
        vec_cross(p.normal + 3 * c, m + 4 * ((c + 1) % 3), m + 4 * ((c + 2) % 3));
        for (int i = 0; i < 3; i++) {
            p.normal[3 * c + i] *= p.mirrored ? -1 : 1;
        }
    }
    return p;
}

static void place_position(const placement *at, const float *p, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = at->m[i] * p[0] + at->m[4 + i] * p[1] + at->m[8 + i] * p[2] + at->m[12 + i];
    }
}

// False if the normal is 0.
static bool place_normal(const placement *at, const float *n, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = at->normal[i] * n[0] + at->normal[3 + i] * n[1] + at->normal[6 + i] * n[2];
    }
    return vec_normalize(out);
}

// Room for three vertices and a triangle.
static tyn_result make_room(gltf_meshes *m, const primitive *p)
{
    tyn_surfaces *s = &m->materials.scene->surfaces;
    if (s->num_vertices > MAX_VERTICES - 3 || s->num_triangles > MAX_VERTICES - 1) {
        return tyn_json_fault(m->data.doc, p->json, "there may be %d vertices and triangles in all",
                              MAX_VERTICES);
    }
    if (!tyn_grow(&s->vertices, &m->vertex_room, (size_t)s->num_vertices + 3,
                  sizeof *s->vertices) ||
        !tyn_grow(&s->triangles, &m->triangle_room, (size_t)s->num_triangles + 1,
                  sizeof *s->triangles)) {
        return tyn_json_no_memory(m->data.doc, "triangles");
    }
    return TYN_OK;
}

// 0, 0 where there are none.
static void place_texcoord(const gltf_floats *texcoords, const gltf_texture_place *place,
                           uint32_t i, double out[2])
{
    out[0] = out[1] = 0;
    if (texcoords->count) {
        const float *t = texcoords->values + 2 * (size_t)i;
        for (int a = 0; a < 2; a++) {
            const float *row = place->uv[a];
            out[a] = (double)(row[0] * t[0] + row[1] * t[1] + row[2]);
        }
    }
}

// `normal` is the triangle's, for vertices that have none.
static void put_vertex(tyn_surface_vertex *v, const primitive *p, const placement *at, uint32_t i,
                       const double normal[3])
{
    double position[3], n[3];
    place_position(at, p->positions.values + 3 * (size_t)i, position);
    if (!p->normals.count || !place_normal(at, p->normals.values + 3 * (size_t)i, n)) {
        memcpy(n, normal, sizeof n);
    }
    for (int a = 0; a < 3; a++) {
        v->position[a] = (float)position[a];
        v->normal[a] = (float)n[a];
    }
    double uv[2];
    place_texcoord(&p->texcoords, &p->material->color, i, uv);
    v->u = (float)uv[0];
    v->v = (float)uv[1];
}

// Corners of triangle k as places in the list of indices (glTF 2.0, 3.7.2.1), then as indices.
static void corners(const primitive *p, uint32_t k, uint32_t out[3])
{
    out[0] = p->mode == MODE_TRIANGLES ? 3 * k : p->mode == MODE_STRIP ? k : k + 1;
    out[1] = p->mode == MODE_TRIANGLES ? 3 * k + 1 : p->mode == MODE_STRIP ? k + 1 + k % 2 : k + 2;
    out[2] = p->mode == MODE_TRIANGLES ? 3 * k + 2 : p->mode == MODE_STRIP ? k + 2 - k % 2 : 0;
    for (int c = 0; p->indices && c < 3; c++) {
        out[c] = p->indices[out[c]];
    }
}

// A triangle on its way into the scene.
typedef struct arrival {
    gltf_meshes *m;
    const primitive *p;
    const placement *at;
    uint32_t *moved;     // where a vertex has gone
    uint32_t corners[3]; // indices
    double normal[3];
    tyn_result result;
} arrival;

// With normals of their own vertices are shared as in the file, those that no triangle uses stay behind; without, every
// triangle has three.
static uint32_t share_vertex(arrival *a, uint32_t index)
{
    tyn_surfaces *s = &a->m->materials.scene->surfaces;
    uint32_t *place = &a->moved[index];
    if (*place == UINT32_MAX || !a->p->normals.count) {
        *place = s->num_vertices++;
        put_vertex(&s->vertices[*place], a->p, a->at, index, a->normal);
    }
    return *place;
}

// A vertex between the corners.
static uint32_t mix_vertex(arrival *a, const double weights[3])
{
    tyn_surfaces *s = &a->m->materials.scene->surfaces;
    tyn_surface_vertex corner, *to = &s->vertices[s->num_vertices];
    double position[3] = {0}, normal[3] = {0}, uv[2] = {0};
    for (int k = 0; k < 3; k++) {
        put_vertex(&corner, a->p, a->at, a->corners[k], a->normal);
        for (int c = 0; c < 3; c++) {
            position[c] += weights[k] * (double)corner.position[c];
            normal[c] += weights[k] * (double)corner.normal[c];
        }
        uv[0] += weights[k] * (double)corner.u;
        uv[1] += weights[k] * (double)corner.v;
    }
    if (!vec_normalize(normal)) {
        memcpy(normal, a->normal, sizeof normal);
    }
    for (int c = 0; c < 3; c++) {
        to->position[c] = (float)position[c];
        to->normal[c] = (float)normal[c];
    }
    to->u = (float)uv[0];
    to->v = (float)uv[1];
    return s->num_vertices++;
}

// NULL: a->result says why.
static tyn_surface_triangle *next_triangle(arrival *a)
{
    tyn_surfaces *s = &a->m->materials.scene->surfaces;
    a->result = make_room(a->m, a->p);
    return a->result ? NULL : &s->triangles[s->num_triangles++];
}

static bool put_facet(void *user, const gltf_facet *facet)
{
    arrival *a = user;
    uint32_t material;
    a->result = tyn_gltf_material_paint(&a->m->materials, a->p->material, facet->tint, facet->glow,
                                        &material);
    tyn_surface_triangle *triangle = a->result ? NULL : next_triangle(a);
    for (int k = 0; triangle && k < 3; k++) {
        triangle->vertices[k] =
            facet->whole ? share_vertex(a, a->corners[k]) : mix_vertex(a, facet->corners[k]);
        triangle->material = material;
    }
    return triangle != NULL;
}

static void add_facets(arrival *a)
{
    const primitive *p = a->p;
    const gltf_material *material = p->material;
    double colors[3][4], alpha_uv[3][2], glow_uv[3][2];
    for (int k = 0; k < 3; k++) {
        const uint32_t i = a->corners[k];
        for (uint32_t c = 0; p->colors.count && c < 4; c++) {
            colors[k][c] = c < p->colors.components
                               ? (double)p->colors.values[(size_t)i * p->colors.components + c]
                               : 1;
        }
        place_texcoord(&p->texcoords, &material->color, i, alpha_uv[k]);
        place_texcoord(&p->glow_texcoords, &material->glow_place, i, glow_uv[k]);
    }
    const gltf_painted painted = {
        .colors = p->colors.count ? colors : NULL,
        .reflects = p->reflects,
        .alpha = material->alpha,
        .glow = material->glow,
        .alpha_uv = alpha_uv,
        .glow_uv = glow_uv,
        .opacity = material->opacity,
        .cutoff = material->cutoff,
    };
    tyn_gltf_cut(&painted, &a->m->facets, put_facet, a);
}

static void add_triangle(arrival *a)
{
    tyn_surface_triangle *triangle = next_triangle(a);
    for (int k = 0; triangle && k < 3; k++) {
        triangle->vertices[k] = share_vertex(a, a->corners[k]);
        triangle->material = a->p->material_index;
    }
}

// Triangles without area show nothing and are left out.
static tyn_result add_triangles(gltf_meshes *m, const primitive *p, const placement *at)
{
    m->visited += (uint64_t)p->positions.count + p->num_indices;
    if (m->visited > MAX_VISITED) {
        return tyn_json_fault(m->data.doc, p->json,
                              "nodes and instances show more than %llu vertices and indices",
                              (unsigned long long)MAX_VISITED);
    }
    arrival a = {.m = m, .p = p, .at = at, .moved = malloc(p->positions.count * sizeof *a.moved)};
    const uint32_t count = p->mode == MODE_TRIANGLES ? p->num_indices / 3 : p->num_indices - 2;
    if (!a.moved) {
        return tyn_json_fault(m->data.doc, p->json, "no memory for its vertices");
    }
    memset(a.moved, 0xff, p->positions.count * sizeof *a.moved);
    for (uint32_t k = 0; !a.result && k < count; k++) {
        double v[3][3];
        corners(p, k, a.corners);
        if (at->mirrored) {
            const uint32_t second = a.corners[1];
            a.corners[1] = a.corners[2];
            a.corners[2] = second;
        }
        for (int c = 0; c < 3; c++) {
            place_position(at, p->positions.values + 3 * (size_t)a.corners[c], v[c]);
        }
        for (int c = 0; c < 3; c++) {
            v[1][c] -= v[0][c];
            v[2][c] -= v[0][c];
        }
        vec_cross(a.normal, v[1], v[2]);
        if (vec_normalize(a.normal)) {
            if (p->painted) {
                add_facets(&a);
            } else {
                add_triangle(&a);
            }
        }
    }
    if (p->painted && m->facets <= 0) {
        lack(m, p->mesh, LACK_FACETS);
    }
    free(a.moved);
    return a.result;
}

tyn_result tyn_gltf_mesh_add(gltf_meshes *m, const cJSON *node, int64_t mesh,
                             const double to_world[16])
{
    json_list primitives = {0};
    const placement at = place(to_world);
    if (!mat_invertible(to_world)) {
        return tyn_json_fault(
            m->data.doc, node,
            "its mesh is flat: the matrix must be invertible, its determinant is %g",
            mat_det3(to_world));
    }
    if (tyn_json_member(node, "skin")) {
        lack(m, mesh, LACK_SKIN);
    }
    tyn_result r = tyn_json_list(m->data.doc, m->list->items[mesh], "primitives", &primitives);
    for (int64_t i = 0; !r && i < primitives.count; i++) {
        primitive p = {.json = primitives.items[i], .mesh = mesh};
        r = read_primitive(m, &p);
        const uint32_t before = m->materials.scene->surfaces.num_triangles;
        if (!r && p.positions.count) {
            r = add_triangles(m, &p, &at);
            if (!r && m->materials.scene->surfaces.num_triangles == before &&
                p.material->cutoff == 0) {
                lack(m, mesh, LACK_AREA);
            }
        }
        primitive_finish(&p);
    }
    free(primitives.items);
    return r;
}
