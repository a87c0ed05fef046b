// gltf_mesh.c -- the meshes of a scene as glTF: one buffer, four accessors a mesh.
#include <stdlib.h>
#include <string.h>

#include "gltf.h"
#include "volume.h"

enum { ACCESSORS = 4 }; // of a mesh: positions, normals, texture coordinates, indices

// Bytes of an accessor: 32-bit components throughout.
static size_t size_of(const gen_mesh *mesh, int accessor)
{
    static const size_t components[] = {3, 3, 2};
    return 4 * (accessor < 3 ? components[accessor] * mesh->num_vertices : mesh->num_indices);
}

static size_t total_size(const gen_model *model)
{
    size_t size = 0;
    for (uint32_t i = 0; i < ACCESSORS * model->num_meshes; i++) {
        size += size_of(&model->meshes[i / ACCESSORS], (int)(i % ACCESSORS));
    }
    return size;
}

static void put_materials(FILE *f, const gen_scene *s)
{
    const char *textures[GEN_MAX_MATERIALS];
    int num_textures = 0;
    fputs("  \"materials\": [", f);
    for (int i = 0; i < GEN_MAX_MATERIALS && s->materials[i].name; i++) {
        const gen_material *m = &s->materials[i];
        const float *e = m->emission;
        const float albedo[4] = {m->albedo[0], m->albedo[1], m->albedo[2], 1};
        fprintf(f, "%s\n    { \"name\": \"%s\", \"pbrMetallicRoughness\": { \"baseColorFactor\": ",
                i ? "," : "", m->name);
        gen_put_floats(f, albedo, 4);
        fputs(", \"metallicFactor\": 0", f);
        if (m->texture) {
            int t = 0;
            while (t < num_textures && strcmp(textures[t], m->texture) != 0) {
                t++;
            }
            if (t == num_textures) {
                textures[num_textures++] = m->texture;
            }
            fprintf(f, ", \"baseColorTexture\": { \"index\": %d }", t);
        }
        fputs(" }", f);
        const float strength = e[0] > e[1]   ? (e[0] > e[2] ? e[0] : e[2])
                               : e[1] > e[2] ? e[1]
                                             : e[2];
        if (strength > 0) {
            fputs(",\n      \"emissiveFactor\": ", f);
            gen_put_floats(f, (const float[3]){e[0] / strength, e[1] / strength, e[2] / strength},
                           3);
            fprintf(f,
                    ", \"extensions\": { \"KHR_materials_emissive_strength\": { "
                    "\"emissiveStrength\": %.9g } }",
                    (double)strength);
        }
        fputs(" }", f);
    }
    fputs("\n  ],\n", f);
    if (num_textures == 0) {
        return;
    }
    fputs("  \"images\": [", f);
    for (int i = 0; i < num_textures; i++) {
        fprintf(f, "%s { \"uri\": \"%s\" }", i ? "," : "", textures[i]);
    }
    fputs(" ],\n  \"textures\": [", f);
    for (int i = 0; i < num_textures; i++) {
        fprintf(f, "%s { \"source\": %d }", i ? "," : "", i); // repeats
    }
    fputs(" ],\n", f);
}

static void put_accessors(FILE *f, const gen_model *model)
{
    enum { FLOAT = 5126, UINT = 5125 };
    static const char *const types[ACCESSORS] = {"VEC3", "VEC3", "VEC2", "SCALAR"};
    fputs("  \"accessors\": [", f);
    for (uint32_t i = 0; i < ACCESSORS * model->num_meshes; i++) {
        const gen_mesh *mesh = &model->meshes[i / ACCESSORS];
        const uint32_t a = i % ACCESSORS;
        fprintf(f,
                "%s\n    { \"bufferView\": %u, \"componentType\": %d, \"type\": \"%s\", "
                "\"count\": %u",
                i ? "," : "", i, a < 3 ? FLOAT : UINT, types[a],
                a < 3 ? mesh->num_vertices : mesh->num_indices);
        if (a == 0) {
            float lo[3], hi[3];
            for (uint32_t v = 0; v < mesh->num_vertices; v++) {
                for (int k = 0; k < 3; k++) {
                    const float p = mesh->vertices[v].position[k];
                    lo[k] = v == 0 || p < lo[k] ? p : lo[k];
                    hi[k] = v == 0 || p > hi[k] ? p : hi[k];
                }
            }
            fputs(",\n      \"min\": ", f);
            gen_put_floats(f, lo, 3);
            fputs(", \"max\": ", f);
            gen_put_floats(f, hi, 3);
        }
        fputs(" }", f);
    }
    fputs("\n  ],\n", f);
}

