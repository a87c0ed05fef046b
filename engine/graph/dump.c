// dump.c -- the compiled graph as text and as Graphviz.
#include "graph/internal.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct text {
    char *data;
    size_t used, cap;
} text;

static void put(text *t, const char *format, ...) TYN_PRINTF(2, 3);
static void put(text *t, const char *format, ...)
{
    char line[1024];
    va_list args;
    va_start(args, format);
    int n = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    size_t length = n < 0 ? 0 : (size_t)n < sizeof line ? (size_t)n : sizeof line - 1;
    if (t->used + length + 1 > t->cap) {
        size_t cap = (t->used + length + 1) * 2;
        char *grown = realloc(t->data, cap);
        if (!grown) {
            return;
        }
        t->data = grown;
        t->cap = cap;
    }
    memcpy(t->data + t->used, line, length + 1);
    t->used += length;
}

static void put_line(void *user, const char *line)
{
    put(user, "%s\n", line);
}

static const char *const kind_names[] = {"persistent", "transient", "imported", "upload",
                                         "history"};
static const char *const dir_names[] = {"in", "out", "inout", "scratch"};

static void print_shape(char *out, size_t size, const resource *r)
{
    if (r->dim == TYN_BUFFER) {
        snprintf(out, size, "buffer %u B", r->extent.x);
    } else if (r->dim == TYN_IMAGE_2D) {
        snprintf(out, size, "%s %u x %u", graph_format_name(r->format), r->extent.x, r->extent.y);
    } else {
        snprintf(out, size, "%s %u x %u x %u", graph_format_name(r->format), r->extent.x,
                 r->extent.y, r->extent.z);
    }
}

static void put_ports(text *t, const tyn_graph *g, const node *n)
{
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const tyn_port *port = &n->pass->ports[p];
        if (!n->res[p]) {
            put(t, "    %-7s %s: none\n", dir_names[port->dir], port->name);
            continue;
        }
        const resource *r = &g->resources[n->res[p] - 1];
        char shape[96];
        print_shape(shape, sizeof shape, r);
        put(t, "    %-7s %s", dir_names[port->dir], port->name);
        if (strcmp(port->name, r->name)) {
            put(t, " = %s", r->name);
        }
        put(t, " (%s, %s)%s%s\n", shape, kind_names[r->kind], port->meaning ? ": " : "",
            port->meaning ? port->meaning : "");
    }
}

// The barriers of a first frame, planned without a device.
static void put_plan(text *t, tyn_graph *g, uint32_t index, tyn_track *tracks)
{
    tyn_recorder r = {.g = g,
                      .node = index,
                      .mode = RECORD_PLAN,
                      .tracks = tracks,
                      .print = put_line,
                      .print_user = t};
    recorder_enter(&r);
    recorder_run(&r);
}

// Could the method have declared it, and did not? It says so of passes that not all scenes need.
static bool left_out(const tyn_graph *g, const tyn_pass_desc *pass)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        if (g->nodes[i].pass == pass) {
            return false;
        }
    }
    return pass->serves != NULL;
}

