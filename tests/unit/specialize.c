// specialize.c -- SPIR-V with its specialization constants filled in: every kernel stays valid, and what is off goes.
#include "gpu/specialize.h"
#include <tyndall/registry.h>
#include <spirv-tools/libspirv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static spv_context tools;

static int set_up(void **state)
{
    (void)state;
    tools = spvContextCreate(SPV_ENV_VULKAN_1_3);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    spvContextDestroy(tools);
    return 0;
}

typedef struct text {
    char *chars; // disassembly
    size_t words;
} text;

static text disassemble(const uint32_t *words, size_t count)
{
    spv_text out = NULL;
    assert_int_equal(
        spvBinaryToText(tools, words, count, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER, &out, NULL),
        SPV_SUCCESS);
    const text t = {strdup(out->str), count};
    spvTextDestroy(out);
    return t;
}

static uint32_t count_of(const text *t, const char *what)
{
    uint32_t n = 0;
    for (const char *at = t->chars; (at = strstr(at, what)); at++) {
        n++;
    }
    return n;
}

static bool is_valid(const char *what, const uint32_t *words, size_t count)
{
    spv_diagnostic diagnostic = NULL;
    spv_const_binary_t binary = {words, count};
    spv_validator_options options = spvValidatorOptionsCreate();
    spvValidatorOptionsSetScalarBlockLayout(options, true);
    const spv_result_t result = spvValidateWithOptions(tools, options, &binary, &diagnostic);
    if (result != SPV_SUCCESS) {
        fprintf(stderr, "%s: %s\n", what, diagnostic ? diagnostic->error : "not valid");
    }
    spvDiagnosticDestroy(diagnostic);
    spvValidatorOptionsDestroy(options);
    return result == SPV_SUCCESS;
}

// ---- the kernels of all passes ------------------------------------------------------------------

typedef struct totals {
    uint32_t modules, invalid;
    size_t words, kept;
} totals;

static void try_values(const char *name, const uint32_t *words, size_t size, const uint32_t *spec,
                       uint32_t num_spec, totals *t)
{
    const size_t count = size / sizeof *words;
    uint32_t *out = malloc(size);
    const size_t kept = tyn_spirv_specialize(words, count, spec, num_spec, out);
    assert_in_range(kept, 6, count);
    t->modules++;
    t->words += count;
    t->kept += kept;
    const text after = disassemble(out, kept);
    t->invalid += !is_valid(name, out, kept) || count_of(&after, "SpecId") ||
                  count_of(&after, "OpSpecConstant ") || count_of(&after, "OpSpecConstantTrue") ||
                  count_of(&after, "OpSpecConstantFalse");
    free(after.chars);
    free(out);
}

static void try_kernel(const tyn_kernel *k, totals *t)
{
    uint32_t spec[TYN_MAX_SPEC];
    static const uint32_t words[] = {0, 1, 0x55555555};
    try_values(k->name, k->spirv, k->spirv_size, NULL, 0, t);
    for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
        for (uint32_t i = 0; i < k->num_spec; i++) {
            spec[i] = words[w];
        }
        if (k->num_spec) {
            try_values(k->name, k->spirv, k->spirv_size, spec, k->num_spec, t);
        }
        if (k->num_spec && k->raster && k->raster->fragment) {
            try_values(k->name, k->raster->fragment, k->raster->fragment_size, spec, k->num_spec,
                       t);
        }
    }
}

static void every_kernel(void **state)
{
    (void)state;
    totals t = {0};
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        for (uint32_t k = 0; k < pass->num_kernels; k++) {
            try_kernel(&pass->kernels[k], &t);
        }
    }
    printf("%u modules, %zu of %zu words kept\n", t.modules, t.kept, t.words);
    assert_int_equal(t.invalid, 0);
    assert_true(t.kept < t.words * 3 / 4);
}

// ---- modules written by hand --------------------------------------------------------------------

