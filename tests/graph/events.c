// events.c -- what one change of a scene costs: for each kind of event the nodes that run, and what is made in Vulkan, on a device that
// only writes down what it is told. docs/events.md shows the tables; with --tables the program prints them, which
// tools/docs/events puts there.
#include "built_in.h"
#include "skip.h"
#include "events_before.h"
#include "fake_vulkan.h"
#include "solids.h"
#include <tyndall/context.h>
#include <tyndall/registry.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

// ---- the scene --------------------------------------------------------------------------------

enum { NX = 16, NY = 12, NZ = 20, MAP = 8, SUN = 0, LAMP = 1 };

typedef struct stage {
    fake_vulkan *fake;
    tyn_context *ctx;
    tyn_scene scene;
    tyn_view view;
} stage;

static void add_smoke(tyn_scene *s)
{
    s->volumes = calloc(1, sizeof *s->volumes);
    s->num_volumes = 1;
    s->volumes[0] = (tyn_volume){.size = {NX, NY, NZ},
                                 .data = malloc(NX * NY * NZ * sizeof(float)),
                                 .max_density = 1,
                                 .hash = 1};
    for (int i = 0; i < NX * NY * NZ; i++) {
        s->volumes[0].data[i] = (float)(i % 11) * 0.1f;
    }
    s->media[s->num_media++] = (tyn_medium){.sigma_s = {4, 4, 4},
                                            .sigma_a = {0.5f, 0.5f, 0.5f},
                                            .phase = {{.g = 0.5f}, {.g = 0.5f}, {.g = 0.5f}},
                                            .density_scale = 1};
    tyn_shape *shape = &s->shapes[s->num_shapes++];
    *shape = (tyn_shape){.kind = TYN_SHAPE_BOX};
    const float sides[4] = {1.6f, 1.2f, 2.0f, 1};
    for (int a = 0; a < 4; a++) {
        shape->to_world[5 * a] = sides[a];
    }
}

static void add_map(tyn_scene *s)
{
    tyn_environment *env = &s->environment;
    *env = (tyn_environment){
        .present = true, .size = {2 * MAP, MAP}, .radiance = {1, 1, 1}, .strength = 1, .hash = 1};
    env->data = malloc(sizeof(float[3]) * 2 * MAP * MAP);
    for (int i = 0; i < 2 * MAP * MAP * 3; i++) {
        env->data[i] = i < MAP * MAP * 3 ? 0.3f : 0.05f; // rows from the top
    }
}

static void make_scene(tyn_scene *s, bool floor, bool map)
{
    tyn_scene_init(s);
    add_smoke(s);
    if (map) {
        add_map(s);
    }
    s->lights[s->num_lights++] = (tyn_light){
        .kind = TYN_LIGHT_DIRECTIONAL, .color = {3, 3, 3}, .direction = {0.48f, -0.8f, 0.36f}};
    for (int i = 0; i < 4; i++) {
        s->lights[s->num_lights++] = (tyn_light){.kind = TYN_LIGHT_POINT,
                                                 .color = {2.4f, 2.4f, 2.4f},
                                                 .position = {0.4f * (float)i - 0.6f, 1, 0.2f}};
    }
    if (floor) {
        const uint32_t grey = solids_material(s, (float[]){0.5f, 0.5f, 0.5f}, (float[3]){0});
        solids_quad(s, (float[]){-2, -0.9f, -2}, (float[]){0, 0, 4}, (float[]){4, 0, 0}, grey);
        s->surfaces.hash = 1;
    }
}

// ---- events -----------------------------------------------------------------------------------

static void nothing(stage *st)
{
    (void)st;
}

static void move_camera(stage *st)
{
    st->view.camera.position[0] += 0.1f;
}

static void turn_camera(stage *st)
{
    const float *p = st->view.camera.position, at[3] = {0.1f, 0, 0};
    assert_int_equal(tyn_camera_look_at(&st->view.camera, (float[]){p[0], p[1], p[2]}, at), TYN_OK);
}

static void resize(stage *st)
{
    st->view.width = 64;
}

