// gltf.c -- writes a scene description as glTF 2.0 with Tyndall's two extensions.
#include "gltf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "portable.h"

static void cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

void gen_put_floats(FILE *f, const float *v, int n)
{
    fputc('[', f);
    for (int i = 0; i < n; i++) {
        // Adding zero turns -0 into 0.
        fprintf(f, "%s%.9g", i ? ", " : "", (double)(v[i] + 0.0f));
    }
    fputc(']', f);
}

// The matrix of a node at `position` whose -Z axis points along `forward`.
static void put_aim(FILE *f, const float position[3], const float forward[3], const float up[3])
{
    float ahead[3], right[3], above[3];
    memcpy(ahead, forward, sizeof(ahead));
    normalize(ahead);
    cross(ahead, up, right);
    if (right[0] * right[0] + right[1] * right[1] + right[2] * right[2] < 1e-6f) {
        cross(ahead, (const float[3]){0, 0, -1}, right);
    }
    normalize(right);
    cross(right, ahead, above);
    const float m[16] = {right[0],    right[1],    right[2],    0,         above[0],  above[1],
                         above[2],    0,           -ahead[0],   -ahead[1], -ahead[2], 0,
                         position[0], position[1], position[2], 1};
    fputs("\"matrix\": ", f);
    gen_put_floats(f, m, 16);
}

static void put_media(FILE *f, const gen_scene *s)
{
    fputs("    \"TYN_participating_media\": { \"media\": [", f);
    for (int i = 0; i < GEN_MAX && s->media[i].name; i++) {
        const gen_medium *m = &s->media[i];
        fprintf(f, "%s\n      { \"name\": \"%s\", \"scattering\": ", i ? "," : "", m->name);
        gen_put_floats(f, m->scattering, 3);
        fputs(", \"absorption\": ", f);
        gen_put_floats(f, m->absorption, 3);
        fprintf(f, ",\n        \"anisotropy\": %.9g", (double)m->anisotropy);
        if (m->density.uri) {
            const gen_volume *v = &m->density;
            fprintf(f,
                    ",\n        \"density\": { \"uri\": \"%s\", \"size\": [%u, %u, %u], "
                    "\"type\": \"%s\" }",
                    v->uri, v->size[0], v->size[1], v->size[2], v->type);
        }
        fputs(" }", f);
    }
    fputs("\n    ] }", f);
}

// Suns first, then lamps.
static void put_lights(FILE *f, const gen_scene *s, const gen_model *model)
{
    const char *comma = "";
    fputs("    \"KHR_lights_punctual\": { \"lights\": [", f);
    for (int i = 0; i < GEN_MAX && s->suns[i].irradiance > 0; i++, comma = ",") {
        const gen_sun *sun = &s->suns[i];
        const bool white = sun->color[0] + sun->color[1] + sun->color[2] <= 0;
        fprintf(f, "%s\n      { \"type\": \"directional\", \"intensity\": %.9g, \"color\": ", comma,
                (double)sun->irradiance);
        gen_put_floats(f, white ? (const float[3]){1, 1, 1} : sun->color, 3);
        fputs(" }", f);
    }
    for (uint32_t i = 0; i < model->num_lamps; i++, comma = ",") {
        const gen_lamp *lamp = &model->lamps[i];
        fprintf(f, "%s\n      { \"type\": \"%s\", \"intensity\": %.9g, \"color\": ", comma,
                lamp->outer > 0 ? "spot" : "point", (double)lamp->intensity);
        gen_put_floats(f, lamp->color, 3);
        if (lamp->outer > 0) {
            fprintf(f, ", \"spot\": { \"innerConeAngle\": %.9g, \"outerConeAngle\": %.9g }",
                    (double)lamp->inner, (double)lamp->outer);
        }
        fputs(" }", f);
    }
    fputs("\n    ] }", f);
}

static bool has_strong_emission(const gen_scene *s)
{
    for (int i = 0; i < GEN_MAX_MATERIALS && s->materials[i].name; i++) {
        const float *e = s->materials[i].emission;
        if (e[0] > 0 || e[1] > 0 || e[2] > 0) {
            return true;
        }
    }
    return false;
}

