// declare.c -- building the two lists: resources and nodes.
#include "graph/internal.h"
#include "base/grow.h"
#include <tyndall/extend/hash.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct tyn_builder {
    tyn_graph *g;
    node *node;
    VkFormat formats[TYN_MAX_PORTS]; // overrides
};

tyn_result graph_fail(tyn_graph *g, tyn_result result, const char *format, ...)
{
    char line[512];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    tyn_log_print(&g->dev->log, TYN_LOG_ERROR, "%s", line);
    if (g->status == TYN_OK) {
        g->status = result;
    }
    return result;
}

tyn_result tyn_graph_status(const tyn_graph *g)
{
    return g->status;
}

static tyn_ref add_resource(tyn_graph *g, const resource *r)
{
    if (!tyn_grow(&g->resources, &g->cap_resources, g->num_resources + 1, sizeof *r)) {
        graph_fail(g, TYN_ERR_MEMORY, "out of memory while declaring '%s'", r->name);
        return (tyn_ref){0};
    }
    resource *added = &g->resources[g->num_resources++];
    *added = *r;
    added->owner = r->owner ? r->owner : "";
    added->mips = r->mips ? r->mips : 1;
    return (tyn_ref){g->num_resources, 0};
}

void tyn_graph_begin(tyn_graph *g)
{
    static const VkFormat formats[NUM_ZEROS] = {[TYN_IMAGE_2D] = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                [TYN_IMAGE_3D] = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                [ZERO_WORDS] = VK_FORMAT_R32G32_UINT};
    g->status = TYN_OK;
    g->num_resources = 0;
    g->num_nodes = 0;
    g->num_outputs = 0;
    g->params_used = 0;
    g->mode = (tyn_record_mode){0};
    g->aid = false;
    g->current = false;
    for (int i = 0; i < NUM_ZEROS; i++) {
        tyn_graph_history_image(g, "none", i == ZERO_WORDS ? TYN_IMAGE_2D : (tyn_dim)i, formats[i],
                                (tyn_extent){i == TYN_BUFFER ? ZERO_BYTES : 1, 1, 1}, 0);
    }
}

tyn_record_mode *tyn_graph_mode(tyn_graph *g)
{
    return &g->mode;
}

static resource *find(tyn_graph *g, tyn_ref ref)
{
    return ref.resource && ref.resource <= g->num_resources ? &g->resources[ref.resource - 1]
                                                            : NULL;
}

VkFormat tyn_graph_format(const tyn_graph *g, tyn_ref ref)
{
    const resource *r = find((tyn_graph *)g, ref);
    return r ? r->format : VK_FORMAT_UNDEFINED;
}

uint32_t tyn_graph_drawn_side(const tyn_graph *g)
{
    const VkPhysicalDeviceLimits *limits = &g->dev->properties.limits;
    const uint32_t sides[] = {limits->maxFramebufferWidth, limits->maxFramebufferHeight,
                              limits->maxViewportDimensions[0], limits->maxViewportDimensions[1]};
    uint32_t side = limits->maxImageDimension2D;
    for (uint32_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        side = side < sides[i] ? side : sides[i];
    }
    return side;
}

// ---- resources from outside -------------------------------------------------------------------

tyn_ref tyn_graph_import_image(tyn_graph *g, const char *name, tyn_dim dim, const tyn_image *image,
                               uint64_t version)
{
    uint64_t content = version ? tyn_hash_u64(version, (uint64_t)image->image) : ++g->unique;
    return add_resource(
        g, &(resource){.name = name,
                       .kind = RESOURCE_IMPORT,
                       .dim = dim,
                       .format = image->format,
                       .extent = {image->extent.width, image->extent.height, image->extent.depth},
                       .content = tyn_hash_string(content, name),
                       .image = *image});
}

// Can a buffer from outside be bound?
static bool check_size(tyn_graph *g, const char *name, uint64_t bytes)
{
    const uint32_t most = g->dev->properties.limits.maxStorageBufferRange;
    if (bytes > most) {
        graph_fail(g, TYN_ERR_UNSUPPORTED, "'%s' takes %.1f MiB; the device binds at most %.1f MiB",
                   name, (double)bytes / (1 << 20), (double)most / (1 << 20));
    }
    return bytes <= most;
}

