// gltf_accessor.c -- values of accessors as floats or indices.
#include "io/gltf_accessor.h"
#include "base/bytes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Elements of an accessor, and of one without a buffer view: all zeros, a file of a few bytes can ask for any number.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
enum { MAX_ELEMENTS = 1 << 16, MAX_ZEROS = 1 << 12 };
#else
enum { MAX_ELEMENTS = 1 << 27, MAX_ZEROS = 1 << 22 };
#endif

enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };

// ---- bytes ------------------------------------------------------------------------------------

const uint8_t *tyn_gltf_view_bytes(const gltf_data *data, int64_t view, size_t *size)
{
    const gltf_view *v = &data->model->views[view];
    *size = (size_t)v->length;
    return data->model->buffers[v->buffer].data + v->offset;
}

// NULL: all are zero.
static const uint8_t *bytes_of(const gltf_data *data, const gltf_elements *elements)
{
    size_t size;
    return elements->view < 0 ? NULL
                              : tyn_gltf_view_bytes(data, elements->view, &size) + elements->offset;
}

// ---- components -------------------------------------------------------------------------------

static uint32_t component_size(int64_t type)
{
    return type <= UBYTE ? 1 : type <= USHORT ? 2 : 4;
}

static double load(const uint8_t *p, int64_t type)
{
    const uint32_t bits = (uint32_t)tyn_load(p, (int)component_size(type));
    float value;
    memcpy(&value, &bits, sizeof value);
    return type == BYTE    ? (int8_t)bits
           : type == SHORT ? (int16_t)bits
           : type == FLOAT ? value
                           : bits;
}

static float load_float(const uint8_t *p, int64_t type, bool normalized)
{
    static const double largest[] = {127, 255, 32767, 65535};
    double value = load(p, type);
    return (float)(normalized && type <= USHORT ? fmax(value / largest[type - BYTE], -1) : value);
}

// ---- accessors --------------------------------------------------------------------------------

static tyn_result find_accessor(const gltf_data *data, const cJSON *at, const gltf_accessor **out)
{
    const int64_t index = (int64_t)at->valuedouble;
    const gltf_accessor *a = *out = &data->model->accessors[index];
    const bool zeros = a->elements.view < 0;
    const int64_t most = zeros ? MAX_ZEROS : MAX_ELEMENTS;
    return a->count <= most
               ? TYN_OK
               : tyn_json_fault(
                     data->doc,
                     tyn_json_member(data->model->lists[GLTF_ACCESSORS].items[index], "count"),
                     "at most %lld elements%s are read", (long long)most,
                     zeros ? " without a bufferView" : "");
}

// All elements, then those that are replaced, in order; `at` names the accessor.
typedef void (*put_fn)(void *user, uint32_t index, const uint8_t *bytes);
static tyn_result read_elements(const gltf_data *data, const cJSON *at, const gltf_accessor *a,
                                put_fn put, void *user)
{
    const cJSON *json = data->model->lists[GLTF_ACCESSORS].items[(int64_t)at->valuedouble];
    const uint8_t *from = bytes_of(data, &a->elements);
    for (int64_t i = 0; from && i < a->count; i++) {
        put(user, (uint32_t)i, from + i * a->elements.stride);
    }
    for (int64_t i = 0; i < a->num_sparse; i++) {
        const uint32_t index =
            (uint32_t)load(bytes_of(data, &a->indices) + i * a->indices.stride, a->index_type);
        if (index >= a->count) {
            return tyn_json_fault(data->doc, tyn_json_member(json, "sparse"),
                                  "index %lld is %u: the accessor has %u elements", (long long)i,
                                  index, (uint32_t)a->count);
        }
        put(user, index, bytes_of(data, &a->values) + i * a->values.stride);
    }
    return TYN_OK;
}

typedef struct float_target {
    const gltf_accessor *a;
    float *values;
} float_target;

static void put_floats(void *user, uint32_t index, const uint8_t *bytes)
{
    const float_target *t = user;
    for (uint32_t c = 0; c < t->a->components; c++) {
        t->values[(size_t)index * t->a->components + c] = load_float(
            bytes + (size_t)c * component_size(t->a->type), t->a->type, t->a->normalized);
    }
}

static tyn_result check_finite(const gltf_data *data, const cJSON *at, const gltf_floats *f)
{
    for (size_t i = 0; i < (size_t)f->count * f->components; i++) {
        if (!isfinite(f->values[i])) {
            return tyn_json_fault(data->doc, at, "element %zu of its accessor is not finite",
                                  i / f->components);
        }
    }
    return TYN_OK;
}

tyn_result tyn_gltf_read_floats(const gltf_data *data, const cJSON *at, uint32_t least,
                                uint32_t most, gltf_floats *out)
{
    const gltf_accessor *a;
    *out = (gltf_floats){0};
    TYN_TRY(find_accessor(data, at, &a));
    if (a->components < least || a->components > most || a->type == UINT) {
        if (most == 1) {
            return tyn_json_fault(data->doc, at,
                                  "its accessor must be of type SCALAR, of floats, "
                                  "bytes or shorts");
        }
        return tyn_json_fault(data->doc, at,
                              "its accessor must be of type VEC%u%s, of floats, bytes or shorts",
                              least, most > least ? " or VEC4" : "");
    }
    *out = (gltf_floats){calloc((size_t)a->count * a->components, sizeof(float)),
                         (uint32_t)a->count, a->components};
    float_target target = {a, out->values};
    tyn_result r = out->values ? read_elements(data, at, a, put_floats, &target)
                               : tyn_json_fault(data->doc, at, "no memory for %u elements",
                                                (uint32_t)a->count);
    r = r ? r : check_finite(data, at, out);
    if (r) {
        free(out->values);
        *out = (gltf_floats){0};
    }
    return r;
}

typedef struct index_target {
    int64_t type;
    uint32_t *indices;
} index_target;

static void put_index(void *user, uint32_t index, const uint8_t *bytes)
{
    const index_target *t = user;
    t->indices[index] = (uint32_t)load(bytes, t->type);
}

tyn_result tyn_gltf_read_indices(const gltf_data *data, const cJSON *at, uint32_t limit,
                                 uint32_t **out, uint32_t *count)
{
    const gltf_accessor *a;
    TYN_TRY(find_accessor(data, at, &a));
    if (a->components != 1 || (a->type != UBYTE && a->type != USHORT && a->type != UINT)) {
        return tyn_json_fault(
            data->doc, at,
            "its accessor must be of type SCALAR, of unsigned bytes, shorts or ints");
    }
    index_target target = {a->type, calloc((uint32_t)a->count, sizeof(uint32_t))};
    tyn_result r = target.indices ? read_elements(data, at, a, put_index, &target)
                                  : tyn_json_fault(data->doc, at, "no memory for %u indices",
                                                   (uint32_t)a->count);
    for (uint32_t i = 0; !r && i < a->count; i++) {
        if (target.indices[i] >= limit) {
            r = tyn_json_fault(data->doc, at, "index %u is %u: there are %u vertices", i,
                               target.indices[i], limit);
        }
    }
    if (r) {
        free(target.indices);
        return r;
    }
    *out = target.indices;
    *count = (uint32_t)a->count;
    return TYN_OK;
}
