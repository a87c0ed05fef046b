// rounding.c -- see rounding.h. Instructions: SPIR-V 1.6, section 3; all that is added is straight-line code before or after one.
#include "rounding.h"
#include <stdlib.h>
#include <string.h>
#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.h>

extern inline void SpvHasResultAndType(SpvOp op, bool *has_result, bool *has_type);

enum { HEADER = 5, BOUND = 3, MOST_ADDED = 64 }; // words that one instruction gains

typedef struct words {
    uint32_t *items;
    size_t count, room;
    bool failed;
} words;

// What is needed of an id.
typedef struct id_info {
    uint32_t type;      // of a value
    uint32_t at;        // of a value: its instruction
    uint32_t component; // of a vector type; itself of a scalar type
    uint32_t num;       // of a vector type; 1 of a scalar one; 0: neither
    uint32_t image;     // of a sampled image's type
    bool real;          // float, 32 bits
    bool exact;         // decorated NoContraction
    uint32_t built_in;  // 1 + its number, of a variable
} id_info;

typedef struct module {
    const rounding_kinds *kinds;
    const uint32_t *in;
    size_t count;
    id_info *ids;
    uint32_t bound;
    uint32_t functions;                // GLSL.std.450
    uint32_t reals[5], doubles[5];     // types by number of components
    uint32_t ints[5], unsigneds[5];    // likewise; of 32 bits
    uint32_t local_size[3];            // threads of a workgroup; 0: not known
    uint32_t workgroups;               // the variable NumWorkgroups
    uint32_t size, ones, last;         // constants of three: threads, 1, threads - 1
    uint32_t last_index;               // of a thread in its workgroup
    uint32_t zero, shift, mix;         // constants: 0 as int, 30 and a factor as unsigned
    uint32_t texels, texel, step, low; // as float
    bool order;                        // threads are reversed
    uint32_t old_bound;
    words globals; // types and constants that are added
    words out;
} module;

static uint32_t op_at(const module *m, size_t at)
{
    return m->in[at] & 0xffff;
}

static uint32_t length_at(const module *m, size_t at)
{
    return m->in[at] >> 16;
}

static void put(words *w, const uint32_t *from, size_t num)
{
    if (w->count + num > w->room) {
        const size_t room = 2 * w->room + num;
        uint32_t *grown = realloc(w->items, room * sizeof *grown);
        if (!grown) {
            w->failed = true;
            return;
        }
        w->items = grown;
        w->room = room;
    }
    memcpy(w->items + w->count, from, num * sizeof *from);
    w->count += num;
}

#define EMIT(w, op, ...)                                                                           \
    do {                                                                                           \
        const uint32_t operands_[] = {__VA_ARGS__};                                                \
        const uint32_t num_ = sizeof operands_ / sizeof *operands_;                                \
        put(w, &(uint32_t){(num_ + 1) << 16 | (op)}, 1);                                           \
        put(w, operands_, num_);                                                                   \
    } while (0)

