// extend.c -- what plugins rely on: the layout behind TYN_EXTEND_ABI, and that what does not fit is refused with one line.
#include <tyndall/extend/plugin.h>
#include "registry/addition.h"
#include "registry/built_in.h"
#include "registry/registry.h"
#include "shaders/beams/radial_args.h"
#include "shaders/common/counters.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/light/shadow_args.h"
#include "shaders/walls/walls_args.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

// ---- the layout --------------------------------------------------------------------------------

// Another size is another ABI. Of structs of C alone TYN_EXTEND_LAYOUT sees it too; of blocks that kernels read nobody else does:
// raise TYN_EXTEND_ABI, and write number and size here.
static void layout(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t size, expected;
    } structs[] = {
#define SIZE(type, bytes) {#type, sizeof(type), bytes}
        SIZE(tyn_port, 32),
        SIZE(tyn_binding, 12),
        SIZE(tyn_raster, 40),
        SIZE(tyn_kernel, 64),
        SIZE(tyn_param, 80),
        SIZE(tyn_counter, 48),
        SIZE(tyn_pass_desc, 152),
        SIZE(tyn_dispatch, 56),
        SIZE(tyn_tile, 32),
        SIZE(tyn_draw, 64),
        SIZE(tyn_regime, 200),
        SIZE(tyn_limit, 240),
        SIZE(tyn_method_info, 64),
        SIZE(tyn_setting, 32),
        SIZE(tyn_scene, 10904),
        SIZE(tyn_view, 192),
        SIZE(tyn_ref, 8),
        SIZE(tyn_lattice_shape, 44),
        SIZE(tyn_lights, 8716),
        SIZE(tyn_frame_scene, 27200),
        SIZE(tyn_scene_refs, 336),
        SIZE(tyn_job, 480),
        SIZE(tyn_picture, 24),
        SIZE(tyn_picture_hook, 48),
        SIZE(tyn_sources, 436),
        SIZE(tyn_rsm, 6268),
        SIZE(tyn_field, 56),
        SIZE(tyn_view_inputs, 88),
        SIZE(tyn_method, 96),
        SIZE(tyn_calls, 808),
        SIZE(tyn_plugin, 64),
        // What kernels read that were compiled with the GLSL of then.
        SIZE(struct medium_block, 196),
        SIZE(struct shape_block, 248),
        SIZE(struct light_block, 64),
        SIZE(struct camera_block, 96),
        SIZE(struct env_block, 112),
        SIZE(struct beam_block, 204),
        SIZE(struct radial_block, 51216),
        SIZE(struct ordinates_block, 12304),
        SIZE(struct shadow_light, 80),
        SIZE(struct wall_cell, 64),
        SIZE(struct surface_block, 2048),
        SIZE(struct counters_block, 2084),
    };
    int changed = 0;
    for (size_t i = 0; i < sizeof structs / sizeof *structs; i++) {
        if (structs[i].size != structs[i].expected) {
            print_error("%s is %zu bytes, at ABI %u it was %zu\n", structs[i].name, structs[i].size,
                        TYN_EXTEND_ABI, structs[i].expected);
            changed++;
        }
    }
    assert_int_equal(TYN_EXTEND_ABI, 17);
    assert_int_equal(changed, 0);
}

// ---- refusals ----------------------------------------------------------------------------------

typedef struct said {
    int lines;
    char last[2048];
} said;

static void hear(void *user, tyn_log_level level, const char *line)
{
    said *s = user;
    assert_int_equal(level, TYN_LOG_ERROR);
    assert_null(strchr(line, '\n'));
    s->lines++;
    snprintf(s->last, sizeof s->last, "%s", line);
}

#define REFUSED(call, text)                                                                        \
    do {                                                                                           \
        said heard = {0};                                                                          \
        const tyn_log log = {hear, &heard, TYN_LOG_WARN};                                          \
        const uint32_t before[2] = {tyn_num_passes(), tyn_num_methods()};                          \
        assert_int_equal(call, TYN_ERR_PARAMS);                                                    \
        assert_int_equal(heard.lines, 1);                                                          \
        if (!strstr(heard.last, text)) {                                                           \
            fail_msg("'%s' does not say '%s'", heard.last, text);                                  \
        }                                                                                          \
        assert_int_equal(before[0], tyn_num_passes());                                             \
        assert_int_equal(before[1], tyn_num_methods());                                            \
    } while (0)

static tyn_result declare_pass(tyn_builder *b, const void *params)
{
    (void)b;
    (void)params;
    return TYN_OK;
}

static void record_pass(tyn_recorder *r, const void *params)
{
    (void)r;
    (void)params;
}

static tyn_result declare_method(tyn_graph *g, const tyn_job *job)
{
    (void)job;
    return tyn_graph_status(g);
}