// A compute shader of GLSL as glslang writes it: BODY in main, between functions `f` (which stores 1) and the end.
#define MODULE_WITH(capability, decorate_bits, types, body)                                        \
    "OpCapability Shader\n" capability "OpMemoryModel Logical GLSL450\n"                           \
    "OpEntryPoint GLCompute %main \"main\" %v\n"                                                   \
    "OpExecutionMode %main LocalSize 1 1 1\n"                                                      \
    "OpName %f \"f\"\n"                                                                            \
    "OpDecorate %on SpecId 0\n" decorate_bits "%void = OpTypeVoid\n"                               \
    "%bool = OpTypeBool\n"                                                                         \
    "%uint = OpTypeInt 32 0\n" types "%fn = OpTypeFunction %void\n"                                \
    "%ptr = OpTypePointer Private %uint\n"                                                         \
    "%v = OpVariable %ptr Private\n"                                                               \
    "%u0 = OpConstant %uint 0\n"                                                                   \
    "%u1 = OpConstant %uint 1\n"                                                                   \
    "%on = OpSpecConstantTrue %bool\n"                                                             \
    "%bits = OpSpecConstant %uint 6\n"                                                             \
    "%bit = OpSpecConstantOp %uint BitwiseAnd %bits %u1\n"                                         \
    "%has = OpSpecConstantOp %bool INotEqual %bit %u0\n"                                           \
    "%f = OpFunction %void None %fn\n"                                                             \
    "%fl = OpLabel\n"                                                                              \
    "OpStore %v %u1\n"                                                                             \
    "OpReturn\n"                                                                                   \
    "OpFunctionEnd\n"                                                                              \
    "%main = OpFunction %void None %fn\n"                                                          \
    "%entry = OpLabel\n" body "OpFunctionEnd\n"
#define MODULE(body) MODULE_WITH("", "OpDecorate %bits SpecId 1\n", "", body)

// `on` and `bits` set; the result must be valid.
static text specialized(const char *source, uint32_t on, uint32_t bits)
{
    spv_binary binary = NULL;
    assert_int_equal(spvTextToBinary(tools, source, strlen(source), &binary, NULL), SPV_SUCCESS);
    assert_true(is_valid("before", binary->code, binary->wordCount));
    uint32_t *out = malloc(binary->wordCount * sizeof *out);
    const size_t kept =
        tyn_spirv_specialize(binary->code, binary->wordCount, (uint32_t[]){on, bits}, 2, out);
    assert_true(is_valid("after", out, kept));
    const text t = disassemble(out, kept);
    free(out);
    spvBinaryDestroy(binary);
    return t;
}

static void expect(const char *source, uint32_t on, uint32_t bits, uint32_t calls,
                   uint32_t functions, uint32_t branches)
{
    const text t = specialized(source, on, bits);
    if (count_of(&t, "OpFunctionCall") != calls || count_of(&t, "= OpFunction ") != functions ||
        count_of(&t, "OpBranchConditional") != branches) {
        fail_msg("on %u, bits %u: expected %u calls, %u functions, %u branches in\n%s", on, bits,
                 calls, functions, branches, t.chars);
    }
    free(t.chars);
}

