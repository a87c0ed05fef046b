// frames.c -- whole frames of the render graph on a device that only writes down what it is told:
// barriers of the first and of later frames, culling, change tracking, histories, host images, faults.
#include "fake_vulkan.h"
#include "graph/graph.h"
#include "toy_passes.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

// ---- harness ----------------------------------------------------------------------------------

enum { W = 40, H = 20 };
static const VkCommandBuffer no_cmd = VK_NULL_HANDLE;

typedef struct fixture {
    fake_vulkan *fake;
    tyn_graph *g;
} fixture;

static int setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    f->fake = fake_create();
    *state = f;
    return tyn_graph_create(&f->fake->dev, 2, &f->g);
}

static int teardown(void **state)
{
    fixture *f = *state;
    tyn_graph_destroy(&f->g);
    fake_destroy(&f->fake); // fails if anything is left
    free(f);
    return 0;
}

static void fill_zero(void *user, void *staging)
{
    (void)user;
    memset(staging, 0, W * H * 4);
}

static tyn_ref upload(tyn_graph *g, const char *name, uint64_t hash)
{
    return tyn_graph_upload_image(g, name, TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT,
                                  (tyn_extent){W, H, 1}, fill_zero, NULL, hash);
}

static tyn_ref add_blur(tyn_graph *g, tyn_ref in, tyn_ref bias, node_params p)
{
    tyn_ref refs[BLUR_NUM] = {in, bias};
    tyn_graph_add(g, &toy_blur, &p, refs);
    return refs[BLUR_OUT];
}

static tyn_result frame(fixture *f)
{
    fake_clear(f->fake);
    if (!tyn_graph_matches(f->g)) {
        tyn_result result = tyn_graph_compile(f->g);
        if (result != TYN_OK) {
            return result;
        }
    }
    f->fake->recording = true;
    tyn_result result = tyn_graph_record(f->g, no_cmd);
    f->fake->recording = false;
    assert_int_equal(f->fake->created_while_recording, 0);
    return result;
}

static void assert_states(fixture *f, const char *expected) // one letter a node: r, u, c, e
{
    const tyn_node_stats *stats;
    uint32_t num = tyn_graph_stats(f->g, &stats);
    char found[33] = "";
    for (uint32_t i = 0; i < num; i++) {
        found[i] = "ruce"[stats[i].state];
    }
    assert_string_equal(found, expected);
}

static void compare_golden(const char *name, const char *text)
{
    char path[512], *golden;
    snprintf(path, sizeof path, "%s/%s", TYN_TEST_GOLDEN, name);
    if (getenv("TYN_TEST_WRITE_GOLDEN")) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fputs(text, file);
        fclose(file);
    }
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    golden = calloc(1, 1 << 16);
    size_t n = fread(golden, 1, (1 << 16) - 1, file);
    golden[n] = 0;
    fclose(file);
    assert_string_equal(text, golden);
    free(golden);
}

// upload -> blur (4) -> blur (3, with bias) -> result, and a blur that nobody needs.
typedef struct chain {
    uint64_t input;
    float bias;
    node_params first, second;
} chain;
static const chain default_chain = {1, 0.25f, {4, 1, 0}, {3, 1, 0}};

static void declare_chain(tyn_graph *g, const chain *c)
{
    tyn_graph_begin(g);
    tyn_ref in = upload(g, "input", c->input);
    tyn_ref bias = tyn_graph_upload_buffer(g, "bias", &c->bias, sizeof c->bias, 0);
    tyn_ref a = add_blur(g, in, (tyn_ref){0}, c->first);
    tyn_ref b = add_blur(g, a, bias, c->second);
    node_params other = c->first; // a node like another is that one
    other.value++;
    add_blur(g, in, (tyn_ref){0}, other);
    tyn_graph_output(g, "result", b, true);
}