tyn_ref tyn_graph_upload_buffer(tyn_graph *g, const char *name, const void *data, size_t size,
                                uint64_t hash)
{
    if (!check_size(g, name, size)) {
        return (tyn_ref){0};
    }
    if (!hash) {
        hash = tyn_hash_bytes(tyn_hash_string(TYN_HASH_SEED, name), data, size);
    }
    return add_resource(g, &(resource){.name = name,
                                       .kind = RESOURCE_UPLOAD,
                                       .dim = TYN_BUFFER,
                                       .extent = {(uint32_t)((size + 3) & ~(size_t)3), 1, 1},
                                       .content = hash,
                                       .key = size,
                                       .data = data});
}

tyn_ref tyn_graph_upload_image(tyn_graph *g, const char *name, tyn_dim dim, VkFormat format,
                               tyn_extent extent, tyn_fill_fn fill, void *user, uint64_t hash)
{
    return add_resource(g, &(resource){.name = name,
                                       .kind = RESOURCE_UPLOAD,
                                       .dim = dim,
                                       .format = format,
                                       .extent = extent,
                                       .content = hash ? hash : 1,
                                       .fill = fill,
                                       .user = user});
}

tyn_ref tyn_graph_history_image(tyn_graph *g, const char *name, tyn_dim dim, VkFormat format,
                                tyn_extent extent, uint64_t key)
{
    return add_resource(g, &(resource){.name = name,
                                       .kind = RESOURCE_HISTORY,
                                       .dim = dim,
                                       .format = format,
                                       .extent = extent,
                                       .content = tyn_hash_u64(TYN_HASH_SEED, key),
                                       .key = key});
}

tyn_ref tyn_graph_history_buffer(tyn_graph *g, const char *name, uint64_t bytes, uint64_t key)
{
    return check_size(g, name, bytes)
               ? tyn_graph_history_image(g, name, TYN_BUFFER, VK_FORMAT_UNDEFINED,
                                         (tyn_extent){(uint32_t)bytes, 1, 1}, key)
               : (tyn_ref){0};
}

void tyn_graph_mark_media(tyn_graph *g, tyn_ref ref)
{
    resource *r = find(g, ref);
    if (r) {
        r->media_only = true;
    }
}

void tyn_graph_aid(tyn_graph *g, bool on)
{
    g->aid = on;
}

// Is there another thing that is read back by this name? It would be taken for it.
static bool clashes(const tyn_graph *g, const char *name, tyn_ref ref, bool readback)
{
    for (uint32_t i = 0; readback && i < g->num_outputs; i++) {
        const output *o = &g->outputs[i];
        if (o->readback && o->ref.resource != ref.resource && !strcmp(o->name, name)) {
            return true;
        }
    }
    return false;
}

void tyn_graph_output(tyn_graph *g, const char *name, tyn_ref ref, bool readback)
{
    if (g->status != TYN_OK) {
        return; // nothing is made any more
    }
    if (!find(g, ref)) {
        graph_fail(g, TYN_ERR_PARAMS, "output '%s' is not a resource", name);
    } else if (clashes(g, name, ref, readback)) {
        graph_fail(g, TYN_ERR_PARAMS,
                   "output '%s' is there already, of another resource: a pass with counters needs "
                   "a name that no output has",
                   name);
    } else if (g->num_outputs == sizeof g->outputs / sizeof g->outputs[0]) {
        graph_fail(g, TYN_ERR_PARAMS, "output '%s' is one too many", name);
    } else {
        g->outputs[g->num_outputs++] = (output){name, ref, readback};
    }
}

// What tyn_record_mode.inspect asks for, if this node makes it.
static void inspect_node(tyn_graph *g, const tyn_pass_desc *pass, const tyn_ref *refs)
{
    static const char name[] = "inspect";
    const tyn_ref ref = refs[pass->debug_port];
    if (!g->mode.inspect || strcmp(g->mode.inspect, pass->name) || !ref.resource ||
        g->resources[ref.resource - 1].dim == TYN_BUFFER) {
        return;
    }
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        if (!strcmp(g->outputs[i].name, name)) {
            g->outputs[i].ref = ref;
            return;
        }
    }
    tyn_graph_output(g, name, ref, true);
}