static void one_more_output(stage *st)
{
    st->view.outputs |= TYN_OUTPUT_DEPTH;
}

static void scale_lamp(stage *st)
{
    for (int c = 0; c < 3; c++) {
        st->scene.lights[LAMP].color[c] = 2.8f;
    }
}

static void lamp_off(stage *st)
{
    memset(st->scene.lights[LAMP].color, 0, sizeof st->scene.lights[LAMP].color);
}

static void lamp_on(stage *st)
{
    for (int c = 0; c < 3; c++) {
        st->scene.lights[LAMP].color[c] = 2.4f;
    }
}

static void move_lamp(stage *st)
{
    st->scene.lights[LAMP].position[1] += 0.1f;
}

static void add_lamp(stage *st)
{
    tyn_scene *s = &st->scene;
    s->lights[s->num_lights] = s->lights[LAMP];
    s->lights[s->num_lights++].position[2] = -0.4f;
}

static void colour_lamp(stage *st)
{
    st->scene.lights[LAMP].color[2] *= 0.5f;
}

static void scale_sun(stage *st)
{
    for (int c = 0; c < 3; c++) {
        st->scene.lights[SUN].color[c] *= 1.2f;
    }
}

static void sun_off(stage *st)
{
    memset(st->scene.lights[SUN].color, 0, sizeof st->scene.lights[SUN].color);
}

static void sun_on(stage *st)
{
    for (int c = 0; c < 3; c++) {
        st->scene.lights[SUN].color[c] = 3;
    }
}

static void aim_sun(stage *st, float x, float y, float z)
{
    memcpy(st->scene.lights[SUN].direction, (float[]){x, y, z}, sizeof(float[3]));
}

static void turn_sun(stage *st)
{
    aim_sun(st, 0.36f, -0.8f, 0.48f);
}

static void cross_side(stage *st)
{
    aim_sun(st, 0.8f, -0.48f, 0.36f);
}

static void colour_sun(stage *st)
{
    st->scene.lights[SUN].color[2] *= 0.5f;
}

static void colour_medium(stage *st)
{
    st->scene.media[0].sigma_s[2] *= 0.5f;
}

static void scale_density(stage *st)
{
    st->scene.media[0].density_scale *= 1.1f;
}

static void replace_grid(stage *st)
{
    st->scene.volumes[0].data[7] = 0.35f;
    st->scene.volumes[0].hash++;
}

static void move_medium(stage *st)
{
    st->scene.shapes[0].to_world[12] += 0.1f;
}

static void scale_map(stage *st)
{
    st->scene.environment.strength *= 1.2f;
}

static void turn_map(stage *st)
{
    memcpy(st->scene.environment.rotation, (float[]){0, 0.1f, 0, 0.995f}, sizeof(float[4]));
}

static void even_sky(stage *st)
{
    free(st->scene.environment.data);
    st->scene.environment.data = NULL;
    memset(st->scene.environment.size, 0, sizeof st->scene.environment.size);
}

static void replace_map(stage *st)
{
    st->scene.environment.data[5] *= 1.5f;
    st->scene.environment.hash++;
}

static void move_surface(stage *st)
{
    for (uint32_t i = 0; i < st->scene.surfaces.num_vertices; i++) {
        st->scene.surfaces.vertices[i].position[1] -= 0.1f;
    }
    st->scene.surfaces.hash++;
}

static void set_cells(stage *st)
{
    assert_int_equal(tyn_context_set(st->ctx, "lattice.cells", "24"), TYN_OK);
}

typedef struct cost {
    uint32_t nodes, objects, allocations, kernels;
    char record; // without prepare: 'y' goes on, 'p' TYN_PENDING, 'n' refuses
    char ran[512];
} cost;

