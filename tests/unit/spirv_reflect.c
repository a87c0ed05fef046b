// spirv_reflect.c -- a small SPIR-V reader: one pass that indexes ids and decorations, then questions.
#include "spirv_reflect.h"
#include <spirv/unified1/spirv.h>
#include <stdlib.h>
#include <string.h>

typedef struct module {
    const uint32_t *words;
    size_t count;
    uint32_t bound;
    const uint32_t **def; // instruction that defines an id; NULL = none
} module;

// Index of the id that an instruction defines, 0 if it defines none (of those we look at).
static uint32_t result_index(SpvOp op)
{
    switch (op) {
    case SpvOpTypeVoid:
    case SpvOpTypeBool:
    case SpvOpTypeInt:
    case SpvOpTypeFloat:
    case SpvOpTypeVector:
    case SpvOpTypeMatrix:
    case SpvOpTypeImage:
    case SpvOpTypeSampler:
    case SpvOpTypeSampledImage:
    case SpvOpTypeArray:
    case SpvOpTypeRuntimeArray:
    case SpvOpTypeStruct:
    case SpvOpTypePointer:
        return 1;
    case SpvOpConstant:
    case SpvOpConstantTrue:
    case SpvOpConstantFalse:
    case SpvOpSpecConstant:
    case SpvOpSpecConstantTrue:
    case SpvOpSpecConstantFalse:
    case SpvOpConstantComposite:
    case SpvOpSpecConstantComposite:
    case SpvOpVariable:
        return 2;
    default:
        return 0;
    }
}

static const uint32_t *next(const module *m, const uint32_t *at)
{
    return at ? at + (*at >> SpvWordCountShift) : m->words + 5;
}

static bool more(const module *m, const uint32_t *at)
{
    return at < m->words + m->count;
}

static SpvOp op_of(const uint32_t *at)
{
    return (SpvOp)(*at & SpvOpCodeMask);
}

// First literal of a decoration of an id, or of a member of a struct (member >= 0); NULL = not there.
static const uint32_t *decoration(const module *m, uint32_t id, int member, SpvDecoration which)
{
    static const uint32_t present = 0;
    for (const uint32_t *at = next(m, NULL); more(m, at); at = next(m, at)) {
        uint32_t length = *at >> SpvWordCountShift;
        if (member < 0 && op_of(at) == SpvOpDecorate && at[1] == id && at[2] == which) {
            return length > 3 ? at + 3 : &present;
        }
        if (member >= 0 && op_of(at) == SpvOpMemberDecorate && at[1] == id &&
            at[2] == (uint32_t)member && at[3] == which) {
            return length > 4 ? at + 4 : &present;
        }
    }
    return NULL;
}

static uint32_t constant(const module *m, uint32_t id)
{
    return m->def[id] ? m->def[id][3] : 0;
}

// Bytes of a type: explicit layout where it is decorated (blocks), tightly packed else (shared memory).
static uint32_t type_bytes(const module *m, uint32_t id)
{
    const uint32_t *t = m->def[id];
    const uint32_t *stride;
    uint32_t end = 0;
    switch (op_of(t)) {
    case SpvOpTypeBool:
        return 4;
    case SpvOpTypeInt:
    case SpvOpTypeFloat:
        return t[2] / 8;
    case SpvOpTypeVector:
    case SpvOpTypeMatrix:
        return t[3] * type_bytes(m, t[2]);
    case SpvOpTypeArray:
        stride = decoration(m, id, -1, SpvDecorationArrayStride);
        return constant(m, t[3]) * (stride ? *stride : type_bytes(m, t[2]));
    case SpvOpTypeStruct:
        for (uint32_t i = 0; i + 2 < *t >> SpvWordCountShift; i++) {
            const uint32_t *offset = decoration(m, id, (int)i, SpvDecorationOffset);
            uint32_t bytes = type_bytes(m, t[2 + i]);
            end = offset ? (*offset + bytes > end ? *offset + bytes : end) : end + bytes;
        }
        return end;
    default:
        return 0;
    }
}

// A decoration that buffers carry on every member and images on the variable.
static bool access_decorated(const module *m, uint32_t var, uint32_t type, SpvDecoration which)
{
    if (decoration(m, var, -1, which)) {
        return true;
    }
    const uint32_t *t = m->def[type];
    if (op_of(t) != SpvOpTypeStruct) {
        return false;
    }
    uint32_t members = (*t >> SpvWordCountShift) - 2;
    for (uint32_t i = 0; i < members; i++) {
        if (!decoration(m, type, (int)i, which)) {
            return false;
        }
    }
    return members > 0;
}