static uint32_t new_id(module *m)
{
    return m->bound++;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// ---- what there is ----------------------------------------------------------------------------------

static void read_type(module *m, const uint32_t *w, uint32_t op)
{
    id_info *id = &m->ids[w[1]];
    if (op == SpvOpTypeFloat) {
        *id = (id_info){.component = w[1], .num = 1, .real = w[2] == 32};
        *(w[2] == 32 ? &m->reals[1] : w[2] == 64 ? &m->doubles[1] : &m->reals[0]) = w[1];
    } else if (op == SpvOpTypeInt && w[2] == 32) {
        *id = (id_info){.component = w[1], .num = 1};
        *(w[3] ? &m->ints[1] : &m->unsigneds[1]) = w[1];
    } else if (op == SpvOpTypeVector) {
        *id = (id_info){.component = w[2], .num = w[3], .real = m->ids[w[2]].real};
        uint32_t *known = w[2] == m->reals[1]       ? m->reals
                          : w[2] == m->doubles[1]   ? m->doubles
                          : w[2] == m->ints[1]      ? m->ints
                          : w[2] == m->unsigneds[1] ? m->unsigneds
                                                    : NULL;
        if (known && w[2]) {
            known[w[3]] = w[1];
        }
    } else if (op == SpvOpTypeSampledImage) {
        id->image = w[2];
    } else if (op == SpvOpTypeImage) {
        // Dimensions, of images without layers; 0: left alone
        static const uint32_t dimensions[] = {1, 2, 3};
        id->num = !w[5] && w[3] <= SpvDim3D ? dimensions[w[3]] : 0;
    }
}

static void read_all(module *m)
{
    bool ids_of_size = false;
    for (size_t at = HEADER; at < m->count; at += length_at(m, at)) {
        const uint32_t *w = m->in + at, op = op_at(m, at);
        bool has_result, has_type;
        SpvHasResultAndType((SpvOp)op, &has_result, &has_type);
        if (op >= SpvOpTypeVoid && op <= SpvOpTypeFunction) {
            read_type(m, w, op);
        } else if (op == SpvOpExtInstImport && !strcmp((const char *)(w + 2), "GLSL.std.450")) {
            m->functions = w[1];
        } else if (op == SpvOpDecorate && w[2] == SpvDecorationNoContraction) {
            m->ids[w[1]].exact = true;
        } else if (op == SpvOpDecorate && w[2] == SpvDecorationBuiltIn) {
            m->ids[w[1]].built_in = 1 + w[3];
            m->workgroups = w[3] == SpvBuiltInNumWorkgroups ? w[1] : m->workgroups;
        } else if ((op == SpvOpExecutionMode && w[2] == SpvExecutionModeLocalSize) ||
                   (op == SpvOpExecutionModeId && w[2] == SpvExecutionModeLocalSizeId)) {
            ids_of_size = op == SpvOpExecutionModeId;
            memcpy(m->local_size, w + 3, sizeof m->local_size);
        } else if (has_result && has_type) {
            m->ids[w[2]].type = w[1];
            m->ids[w[2]].at = (uint32_t)at;
        }
    }
    for (int a = 0; a < 3 && ids_of_size; a++) {
        m->local_size[a] = m->in[m->ids[m->local_size[a]].at + 3]; // a constant's value
    }
}

// ---- types and constants that are added -------------------------------------------------------------

static uint32_t vector_type(module *m, uint32_t *known, uint32_t num)
{
    if (!known[num]) {
        known[num] = new_id(m);
        EMIT(&m->globals, SpvOpTypeVector, known[num], known[1], num);
    }
    return known[num];
}

static uint32_t constant(module *m, uint32_t type, uint32_t value)
{
    const uint32_t id = new_id(m);
    EMIT(&m->globals, SpvOpConstant, type, id, value);
    return id;
}

static uint32_t constant_of_three(module *m, const uint32_t v[3], uint32_t less)
{
    uint32_t parts[3];
    for (int a = 0; a < 3; a++) {
        parts[a] = constant(m, m->unsigneds[1], v[a] - less);
    }
    const uint32_t id = new_id(m);
    EMIT(&m->globals, SpvOpConstantComposite, m->unsigneds[3], id, parts[0], parts[1], parts[2]);
    return id;
}

static void add_order(module *m)
{
    vector_type(m, m->unsigneds, 3);
    m->size = constant_of_three(m, m->local_size, 0);
    m->last = constant_of_three(m, m->local_size, 1);
    m->last_index =
        constant(m, m->unsigneds[1], m->local_size[0] * m->local_size[1] * m->local_size[2] - 1);
    m->ones = constant_of_three(m, (const uint32_t[]){1, 1, 1}, 0);
    if (m->workgroups >= m->old_bound) { // it was not there
        const uint32_t pointer = new_id(m);
        EMIT(&m->globals, SpvOpTypePointer, pointer, SpvStorageClassInput, m->unsigneds[3]);
        EMIT(&m->globals, SpvOpVariable, pointer, m->workgroups, SpvStorageClassInput);
    }
}

static void add_globals(module *m)
{
    if (!m->ints[1]) {
        m->ints[1] = new_id(m);
        EMIT(&m->globals, SpvOpTypeInt, m->ints[1], 32, 1);
    }
    if (!m->unsigneds[1]) {
        m->unsigneds[1] = new_id(m);
        EMIT(&m->globals, SpvOpTypeInt, m->unsigneds[1], 32, 0);
    }
    if (!m->doubles[1] && m->kinds->fused) {
        m->doubles[1] = new_id(m);
        EMIT(&m->globals, SpvOpTypeFloat, m->doubles[1], 64);
    }
    const float texels = (float)(1 << ROUNDING_TEXEL_BITS);
    const float step = (float)ROUNDING_ULPS * 2 / 3 / 8388608; // -1.5 to 1.5 steps are all ulps
    if (m->order) {
        add_order(m);
    }
    m->zero = constant(m, m->ints[1], 0);
    m->shift = constant(m, m->unsigneds[1], 30);
    m->mix = constant(m, m->unsigneds[1], 0x9e3779b1u);
    m->texels = constant(m, m->reals[1], bits_of(texels));
    m->texel = constant(m, m->reals[1], bits_of(1 / texels));
    m->step = constant(m, m->reals[1], bits_of(step));
    m->low = constant(m, m->reals[1], bits_of(1 - 1.5f * step));
    for (uint32_t num = 2; num <= 4; num++) {
        vector_type(m, m->reals, num);
        vector_type(m, m->ints, num);
        if (m->doubles[1]) {
            vector_type(m, m->doubles, num);
        }
    }
}

// ---- instructions -------------------------------------------------------------------------------------

static uint32_t scale(module *m, uint32_t num, uint32_t value, uint32_t factor)
{
    const uint32_t id = new_id(m);
    EMIT(&m->out, num == 1 ? SpvOpFMul : SpvOpVectorTimesScalar, m->reals[num], id, value, factor);
    return id;
}

// The mip that is read, as an integer.
static uint32_t level_of(module *m, size_t at, uint32_t operands_at)
{
    const uint32_t *w = m->in + at;
    const uint32_t mask = length_at(m, at) > operands_at ? w[operands_at] : 0;
    const uint32_t *lod = w + operands_at + 1 + (mask & SpvImageOperandsBiasMask ? 1 : 0);
    if (!(mask & SpvImageOperandsLodMask)) {
        return m->zero;
    }
    const uint32_t at_lod = m->ids[*lod].at;
    if (at_lod && op_at(m, at_lod) == SpvOpConstant && m->in[at_lod + 3] == 0) {
        return m->zero;
    }
    const uint32_t rounded = new_id(m), id = new_id(m);
    EMIT(&m->out, SpvOpExtInst, m->reals[1], rounded, m->functions, GLSLstd450RoundEven, *lod);
    EMIT(&m->out, SpvOpConvertFToS, m->ints[1], id, rounded);
    return id;
}

// A filtered read takes place on the grid of 1 / 2^ROUNDING_TEXEL_BITS texel; weights are differences from texels' centres, which lie
// on it. Reads by the nearest sampler do so too: cards round all of their coordinates.
static void round_read(module *m, size_t at, uint32_t operands_at)
{
    uint32_t *w = malloc(length_at(m, at) * sizeof *w);
    if (!w) {
        m->out.failed = true;
        return;
    }
    memcpy(w, m->in + at, length_at(m, at) * sizeof *w);
    const uint32_t image_type = m->ids[m->ids[w[3]].type].image, num = m->ids[image_type].num;
    if (num) {
        const uint32_t image = new_id(m), size = new_id(m), sizes = new_id(m),
                       in_texels = new_id(m), rounded = new_id(m), coordinates = new_id(m);
        const uint32_t level = level_of(m, at, operands_at), type = m->reals[num];
        EMIT(&m->out, SpvOpImage, image_type, image, w[3]);
        EMIT(&m->out, SpvOpImageQuerySizeLod, m->ints[num], size, image, level);
        EMIT(&m->out, SpvOpConvertSToF, type, sizes, size);
        EMIT(&m->out, SpvOpFMul, type, in_texels, w[4], sizes);
        const uint32_t in_steps = scale(m, num, in_texels, m->texels);
        EMIT(&m->out, SpvOpExtInst, type, rounded, m->functions, GLSLstd450RoundEven, in_steps);
        const uint32_t back = scale(m, num, rounded, m->texel);
        EMIT(&m->out, SpvOpFDiv, type, coordinates, back, sizes);
        w[4] = coordinates;
    }
    put(&m->out, w, length_at(m, at));
    free(w);
}

// Off by a few ulps: which way and how far follows from the value's own bits.
static void put_off(module *m, size_t at)
{
    const uint32_t *w = m->in + at;
    const uint32_t type = w[1], num = m->ids[type].num, whole = new_id(m);
    uint32_t parts[4], copy[16];
    if (length_at(m, at) > 16) {
        put(&m->out, w, length_at(m, at));
        return;
    }
    memcpy(copy, w, length_at(m, at) * sizeof *copy);
    copy[2] = whole;
    put(&m->out, copy, length_at(m, at));
    for (uint32_t i = 0; i < num; i++) {
        const uint32_t part = num > 1 ? new_id(m) : whole, bits = new_id(m), mixed = new_id(m),
                       top = new_id(m), steps = new_id(m), off = new_id(m), factor = new_id(m);
        if (num > 1) {
            EMIT(&m->out, SpvOpCompositeExtract, m->reals[1], part, whole, i);
        }
        EMIT(&m->out, SpvOpBitcast, m->unsigneds[1], bits, part);
        EMIT(&m->out, SpvOpIMul, m->unsigneds[1], mixed, bits, m->mix);
        EMIT(&m->out, SpvOpShiftRightLogical, m->unsigneds[1], top, mixed, m->shift);
        EMIT(&m->out, SpvOpConvertUToF, m->reals[1], steps, top);
        EMIT(&m->out, SpvOpFMul, m->reals[1], off, steps, m->step);
        EMIT(&m->out, SpvOpFAdd, m->reals[1], factor, off, m->low);
        parts[i] = num > 1 ? new_id(m) : w[2];
        EMIT(&m->out, SpvOpFMul, m->reals[1], parts[i], part, factor);
    }
    if (num > 1) {
        put(&m->out, &(uint32_t){(3 + num) << 16 | SpvOpCompositeConstruct}, 1);
        put(&m->out, (const uint32_t[]){type, w[2]}, 2);
        put(&m->out, parts, num);
    }
}

// The built-in variable that a pointer leads to, or to a component of; 0: none whose threads are counted.
static uint32_t variable_of(const module *m, uint32_t pointer)
{
    const uint32_t at = m->ids[pointer].at;
    const bool part = at && op_at(m, at) == SpvOpAccessChain && length_at(m, at) == 5;
    const uint32_t variable = part ? m->in[at + 3] : pointer;
    switch (m->ids[variable].built_in) {
    case 1 + SpvBuiltInWorkgroupId:
    case 1 + SpvBuiltInLocalInvocationId:
    case 1 + SpvBuiltInGlobalInvocationId:
    case 1 + SpvBuiltInLocalInvocationIndex:
        return variable;
    default:
        return 0;
    }
}

// The last thread is the first, and the last workgroup: what depends on their order shows.
static void reverse(module *m, size_t at)
{
    const uint32_t *w = m->in + at, type = w[1], result = w[2];
    const uint32_t variable = variable_of(m, w[3]), built_in = m->ids[variable].built_in - 1;
    const uint32_t forward = new_id(m), whole = m->unsigneds[3];
    EMIT(&m->out, SpvOpLoad, type, forward, w[3]);
    if (built_in == SpvBuiltInLocalInvocationIndex) {
        EMIT(&m->out, SpvOpISub, type, result, m->last_index, forward);
        return;
    }
    uint32_t last = m->last;
    if (built_in != SpvBuiltInLocalInvocationId) {
        const uint32_t groups = new_id(m), all = new_id(m);
        last = new_id(m);
        EMIT(&m->out, SpvOpLoad, whole, groups, m->workgroups);
        EMIT(&m->out, SpvOpIMul, whole, all, groups,
             built_in == SpvBuiltInGlobalInvocationId ? m->size : m->ones);
        EMIT(&m->out, SpvOpISub, whole, last, all, m->ones);
    }
    if (variable != w[3]) { // a component
        const uint32_t part = new_id(m), index = m->in[m->ids[w[3]].at + 4];
        EMIT(&m->out, SpvOpCompositeExtract, type, part, last, m->in[m->ids[index].at + 3]);
        last = part;
    }
    EMIT(&m->out, SpvOpISub, type, result, last, forward);
}

static uint32_t widen(module *m, uint32_t num, uint32_t value)
{
    const uint32_t id = new_id(m);
    EMIT(&m->out, SpvOpFConvert, m->doubles[num], id, value);
    return id;
}

// The product that an operand of a sum is, if a compiler may fuse the two; 0: none.
static uint32_t product_of(const module *m, uint32_t id)
{
    const uint32_t at = m->ids[id].at;
    const bool is_product =
        at && (op_at(m, at) == SpvOpFMul || op_at(m, at) == SpvOpVectorTimesScalar);
    return is_product && !m->ids[id].exact ? at : 0;
}

// a * b + c with doubles, in which the product is exact.
static void fuse(module *m, size_t at)
{
    const uint32_t *w = m->in + at, num = m->ids[w[1]].num, op = op_at(m, at);
    const uint32_t first = product_of(m, w[3]), second = first ? 0 : product_of(m, w[4]);
    const uint32_t *p = m->in + (first ? first : second);
    const uint32_t a = widen(m, num, p[3]), c = widen(m, num, first ? w[4] : w[3]);
    const bool scalar = op_at(m, first ? first : second) == SpvOpVectorTimesScalar;
    const uint32_t b = widen(m, scalar ? 1 : num, p[4]), product = new_id(m), sum = new_id(m);
    EMIT(&m->out, scalar ? SpvOpVectorTimesScalar : SpvOpFMul, m->doubles[num], product, a, b);
    EMIT(&m->out, op, m->doubles[num], sum, first ? product : c, first ? c : product);
    EMIT(&m->out, SpvOpFConvert, w[1], w[2], sum);
}

static bool is_function_put_off(const module *m, size_t at)
{
    const uint32_t *w = m->in + at;
    if (op_at(m, at) == SpvOpFDiv) {
        return m->ids[w[1]].real;
    }
    if (op_at(m, at) != SpvOpExtInst || w[3] != m->functions || !m->ids[w[1]].real) {
        return false;
    }
    switch (w[4]) {
    case GLSLstd450Sin:
    case GLSLstd450Cos:
    case GLSLstd450Tan:
    case GLSLstd450Asin:
    case GLSLstd450Acos:
    case GLSLstd450Atan:
    case GLSLstd450Atan2:
    case GLSLstd450Pow:
    case GLSLstd450Exp:
    case GLSLstd450Log:
    case GLSLstd450Exp2:
    case GLSLstd450Log2:
    case GLSLstd450Sqrt:
    case GLSLstd450InverseSqrt:
    case GLSLstd450Length:
    case GLSLstd450Distance:
    case GLSLstd450Normalize:
        return true;
    default:
        return false;
    }
}

static void rewrite(module *m, size_t at)
{
    const uint32_t *w = m->in + at, op = op_at(m, at);
    const bool sum = (op == SpvOpFAdd || op == SpvOpFSub) && m->ids[w[1]].real;
    if (m->kinds->weights &&
        (op == SpvOpImageSampleImplicitLod || op == SpvOpImageSampleExplicitLod)) {
        round_read(m, at, 5);
    } else if (m->kinds->weights && op == SpvOpImageGather) {
        round_read(m, at, 6);
    } else if (m->order && op == SpvOpLoad && variable_of(m, w[3])) {
        reverse(m, at);
    } else if (m->kinds->functions && is_function_put_off(m, at)) {
        put_off(m, at);
    } else if (m->kinds->fused && sum && !m->ids[w[2]].exact &&
               (product_of(m, w[3]) || product_of(m, w[4]))) {
        fuse(m, at);
    } else {
        put(&m->out, w, length_at(m, at));
    }
}

// Decorations and what comes after them.
static bool is_past_names(uint32_t op)
{
    return op == SpvOpDecorate || op == SpvOpMemberDecorate ||
           (op >= SpvOpTypeVoid && op <= SpvOpTypeFunction);
}

static void write_all(module *m)
{
    bool in_code = false, at_end_of_imports = m->functions != 0, annotated = false;
    put(&m->out, m->in, HEADER);
    EMIT(&m->out, SpvOpCapability, SpvCapabilityImageQuery);
    if (m->kinds->fused) {
        EMIT(&m->out, SpvOpCapability, SpvCapabilityFloat64);
    }
    if (!m->functions) {
        m->functions = new_id(m);
    }
    m->order = m->kinds->order && m->local_size[0];
    const bool lacks_groups = m->order && !m->workgroups;
    m->workgroups = lacks_groups ? new_id(m) : m->workgroups;
    for (size_t at = HEADER; at < m->count; at += length_at(m, at)) {
        const uint32_t op = op_at(m, at);
        if (op == SpvOpMemoryModel && !at_end_of_imports) {
            uint32_t name[4] = {0};
            memcpy(name, "GLSL.std.450", 12);
            EMIT(&m->out, SpvOpExtInstImport, m->functions, name[0], name[1], name[2], name[3]);
            at_end_of_imports = true;
        }
        if (op == SpvOpFunction && !in_code) {
            in_code = true;
            add_globals(m);
            put(&m->out, m->globals.items, m->globals.count);
        }
        if (lacks_groups && !annotated && is_past_names(op)) {
            EMIT(&m->out, SpvOpDecorate, m->workgroups, SpvDecorationBuiltIn,
                 SpvBuiltInNumWorkgroups);
            annotated = true;
        }
        if (in_code) {
            rewrite(m, at);
        } else if (op == SpvOpEntryPoint && lacks_groups) {
            put(&m->out, &(uint32_t){(length_at(m, at) + 1) << 16 | op}, 1);
            put(&m->out, m->in + at + 1, length_at(m, at) - 1);
            put(&m->out, &m->workgroups, 1);
        } else {
            put(&m->out, m->in + at, length_at(m, at));
        }
    }
}

uint32_t *rounding_rewrite(const rounding_kinds *kinds, const uint32_t *in, size_t count,
                           size_t *size)
{
    module m = {.kinds = kinds, .in = in, .count = count};
    if (!kinds->weights && !kinds->fused && !kinds->functions && !kinds->order) {
        return NULL;
    }
    m.bound = m.old_bound = in[BOUND];
    m.ids = calloc(m.bound, sizeof *m.ids);
    if (!m.ids) {
        return NULL;
    }
    read_all(&m);
    if (m.reals[1]) {
        write_all(&m);
    }
    free(m.ids);
    free(m.globals.items);
    if (m.out.failed || m.globals.failed || !m.out.count) {
        free(m.out.items);
        return NULL;
    }
    m.out.items[BOUND] = m.bound;
    *size = m.out.count;
    return m.out.items;
}
