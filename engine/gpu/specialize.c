// specialize.c -- see specialize.h. Instructions and rules: SPIR-V 1.6, sections 2.11 (control flow) and 3.
#include "gpu/specialize.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.h>

extern inline void SpvHasResultAndType(SpvOp op, bool *has_result, bool *has_type);

enum { HEADER = 5, BOUND = 3 };

// What is left of a block. A stub is a block that nothing branches to but a kept construct names.
typedef enum block_state { DEAD = 0, MERGE_STUB, CONTINUE_STUB, LIVE } block_state;

// Of one id; 0 where it is something else.
typedef struct id_info {
    uint32_t value;  // of a known constant
    uint32_t spec;   // 1 + its number
    uint32_t at;     // where a function or block begins
    uint32_t only;   // block: its only successor, where a selection was decided
    uint32_t header; // CONTINUE_STUB: the loop's
    uint8_t state;   // of a block
    bool known;      // `value` is that of a 32-bit scalar or bool
    bool is_bool;    // type
    bool is_word;    // type: 32-bit integer
    bool is_real;    // type: 32-bit float
    bool merges;     // block: merge of a decided selection
    bool called;     // function
    bool gone;       // defined in code that is left out
} id_info;

typedef struct module {
    const uint32_t *words;
    size_t count;
    id_info *ids;
    uint32_t bound;
    bool plain;          // it is known which ids each instruction refers to
    uint32_t *functions; // called, in the order in which they were found
    uint32_t num_functions;
    uint32_t *out;
    size_t written;
} module;

static uint32_t op_at(const module *m, size_t at)
{
    return m->words[at] & 0xffff;
}

static size_t next(const module *m, size_t at)
{
    return at + (m->words[at] >> 16);
}

// Every instruction has a length, and ends within the module.
static bool is_whole(const module *m)
{
    size_t at = HEADER;
    while (at < m->count && m->words[at] >> 16) {
        at = next(m, at);
    }
    return at == m->count;
}

// The id that an instruction of a function defines; 0: none.
static uint32_t result_at(const module *m, size_t at)
{
    bool has_result, has_type;
    SpvHasResultAndType((SpvOp)op_at(m, at), &has_result, &has_type);
    return has_result ? m->words[at + (has_type ? 2 : 1)] : 0;
}

// ---- constants ----------------------------------------------------------------------------------

// -1: not known.
static int64_t evaluate(uint32_t op, const uint32_t v[3])
{
    const int32_t a = (int32_t)v[0], b = (int32_t)v[1];
    switch (op) {
    case SpvOpIAdd:
        return (uint32_t)(v[0] + v[1]);
    case SpvOpISub:
        return (uint32_t)(v[0] - v[1]);
    case SpvOpIMul:
        return (uint32_t)(v[0] * v[1]);
    case SpvOpLogicalEqual:
    case SpvOpIEqual:
        return v[0] == v[1];
    case SpvOpLogicalNotEqual:
    case SpvOpINotEqual:
        return v[0] != v[1];
    case SpvOpLogicalOr:
    case SpvOpBitwiseOr:
        return v[0] | v[1];
    case SpvOpLogicalAnd:
    case SpvOpBitwiseAnd:
        return v[0] & v[1];
    case SpvOpBitwiseXor:
        return v[0] ^ v[1];
    case SpvOpLogicalNot:
        return !v[0];
    case SpvOpNot:
        return (uint32_t)(~v[0]);
    case SpvOpSelect:
        return v[0] ? v[1] : v[2];
    case SpvOpUGreaterThan:
        return v[0] > v[1];
    case SpvOpSGreaterThan:
        return a > b;
    case SpvOpUGreaterThanEqual:
        return v[0] >= v[1];
    case SpvOpSGreaterThanEqual:
        return a >= b;
    case SpvOpULessThan:
        return v[0] < v[1];
    case SpvOpSLessThan:
        return a < b;
    case SpvOpULessThanEqual:
        return v[0] <= v[1];
    case SpvOpSLessThanEqual:
        return a <= b;
    case SpvOpShiftRightLogical:
        return v[1] < 32 ? (int64_t)(v[0] >> v[1]) : -1;
    case SpvOpShiftLeftLogical:
        return v[1] < 32 ? (int64_t)(v[0] << v[1]) : -1;
    default:
        return -1;
    }
}