static void put_root_extensions(FILE *f, const gen_scene *s, const gen_model *model)
{
    const bool lights = s->suns[0].irradiance > 0 || model->num_lamps > 0;
    const char *comma = "";
    fputs("  \"extensionsUsed\": [", f);
    if (s->media[0].name) {
        fputs("\"TYN_participating_media\"", f);
        comma = ", ";
    }
    if (lights) {
        fprintf(f, "%s\"KHR_lights_punctual\"", comma);
        comma = ", ";
    }
    if (has_strong_emission(s)) {
        fprintf(f, "%s\"KHR_materials_emissive_strength\"", comma);
        comma = ", ";
    }
    if (s->environment) {
        fprintf(f, "%s\"TYN_environment_map\"", comma);
    }
    fputs("],\n  \"extensions\": {\n", f);
    comma = "";
    if (s->media[0].name) {
        put_media(f, s);
        comma = ",\n";
    }
    if (lights) {
        fputs(comma, f);
        put_lights(f, s, model);
        comma = ",\n";
    }
    if (s->environment) {
        fprintf(f, "%s    \"TYN_environment_map\": { \"environments\": [ { ", comma);
        if (s->environment_uri) {
            fprintf(f, "\"uri\": \"%s\", ", s->environment_uri);
        }
        fputs("\"radiance\": ", f);
        gen_put_floats(f, s->environment_radiance, 3);
        fputs(" } ] }", f);
    }
    fputs("\n  },\n", f);
}

static void put_shape(FILE *f, const gen_shape *shape)
{
    fprintf(f, "    { \"name\": \"%s\", \"translation\": ", shape->name);
    gen_put_floats(f, shape->translation, 3);
    const float *q = shape->rotation;
    if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 0) {
        fputs(", \"rotation\": ", f);
        gen_put_floats(f, q, 4);
    }
    fputs(", \"scale\": ", f);
    gen_put_floats(f, shape->scale, 3);
    fprintf(f,
            ",\n      \"extensions\": { \"TYN_participating_media\": { \"medium\": %u, "
            "\"shape\": \"%s\"",
            shape->medium, shape->sphere ? "sphere" : "box");
    if (shape->repeat[0] || shape->repeat[1] || shape->repeat[2]) {
        fprintf(f, ", \"repeat\": [%s, %s, %s]", shape->repeat[0] ? "true" : "false",
                shape->repeat[1] ? "true" : "false", shape->repeat[2] ? "true" : "false");
    }
    fputs(" } } }", f);
}

static void put_light_of_node(FILE *f, uint32_t light)
{
    fprintf(f, ",\n      \"extensions\": { \"KHR_lights_punctual\": { \"light\": %u } } }", light);
}

static void put_part(FILE *f, const gen_model *model, const gen_part *part)
{
    fprintf(f, "    { \"name\": \"%s\", \"mesh\": %u", model->meshes[part->mesh].name, part->mesh);
    const float *t = part->translation;
    if (t[0] != 0 || t[1] != 0 || t[2] != 0) {
        fputs(", \"translation\": ", f);
        gen_put_floats(f, t, 3);
    }
    if (part->turn != 0) {
        const double half = 0.5 * (double)part->turn;
        fputs(", \"rotation\": ", f);
        gen_put_floats(f, (const float[4]){0, (float)gen_sin(half), 0, (float)gen_cos(half)}, 4);
    }
    if (part->scale != 1) {
        fputs(", \"scale\": ", f);
        gen_put_floats(f, (const float[3]){part->scale, part->scale, part->scale}, 3);
    }
    fputs(" }", f);
}