// if (on) f();
static void selection(void **state)
{
    (void)state;
    static const char source[] = MODULE("OpSelectionMerge %end None\n"
                                        "OpBranchConditional %on %yes %end\n"
                                        "%yes = OpLabel\n"
                                        "%call = OpFunctionCall %void %f\n"
                                        "OpBranch %end\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 1, 0, 1, 2, 0);
    expect(source, 0, 0, 0, 1, 0);
}

// if ((bits & 1) != 0 && v == 0) f(); else return; the condition goes through a phi.
static void condition_of_two(void **state)
{
    (void)state;
    static const char source[] = MODULE("OpSelectionMerge %both None\n"
                                        "OpBranchConditional %has %second %both\n"
                                        "%second = OpLabel\n"
                                        "%x = OpLoad %uint %v\n"
                                        "%is = OpIEqual %bool %x %u0\n"
                                        "OpBranch %both\n"
                                        "%both = OpLabel\n"
                                        "%and = OpPhi %bool %has %entry %is %second\n"
                                        "OpSelectionMerge %end None\n"
                                        "OpBranchConditional %and %yes %end\n"
                                        "%yes = OpLabel\n"
                                        "%call = OpFunctionCall %void %f\n"
                                        "OpBranch %end\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 1, 1, 1, 2, 1);
    expect(source, 1, 2, 0, 1, 0);
}

// for (;;) { if (on) break; f(); } -- without `on` there is no way out, with it no way back.
static void loop(void **state)
{
    (void)state;
    static const char source[] = MODULE("OpBranch %head\n"
                                        "%head = OpLabel\n"
                                        "OpLoopMerge %end %again None\n"
                                        "OpBranch %body\n"
                                        "%body = OpLabel\n"
                                        "OpSelectionMerge %rest None\n"
                                        "OpBranchConditional %on %leave %rest\n"
                                        "%leave = OpLabel\n"
                                        "OpBranch %end\n"
                                        "%rest = OpLabel\n"
                                        "%call = OpFunctionCall %void %f\n"
                                        "OpBranch %again\n"
                                        "%again = OpLabel\n"
                                        "OpBranch %head\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 1, 0, 0, 1, 0);
    expect(source, 0, 0, 1, 2, 0);
}

// A switch on what is not known keeps all its cases; a selection in one of them is decided.
static void cases(void **state)
{
    (void)state;
    static const char source[] = MODULE("%x = OpLoad %uint %v\n"
                                        "OpSelectionMerge %end None\n"
                                        "OpSwitch %x %end 1 %one 2 %two\n"
                                        "%one = OpLabel\n"
                                        "OpSelectionMerge %after None\n"
                                        "OpBranchConditional %on %yes %after\n"
                                        "%yes = OpLabel\n"
                                        "%call = OpFunctionCall %void %f\n"
                                        "OpBranch %after\n"
                                        "%after = OpLabel\n"
                                        "OpBranch %end\n"
                                        "%two = OpLabel\n"
                                        "OpStore %v %u0\n"
                                        "OpBranch %end\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 1, 0, 1, 2, 0);
    expect(source, 0, 0, 0, 1, 0);
}

// A value that a loop carries: its function is left as it is, but for the constants.
static void carried_value(void **state)
{
    (void)state;
    static const char source[] = MODULE("OpBranch %head\n"
                                        "%head = OpLabel\n"
                                        "%i = OpPhi %uint %u0 %entry %next %again\n"
                                        "OpLoopMerge %end %again None\n"
                                        "OpBranch %test\n"
                                        "%test = OpLabel\n"
                                        "%less = OpULessThan %bool %i %bits\n"
                                        "OpBranchConditional %less %body %end\n"
                                        "%body = OpLabel\n"
                                        "OpSelectionMerge %rest None\n"
                                        "OpBranchConditional %on %yes %rest\n"
                                        "%yes = OpLabel\n"
                                        "%call = OpFunctionCall %void %f\n"
                                        "OpBranch %rest\n"
                                        "%rest = OpLabel\n"
                                        "OpBranch %again\n"
                                        "%again = OpLabel\n"
                                        "%next = OpIAdd %uint %i %u1\n"
                                        "OpBranch %head\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 0, 3, 1, 2, 2);
}

// if (on) { if (v == 0) { v = 0; } } where the inner one leaves by the outer one's merge block: that is declared by the outer.
static void nested_exit(void **state)
{
    (void)state;
    static const char source[] = MODULE("%x = OpLoad %uint %v\n"
                                        "%is = OpIEqual %bool %x %u0\n"
                                        "OpSelectionMerge %end None\n"
                                        "OpBranchConditional %on %yes %end\n"
                                        "%yes = OpLabel\n"
                                        "OpBranchConditional %is %store %end\n"
                                        "%store = OpLabel\n"
                                        "OpStore %v %u0\n"
                                        "OpBranch %end\n"
                                        "%end = OpLabel\n"
                                        "OpReturn\n");
    expect(source, 1, 0, 0, 1, 2);
    expect(source, 0, 0, 0, 1, 0);
}

// Instructions that this does not follow: all code stays, constants of 32 bits are filled in.
static void kept_whole(void **state)
{
    (void)state;
#define SELECTION                                                                                  \
    "OpSelectionMerge %end None\n"                                                                 \
    "OpBranchConditional %on %yes %end\n"                                                          \
    "%yes = OpLabel\n"                                                                             \
    "%y = OpIAdd %uint %u1 %bits\n"                                                                \
    "%call = OpFunctionCall %void %f\n"                                                            \
    "OpBranch %end\n"                                                                              \
    "%end = OpLabel\n"                                                                             \
    "OpReturn\n"
    static const char grouped[] = MODULE_WITH(
        "", "OpDecorate %all SpecId 1\n%all = OpDecorationGroup\nOpGroupDecorate %all %bits\n", "",
        SELECTION);
    static const char wide[] =
        MODULE_WITH("OpCapability Int64\n", "OpDecorate %bits SpecId 1\nOpDecorate %k SpecId 0\n",
                    "%long = OpTypeInt 64 1\n%k = OpSpecConstant %long 5\n",
                    "%x = OpLoad %uint %v\n"
                    "%wide = OpSConvert %long %x\n"
                    "OpSelectionMerge %past None\n"
                    "OpSwitch %wide %past -1 %case\n"
                    "%case = OpLabel\n"
                    "OpBranch %past\n"
                    "%past = OpLabel\n" SELECTION);
    expect(grouped, 0, 9, 1, 2, 1);
    expect(wide, 0, 9, 1, 2, 1);
    const text t = specialized(grouped, 0, 9);
    assert_int_equal(count_of(&t, " 9\n"), 1);
    free(t.chars);
#undef SELECTION
}

// A decoration by ids of what goes.
static void decorated_by_id(void **state)
{
    (void)state;
    static const char source[] =
        MODULE_WITH("OpCapability UniformDecoration\n",
                    "OpDecorate %bits SpecId 1\nOpDecorateId %y UniformId %subgroup\n",
                    "%subgroup = OpConstant %uint 3\n",
                    "OpSelectionMerge %end None\n"
                    "OpBranchConditional %on %yes %end\n"
                    "%yes = OpLabel\n"
                    "%y = OpIAdd %uint %u1 %bits\n"
                    "OpStore %v %y\n"
                    "OpBranch %end\n"
                    "%end = OpLabel\n"
                    "OpReturn\n");
    expect(source, 0, 0, 0, 1, 0);
    expect(source, 1, 0, 0, 1, 0);
}

static void what_is_no_module(void **state)
{
    (void)state;
    // A word; an instruction that is longer than the module; one of no length.
    static const uint32_t modules[3][6] = {
        {0x07230203},
        {0x07230203, 0x10600, 0, 8, 0, 0x00050011},
        {0x07230203, 0x10600, 0, 8, 0, 0x00000011},
    };
    static const size_t counts[3] = {1, 6, 6};
    for (int i = 0; i < 3; i++) {
        uint32_t out[6];
        assert_int_equal(tyn_spirv_specialize(modules[i], counts[i], NULL, 0, out), counts[i]);
        assert_memory_equal(out, modules[i], counts[i] * sizeof *out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kernel),
        cmocka_unit_test(selection),
        cmocka_unit_test(condition_of_two),
        cmocka_unit_test(loop),
        cmocka_unit_test(cases),
        cmocka_unit_test(carried_value),
        cmocka_unit_test(nested_exit),
        cmocka_unit_test(kept_whole),
        cmocka_unit_test(decorated_by_id),
        cmocka_unit_test(what_is_no_module),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