// Has the buffer read back in which the first node of a pass counts.
static void count_node(tyn_graph *g, const tyn_pass_desc *pass, const tyn_ref *refs)
{
    bool first = g->mode.counters && pass->counters && refs[pass->counter_port].resource;
    for (uint32_t i = 0; first && i + 1 < g->num_nodes; i++) {
        first = g->nodes[i].pass != pass;
    }
    if (first) {
        tyn_graph_output(g, pass->name, refs[pass->counter_port], true);
    }
}

// ---- nodes ------------------------------------------------------------------------------------

bool tyn_build_has(const tyn_builder *b, uint8_t port)
{
    return b->node->res[port] != 0;
}

tyn_extent tyn_build_extent(const tyn_builder *b, uint8_t port)
{
    uint32_t res = b->node->res[port];
    return res ? b->g->resources[res - 1].extent : (tyn_extent){0, 0, 0};
}

const tyn_log *tyn_build_log(const tyn_builder *b)
{
    return &b->g->dev->log;
}

void tyn_build_format(tyn_builder *b, uint8_t port, VkFormat format)
{
    b->formats[port] = format;
}

static void build(tyn_builder *b, uint8_t port, tyn_extent extent, uint32_t mips)
{
    const tyn_pass_desc *pass = b->node->pass;
    const tyn_port *p = &pass->ports[port];
    if (p->dir != TYN_OUT && p->dir != TYN_SCRATCH) {
        graph_fail(b->g, TYN_ERR_PARAMS, "pass '%s' gives a shape to '%s', which is an input",
                   pass->name, p->name);
        return;
    }
    tyn_ref ref =
        add_resource(b->g, &(resource){.name = p->name,
                                       .owner = pass->name,
                                       .kind = p->dir == TYN_OUT ? RESOURCE_OUT : RESOURCE_SCRATCH,
                                       .dim = p->dim,
                                       .format = b->formats[port] ? b->formats[port] : p->format,
                                       .extent = extent,
                                       .mips = mips});
    b->node->res[port] = ref.resource;
}

void tyn_build_image(tyn_builder *b, uint8_t port, tyn_extent extent, uint32_t mips)
{
    extent.x = extent.x ? extent.x : 1;
    extent.y = extent.y ? extent.y : 1;
    extent.z = extent.z ? extent.z : 1;
    build(b, port, extent, mips);
}

void tyn_build_buffer(tyn_builder *b, uint8_t port, uint64_t bytes)
{
    const VkPhysicalDeviceLimits *limits = &b->g->dev->properties.limits;
    if (bytes > limits->maxStorageBufferRange || bytes > UINT32_MAX - 3) {
        graph_fail(b->g, TYN_ERR_UNSUPPORTED,
                   "pass '%s' needs a buffer '%s' of %.1f MiB; "
                   "the device binds at most %.1f MiB",
                   b->node->pass->name, b->node->pass->ports[port].name, (double)bytes / (1 << 20),
                   (double)limits->maxStorageBufferRange / (1 << 20));
        return;
    }
    build(b, port, (tyn_extent){(uint32_t)((bytes + 3) & ~3ull), 1, 1}, 1);
}

static void connect_inputs(tyn_graph *g, node *n, const tyn_ref *refs)
{
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const tyn_port *port = &n->pass->ports[p];
        if (port->dir != TYN_IN && port->dir != TYN_INOUT) {
            continue;
        }
        const resource *r = find(g, refs[p]);
        if (!r) {
            if (!port->optional || port->dir == TYN_INOUT) {
                graph_fail(g, TYN_ERR_PARAMS, "node '%s': input '%s' (%s) is not connected",
                           n->pass->name, port->name, port->meaning ? port->meaning : "");
            }
            continue;
        }
        if (refs[p].version != r->version) {
            graph_fail(g, TYN_ERR_PARAMS,
                       "node '%s': input '%s' is version %u of '%s', which was overwritten; the "
                       "newest is %u",
                       n->pass->name, port->name, refs[p].version, r->name, r->version);
        }
        if (r->dim != port->dim) {
            graph_fail(g, TYN_ERR_PARAMS, "node '%s': input '%s' and '%s' differ in kind (%d, %d)",
                       n->pass->name, port->name, r->name, port->dim, r->dim);
        }
        if (port->dir == TYN_INOUT && r->kind == RESOURCE_UPLOAD) {
            graph_fail(g, TYN_ERR_PARAMS,
                       "node '%s': '%s' would change the upload '%s' in place; use a history",
                       n->pass->name, port->name, r->name);
        }
        n->res[p] = refs[p].resource;
        n->versions[p] = refs[p].version;
    }
}

