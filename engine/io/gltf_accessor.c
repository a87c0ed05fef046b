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

uint64_t tyn_gltf_view_size(const gltf_data *data, int64_t view)
{
    return (uint64_t)tyn_json_whole(data->model->lists[GLTF_BUFFER_VIEWS].items[view], "byteLength",
                                    0);
}

const uint8_t *tyn_gltf_view_bytes(const gltf_data *data, int64_t view, uint64_t offset,
                                   uint64_t size)
{
    const cJSON *v = data->model->lists[GLTF_BUFFER_VIEWS].items[view];
    const int64_t buffer = tyn_json_whole(v, "buffer", 0);
    const gltf_buffer *bytes = &data->model->buffers[buffer];
    const uint64_t start = (uint64_t)tyn_json_whole(v, "byteOffset", 0) + offset;
    return start <= bytes->size && size <= bytes->size - start ? bytes->data + start : NULL;
}

// `count` elements of `size` bytes, `stride` apart, of the view that `at` names. False after a fault.
typedef struct elements {
    const uint8_t *bytes; // NULL: all are zero
    uint64_t stride;
} elements;
static tyn_result find_elements(const gltf_data *data, const cJSON *at, uint64_t count,
                                uint64_t size, elements *out)
{
    const int64_t view = tyn_json_whole(at, "bufferView", -1);
    *out = (elements){NULL, size};
    if (view < 0) {
        return TYN_OK;
    }
    out->stride = (uint64_t)tyn_json_whole(data->model->lists[GLTF_BUFFER_VIEWS].items[view],
                                           "byteStride", (int64_t)size);
    out->bytes = tyn_gltf_view_bytes(data, view, (uint64_t)tyn_json_whole(at, "byteOffset", 0),
                                     out->stride * (count - 1) + size);
    return out->bytes ? TYN_OK : tyn_json_fault(data->doc, at, "reaches beyond its buffer");
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

typedef struct accessor {
    const cJSON *json;
    int64_t type; // of its components
    uint32_t count, components;
    bool normalized;
} accessor;

static tyn_result find_accessor(const gltf_data *data, const cJSON *at, accessor *a)
{
    static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const cJSON *json = data->model->lists[GLTF_ACCESSORS].items[(int64_t)at->valuedouble];
    const int64_t count = tyn_json_whole(json, "count", 0);
    *a = (accessor){.json = json,
                    .type = tyn_json_whole(json, "componentType", FLOAT),
                    .normalized = cJSON_IsTrue(tyn_json_member(json, "normalized"))};
    for (uint32_t i = 0; i < 4; i++) {
        if (strcmp(types[i], tyn_json_member(json, "type")->valuestring) == 0) {
            a->components = i + 1;
        }
    }
    const bool zeros = !tyn_json_member(json, "bufferView");
    const int64_t most = zeros ? MAX_ZEROS : MAX_ELEMENTS;
    if (count > most) {
        return tyn_json_fault(data->doc, tyn_json_member(json, "count"),
                              "at most %lld elements%s are read", (long long)most,
                              zeros ? " without a bufferView" : "");
    }
    a->count = (uint32_t)count;
    return TYN_OK;
}

// Where element i is replaced: for every sparse index, in order, calls put.
typedef void (*put_fn)(void *user, uint32_t index, const uint8_t *bytes);
static tyn_result read_sparse(const gltf_data *data, const accessor *a, put_fn put, void *user)
{
    const cJSON *sparse = tyn_json_member(a->json, "sparse");
    if (!sparse) {
        return TYN_OK;
    }
    const cJSON *indices = tyn_json_member(sparse, "indices");
    const int64_t count = tyn_json_whole(sparse, "count", 0),
                  type = tyn_json_whole(indices, "componentType", UINT);
    elements at, values;
    tyn_result r = find_elements(data, indices, (uint64_t)count, component_size(type), &at);
    r = r ? r
          : find_elements(data, tyn_json_member(sparse, "values"), (uint64_t)count,
                          (uint64_t)a->components * component_size(a->type), &values);
    for (int64_t i = 0; !r && i < count; i++) {
        const uint32_t index = (uint32_t)load(at.bytes + (uint64_t)i * at.stride, type);
        if (index >= a->count) {
            return tyn_json_fault(data->doc, sparse,
                                  "index %lld is %u: the accessor has %u elements", (long long)i,
                                  index, a->count);
        }
        put(user, index, values.bytes + (uint64_t)i * values.stride);
    }
    return r;
}

// All elements, then those that are replaced.
static tyn_result read_elements(const gltf_data *data, const accessor *a, put_fn put, void *user)
{
    elements from;
    TYN_TRY(find_elements(data, a->json, a->count,
                          (uint64_t)a->components * component_size(a->type), &from));
    for (uint32_t i = 0; from.bytes && i < a->count; i++) {
        put(user, i, from.bytes + i * from.stride);
    }
    return read_sparse(data, a, put, user);
}

typedef struct float_target {
    const accessor *a;
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
    accessor a;
    *out = (gltf_floats){0};
    TYN_TRY(find_accessor(data, at, &a));
    if (a.components < least || a.components > most || a.type == UINT) {
        if (most == 1) {
            return tyn_json_fault(data->doc, at,
                                  "its accessor must be of type SCALAR, of floats, "
                                  "bytes or shorts");
        }
        return tyn_json_fault(data->doc, at,
                              "its accessor must be of type VEC%u%s, of floats, bytes or shorts",
                              least, most > least ? " or VEC4" : "");
    }
    *out =
        (gltf_floats){calloc((size_t)a.count * a.components, sizeof(float)), a.count, a.components};
    float_target target = {&a, out->values};
    tyn_result r = out->values
                       ? read_elements(data, &a, put_floats, &target)
                       : tyn_json_fault(data->doc, at, "no memory for %u elements", a.count);
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
    accessor a;
    TYN_TRY(find_accessor(data, at, &a));
    if (a.components != 1 || (a.type != UBYTE && a.type != USHORT && a.type != UINT)) {
        return tyn_json_fault(
            data->doc, at,
            "its accessor must be of type SCALAR, of unsigned bytes, shorts or ints");
    }
    index_target target = {a.type, calloc(a.count, sizeof(uint32_t))};
    tyn_result r = target.indices
                       ? read_elements(data, &a, put_index, &target)
                       : tyn_json_fault(data->doc, at, "no memory for %u indices", a.count);
    for (uint32_t i = 0; !r && i < a.count; i++) {
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
    *count = a.count;
    return TYN_OK;
}