static const struct event {
    const char *name;
    void (*from)(stage *st); // on the scene before the first frame
    void (*change)(stage *st);
    bool bare;   // without the floor
    bool no_map; // and without the map
} events[] = {
    {"nothing changed", nothing, nothing, false, false},
    {"camera moved", nothing, move_camera, false, false},
    {"camera turned", nothing, turn_camera, false, false},
    {"picture resized", nothing, resize, false, false},
    {"one more output", nothing, one_more_output, false, false},
    {"lamp of four: strength 2.4 to 2.8", nothing, scale_lamp, false, false},
    {"lamp of four off", nothing, lamp_off, false, false},
    {"lamp of four on", lamp_off, lamp_on, false, false},
    {"lamp moved", nothing, move_lamp, false, false},
    {"lamp grey to coloured", nothing, colour_lamp, false, false},
    {"lamp added", nothing, add_lamp, false, false},
    {"sun's strength", nothing, scale_sun, false, false},
    {"sun off", nothing, sun_off, false, false},
    {"sun on", sun_off, sun_on, false, false},
    {"sun turned", nothing, turn_sun, false, false},
    {"sun crosses a side", nothing, cross_side, false, false},
    {"sun grey to coloured, no surfaces", nothing, colour_sun, true, false},
    {"sun grey to coloured, no surfaces, no map", nothing, colour_sun, true, true},
    {"sun grey to coloured", nothing, colour_sun, false, false},
    {"medium grey to coloured", nothing, colour_medium, true, false},
    {"density scale of the medium", nothing, scale_density, false, false},
    {"grid replaced by one of equal size", nothing, replace_grid, false, false},
    {"medium moved", nothing, move_medium, false, false},
    {"map's strength", nothing, scale_map, false, false},
    {"map turned", nothing, turn_map, false, false},
    {"map replaced", nothing, replace_map, false, false},
    {"surface moved", nothing, move_surface, false, false},
    {"`lattice.cells` 32 to 24", nothing, set_cells, false, false},
};
enum { NUM_EVENTS = sizeof events / sizeof *events };

// ---- frames -----------------------------------------------------------------------------------

static void open_stage(stage *st, const char *method, const struct event *e)
{
    *st = (stage){.fake = fake_create()};
    assert_int_equal(tyn_context_create(&st->fake->dev,
                                        tyn_context_params(.method = method, .frames_in_flight = 2),
                                        &st->ctx),
                     TYN_OK);
    make_scene(&st->scene, !e->bare, !e->no_map);
    st->view = (tyn_view){.width = 48, .height = 32, .outputs = TYN_OUTPUT_RADIANCE};
    st->view.camera.yfov = 0.7f;
    assert_int_equal(tyn_camera_look_at(&st->view.camera, (float[]){1, 2, 4}, (float[]){0, 0, 0}),
                     TYN_OK);
    e->from(st);
}

static void close_stage(stage *st)
{
    tyn_context_destroy(&st->ctx);
    tyn_scene_finish(&st->scene);
    fake_destroy(&st->fake); // fails if anything is left
}

static tyn_result record(stage *st)
{
    st->fake->recording = true;
    const tyn_result result =
        tyn_context_record(st->ctx, tyn_frame(.cmd = (VkCommandBuffer)(uintptr_t)1,
                                              .scene = &st->scene, .view = &st->view));
    st->fake->recording = false;
    assert_int_equal(st->fake->created_while_recording, 0);
    return result;
}

static void prepare(stage *st)
{
    const tyn_result result =
        tyn_context_prepare(st->ctx, tyn_frame(.scene = &st->scene, .view = &st->view));
    if (result != TYN_OK) {
        fail_msg("prepare gives %d: %s", result, st->fake->log);
    }
}

static void list_nodes(stage *st, cost *c)
{
    tyn_report report;
    tyn_context_report(st->ctx, &report);
    for (uint32_t i = 0; i < report.num_nodes; i++) {
        if (!strcmp(report.nodes[i].state, "ran")) {
            const size_t used = strlen(c->ran);
            snprintf(c->ran + used, sizeof c->ran - used, "%s%s", used ? " " : "",
                     report.nodes[i].name);
            c->nodes++;
        }
    }
}