// `operands` of an operation whose result is of `type`, into the result's info.
static void fold(module *m, uint32_t op, uint32_t type, const uint32_t *operands, size_t num,
                 id_info *result)
{
    uint32_t values[3] = {0}, num_known = 0;
    if (op < SpvOpIAdd || op > SpvOpNot || num > 3 ||
        !(m->ids[type].is_bool || m->ids[type].is_word)) {
        return;
    }
    for (size_t i = 0; i < num; i++) {
        const id_info *id = &m->ids[operands[i]];
        values[i] = id->value;
        num_known += id->known;
        // One of the two decides.
        if (id->known &&
            ((op == SpvOpLogicalAnd && !id->value) || (op == SpvOpLogicalOr && id->value))) {
            result->known = true;
            result->value = id->value;
            return;
        }
    }
    const int64_t value = num_known == num ? evaluate(op, values) : -1;
    result->known = value >= 0;
    result->value = (uint32_t)value;
}

static void read_constant(module *m, size_t at)
{
    const uint32_t *w = m->words + at, op = op_at(m, at), length = w[0] >> 16;
    id_info *id = &m->ids[w[2]];
    switch (op) {
    case SpvOpConstantTrue:
    case SpvOpConstantFalse:
    case SpvOpSpecConstantTrue:
    case SpvOpSpecConstantFalse:
        id->known = true;
        id->value = op == SpvOpConstantTrue || op == SpvOpSpecConstantTrue;
        break;
    case SpvOpConstant:
    case SpvOpSpecConstant:
        id->known = length == 4 && m->ids[w[1]].is_word;
        id->value = w[3];
        break;
    case SpvOpSpecConstantOp:
        fold(m, w[3], w[1], w + 4, length - 4, id);
        break;
    default:
        break;
    }
}

// A specialization constant takes its value before what is made of it is read.
static void specialize(module *m, size_t at, const uint32_t *spec, uint32_t num_spec)
{
    const uint32_t op = op_at(m, at);
    if (op < SpvOpSpecConstantTrue || op > SpvOpSpecConstant) {
        return;
    }
    id_info *id = &m->ids[m->words[at + 2]];
    const id_info *type = &m->ids[m->words[at + 1]];
    if (id->spec && id->spec <= num_spec && (type->is_bool || type->is_word || type->is_real)) {
        id->value = op == SpvOpSpecConstant ? spec[id->spec - 1] : spec[id->spec - 1] != 0;
    } else {
        id->spec = 0;
    }
}

static void read_globals(module *m, const uint32_t *spec, uint32_t num_spec)
{
    for (size_t at = HEADER; at < m->count; at = next(m, at)) {
        const uint32_t *w = m->words + at, op = op_at(m, at);
        m->plain = m->plain && op <= SpvOpPtrDiff && op != SpvOpDecorationGroup;
        if (op == SpvOpDecorate && w[2] == SpvDecorationSpecId) {
            m->ids[w[1]].spec = 1 + w[3];
        } else if (op == SpvOpGroupDecorate) {
            for (uint32_t i = 2; i < w[0] >> 16 && m->ids[w[1]].spec; i++) {
                m->ids[w[i]].spec = m->ids[w[1]].spec;
            }
        } else if (op == SpvOpTypeBool) {
            m->ids[w[1]].is_bool = true;
        } else if (op == SpvOpTypeInt) {
            m->ids[w[1]].is_word = w[2] == 32;
            m->plain = m->plain && w[2] <= 32; // literals of OpSwitch
        } else if (op == SpvOpTypeFloat) {
            m->ids[w[1]].is_real = w[2] == 32;
        } else if (op >= SpvOpConstantTrue && op <= SpvOpSpecConstantOp) {
            read_constant(m, at);
            specialize(m, at, spec, num_spec);
        } else if (op == SpvOpFunction) {
            m->ids[w[2]].at = (uint32_t)at;
        }
    }
}