// A node that makes the same as one before it is that one; not where a param or an input differs, or where it changes something in
// place.
static void same_nodes(void **state)
{
    fixture *f = *state;
    const node_params p = {1, 0, 0}, q = {1, 1, 0};
    tyn_graph_begin(f->g);
    const tyn_ref in = upload(f->g, "in", 1), other = upload(f->g, "other", 2);
    const tyn_ref a = add_blur(f->g, in, (tyn_ref){0}, p);
    assert_int_equal(add_blur(f->g, in, (tyn_ref){0}, p).resource, a.resource);
    assert_int_not_equal(add_blur(f->g, in, (tyn_ref){0}, q).resource, a.resource);
    assert_int_not_equal(add_blur(f->g, other, (tyn_ref){0}, p).resource, a.resource);
    tyn_ref sums[2][ADD_NUM];
    for (int i = 0; i < 2; i++) {
        memset(sums[i], 0, sizeof sums[i]);
        sums[i][ADD_SUM] = i ? sums[0][ADD_SUM] : tyn_graph_history_buffer(f->g, "sum", 4, 1);
        sums[i][ADD_X] = in;
        assert_int_equal(tyn_graph_add(f->g, &toy_add, &p, sums[i]), TYN_OK);
    }
    assert_int_equal(sums[1][ADD_SUM].version, 2);
    const tyn_node_stats *stats;
    tyn_graph_output(f->g, "a", a, true);
    assert_int_equal(frame(f), TYN_OK);
    assert_int_equal(tyn_graph_stats(f->g, &stats), 5);
}

// ---- barriers ---------------------------------------------------------------------------------

static void declare_drawing(tyn_graph *g, node_params p)
{
    static const float corners[9] = {1};
    tyn_graph_begin(g);
    tyn_ref refs[DRAW_NUM] = {tyn_graph_upload_buffer(g, "corners", corners, sizeof corners, 1)};
    tyn_ref blurred[BLUR_NUM] = {{0}};
    if (tyn_graph_add(g, &toy_draw, &p, refs) == TYN_OK) {
        blurred[BLUR_IN] = refs[DRAW_DEPTH];
        tyn_graph_add(g, &toy_blur, &(node_params){1, 0, 0}, blurred);
        tyn_graph_output(g, "color", refs[DRAW_COLOR], true);
        tyn_graph_output(g, "blurred", blurred[BLUR_OUT], false);
    }
}

static void drawing(void **state)
{
    fixture *f = *state;
    declare_drawing(f->g, (node_params){0});
    assert_int_equal(frame(f), TYN_OK);
    compare_golden("drawing.txt", f->fake->text);
    char *dump = tyn_graph_dump(f->g, false, NULL), *dot = tyn_graph_dump(f->g, true, NULL);
    assert_non_null(strstr(dump, "    draw corners 6 vertices, 2 tiles\n"));
    assert_non_null(strstr(dump, "    draw again 3 vertices, 1 tiles\n"));
    assert_non_null(strstr(dump, "depth (D32F 64 x 32, persistent)"));
    assert_non_null(strstr(dot, "#d3f0d3")); // the node that draws
    assert_non_null(strstr(dot, "#cfe2ff")); // the one that computes
    free(dump);
    free(dot);
    const tyn_node_stats *stats;
    assert_int_equal(tyn_graph_stats(f->g, &stats), 2);
    assert_int_equal(stats[0].dispatches, 3); // as many as tiles

    declare_drawing(f->g, (node_params){0}); // nothing changed: nothing is drawn
    fake_clear(f->fake);
    assert_int_equal(frame(f), TYN_OK);
    assert_null(strstr(f->fake->text, "rendering"));
    assert_int_equal(f->fake->dispatches, 0);

    declare_drawing(f->g, (node_params){.value = 1}); // attachments of two sizes
    assert_int_equal(frame(f), TYN_ERR_PARAMS);
    assert_non_null(strstr(f->fake->log, "attachments must exist"));
}