static char *dump_text(tyn_graph *g, const tyn_pass_desc *const *passes)
{
    text t = {0};
    tyn_track *tracks = calloc(g->num_resources ? g->num_resources : 1, sizeof *tracks);
    if (!tracks) {
        return NULL;
    }
    put(&t, "graph: %u nodes, %u resources, persistent %.2f MiB, transient %.2f MiB\n",
        g->num_nodes, g->num_resources - NUM_ZEROS, (double)g->persistent_bytes / (1 << 20),
        (double)g->transient_bytes / (1 << 20));
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        bool outside = r->kind == RESOURCE_UPLOAD || r->kind == RESOURCE_IMPORT;
        if (r->kind == RESOURCE_UPLOAD || r->kind == RESOURCE_HISTORY) {
            tracks[i] =
                (tyn_track){.write_stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                            .write_access = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                            .layout = r->dim == TYN_BUFFER ? VK_IMAGE_LAYOUT_UNDEFINED
                                                           : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
        } else if (r->kind == RESOURCE_IMPORT) {
            tracks[i] = (tyn_track){.write_stages = r->image.before.stages,
                                    .write_access = r->image.before.access,
                                    .layout = r->image.before.layout};
        }
        if (outside) {
            char shape[96];
            print_shape(shape, sizeof shape, r);
            put(&t, "%s %s (%s)\n", kind_names[r->kind], r->name, shape);
        }
    }
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        put(&t, "node %u %s: %s%s\n", i, n->pass->name, n->pass->summary,
            n->needed ? "" : " [culled: no output needs it]");
        if (g->current && n->needed) {
            uint64_t bytes, shared;
            graph_node_bytes(g, i, &bytes, &shared);
            put(&t, "    memory  %.2f MiB, %.2f MiB of it shared with other nodes\n",
                (double)bytes / (1 << 20), (double)shared / (1 << 20));
        }
        put_ports(&t, g, n);
        if (n->needed) {
            put_plan(&t, g, i, tracks);
        }
    }
    for (; passes && *passes; passes++) {
        if (left_out(g, *passes)) {
            put(&t, "left out %s: only for %s\n", (*passes)->name, (*passes)->serves);
        }
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        put(&t, "output %s = %s%s\n", g->outputs[i].name,
            g->resources[g->outputs[i].ref.resource - 1].name,
            g->outputs[i].readback ? " (read back)" : "");
    }
    free(tracks);
    return t.data;
}

static bool draws(const tyn_pass_desc *pass)
{
    for (uint32_t k = 0; k < pass->num_kernels; k++) {
        if (pass->kernels[k].raster) {
            return true;
        }
    }
    return false;
}

// Nodes that draw are green, those that only compute blue, those that are culled or left out grey.
static char *dump_dot(tyn_graph *g, const tyn_pass_desc *const *passes)
{
    text t = {0};
    put(&t, "digraph tyndall {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n");
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        put(&t, "  n%u [label=\"%s\" shape=box style=\"filled%s\" fillcolor=\"%s\"];\n", i,
            n->pass->name, n->needed ? "" : ",dashed",
            !n->needed       ? "#eeeeee"
            : draws(n->pass) ? "#d3f0d3"
                             : "#cfe2ff");
        for (uint32_t p = 0; p < n->pass->num_ports; p++) {
            if (graph_port(n, p, DIR_READ)) {
                put(&t, "  r%u -> n%u;\n", n->res[p] - 1, i);
            }
            if (graph_port(n, p, DIR_WRITTEN)) {
                put(&t, "  n%u -> r%u;\n", i, n->res[p] - 1);
            }
        }
    }
    for (uint32_t i = NUM_ZEROS; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        char shape[96];
        if (r->kind != RESOURCE_SCRATCH) {
            print_shape(shape, sizeof shape, r);
            put(&t, "  r%u [label=\"%s\\n%s\\n%s\" shape=ellipse];\n", i, r->name, shape,
                kind_names[r->kind]);
        }
    }
    for (uint32_t i = 0; passes && passes[i]; i++) {
        if (left_out(g, passes[i])) {
            put(&t,
                "  out%u [label=\"%s\\nleft out: only for\\n%s\" shape=box "
                "style=\"filled,dashed\" fillcolor=\"#eeeeee\"];\n",
                i, passes[i]->name, passes[i]->serves);
        }
    }
    put(&t, "}\n");
    return t.data;
}

char *tyn_graph_dump(tyn_graph *g, bool dot, const tyn_pass_desc *const *passes)
{
    if (!g->current) {
        return NULL; // nodes have no slots yet
    }
    graph_cull(g);
    return dot ? dump_dot(g, passes) : dump_text(g, passes);
}