// Identifies what the node will write: its pass, params, and the content of what it reads.
static void hash_node(const tyn_graph *g, node *n)
{
    const tyn_pass_desc *pass = n->pass;
    uint64_t h = tyn_hash_string(TYN_HASH_SEED, pass->name);
    h = tyn_hash_bytes(h, n->params, pass->params_size);
    n->media_only = pass->media_only;
    for (uint32_t p = 0; p < pass->num_ports; p++) {
        const resource *r = n->res[p] ? &g->resources[n->res[p] - 1] : NULL;
        tyn_port_dir dir = pass->ports[p].dir;
        if (!r) {
            continue;
        }
        h = tyn_hash_u64(h, p);
        if (dir == TYN_IN || dir == TYN_INOUT) {
            // What a history holds is the node's own doing; only a new start changes it.
            h = tyn_hash_u64(h,
                             r->kind == RESOURCE_HISTORY && r->version == 0 ? r->key : r->content);
            n->media_only = n->media_only && r->media_only;
        }
        // Of inputs too: an upload's hash need not tell in which shape it is stored.
        h = tyn_hash_bytes(h, &r->extent, sizeof r->extent);
        h = tyn_hash_u64(h, (uint64_t)r->dim << 40 | (uint64_t)r->mips << 32 | (uint32_t)r->format);
    }
    n->hash = h ? h : 1;
}

// A node that settles has another hash in each of the frames in which it still has to run, then that of the last.
static void settle_node(const tyn_graph *g, node *n, uint32_t index)
{
    if (!n->pass->settles) {
        return;
    }
    uint32_t frames;
    memcpy(&frames, (const uint8_t *)n->params + n->pass->settles, sizeof frames);
    const node_run *last = index < g->num_runs ? &g->runs[index] : NULL;
    n->asked = n->hash;
    if (last && last->hash && last->asked == n->asked) {
        const bool done = last->settled >= frames;
        n->settled = done ? last->settled : last->settled + 1;
        n->hash = done ? last->hash : tyn_hash_u64(n->asked, n->settled);
    }
}

// A node whose results may be old has the hash of its last run.
static void hold_node(const tyn_graph *g, node *n, uint32_t index)
{
    if (!n->pass->holds) {
        return;
    }
    tyn_hold hold;
    memcpy(&hold, (const uint8_t *)n->params + n->pass->holds, sizeof hold);
    const node_run *last = index < g->num_runs ? &g->runs[index] : NULL;
    n->hold = hold.key;
    if (last && last->hash && last->hold == hold.key && last->hash != n->hash &&
        last->held + 1 < hold.frames) {
        n->held = last->held + 1;
        n->hash = last->hash;
    }
}

static void publish_outputs(tyn_graph *g, node *n, uint32_t index, tyn_ref *refs)
{
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        tyn_port_dir dir = n->pass->ports[p].dir;
        if (dir != TYN_OUT && dir != TYN_INOUT) {
            continue;
        }
        resource *r = n->res[p] ? &g->resources[n->res[p] - 1] : NULL;
        refs[p] = (tyn_ref){0};
        if (!r) {
            continue;
        }
        if (dir == TYN_INOUT && ++r->version == MAX_VERSIONS) {
            graph_fail(g, TYN_ERR_PARAMS, "'%s' is changed by more than %d nodes", r->name,
                       MAX_VERSIONS - 1);
            r->version--;
        }
        r->writers[r->version] = index + 1;
        r->content = tyn_hash_u64(n->hash, p + 1);
        r->media_only = n->media_only;
        refs[p] = (tyn_ref){n->res[p], r->version};
    }
}