// A queue without graphics does everything but draw.
static void drawing_needs_graphics(void **state)
{
    fixture *f = *state;
    f->fake->dev.graphics = false;
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
    assert_null(strstr(f->fake->text, "VERTEX"));
    declare_drawing(f->g, (node_params){0});
    assert_int_equal(frame(f), TYN_ERR_UNSUPPORTED);
    assert_non_null(strstr(f->fake->log, "it needs a queue family with graphics"));
    f->fake->dev.graphics = true;
    f->fake->dev.depth = false;
    fake_clear(f->fake);
    declare_drawing(f->g, (node_params){0});
    assert_int_equal(frame(f), TYN_ERR_UNSUPPORTED);
    assert_non_null(strstr(f->fake->log, "it needs depth in format D32_SFLOAT"));
}

static void first_frame(void **state)
{
    fixture *f = *state;
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
    assert_states(f, "rrc");
    compare_golden("first_frame.txt", f->fake->text);
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

// The barriers and dispatches among the lines of a text, from line `from` on until one that starts
// with `until`; barriers of one dispatch sorted, as they go out together.
static void work_of(char *text, const char *from, const char *until, char *out)
{
    char *barriers[32];
    int num = 0;
    *out = 0;
    text = strstr(text, from);
    assert_non_null(text);
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        line += strspn(line, " ");
        if (strncmp(line, until, strlen(until)) == 0) {
            return; // barriers that wait belong to what comes after
        }
        if (strncmp(line, "barrier", 7) == 0) {
            barriers[num++] = line;
        } else if (strncmp(line, "dispatch", 8) == 0) {
            qsort(barriers, (size_t)num, sizeof *barriers, by_text);
            for (int i = 0; i < num; i++) {
                strcat(strcat(out, barriers[i]), "\n");
            }
            strcat(strcat(out, line), "\n");
            num = 0;
        }
    }
}

// What the dump says is what is recorded: same barriers, same dispatches, same order.
static void dump_tells_the_truth(void **state)
{
    fixture *f = *state;
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
    char *dump = tyn_graph_dump(f->g, false, NULL), *dot = tyn_graph_dump(f->g, true, NULL);
    compare_golden("dump.txt", dump);
    compare_golden("dump.dot", dot);
    char planned[8192], recorded[8192];
    work_of(dump, "node 0", "output", planned);
    work_of(f->fake->text, "node blur", "copy", recorded);
    assert_string_equal(planned, recorded);
    assert_true(strlen(planned) > 500);
    free(dump);
    free(dot);
}

// The first accesses of a frame wait for the last ones of the frame before.
static void second_frame_waits_for_the_first(void **state)
{
    fixture *f = *state;
    chain c = default_chain;
    declare_chain(f->g, &c);
    frame(f);
    c.bias = 0.5f;
    declare_chain(f->g, &c);
    assert_int_equal(frame(f), TYN_OK);
    assert_states(f, "urc");
    compare_golden("second_frame.txt", f->fake->text);
}

static void indirect_dispatch(void **state)
{
    fixture *f = *state;
    tyn_graph_begin(f->g);
    tyn_ref refs[COUNT_NUM] = {upload(f->g, "input", 1)};
    node_params p = {0};
    assert_int_equal(tyn_graph_add(f->g, &toy_count, &p, refs), TYN_OK);
    tyn_graph_output(f->g, "out", refs[COUNT_OUT], false);
    assert_int_equal(frame(f), TYN_OK);
    compare_golden("indirect.txt", f->fake->text);
}