static cost cost_of(const char *method, const struct event *e)
{
    stage st;
    open_stage(&st, method, e);
    for (int i = 0; i < 2; i++) {
        prepare(&st);
        assert_int_equal(record(&st), TYN_OK);
    }
    e->change(&st);
    fake_clear(st.fake);
    const fake_vulkan before = *st.fake;
    cost c = {0};
    const tyn_result alone = record(&st);
    c.record = alone == TYN_OK ? 'y' : alone == TYN_PENDING ? 'p' : 'n';
    if (alone != TYN_OK) {
        prepare(&st);
        assert_int_equal(record(&st), TYN_OK);
    }
    list_nodes(&st, &c);
    c.allocations = st.fake->memory - before.memory;
    c.kernels = st.fake->kernels - before.kernels;
    c.objects = st.fake->created - before.created - c.allocations - c.kernels;
    close_stage(&st);
    return c;
}

// ---- tables -----------------------------------------------------------------------------------

static const char *const methods[] = {"pop", "lpv", "pop-paper"};
enum { NUM_METHODS = sizeof methods / sizeof *methods };

static const char *words(char record)
{
    return record == 'y' ? "goes on" : record == 'p' ? "waits" : "refuses";
}

static void print_pair(FILE *out, uint32_t from, uint32_t to)
{
    if (from == to) {
        fprintf(out, " %u |", to);
    } else {
        fprintf(out, " %u to **%u** |", from, to);
    }
}

static void print_row(FILE *out, const struct event *e, const struct before *b, const cost *c)
{
    fprintf(out, "| %s | ", e->name);
    if (b->record != c->record) {
        fprintf(out, "%s to **%s** |", words(b->record), words(c->record));
    } else {
        fprintf(out, "%s |", words(c->record));
    }
    print_pair(out, b->nodes, c->nodes);
    print_pair(out, b->objects, c->objects);
    print_pair(out, b->allocations, c->allocations);
    fprintf(out, " %u |\n", c->kernels / 4); // a module, two layouts and a pipeline each
}

static void print_tables(FILE *out)
{
    for (int m = 0; m < NUM_METHODS; m++) {
        fprintf(out, "%s## `%s`\n\n", m ? "\n" : "", methods[m]);
        fprintf(out, "| event | record without prepare | nodes run | objects made | allocations | "
                     "kernels |\n|---|---|---|---|---|---|\n");
        for (int i = 0; i < NUM_EVENTS; i++) {
            const cost c = cost_of(methods[m], &events[i]);
            print_row(out, &events[i], &costs_before[m][i], &c);
        }
    }
    fprintf(out, "\n## Nodes that run, `pop`\n\n| event | nodes |\n|---|---|\n");
    for (int i = 0; i < NUM_EVENTS; i++) {
        const cost c = cost_of("pop", &events[i]);
        fprintf(out, "| %s | %s |\n", events[i].name, c.ran);
    }
}

// ---- tests ------------------------------------------------------------------------------------

// What docs/events.md shows between its marks is what happens.
static void page_is_true(void **state)
{
    (void)state;
    for (int m = 0; m < NUM_METHODS; m++) {
        if (!is_built_in(methods[m])) {
            skip_case("no method '%s'", methods[m]);
        }
    }
    char *tables = NULL, *page = calloc(1, 1 << 16);
    size_t size = 0;
    FILE *out = open_memstream(&tables, &size), *file = fopen(TYN_TEST_PAGE, "r");
    print_tables(out);
    fclose(out);
    assert_non_null(file);
    assert_true(fread(page, 1, (1 << 16) - 1, file) > 0);
    fclose(file);
    const char *shown = strstr(page, "<!-- tables -->\n");
    assert_non_null(shown);
    shown += strlen("<!-- tables -->\n");
    if (strncmp(shown, tables, size) || strncmp(shown + size, "<!-- end of tables -->", 22)) {
        size_t at = 0;
        while (at < size && shown[at] == tables[at]) {
            at++;
        }
        fail_msg("docs/events.md differs from here on; tools/docs/events makes it anew:\n%.200s",
                 tables + (at > 100 ? at - 100 : 0));
    }
    free(tables);
    free(page);
}

// What changes sizes, counts or settings; all else are values.
static bool changes_sizes(const struct event *e)
{
    return e->change == resize || e->change == one_more_output || e->change == add_lamp ||
           e->change == set_cells;
}