static uint32_t put_nodes(FILE *f, const gen_scene *s, const gen_model *model)
{
    uint32_t n = 0;
    fputs("  \"nodes\": [", f);
    for (int i = 0; i < GEN_MAX && s->shapes[i].name; i++) {
        fputs(n++ ? ",\n" : "\n", f);
        put_shape(f, &s->shapes[i]);
    }
    for (uint32_t i = 0; i < model->num_parts; i++) {
        fputs(n++ ? ",\n" : "\n", f);
        put_part(f, model, &model->parts[i]);
    }
    uint32_t light = 0;
    for (int i = 0; i < GEN_MAX && s->suns[i].irradiance > 0; i++) {
        fprintf(f, "%s    { \"name\": \"sun%d\", ", n++ ? ",\n" : "\n", i);
        put_aim(f, (const float[3]){0}, s->suns[i].direction, (const float[3]){0, 1, 0});
        put_light_of_node(f, light++);
    }
    for (uint32_t i = 0; i < model->num_lamps; i++) {
        const gen_lamp *lamp = &model->lamps[i];
        fprintf(f, "%s    { \"name\": \"lamp%u\", ", n++ ? ",\n" : "\n", i);
        put_aim(f, lamp->position, lamp->outer > 0 ? lamp->direction : (const float[3]){0, 0, -1},
                (const float[3]){0, 1, 0});
        put_light_of_node(f, light++);
    }
    for (int i = 0; i <= GEN_MAX && s->cameras[i].name; i++) {
        const gen_camera *c = &s->cameras[i];
        const float ahead[3] = {c->at[0] - c->from[0], c->at[1] - c->from[1],
                                c->at[2] - c->from[2]};
        const bool has_up = c->up[0] * c->up[0] + c->up[1] * c->up[1] + c->up[2] * c->up[2] > 0;
        fprintf(f, "%s    { \"name\": \"%s\", \"camera\": %d, ", n++ ? ",\n" : "\n", c->name, i);
        put_aim(f, c->from, ahead, has_up ? c->up : (const float[3]){0, 1, 0});
        fputs(" }", f);
    }
    fputs("\n  ]", f);
    return n;
}

static void put_cameras(FILE *f, const gen_scene *s)
{
    fputs("  \"cameras\": [", f);
    for (int i = 0; i <= GEN_MAX && s->cameras[i].name; i++) {
        const gen_camera *c = &s->cameras[i];
        fprintf(f, "%s\n    { \"name\": \"%s\", ", i ? "," : "", c->name);
        if (c->yfov > 0) {
            fprintf(f,
                    "\"type\": \"perspective\", \"perspective\": { \"aspectRatio\": 1, "
                    "\"yfov\": %.9g, \"znear\": 0.01 } }",
                    (double)c->yfov);
        } else {
            fprintf(f,
                    "\"type\": \"orthographic\", \"orthographic\": { \"xmag\": %.9g, "
                    "\"ymag\": %.9g, \"znear\": 0, \"zfar\": 100 } }",
                    (double)c->ymag, (double)c->ymag);
        }
    }
    fputs("\n  ]", f);
}

static bool write_scene(const char *folder, const gen_scene *s, const gen_model *model)
{
    char path[4096];
    snprintf(path, sizeof(path), "%s/%s.gltf", folder, s->name);
    FILE *f = fopen(path, "wb");
    if (!f) {
        fprintf(stderr, "%s: cannot be written\n", path);
        return false;
    }
    fprintf(f,
            "{\n  \"asset\": { \"version\": \"2.0\", \"generator\": \"tyndall-scenes\", "
            "\"extras\": { \"about\": \"%s\" } },\n",
            s->about);
    put_root_extensions(f, s, model);
    if (model->num_meshes > 0) {
        gen_put_meshes(f, s, model);
    }
    put_cameras(f, s);
    fputs(",\n", f);
    const uint32_t nodes = put_nodes(f, s, model);
    fprintf(f, ",\n  \"scene\": 0,\n  \"scenes\": [ { \"name\": \"%s\", \"nodes\": [", s->name);
    for (uint32_t i = 0; i < nodes; i++) {
        fprintf(f, "%s%u", i ? ", " : "", i);
    }
    fputs("]", f);
    if (s->environment) {
        fputs(",\n    \"extensions\": { \"TYN_environment_map\": { \"environment\": 0 } }", f);
    }
    fputs(" } ]\n}\n", f);
    const bool ok = !ferror(f);
    if (fclose(f) != 0 || !ok) {
        fprintf(stderr, "%s: cannot be written (is the disk full?)\n", path);
        return false;
    }
    return true;
}

bool gen_write_gltf(const char *folder, const gen_scene *s)
{
    gen_model model = {0};
    if (s->build) {
        s->build(&model);
    }
    const bool ok = write_scene(folder, s, &model) &&
                    (model.num_meshes == 0 || gen_write_buffer(folder, s->name, &model));
    gen_model_free(&model);
    return ok;
}