// A host image comes in one state and is left in another, used or not.
static void host_image(void **state)
{
    fixture *f = *state;
    tyn_image image = fake_image(f->fake, "host", (VkExtent3D){W, H, 1});
    image.before = (tyn_sync){VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                              VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    image.after = (tyn_sync){VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                             VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    for (int i = 0; i < 2; i++) { // version 0: it may have changed, so both frames run
        tyn_graph_begin(f->g);
        tyn_ref in = tyn_graph_import_image(f->g, "host", TYN_IMAGE_2D, &image, 0);
        tyn_graph_output(f->g, "out", add_blur(f->g, in, (tyn_ref){0}, (node_params){1, 0, 0}),
                         false);
        assert_int_equal(frame(f), TYN_OK);
        assert_states(f, "r");
    }
    compare_golden("host_image.txt", f->fake->text);
    // A version says that the content is the same: nothing runs, the states are still exchanged.
    for (int i = 0; i < 2; i++) {
        tyn_graph_begin(f->g);
        tyn_ref in = tyn_graph_import_image(f->g, "host", TYN_IMAGE_2D, &image, 7);
        tyn_graph_output(f->g, "out", add_blur(f->g, in, (tyn_ref){0}, (node_params){1, 0, 0}),
                         false);
        assert_int_equal(frame(f), TYN_OK);
    }
    assert_states(f, "u");
    assert_int_equal(f->fake->dispatches, 0);
    assert_string_equal(f->fake->text,
                        "barrier host: COLOR_OUTPUT COLOR_WRITE -> FRAGMENT SAMPLED_READ, "
                        "COLOR_ATTACHMENT -> GENERAL\n");
    fake_free_image(f->fake, &image);
}

// ---- change tracking --------------------------------------------------------------------------

static void only_what_changed_runs(void **state)
{
    fixture *f = *state;
    chain c = default_chain;
    declare_chain(f->g, &c);
    frame(f);
    declare_chain(f->g, &c);
    frame(f);
    assert_states(f, "uuc");
    assert_int_equal(f->fake->dispatches + f->fake->copies, 0); // not even read back again

    c.second.value = 2; // arguments of the second
    declare_chain(f->g, &c);
    assert_true(tyn_graph_matches(f->g));
    frame(f);
    assert_states(f, "urc");
    assert_int_equal(f->fake->dispatches, 3);

    c.first.value = 2; // arguments of the first: the second reads what it made
    declare_chain(f->g, &c);
    frame(f);
    assert_states(f, "rrc");

    c.input = 2; // the data of both
    declare_chain(f->g, &c);
    frame(f);
    assert_states(f, "rrc");
    declare_chain(f->g, &c);
    frame(f);
    assert_states(f, "uuc");

    c.input = 1; // back again is a change, too
    declare_chain(f->g, &c);
    frame(f);
    assert_states(f, "rrc");

    declare_chain(f->g, &c);
    tyn_graph_mode(f->g)->recompute = true;
    frame(f);
    assert_states(f, "rrc");
}

static void structure_is_noticed(void **state)
{
    fixture *f = *state;
    chain c = default_chain;
    declare_chain(f->g, &c);
    frame(f);
    c.first.times = 2; // other dispatches
    declare_chain(f->g, &c);
    assert_false(tyn_graph_matches(f->g));
    fake_clear(f->fake);
    assert_int_equal(tyn_graph_record(f->g, no_cmd), TYN_ERR_PARAMS);
    assert_string_equal(f->fake->text, ""); // refused before the first command
    assert_non_null(strstr(f->fake->log, "prepare it first"));
    c = default_chain;
    c.second.spec = 1; // another pipeline
    declare_chain(f->g, &c);
    assert_false(tyn_graph_matches(f->g));
    declare_chain(f->g, &default_chain);
    assert_true(tyn_graph_matches(f->g));
    tyn_graph_output(f->g, "input", (tyn_ref){1, 0}, true); // another output
    assert_false(tyn_graph_matches(f->g));
}

// The media's nodes are no part of a frame's cost: they run when only the set-up is asked for, and are
// spared when everything else runs again.
static void media_are_set_up_apart(void **state)
{
    fixture *f = *state;
    tyn_pass_desc medium = toy_blur;
    medium.media_only = true;
    for (int i = 0; i < 3; i++) {
        tyn_graph_begin(f->g);
        tyn_ref in = upload(f->g, "input", 1);
        tyn_graph_mark_media(f->g, in);
        tyn_ref refs[BLUR_NUM] = {in};
        tyn_graph_add(f->g, &medium, &(node_params){1, 0, 0}, refs);
        tyn_graph_output(f->g, "out",
                         add_blur(f->g, refs[BLUR_OUT], (tyn_ref){0}, (node_params){1, 0, 0}),
                         true);
        if (i == 0) {
            tyn_graph_mode(f->g)->setup_only = true;
        } else if (i == 2) {
            tyn_graph_mode(f->g)->recompute = true;
        }
        assert_int_equal(frame(f), TYN_OK);
        assert_states(f, i == 0 ? "ru" : "ur");
    }
}

// In-place changes: the buffer is an upload that two nodes change; if one must run again so must the
// other, from the upload on.
static void histories(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < 6; i++) {
        uint64_t key = i < 3 ? 5 : 6;
        tyn_graph_begin(f->g);
        if (i >= 4) {
            tyn_graph_output(
                f->g, "other",
                add_blur(f->g, upload(f->g, "y", 1), (tyn_ref){0}, (node_params){1, 0, 0}), false);
        }
        tyn_ref x = upload(f->g, "x", i < 2 ? 1 : 2);
        tyn_ref refs[ADD_NUM] = {tyn_graph_history_buffer(f->g, "history", i < 5 ? 64 : 128, key),
                                 x};
        assert_int_equal(tyn_graph_add(f->g, &toy_add, &(node_params){0}, refs), TYN_OK);
        tyn_graph_output(f->g, "sum", refs[ADD_SUM], false);
        assert_int_equal(frame(f), TYN_OK);
        assert_states(f, i == 1 ? "u" : i < 4 ? "r" : i == 4 ? "rr" : "ur");
        // Zeros at the start and when the key changes, never in between, also not when the graph is compiled
        // anew because there is something else in it; then because the history has another size.
        assert_int_equal(strstr(f->fake->text, "fill history\n") != NULL,
                         i == 0 || i == 3 || i == 5);
    }
}

// One output more is another structure: what is in both compilations keeps its object and its content, nothing is
// uploaded again, and the new node waits for what the old one wrote in the frame before.
static void new_compilation_keeps(void **state)
{
    fixture *f = *state;
    uint32_t made[2];
    for (int i = 0; i < 5; i++) {
        const bool more = i == 1 || i == 2 || i == 4;
        tyn_graph_begin(f->g);
        const tyn_ref first =
            add_blur(f->g, upload(f->g, "x", 1), (tyn_ref){0}, (node_params){1, 0, 0});
        const tyn_ref second = add_blur(f->g, first, (tyn_ref){0}, (node_params){2, 0, 0});
        tyn_graph_output(f->g, "second", second, false);
        if (more) {
            const tyn_ref third =
                add_blur(f->g, i == 4 ? second : first, (tyn_ref){0}, (node_params){i, 1, 0});
            tyn_graph_output(f->g, "third", third, false);
        }
        const uint32_t before = f->fake->created;
        assert_int_equal(frame(f), TYN_OK);
        // In the last the second is sampled, which its image was not made for: a new one.
        assert_states(f, i == 0 ? "rr" : i == 4 ? "urr" : more ? "uur" : "uu");
        assert_int_equal(strstr(f->fake->text, "copy") != NULL, i == 0);
        if (i < 2) {
            made[i] = f->fake->created - before;
        }
        if (i == 1) {
            // Only the new image begins without a layout: that of what was kept, stand-ins too, is known.
            uint32_t undefined = 0;
            for (const char *at = f->fake->text; (at = strstr(at, "UNDEFINED ->")); at++) {
                undefined++;
            }
            assert_int_equal(undefined, 1);
        }
    }
    assert_true(made[1] < made[0]);
}

// What another graph replaces is there until the frames that used it are over: two are in flight. If the device is idle it
// goes at once; what no frame has used goes at once as well.
static void replaced_outlives_its_frames(void **state)
{
    fixture *f = *state;
    for (int idle = 0; idle < 2; idle++) {
        uint32_t live[4];
        declare_chain(f->g, &default_chain);
        assert_int_equal(frame(f), TYN_OK);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(frame(f), TYN_OK);
        }
        declare_drawing(f->g, (node_params){0});
        if (idle) {
            tyn_graph_mode(f->g)->idle = true;
        }
        live[0] = f->fake->live;
        assert_int_equal(tyn_graph_compile(f->g), TYN_OK);
        for (int i = 1; i < 4; i++) {
            live[i] = f->fake->live;
            assert_int_equal(frame(f), TYN_OK);
        }
        print_message("%s: %u objects, compiled %u, after frames %u and %u\n",
                      idle ? "idle" : "in flight", live[0], live[1], live[2], live[3]);
        assert_int_equal(live[2], live[1]);
        assert_true(idle ? live[3] == live[1] : live[3] + 5 < live[1]);
    }
}