// ---- blocks -------------------------------------------------------------------------------------

static void call(module *m, uint32_t function)
{
    if (!m->ids[function].called) {
        m->ids[function].called = true;
        m->functions[m->num_functions++] = function;
    }
}

// Is the edge taken? `parent` branches to `block` in the module as it was.
static bool is_edge(const module *m, uint32_t parent, uint32_t block)
{
    const id_info *p = &m->ids[parent];
    return (p->state == LIVE && (!p->only || p->only == block)) ||
           (p->state == CONTINUE_STUB && p->header == block);
}

// A value that is the same along all edges that are taken. False where one comes from a block further below.
static bool read_phi(module *m, size_t at, uint32_t block)
{
    const uint32_t *w = m->words + at, length = w[0] >> 16;
    id_info *result = &m->ids[w[2]];
    bool same = m->ids[w[1]].is_bool || m->ids[w[1]].is_word;
    const id_info *first = NULL;
    for (uint32_t i = 3; i + 1 < length; i += 2) {
        if (m->ids[w[i + 1]].at > at || !m->ids[w[i + 1]].at) {
            return false;
        }
        if (is_edge(m, w[i + 1], block)) {
            const id_info *value = &m->ids[w[i]];
            first = first ? first : value;
            same = same && value->known && value->value == first->value;
        }
    }
    result->known = same && first;
    result->value = result->known ? first->value : 0;
    return true;
}

// False where the block stands above `at`: one pass over the function has missed it.
static bool reach(module *m, size_t at, uint32_t block, block_state state)
{
    id_info *b = &m->ids[block];
    if (b->state >= (uint8_t)state) {
        return true;
    }
    b->state = (uint8_t)state;
    return b->at > at;
}

// The successors of the block that ends at `at`; `merge`: of the selection that ends it, or 0.
static bool leave(module *m, size_t at, uint32_t block, uint32_t merge)
{
    const uint32_t *w = m->words + at, op = op_at(m, at), length = w[0] >> 16;
    if (op == SpvOpBranchConditional && merge && m->ids[w[1]].known) {
        m->ids[block].only = m->ids[w[1]].value ? w[2] : w[3];
        m->ids[merge].merges = true;
        return reach(m, at, m->ids[block].only, LIVE);
    }
    bool ordered = !merge || reach(m, at, merge, MERGE_STUB);
    if (op == SpvOpBranch) {
        ordered = reach(m, at, w[1], LIVE) && ordered;
    } else if (op == SpvOpBranchConditional) {
        if (!merge && (m->ids[w[2]].merges || m->ids[w[3]].merges)) {
            return false; // it leaves the selection, and may only where one is declared
        }
        ordered = reach(m, at, w[2], LIVE) && reach(m, at, w[3], LIVE) && ordered;
    } else if (op == SpvOpSwitch) { // selector, default, literals of 32 bits with their targets
        for (uint32_t i = 2; i < length; i += 2) {
            ordered = reach(m, at, w[i], LIVE) && ordered;
        }
    }
    return ordered;
}

static bool enter_loop(module *m, size_t at, uint32_t block)
{
    const uint32_t *w = m->words + at;
    id_info *target = &m->ids[w[2]];
    if (target->state == DEAD) {
        target->header = block;
    }
    return reach(m, at, w[1], MERGE_STUB) && reach(m, at, w[2], CONTINUE_STUB);
}

// An instruction of a live block. False: the function cannot be thinned.
static bool read_live(module *m, size_t at, uint32_t block, uint32_t *merge)
{
    const uint32_t *w = m->words + at, op = op_at(m, at), length = w[0] >> 16;
    switch (op) {
    case SpvOpFunctionCall:
        call(m, w[3]);
        return true;
    case SpvOpPhi:
        return read_phi(m, at, block);
    case SpvOpSelectionMerge:
        *merge = w[1];
        return true;
    case SpvOpLoopMerge:
        return enter_loop(m, at, block);
    case SpvOpBranch:
    case SpvOpBranchConditional:
    case SpvOpSwitch:
        return leave(m, at, block, *merge);
    default:
        if (length > 3) {
            fold(m, op, w[1], w + 3, length - 3, &m->ids[w[2]]);
        }
        return true;
    }
}