// No value makes record refuse, and where it goes on nothing is made.
static void values_do_not_refuse(void **state)
{
    (void)state;
    for (int m = 0; m < NUM_METHODS; m++) {
        for (int i = 0; i < NUM_EVENTS && is_built_in(methods[m]); i++) {
            const cost c = cost_of(methods[m], &events[i]);
            const bool made = c.objects || c.allocations || c.kernels;
            if ((c.record == 'n' && !changes_sizes(&events[i])) || (c.record == 'y' && made)) {
                fail_msg(
                    "%s, %s: record %s, and %u objects, %u allocations and %u kernels are made",
                    methods[m], events[i].name, words(c.record), c.objects, c.allocations,
                    c.kernels);
            }
        }
    }
}

static void more_samples(stage *st)
{
    st->view.num_samples = 3;
    colour_medium(st); // which asks for other kernels
}

static void samples_are_values(void **state)
{
    (void)state;
    assert_int_equal(
        cost_of("path", &(struct event){"", nothing, more_samples, true, false}).record, 'p');
}

// Colours and strengths run no node that does not read them, and make nothing.
static void strengths_are_values(void **state)
{
    (void)state;
    void (*const changes[])(stage *) = {scale_lamp, scale_sun, scale_map, colour_sun};
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        const struct event e = {"", nothing, changes[k], false, false};
        const cost c = cost_of("pop", &e);
        assert_int_equal(c.record, 'y');
        assert_null(strstr(c.ran, "medium"));
        assert_null(strstr(c.ran, "shadow_map"));
        assert_null(strstr(c.ran, "sky_shadows"));
        assert_null(strstr(c.ran, "sky_seen"));
        assert_null(strstr(c.ran, "columns"));
        assert_null(strstr(c.ran, "walls"));
        assert_null(strstr(c.ran, "lattice_cells"));
        assert_true(strncmp(c.ran, "beam", 4) != 0);
    }
    // Without surfaces that reflect it, light of a lamp that flickers goes through the grid that is there.
    const struct event flicker = {"", nothing, scale_lamp, true, false};
    const cost c = cost_of("pop", &flicker);
    assert_int_equal(c.record, 'y');
    assert_non_null(strstr(c.ran, "radial_lights"));
    assert_null(strstr(c.ran, "radial_beam"));
}

// A sky that is even looks the same however it is turned.
static void even_skies_do_not_turn(void **state)
{
    (void)state;
    const cost c = cost_of("pop", &(struct event){"", even_sky, turn_map, false, false});
    assert_int_equal(c.record, 'y');
    assert_string_equal(c.ran, "");
    const cost dimmed = cost_of("pop", &(struct event){"", even_sky, scale_map, false, false});
    assert_non_null(strstr(dimmed.ran, "sky_light"));
    assert_null(strstr(dimmed.ran, "sky_shadows"));
}

// A light that is off and stays off costs what one costs that is not there.
static void dark_lights_are_not_there(void **state)
{
    (void)state;
    uint32_t made[2];
    for (int k = 0; k < 2; k++) {
        stage st;
        open_stage(&st, "pop", &(struct event){"", nothing, nothing, false, false});
        if (k) {
            sun_off(&st);
            lamp_off(&st);
        } else {
            st.scene.num_lights -= 2;
            memmove(st.scene.lights, st.scene.lights + 2,
                    st.scene.num_lights * sizeof *st.scene.lights);
        }
        prepare(&st);
        assert_int_equal(record(&st), TYN_OK);
        made[k] = st.fake->created;
        close_stage(&st);
    }
    assert_int_equal(made[0], made[1]);
}

int main(int argc, char **argv)
{
    if (argc > 1 && !strcmp(argv[1], "--tables")) {
        print_tables(stdout);
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(page_is_true),           cmocka_unit_test(values_do_not_refuse),
        cmocka_unit_test(samples_are_values),     cmocka_unit_test(strengths_are_values),
        cmocka_unit_test(even_skies_do_not_turn), cmocka_unit_test(dark_lights_are_not_there),
    };
    return run_cases(tests, NULL, NULL);
}