// An earlier node with the pass, params and inputs of `n`, whose outputs nobody has changed since. NULL: there is none. A pass that
// settles or holds depends on frames before as well, one with INOUT ports on what it changes.
static node *find_same(const tyn_graph *g, const node *n)
{
    const tyn_pass_desc *pass = n->pass;
    bool can_share = !pass->settles && !pass->holds;
    for (uint32_t p = 0; p < pass->num_ports; p++) {
        can_share = can_share && pass->ports[p].dir != TYN_INOUT;
    }
    for (uint32_t i = 0; can_share && g->nodes + i < n; i++) {
        node *other = &g->nodes[i];
        bool same = other->pass == pass &&
                    (!pass->params_size || !memcmp(other->params, n->params, pass->params_size));
        for (uint32_t p = 0; same && p < pass->num_ports; p++) {
            const bool in = pass->ports[p].dir == TYN_IN;
            same = in ? other->res[p] == n->res[p] && other->versions[p] == n->versions[p]
                      : !other->res[p] || !g->resources[other->res[p] - 1].version;
        }
        if (same) {
            return other;
        }
    }
    return NULL;
}

// Drops the newest node, and gives the outputs of `same`.
static void share_node(tyn_graph *g, node *same, tyn_ref *refs)
{
    g->params_used = (uint32_t)g->nodes[--g->num_nodes].params_offset;
    same->aid = same->aid && g->aid;
    for (uint32_t p = 0; p < same->pass->num_ports; p++) {
        if (same->pass->ports[p].dir == TYN_OUT) {
            refs[p] = (tyn_ref){same->res[p], 0};
        }
    }
}

void tyn_graph_refuse(tyn_graph *g, tyn_result why)
{
    g->status = g->status == TYN_OK ? why : g->status;
}

tyn_result tyn_graph_add(tyn_graph *g, const tyn_pass_desc *pass, const void *params, tyn_ref *refs)
{
    if (g->status != TYN_OK) {
        return g->status;
    }
    const size_t need = g->params_used + (pass->params_size + 15) / 16 * 16;
    if (!tyn_grow(&g->nodes, &g->cap_nodes, g->num_nodes + 1, sizeof *g->nodes) ||
        !tyn_grow(&g->params, &g->params_cap, need, 1)) {
        return graph_fail(g, TYN_ERR_MEMORY, "out of memory while declaring '%s'", pass->name);
    }
    for (uint32_t i = 0; i < g->num_nodes; i++) { // they may have moved
        g->nodes[i].params = g->params + g->nodes[i].params_offset;
    }
    uint32_t index = g->num_nodes++;
    node *n = &g->nodes[index];
    *n = (node){.pass = pass,
                .params = g->params + g->params_used,
                .params_offset = g->params_used,
                .aid = g->aid};
    if (pass->params_size) {
        memcpy(n->params, params, pass->params_size);
    }
    g->params_used = (uint32_t)need;

    connect_inputs(g, n, refs);
    if (g->status != TYN_OK) {
        return g->status;
    }
    node *same = find_same(g, n);
    if (same) {
        share_node(g, same, refs);
        return TYN_OK;
    }
    tyn_builder b = {.g = g, .node = n};
    tyn_result result = pass->declare(&b, n->params);
    if (result == TYN_OK && pass->counter_bytes) {
        tyn_build_buffer(&b, pass->counter_port, pass->counter_bytes);
    }
    if (result != TYN_OK && g->status == TYN_OK) {
        g->status = result; // declare has said why
    }
    if (g->status == TYN_OK) {
        hash_node(g, n);
        settle_node(g, n, index);
        hold_node(g, n, index);
        publish_outputs(g, n, index, refs);
        inspect_node(g, pass, refs);
        count_node(g, pass, refs);
    }
    return g->status;
}

void graph_store_param(const tyn_param *p, void *params, double value)
{
    void *field = (uint8_t *)params + p->offset;
    if (p->type == TYN_PARAM_FLOAT) {
        *(float *)field = (float)value;
    } else {
        *(int32_t *)field = (int32_t)value;
    }
}

void tyn_pass_defaults(const tyn_pass_desc *pass, void *params)
{
    if (!pass || !params) {
        return;
    }
    memset(params, 0, pass->params_size);
    for (uint32_t i = 0; i < pass->num_params; i++) {
        graph_store_param(&pass->params[i], params, pass->params[i].def);
    }
}