// ---- faults -----------------------------------------------------------------------------------

static void expect_fault(fixture *f, const tyn_pass_desc *pass, tyn_ref *refs, const char *text)
{
    f->fake->log[0] = 0;
    assert_int_equal(tyn_graph_add(f->g, pass, &(node_params){1, 0, 0}, refs), TYN_ERR_PARAMS);
    if (!strstr(f->fake->log, text)) {
        fail_msg("'%s' lacks '%s'", f->fake->log, text);
    }
    assert_int_equal(tyn_graph_status(f->g), TYN_ERR_PARAMS);
    assert_int_equal(tyn_graph_compile(f->g), TYN_ERR_PARAMS);
    assert_int_equal(tyn_graph_record(f->g, no_cmd), TYN_ERR_PARAMS);
}

static void faults(void **state)
{
    fixture *f = *state;
    tyn_graph_begin(f->g);
    tyn_ref refs[BLUR_NUM] = {{0}};
    expect_fault(f, &toy_blur, refs, "node 'blur': input 'in' (what is blurred) is not connected");

    // The version of a buffer that a later node has changed.
    tyn_graph_begin(f->g);
    tyn_ref x = upload(f->g, "x", 1), history = tyn_graph_history_buffer(f->g, "sum", 64, 1);
    tyn_ref first[ADD_NUM] = {history, x}, stale[ADD_NUM] = {history, x};
    assert_int_equal(tyn_graph_add(f->g, &toy_add, &(node_params){0}, first), TYN_OK);
    expect_fault(f, &toy_add, stale,
                 "node 'add': input 'sum' is version 0 of 'sum', which was overwritten; the newest "
                 "is 1");

    tyn_graph_begin(f->g);
    tyn_ref kind[BLUR_NUM] = {tyn_graph_history_buffer(f->g, "numbers", 64, 1)};
    expect_fault(f, &toy_blur, kind, "input 'in' and 'numbers' differ in kind");

    tyn_graph_begin(f->g);
    fake_clear(f->fake);
    tyn_graph_output(f->g, "result", (tyn_ref){9, 0}, true);
    assert_string_equal(f->fake->log, "output 'result' is not a resource\n");
    assert_int_equal(tyn_graph_status(f->g), TYN_ERR_PARAMS);

    // Counters of a pass that is named as an output, for instance.
    tyn_graph_begin(f->g);
    fake_clear(f->fake);
    const tyn_ref one = upload(f->g, "one", 1), other = upload(f->g, "other", 2);
    tyn_graph_output(f->g, "result", one, true);
    tyn_graph_output(f->g, "result", one, true);
    tyn_graph_output(f->g, "result", other, false);
    assert_int_equal(tyn_graph_status(f->g), TYN_OK);
    tyn_graph_output(f->g, "result", other, true);
    assert_string_equal(f->fake->log, "output 'result' is there already, of another resource: a "
                                      "pass with counters needs a name that no output has\n");
    assert_int_equal(tyn_graph_status(f->g), TYN_ERR_PARAMS);

    // A new declaration starts afresh.
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
}