static void add_binding(const module *m, const uint32_t *var, uint32_t type, uint32_t binding,
                        reflect_shader *out)
{
    if (out->num_bindings == REFLECT_MAX_BINDINGS) {
        return;
    }
    reflect_binding *b = &out->bindings[out->num_bindings++];
    const uint32_t *set = decoration(m, var[2], -1, SpvDecorationDescriptorSet);
    *b = (reflect_binding){.set = set ? *set : 0, .binding = binding};
    const uint32_t *t = m->def[type], *image = NULL;
    if (op_of(t) == SpvOpTypeSampledImage) {
        b->kind = REFLECT_SAMPLED_IMAGE;
        image = m->def[t[2]];
    } else if (op_of(t) == SpvOpTypeImage && t[7] == 2) {
        b->kind = REFLECT_STORAGE_IMAGE;
        image = t;
    } else if (op_of(t) == SpvOpTypeImage && t[7] == 1 && t[3] == SpvDimBuffer) {
        b->kind = REFLECT_TEXELS;
        image = t;
    } else if (op_of(t) == SpvOpTypeStruct) {
        b->kind = var[3] == SpvStorageClassStorageBuffer ? REFLECT_STORAGE_BUFFER
                                                         : REFLECT_UNIFORM_BUFFER;
    }
    if (image) {
        b->dim = image[3];
        b->arrayed = image[5];
        b->multisampled = image[6];
        b->format = image[8];
        b->float_texels = op_of(m->def[image[2]]) == SpvOpTypeFloat;
    }
    b->non_writable = access_decorated(m, var[2], type, SpvDecorationNonWritable);
    b->non_readable = access_decorated(m, var[2], type, SpvDecorationNonReadable);
}

static void variable(const module *m, const uint32_t *var, reflect_shader *out)
{
    uint32_t type = m->def[var[1]][3]; // what the pointer points to
    const uint32_t *binding, *location = decoration(m, var[2], -1, SpvDecorationLocation);
    switch (var[3]) {
    case SpvStorageClassInput:
        out->inputs |= location ? 1u << *location : 0;
        break;
    case SpvStorageClassOutput:
        out->outputs |= location ? 1u << *location : 0;
        break;
    case SpvStorageClassPushConstant:
        out->push_constant_bytes = type_bytes(m, type);
        break;
    case SpvStorageClassWorkgroup:
        out->shared_bytes += type_bytes(m, type);
        break;
    case SpvStorageClassUniformConstant:
    case SpvStorageClassUniform:
    case SpvStorageClassStorageBuffer:
        binding = decoration(m, var[2], -1, SpvDecorationBinding);
        add_binding(m, var, type, binding ? *binding : UINT32_MAX, out);
        break;
    default:
        break;
    }
}

static void spec_constant(const module *m, const uint32_t *at, reflect_shader *out)
{
    const uint32_t *id = decoration(m, at[2], -1, SpvDecorationSpecId);
    if (!id) {
        return;
    }
    if (*id < 32 && type_bytes(m, at[1]) == 4) {
        out->spec_ids |= 1u << *id;
    } else {
        out->spec_wide = true;
    }
}

static void read_interface(const module *m, reflect_shader *out)
{
    for (const uint32_t *at = next(m, NULL); more(m, at); at = next(m, at)) {
        switch (op_of(at)) {
        case SpvOpCapability:
            if (out->num_capabilities < REFLECT_MAX_CAPABILITIES) {
                out->capabilities[out->num_capabilities++] = at[1];
            }
            break;
        case SpvOpEntryPoint:
            out->num_entry_points++;
            out->compute = at[1] == SpvExecutionModelGLCompute;
            out->vertex = at[1] == SpvExecutionModelVertex;
            out->fragment = at[1] == SpvExecutionModelFragment;
            out->named_main = strcmp((const char *)(at + 3), "main") == 0;
            break;
        case SpvOpExecutionMode:
            if (at[2] == SpvExecutionModeLocalSize) {
                memcpy(out->local_size, at + 3, sizeof out->local_size);
            }
            break;
        case SpvOpExecutionModeId:
            if (at[2] == SpvExecutionModeLocalSizeId) {
                for (int i = 0; i < 3; i++) {
                    out->local_size[i] = constant(m, at[3 + i]);
                }
            }
            break;
        case SpvOpSpecConstant:
        case SpvOpSpecConstantTrue:
        case SpvOpSpecConstantFalse:
            spec_constant(m, at, out);
            break;
        case SpvOpVariable:
            variable(m, at, out);
            break;
        default:
            break;
        }
    }
}

bool reflect(const uint32_t *words, size_t bytes, reflect_shader *out, const char **why)
{
    *out = (reflect_shader){0};
    *why = "not SPIR-V";
    if (!words || bytes < 20 || bytes % 4 != 0 || words[0] != SpvMagicNumber) {
        return false;
    }
    module m = {.words = words, .count = bytes / 4, .bound = words[3]};
    for (const uint32_t *at = next(&m, NULL); more(&m, at); at = next(&m, at)) {
        uint32_t length = *at >> SpvWordCountShift;
        if (length == 0 || length > (size_t)(words + m.count - at)) {
            *why = "an instruction is longer than the module";
            return false;
        }
    }
    m.def = calloc(m.bound, sizeof *m.def);
    if (!m.def) {
        *why = "out of memory";
        return false;
    }
    for (const uint32_t *at = next(&m, NULL); more(&m, at); at = next(&m, at)) {
        uint32_t index = result_index(op_of(at));
        if (index && at[index] < m.bound) {
            m.def[at[index]] = at;
        }
    }
    read_interface(&m, out);
    free(m.def);
    return true;
}