static uint32_t reads_nothing(const tyn_job *job)
{
    (void)job;
    return 0;
}

static void change_nothing(tyn_graph *g, const tyn_job *job, tyn_picture *picture)
{
    (void)g;
    (void)job;
    (void)picture;
}

static void prepare_nothing(tyn_graph *g, tyn_job *job)
{
    (void)g;
    (void)job;
}

static const uint32_t words[5] = {0x07230203};
static const tyn_port one_port[] = {{.name = "out", .dir = TYN_OUT, .meaning = "nothing"}};
static const tyn_binding one_binding[] = {{0, TYN_USE_STORAGE_WRITE, false}};
static const tyn_kernel one_kernel[] = {{.name = "kernel",
                                         .spirv = words,
                                         .spirv_size = sizeof words,
                                         .local_size = {1, 1, 1},
                                         .bindings = one_binding,
                                         .num_bindings = 1}};
static const tyn_param one_param[] = {{"size", TYN_PARAM_INT, 0, 2, 1, 3, "", "a size", NULL}};
static const tyn_pass_desc good_pass = {.name = "added",
                                        .summary = "a pass that was added",
                                        .ports = one_port,
                                        .num_ports = 1,
                                        .kernels = one_kernel,
                                        .num_kernels = 1,
                                        .params = one_param,
                                        .num_params = 1,
                                        .params_size = 4,
                                        .declare = declare_pass,
                                        .record = record_pass};

#define WRONG_PASS(text, ...)                                                                      \
    do {                                                                                           \
        static tyn_pass_desc pass;                                                                 \
        pass = good_pass;                                                                          \
        __VA_ARGS__;                                                                               \
        REFUSED(tyn_pass_register(&pass, &log), text);                                             \
    } while (0)
#define WRONG_KERNEL(text, ...)                                                                    \
    do {                                                                                           \
        static tyn_kernel kernel;                                                                  \
        kernel = one_kernel[0];                                                                    \
        __VA_ARGS__;                                                                               \
        WRONG_PASS(text, pass.kernels = &kernel);                                                  \
    } while (0)

static void passes(void **state)
{
    (void)state;
    WRONG_PASS("there is a pass 'lattice' already", pass.name = "lattice");
    WRONG_PASS("is 'NULL'", pass.name = NULL);
    WRONG_PASS("'a.b'", pass.name = "a.b");
    WRONG_PASS("1 to 31 letters", pass.name = "a-name-of-more-than-thirty-one-letters");
    WRONG_PASS("declare and record are required", pass.record = NULL);
    WRONG_PASS("0 ports", pass.num_ports = 0);
    WRONG_PASS("57 ports", pass.num_ports = TYN_MAX_PORTS + 1);
    WRONG_PASS("debug port 1", pass.debug_port = 1);
    static const tyn_port input[] = {{"in", TYN_IN, TYN_BUFFER, 0, false, "read"}};
    static const tyn_counter rows[] = {{"steps", 0}, {NULL}};
    WRONG_PASS("counters' port 1", pass.counters = rows, pass.counter_port = 1);
    WRONG_PASS("counts in its port 'in'", pass.counters = rows, pass.ports = input);
    WRONG_PASS("'size'", pass.params_size = 3);
    WRONG_KERNEL("SPIR-V", kernel.spirv = NULL);
    WRONG_KERNEL("SPIR-V", kernel.spirv_size = 18);
    WRONG_KERNEL("132 bytes of arguments", kernel.args_size = 132);
    WRONG_KERNEL("local_size", kernel.local_size[1] = 0);
    static const tyn_binding wrong[] = {{1, TYN_USE_STORAGE_WRITE, false}};
    WRONG_KERNEL("binding 0 is of port 1", kernel.bindings = wrong);
    REFUSED(tyn_pass_register(NULL, &log), "'pass' is NULL");

    assert_int_equal(tyn_pass_register(&good_pass, NULL), TYN_OK);
    assert_ptr_equal(tyn_pass_find("added"), &good_pass);
    REFUSED(tyn_pass_register(&good_pass, &log), "there is a pass 'added' already");
    // Its settings are like those of any other.
    tyn_setting setting;
    assert_int_equal(tyn_settings_get(NULL, "added.size", &setting, NULL), TYN_OK);
    assert_true(setting.value == 2);
}

static const char *const method_passes[] = {"medium", "added", NULL};
static const tyn_method good_method = {
    .info = {.name = "added", .summary = "a method", .outputs = TYN_OUTPUT_RADIANCE},
    .passes = method_passes,
    .declare = declare_method};

#define WRONG_METHOD(text, ...)                                                                    \
    do {                                                                                           \
        static tyn_method method;                                                                  \
        method = good_method;                                                                      \
        __VA_ARGS__;                                                                               \
        REFUSED(tyn_method_register(&method, &log), text);                                         \
    } while (0)