// A frame that asks for counters reads back the buffer of the first node of a pass, under the name of the pass. A frame that
// does not keeps no node alive for them.
static void counters(void **state)
{
    fixture *f = *state;
    static const tyn_counter rows[] = {{"groups", 0}, {NULL}};
    static tyn_pass_desc counting;
    counting = toy_count;
    counting.counters = rows;
    counting.counter_port = COUNT_GROUPS;
    for (int asked = 0; asked < 2; asked++) {
        tyn_graph_begin(f->g);
        tyn_graph_mode(f->g)->counters = asked;
        const tyn_ref in = upload(f->g, "input", 1);
        tyn_ref first[COUNT_NUM] = {in}, second[COUNT_NUM] = {in};
        tyn_graph_add(f->g, &counting, &(node_params){0}, first);
        tyn_graph_add(f->g, &counting, &(node_params){0, 1, 0}, second);
        tyn_graph_output(f->g, "out", second[COUNT_OUT], false);
        assert_int_equal(frame(f), TYN_OK);
        const tyn_node_stats *stats;
        assert_int_equal(tyn_graph_stats(f->g, &stats), 2);
        assert_int_equal(stats[0].state, asked ? TYN_NODE_RAN : TYN_NODE_CULLED);
        assert_int_equal(tyn_graph_map(f->g, "count", NULL, NULL) != NULL, asked);
    }
}