void gen_put_meshes(FILE *f, const gen_scene *s, const gen_model *model)
{
    enum { ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963 };
    put_materials(f, s);
    fputs("  \"meshes\": [", f);
    for (uint32_t i = 0; i < model->num_meshes; i++) {
        const uint32_t a = ACCESSORS * i;
        fprintf(f,
                "%s\n    { \"name\": \"%s\", \"primitives\": [ { \"attributes\": { \"POSITION\": "
                "%u, \"NORMAL\": %u, \"TEXCOORD_0\": %u }, \"indices\": %u, \"material\": %u } ] }",
                i ? "," : "", model->meshes[i].name, a, a + 1, a + 2, a + 3,
                model->meshes[i].material);
    }
    fputs("\n  ],\n", f);
    put_accessors(f, model);
    fputs("  \"bufferViews\": [", f);
    size_t offset = 0;
    for (uint32_t i = 0; i < ACCESSORS * model->num_meshes; i++) {
        const size_t size = size_of(&model->meshes[i / ACCESSORS], (int)(i % ACCESSORS));
        fprintf(
            f,
            "%s\n    { \"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu, \"target\": %d }",
            i ? "," : "", offset, size, i % ACCESSORS < 3 ? ARRAY_BUFFER : ELEMENT_ARRAY_BUFFER);
        offset += size;
    }
    fprintf(f, "\n  ],\n  \"buffers\": [ { \"uri\": \"%s.bin\", \"byteLength\": %zu } ],\n",
            s->name, offset);
}

// Little-endian; adding zero turns -0 into 0.
static uint8_t *store(uint8_t *out, uint32_t bits)
{
    for (int i = 0; i < 4; i++) {
        out[i] = (uint8_t)(bits >> (8 * i));
    }
    return out + 4;
}

static uint8_t *store_floats(uint8_t *out, const float *v, int n)
{
    for (int i = 0; i < n; i++) {
        const float value = v[i] + 0.0f;
        uint32_t bits;
        memcpy(&bits, &value, 4);
        out = store(out, bits);
    }
    return out;
}

bool gen_write_buffer(const char *folder, const char *name, const gen_model *model)
{
    const size_t size = total_size(model);
    uint8_t *bytes = malloc(size), *out = bytes;
    if (!bytes) {
        fprintf(stderr, "out of memory for the meshes of %s\n", name);
        exit(1);
    }
    for (uint32_t i = 0; i < model->num_meshes; i++) {
        const gen_mesh *mesh = &model->meshes[i];
        for (uint32_t v = 0; v < mesh->num_vertices; v++) {
            out = store_floats(out, mesh->vertices[v].position, 3);
        }
        for (uint32_t v = 0; v < mesh->num_vertices; v++) {
            out = store_floats(out, mesh->vertices[v].normal, 3);
        }
        for (uint32_t v = 0; v < mesh->num_vertices; v++) {
            out = store_floats(out, mesh->vertices[v].uv, 2);
        }
        for (uint32_t n = 0; n < mesh->num_indices; n++) {
            out = store(out, mesh->indices[n]);
        }
    }
    char file[256];
    snprintf(file, sizeof(file), "%s.bin", name);
    const bool ok = gen_write_bytes(folder, file, "", bytes, size);
    free(bytes);
    return ok;
}