// After `passes`, which has added a pass.
static void methods(void **state)
{
    (void)state;
    static const char *const unknown[] = {"medium", "nowhere", NULL};
    static const tyn_limit unsourced[] = {{.key = "thick"}, {NULL}};
    WRONG_METHOD("there is a method 'pop' already", method.info.name = "pop");
    WRONG_METHOD("names the pass 'nowhere'", method.passes = unknown);
    WRONG_METHOD("are required", method.declare = NULL);
    WRONG_METHOD("are required", method.info.outputs = 0);
    WRONG_METHOD("'path' is the reference", method.info.reference = true);
    WRONG_METHOD("needs 'batch'", method.info.progressive = true);
    WRONG_METHOD("source is required", method.info.limits = unsourced);
    REFUSED(tyn_method_register(NULL, &log), "'method' is NULL");

    assert_int_equal(tyn_method_register(&good_method, NULL), TYN_OK);
    tyn_method_info info;
    assert_true(tyn_method_named("added", &info));
    assert_string_equal(info.plugin, "");
    assert_ptr_equal(info.passes[1], &good_pass);
    assert_null(info.passes[2]);
    // It tells no limits: it has one row that says so.
    assert_non_null(info.limits[0].key);
    assert_null(info.limits[1].key);
    REFUSED(tyn_method_register(&good_method, &log), "there is a method 'added' already");
    assert_string_equal(tyn_method_default(), "pop");
    assert_string_equal(tyn_method_reference(), "path");
}

static void hooks(void **state)
{
    (void)state;
    static const tyn_picture_hook half = {"added", reads_nothing, NULL};
    static const tyn_picture_hook whole = {"added", reads_nothing, change_nothing};
    uint32_t count, own;
    tyn_picture_hooks(&own);
    REFUSED(tyn_picture_hook_register(&half, &log), "are required");
    assert_int_equal(tyn_picture_hook_register(&whole, NULL), TYN_OK);
    REFUSED(tyn_picture_hook_register(&whole, &log), "there is a hook 'added' already");
    assert_ptr_equal(tyn_picture_hooks(&count)[own], &whole);
    assert_int_equal(count, own + 1);
}

// Methods that are registered after a hook list its passes behind the one that it follows; those before do not.
static void followers(void **state)
{
    (void)state;
    static const char *const unknown[] = {"nowhere", NULL}, *const known[] = {"added", NULL};
    static const char *const followed[] = {"medium", "export", NULL};
    tyn_picture_hook hook = {.name = "lost", .prepare = prepare_nothing, .passes = unknown};
    REFUSED(tyn_picture_hook_register(&hook, &log), "hook 'lost' names the pass 'nowhere'");
    static const tyn_picture_hook follower = {
        .name = "follower", .prepare = prepare_nothing, .follows = "medium", .passes = known};
    assert_int_equal(tyn_picture_hook_register(&follower, NULL), TYN_OK);
    static tyn_method late;
    late = good_method;
    late.info.name = "late";
    late.passes = followed;
    assert_int_equal(tyn_method_register(&late, NULL), TYN_OK);
    tyn_method_info info;
    assert_true(tyn_method_named("late", &info));
    assert_string_equal(info.passes[0]->name, "medium");
    assert_ptr_equal(info.passes[1], &good_pass);
    assert_string_equal(info.passes[2]->name, "export");
    assert_null(info.passes[3]);
    assert_true(tyn_method_named("added", &info));
    assert_null(info.passes[2]);
}

// What the library is built of fits as a plugin must.
static void built_in(void **state)
{
    (void)state;
    uint32_t num_passes = 0, num_methods = 0;
    for (uint32_t i = 0; tyn_built_in[i]; i++) {
        tyn_addition a = tyn_addition_of(tyn_built_in[i]);
        a.who = "built in";
        const tyn_log log = {hear, &(said){0}, TYN_LOG_WARN};
        assert_true(i == 0 || tyn_addition_check(&a, &log)); // the reference is the core's alone
        for (uint32_t k = 0; k < a.num_methods; k++) {
            assert_non_null(tyn_method_find(a.methods[k]->info.name));
        }
        num_passes += a.num_passes;
        num_methods += a.num_methods;
    }
    assert_true(tyn_num_passes() >= num_passes && tyn_num_methods() >= num_methods);
    for (uint32_t i = 0; i < tyn_num_passes(); i++) { // no name is there twice
        assert_ptr_equal(tyn_pass_find(tyn_pass_at(i)->name), tyn_pass_at(i));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layout), cmocka_unit_test(passes),    cmocka_unit_test(methods),
        cmocka_unit_test(hooks),  cmocka_unit_test(followers), cmocka_unit_test(built_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