static void huge_image(void **state)
{
    fixture *f = *state;
    tyn_graph_begin(f->g);
    tyn_ref in = tyn_graph_upload_image(f->g, "wide", TYN_IMAGE_2D, VK_FORMAT_R32_SFLOAT,
                                        (tyn_extent){20000, 1, 1}, fill_zero, NULL, 1);
    tyn_graph_output(f->g, "out", add_blur(f->g, in, (tyn_ref){0}, (node_params){1, 0, 0}), false);
    assert_int_equal(frame(f), TYN_ERR_UNSUPPORTED);
    assert_string_equal(f->fake->log,
                        "image 'wide' of 20000 x 1 x 1: the device's limit is 16384 per axis\n");
}

static void huge_buffer(void **state)
{
    fixture *f = *state;
    f->fake->dev.properties.limits.maxStorageBufferRange = 1 << 20;
    static const char bytes[3 << 20];
    tyn_graph_begin(f->g);
    tyn_graph_upload_buffer(f->g, "many", bytes, sizeof bytes, 1);
    assert_string_equal(f->fake->log, "'many' takes 3.0 MiB; the device binds at most 1.0 MiB\n");
    f->fake->dev.properties.limits.maxStorageBufferRange = 8; // of a pass: 12 bytes
    fake_clear(f->fake);
    tyn_graph_begin(f->g);
    tyn_ref refs[COUNT_NUM] = {upload(f->g, "input", 1)};
    assert_int_equal(tyn_graph_add(f->g, &toy_count, &(node_params){0, 1, 0}, refs),
                     TYN_ERR_UNSUPPORTED);
    assert_non_null(strstr(f->fake->log, "pass 'count' needs a buffer '"));
}