static void find_blocks(module *m, size_t at)
{
    for (; op_at(m, at) != SpvOpFunctionEnd; at = next(m, at)) {
        if (op_at(m, at) == SpvOpLabel) {
            m->ids[m->words[at + 1]].at = (uint32_t)at;
        }
    }
}

static bool thin(module *m, size_t at)
{
    uint32_t block = 0, merge = 0;
    bool read = true, first = true;
    for (; op_at(m, at) != SpvOpFunctionEnd && read; at = next(m, at)) {
        if (op_at(m, at) == SpvOpLabel) {
            block = m->words[at + 1];
            merge = 0;
            m->ids[block].state = first ? LIVE : m->ids[block].state;
            first = false;
        } else if (block && m->ids[block].state == LIVE) {
            read = read_live(m, at, block, &merge);
        }
    }
    return read;
}

// All of it stays, and what it calls.
static void keep_whole(module *m, size_t at)
{
    for (; op_at(m, at) != SpvOpFunctionEnd; at = next(m, at)) {
        const uint32_t *w = m->words + at;
        if (op_at(m, at) == SpvOpLabel) {
            m->ids[w[1]].state = LIVE;
            m->ids[w[1]].only = 0;
        } else if (op_at(m, at) == SpvOpFunctionCall) {
            call(m, w[3]);
        }
    }
}

static void read_functions(module *m)
{
    for (size_t at = HEADER; at < m->count; at = next(m, at)) {
        const uint32_t op = op_at(m, at);
        if (op == SpvOpEntryPoint || (op == SpvOpFunction && !m->plain)) {
            call(m, m->words[at + 2]);
        }
    }
    for (uint32_t i = 0; i < m->num_functions; i++) {
        const size_t at = m->ids[m->functions[i]].at;
        find_blocks(m, at);
        if (!m->plain || !thin(m, at)) {
            keep_whole(m, at);
        }
    }
}

// ---- writing ------------------------------------------------------------------------------------

static void emit(module *m, const uint32_t *words, uint32_t op, uint32_t length)
{
    m->out[m->written] = length << 16 | op;
    memcpy(m->out + m->written + 1, words + 1, (length - 1) * sizeof *words);
    m->written += length;
}

static void emit_same(module *m, size_t at)
{
    emit(m, m->words + at, op_at(m, at), m->words[at] >> 16);
}

static void emit_constant(module *m, size_t at)
{
    const uint32_t *w = m->words + at, op = op_at(m, at);
    const id_info *id = &m->ids[w[2]];
    if (op == SpvOpSpecConstantComposite) {
        emit(m, w, SpvOpConstantComposite, w[0] >> 16);
    } else if (op < SpvOpSpecConstantTrue || (op == SpvOpSpecConstantOp && !id->known)) {
        emit_same(m, at);
    } else if (m->ids[w[1]].is_bool) {
        emit(m, w, id->value ? SpvOpConstantTrue : SpvOpConstantFalse, 3);
    } else if (id->known || id->spec) {
        emit(m, (uint32_t[]){0, w[1], w[2], id->value}, SpvOpConstant, 4);
    } else {
        emit(m, w, SpvOpConstant, w[0] >> 16);
    }
}

static void emit_phi(module *m, size_t at, uint32_t block)
{
    const uint32_t *w = m->words + at, length = w[0] >> 16;
    uint32_t *to = m->out + m->written, kept = 3;
    to[1] = w[1];
    to[2] = w[2];
    for (uint32_t i = 3; i + 1 < length; i += 2) {
        if (is_edge(m, w[i + 1], block)) {
            to[kept++] = w[i];
            to[kept++] = w[i + 1];
        }
    }
    to[0] = kept << 16 | SpvOpPhi;
    m->written += kept;
}

