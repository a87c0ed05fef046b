// selftest_graphs.c -- compiled graphs: between a node that writes and one that reads stands a barrier.
#include "selftest.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Follows the text of a compiled graph (tyn_context_graph) line by line. Resources go by name; a node's input
// "density = atlas" reads the resource "atlas".
enum { MAX_RESOURCES = 256, NAME = 48 };
typedef struct resource {
    char name[NAME];
    bool made;     // a node before this one has it as an output
    bool many;     // several nodes have an output of this name: barriers on it may be of any
    bool readable; // a barrier since its node's first launch makes it visible to reads
} resource;

typedef struct graph_check {
    resource resources[MAX_RESOURCES];
    uint32_t num_resources;
    uint32_t outputs[MAX_RESOURCES], num_outputs; // of the node so far
    uint32_t inputs[MAX_RESOURCES], num_inputs;
    uint32_t num_nodes, num_barriers, num_reads, num_missing;
    bool began; // the node has launched
} graph_check;

static uint32_t resource_of(graph_check *g, const char *name, size_t length)
{
    length = length < NAME ? length : NAME - 1;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        if (strlen(g->resources[i].name) == length &&
            strncmp(g->resources[i].name, name, length) == 0) {
            return i;
        }
    }
    if (g->num_resources == MAX_RESOURCES) {
        return 0;
    }
    resource *r = &g->resources[g->num_resources];
    *r = (resource){.made = false};
    memcpy(r->name, name, length);
    return g->num_resources++;
}

// "beams (buffer ..." or "density = atlas (R32F ...": the resource's name. NULL: none is connected.
static const char *name_at(const char *text, size_t *length)
{
    const char *size = strchr(text, '('), *end = strchr(text, ':');
    if (!size || (end && end < size)) {
        return NULL; // "sigma_s: none"
    }
    for (const char *equals = strstr(text, " = "); equals && equals < size;
         equals = strstr(text, " = ")) {
        text = equals + 3;
    }
    *length = (size_t)(size - text - (size[-1] == ' '));
    return text;
}

static void add_port(graph_check *g, const char *text, uint32_t *list, uint32_t *count)
{
    size_t length;
    const char *name = name_at(text, &length);
    if (name && *count < MAX_RESOURCES) {
        list[(*count)++] = resource_of(g, name, length);
    }
}

// A node has ended: what it reads of earlier nodes has been made visible, and others may read what it made.
static void end_node(graph_check *g)
{
    for (uint32_t i = 0; i < g->num_inputs; i++) {
        const resource *r = &g->resources[g->inputs[i]];
        g->num_reads += r->made && !r->many;
        g->num_missing += r->made && !r->many && !r->readable;
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        g->resources[g->outputs[i]].made = true;
    }
    g->num_inputs = g->num_outputs = 0;
}

// "memory: COMPUTE STORAGE_WRITE -> COMPUTE STORAGE_READ|SAMPLED_READ", or of an image that changes its layout.
static void barrier(graph_check *g, const char *text)
{
    const char *to = strstr(text, " -> ");
    const bool readable = to && strstr(to, "READ");
    g->num_barriers++;
    if (strncmp(text, "memory: ", 8) != 0) {
        g->resources[resource_of(g, text, strcspn(text, ":"))].readable = readable;
        return;
    }
    const char *write = strstr(text, "WRITE");
    if (!write || write > to) { // what came before is waited for, not made visible
        return;
    }
    for (uint32_t i = 0; readable && i < g->num_resources; i++) {
        g->resources[i].readable = true;
    }
}

static void take_line(graph_check *g, const char *line)
{
    if (strncmp(line, "node ", 5) == 0) {
        end_node(g);
        g->began = false;
        g->num_nodes++;
        return;
    }
    line += strspn(line, " ");
    if (strncmp(line, "in ", 3) == 0) {
        add_port(g, line + 3 + strspn(line + 3, " "), g->inputs, &g->num_inputs);
    } else if (strncmp(line, "out ", 4) == 0 || strncmp(line, "inout ", 6) == 0) {
        const bool made_anew = line[0] == 'o';
        line += strcspn(line, " ");
        const uint32_t before = g->num_outputs;
        add_port(g, line + strspn(line, " "), g->outputs, &g->num_outputs);
        if (g->num_outputs > before) {
            resource *r = &g->resources[g->outputs[before]];
            r->many = r->many || (made_anew && r->made);
        }
    } else if (strncmp(line, "barrier ", 8) == 0) {
        barrier(g, line + 8);
    } else if (strncmp(line, "dispatch ", 9) == 0 || strncmp(line, "draw ", 5) == 0) {
        for (uint32_t i = 0; i < g->num_outputs && !g->began; i++) {
            g->resources[g->outputs[i]].readable = false;
        }
        g->began = true;
    }
}

int selftest_graphs(selftest *t)
{
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < tyn_num_methods() && code == EXIT_DONE; i++) {
        tyn_method_info info;
        tyn_method_at(i, &info);
        renderer r;
        code = selftest_render_cube(t, info.name, 1, &r);
        if (code == EXIT_DONE) {
            graph_check *g = calloc(1, sizeof *g);
            char *text = tyn_context_graph(tyn_offline_context(r.offline), false);
            char *rest = text;
            for (char *line = g ? strsep(&rest, "\n") : NULL; line; line = strsep(&rest, "\n")) {
                take_line(g, line);
            }
            if (g) {
                end_node(g);
            }
            char name[80];
            snprintf(name, sizeof name, "graph, %s, %u nodes, %u reads: barriers missing",
                     info.name, g ? g->num_nodes : 0, g ? g->num_reads : 0);
            const bool looked = g && g->num_reads > 0 && g->num_barriers > 0;
            selftest_check(t, name, looked ? g->num_missing : 1, 0, 0, "exact");
            free(text);
            free(g);
            renderer_close(&r);
        }
    }
    return code;
}