// What a kernel asks for beyond the device's limits is told.
static void small_device(void **state)
{
    fixture *f = *state;
    VkPhysicalDeviceLimits *limits = &f->fake->dev.properties.limits;
    const struct {
        uint32_t *limit, value;
        const char *line;
    } cases[] = {
        {&limits->maxPerStageDescriptorSampledImages, 0, "needs 1 sampled images; "},
        {&limits->maxPerStageDescriptorSamplers, 0, "needs 1 samplers; "},
        {&limits->maxPerStageDescriptorUniformBuffers, 0, "needs 1 uniform buffers; "},
        {&limits->maxPerStageResources, 2, "needs 3 resources in all; "},
        {&limits->maxPushConstantsSize, 2, "needs 4 bytes of push constants; "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const uint32_t before = *cases[i].limit;
        *cases[i].limit = cases[i].value;
        fake_clear(f->fake);
        declare_chain(f->g, &default_chain);
        assert_int_equal(frame(f), TYN_ERR_UNSUPPORTED);
        assert_non_null(strstr(f->fake->log, cases[i].line));
        *cases[i].limit = before;
    }
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
}

// One line, however many launches want one; then all is as before.
static void no_descriptor_sets(void **state)
{
    fixture *f = *state;
    declare_chain(f->g, &default_chain);
    f->fake->no_sets = true;
    assert_int_equal(frame(f), TYN_ERR_DEVICE);
    assert_string_equal(f->fake->log, "node 'blur': vkAllocateDescriptorSets for kernel 'blur' "
                                      "failed with VkResult -1000069000\n");
    f->fake->no_sets = false;
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
    assert_states(f, "rrc");
}

// Whichever allocation fails: an error, nothing leaks, and the next frame is made in full.
static void out_of_memory(void **state)
{
    fixture *f = *state;
    uint32_t failures = 0;
    for (uint32_t at = 1;; at++) {
        f->fake->created = 0;
        f->fake->fail_at = at;
        declare_chain(f->g, &default_chain);
        tyn_result result = frame(f);
        f->fake->fail_at = 0;
        if (result == TYN_OK) {
            break;
        }
        assert_int_equal(result, TYN_ERR_MEMORY);
        assert_true(strlen(f->fake->log) > 0);
        failures++;
        declare_chain(f->g, &default_chain);
        assert_int_equal(frame(f), TYN_OK);
        assert_states(f, "rrc");
        // Start over with nothing, so that the same calls come again.
        tyn_graph_destroy(&f->g);
        tyn_pipelines_destroy(&f->fake->dev);
        if (f->fake->live) {
            fail_msg("call %u fails: something is left", at);
        }
        assert_int_equal(tyn_graph_create(&f->fake->dev, 2, &f->g), TYN_OK);
    }
    assert_true(failures > 20);
}

// What was recorded is thrown away, with two frames in flight: all goes at once, and the next frame is made in full.
static void forgotten(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < 2; i++) {
        declare_chain(f->g, &default_chain);
        assert_int_equal(frame(f), TYN_OK);
    }
    tyn_graph_forget(f->g);
    const uint32_t live = f->fake->live;
    declare_chain(f->g, &default_chain);
    assert_int_equal(frame(f), TYN_OK);
    assert_states(f, "rrc");
    assert_true(f->fake->live > live);
    tyn_graph_forget(f->g);
    tyn_graph_destroy(&f->g);
    assert_int_equal(f->fake->live, live); // but kernels
    assert_int_equal(tyn_graph_create(&f->fake->dev, 2, &f->g), TYN_OK);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(first_frame),
        TEST(dump_tells_the_truth),
        TEST(second_frame_waits_for_the_first),
        TEST(indirect_dispatch),
        TEST(same_nodes),
        TEST(drawing),
        TEST(drawing_needs_graphics),
        TEST(host_image),
        TEST(only_what_changed_runs),
        TEST(structure_is_noticed),
        TEST(media_are_set_up_apart),
        TEST(histories),
        TEST(new_compilation_keeps),
        TEST(replaced_outlives_its_frames),
        TEST(forgotten),
        TEST(faults),
        TEST(counters),
        TEST(huge_image),
        TEST(huge_buffer),
        TEST(small_device),
        TEST(no_descriptor_sets),
        TEST(out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