static void emit_live(module *m, size_t at, uint32_t block)
{
    const uint32_t op = op_at(m, at), only = m->ids[block].only;
    if (op == SpvOpPhi) {
        emit_phi(m, at, block);
    } else if (op == SpvOpBranchConditional && only) {
        emit(m, (uint32_t[]){0, only}, SpvOpBranch, 2);
    } else if (op != SpvOpSelectionMerge || !only) {
        emit_same(m, at);
    }
}

static void emit_stub(module *m, uint32_t block)
{
    const id_info *b = &m->ids[block];
    emit(m, (uint32_t[]){0, block}, SpvOpLabel, 2);
    if (b->state == CONTINUE_STUB) {
        emit(m, (uint32_t[]){0, b->header}, SpvOpBranch, 2);
    } else {
        emit(m, (uint32_t[]){0}, SpvOpUnreachable, 1);
    }
}

static void emit_function(module *m, size_t at)
{
    uint32_t block = 0;
    for (; op_at(m, at) != SpvOpFunctionEnd; at = next(m, at)) {
        if (op_at(m, at) == SpvOpLabel) {
            block = m->words[at + 1];
            if (m->ids[block].state == MERGE_STUB || m->ids[block].state == CONTINUE_STUB) {
                emit_stub(m, block);
            }
        }
        if (!block) {
            emit_same(m, at);
        } else if (m->ids[block].state == LIVE) {
            emit_live(m, at, block);
        }
    }
    emit_same(m, at);
}

// Names and decorations must not speak of what is left out.
static void mark_gone(module *m)
{
    uint32_t block = 0;
    bool called = true;
    for (size_t at = HEADER; at < m->count; at = next(m, at)) {
        const uint32_t *w = m->words + at, op = op_at(m, at);
        if (op == SpvOpFunction) {
            called = m->ids[w[2]].called;
            block = 0;
        } else if (op == SpvOpFunctionEnd) {
            called = true;
            block = 0;
        } else if (op == SpvOpLabel) {
            block = w[1];
        }
        // The label of a stub stays.
        if (!called || (block && m->ids[block].state == DEAD) ||
            (block && m->ids[block].state != LIVE && op != SpvOpLabel)) {
            m->ids[result_at(m, at)].gone = true;
        }
    }
}

static void emit_all(module *m)
{
    bool called = true;
    memcpy(m->out, m->words, HEADER * sizeof *m->words);
    m->written = HEADER;
    for (size_t at = HEADER; at < m->count; at = next(m, at)) {
        const uint32_t *w = m->words + at, op = op_at(m, at);
        if (op == SpvOpFunction) {
            called = m->ids[w[2]].called;
            if (called) {
                emit_function(m, at);
            }
            while (op_at(m, at) != SpvOpFunctionEnd) {
                at = next(m, at);
            }
        } else if (op >= SpvOpConstantTrue && op <= SpvOpSpecConstantOp) {
            emit_constant(m, at);
        } else if (!((op == SpvOpName || op == SpvOpDecorate || op == SpvOpDecorateId) &&
                     m->ids[w[1]].gone) &&
                   !(op == SpvOpDecorate && w[2] == SpvDecorationSpecId)) {
            emit_same(m, at);
        }
    }
}

size_t tyn_spirv_specialize(const uint32_t *words, size_t count, const uint32_t *spec,
                            uint32_t num_spec, uint32_t *out)
{
    module m = {.words = words, .count = count, .out = out, .plain = true};
    if (count <= HEADER || !is_whole(&m)) {
        memcpy(out, words, count * sizeof *words);
        return count;
    }
    m.bound = words[BOUND];
    m.ids = calloc(m.bound, sizeof *m.ids);
    m.functions = calloc(m.bound, sizeof *m.functions);
    if (m.ids && m.functions) {
        read_globals(&m, spec, num_spec);
        read_functions(&m);
        mark_gone(&m);
        emit_all(&m);
    }
    free(m.ids);
    free(m.functions);
    return m.written;
}
