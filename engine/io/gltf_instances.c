// gltf_instances.c -- EXT_mesh_gpu_instancing: one mesh of a node in many places.
#include "io/gltf_instances.h"
#include "scene/matrix.h"
#include <stdlib.h>
#include <string.h>

void tyn_gltf_trs(double m[16], const double translation[3], const double q[4],
                  const double scale[3])
{
    double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    double x = q[0], y = q[1], z = q[2], w = q[3], s = 2.0 / n;
    const double r[9] = {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
                         s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
                         s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
    mat_identity(m);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 3; i++) {
            m[c * 4 + i] = r[c * 3 + i] * scale[c];
        }
        m[12 + c] = translation[c];
    }
}

// One of the attributes; all must have as many elements.
static tyn_result read_attribute(gltf_instances *instances, const gltf_data *data,
                                 const cJSON *attributes, const char *name, uint32_t components,
                                 gltf_floats *out)
{
    const cJSON *at = tyn_json_member(attributes, name);
    int64_t unused;
    if (!at) {
        return TYN_OK;
    }
    TYN_TRY(tyn_json_index(data->doc, at, data->model->lists[GLTF_ACCESSORS].count, "accessors",
                           &unused));
    TYN_TRY(tyn_gltf_read_floats(data, at, components, components, out));
    if (instances->count && instances->count != out->count) {
        return tyn_json_fault(data->doc, at, "has %u elements, the one before has %u", out->count,
                              instances->count);
    }
    instances->count = out->count;
    return TYN_OK;
}

tyn_result tyn_gltf_instances_read(gltf_instances *instances, const gltf_data *data,
                                   const cJSON *node)
{
    cJSON *instancing, *attributes;
    *instances = (gltf_instances){0};
    TYN_TRY(tyn_json_extension(data->doc, node, "EXT_mesh_gpu_instancing", &instancing));
    TYN_TRY(tyn_json_object(data->doc, instancing, "attributes", &attributes));
    tyn_result r =
        read_attribute(instances, data, attributes, "TRANSLATION", 3, &instances->translations);
    r = r ? r : read_attribute(instances, data, attributes, "ROTATION", 4, &instances->rotations);
    r = r ? r : read_attribute(instances, data, attributes, "SCALE", 3, &instances->scales);
    const float *q = instances->rotations.values;
    for (uint32_t i = 0; !r && i < instances->rotations.count; i++, q += 4) {
        if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 1e-6f)) {
            r = tyn_json_fault(data->doc, tyn_json_member(attributes, "ROTATION"),
                               "element %u is no rotation: a quaternion of length 0", i);
        }
    }
    if (r) {
        tyn_gltf_instances_finish(instances);
    }
    return r;
}

void tyn_gltf_instances_finish(gltf_instances *instances)
{
    free(instances->translations.values);
    free(instances->rotations.values);
    free(instances->scales.values);
    *instances = (gltf_instances){0};
}

void tyn_gltf_instance_matrix(const gltf_instances *instances, uint32_t i, double m[16])
{
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    const struct {
        const gltf_floats *from;
        double *to;
    } parts[] = {
        {&instances->translations, t}, {&instances->rotations, q}, {&instances->scales, s}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const gltf_floats *f = parts[k].from;
        for (uint32_t c = 0; f->count && c < f->components; c++) {
            parts[k].to[c] = (double)f->values[(size_t)i * f->components + c];
        }
    }
    tyn_gltf_trs(m, t, q, s);
}
