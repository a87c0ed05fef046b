// record.c -- one frame: uploads, the nodes that must run, readbacks; then what happened.
#include "base/fault.h"
#include "graph/internal.h"
#include "base/clock.h"
#include <tyndall/extend/hash.h>
#include <stdlib.h>
#include <string.h>

tyn_result tyn_graph_create(tyn_device *dev, uint32_t frames_in_flight, tyn_graph **out)
{
    *out = calloc(1, sizeof **out);
    if (!*out) {
        return TYN_ERR_MEMORY;
    }
    (*out)->dev = dev;
    (*out)->num_slots = frames_in_flight < 1           ? 1
                        : frames_in_flight > MAX_SLOTS ? MAX_SLOTS
                                                       : frames_in_flight;
    return TYN_OK;
}

void tyn_graph_destroy(tyn_graph **graph)
{
    tyn_graph *g = graph ? *graph : NULL;
    if (!g) {
        return;
    }
    graph_forget_pipelines(g);
    g->mode.idle = true;
    graph_finish(g);
    graph_retire_finish(g);
    free(g->resources);
    free(g->nodes);
    free(g->params);
    free(g->stats);
    free(g->sets.items);
    free(g);
    *graph = NULL;
}

// ---- uploads and first contents ---------------------------------------------------------------

tyn_access graph_transfer(const resource *r, bool write)
{
    return (tyn_access){VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                        write ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_TRANSFER_READ_BIT,
                        !write, write,
                        r->dim == TYN_BUFFER ? VK_IMAGE_LAYOUT_UNDEFINED
                        : write              ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
                                             : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
}

static VkBufferImageCopy whole_image(const resource *r)
{
    return (VkBufferImageCopy){.imageSubresource = {graph_aspect(r->format), 0, 0, 1},
                               .imageExtent = {r->extent.x, r->extent.y, r->extent.z}};
}

static void record_upload(tyn_recorder *rec, uint32_t index)
{
    tyn_graph *g = rec->g;
    const resource *r = &g->resources[index];
    phys *p = &g->phys[index];
    const tyn_procs *vk = &g->dev->vk;
    recorder_access(rec, index, graph_transfer(r, true));
    if (r->fill) {
        VkBufferImageCopy copy = whole_image(r);
        vk->CmdCopyBufferToImage(rec->cmd, p->staging.buffer, p->image,
                                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    } else if (r->extent.x > INLINE_UPLOAD) {
        vk->CmdCopyBuffer(rec->cmd, p->staging.buffer, p->buffer, 1,
                          &(VkBufferCopy){0, 0, p->bytes});
    } else if (r->extent.x == r->key) {
        vk->CmdUpdateBuffer(rec->cmd, p->buffer, 0, r->key, r->data);
    } else { // size is not a multiple of 4
        uint8_t padded[INLINE_UPLOAD] = {0};
        memcpy(padded, r->data, r->key);
        vk->CmdUpdateBuffer(rec->cmd, p->buffer, 0, r->extent.x, padded);
    }
    p->content = r->content;
}

static void record_fill(tyn_recorder *rec, uint32_t index, uint32_t word)
{
    tyn_graph *g = rec->g;
    const resource *r = &g->resources[index];
    phys *p = &g->phys[index];
    recorder_access(rec, index, graph_transfer(r, true));
    if (r->dim == TYN_BUFFER) {
        g->dev->vk.CmdFillBuffer(rec->cmd, p->buffer, 0, VK_WHOLE_SIZE, word);
    } else {
        const VkClearColorValue color = {.uint32 = {word, word, word, word}};
        g->dev->vk.CmdClearColorImage(rec->cmd, p->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                      &color, 1,
                                      &(VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0,
                                                                 VK_REMAINING_MIP_LEVELS, 0, 1});
    }
}

static void record_zeros(tyn_recorder *rec, uint32_t index)
{
    const resource *r = &rec->g->resources[index];
    phys *p = &rec->g->phys[index];
    record_fill(rec, index, 0);
    p->key = r->key;
    p->content = 1; // zeros
    p->started = true;
}

// After a compilation that gave memory of what is gone to others, of which no track is left.
static void wait_for_all(tyn_graph *g, VkCommandBuffer cmd)
{
    if (g->reused) {
        graph_memory_barrier(
            g, cmd,
            &(tyn_barrier){VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                           VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                           VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
        g->reused = false;
    }
}

static void record_sources(tyn_recorder *rec)
{
    tyn_graph *g = rec->g;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        phys *p = &g->phys[i];
        if (r->kind == RESOURCE_IMPORT) {
            p->image = r->image.image;
            p->track = (tyn_track){.write_stages = r->image.before.stages,
                                   .write_access = r->image.before.access,
                                   .layout = r->image.before.layout};
        } else if (r->kind == RESOURCE_UPLOAD && p->content != r->content) {
            record_upload(rec, i);
        } else if (r->kind == RESOURCE_HISTORY && (!p->content || p->key != r->key)) {
            record_zeros(rec, i);
        } else if (g->poison && !p->content &&
                   graph_aspect(r->format) == VK_IMAGE_ASPECT_COLOR_BIT &&
                   (r->kind == RESOURCE_OUT || r->kind == RESOURCE_SCRATCH)) {
            record_fill(rec, i, 0x7fc00000u); // NaN
            p->content = 1;
        }
    }
}

// ---- nodes ------------------------------------------------------------------------------------

static bool outputs_current(const tyn_graph *g, const node *n, uint32_t index)
{
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t id = graph_port(n, p, DIR_WRITTEN);
        const resource *r = id ? &g->resources[id - 1] : NULL;
        // Of a resource that later nodes change as well, only the last content can be compared.
        if (r && r->writers[r->version] == index + 1 && g->phys[id - 1].content != r->content) {
            return false;
        }
    }
    return true;
}

// The newest version of a resource that is made in this frame.
static uint32_t newest_needed(const tyn_graph *g, const resource *r)
{
    uint32_t v = r->version;
    while (v > 0 && r->writers[v] && !g->nodes[r->writers[v] - 1].needed) {
        v--;
    }
    return v;
}

static bool also_run(bool *run_node, uint32_t writer)
{
    bool more = writer && !run_node[writer - 1];
    if (more) {
        run_node[writer - 1] = true;
    }
    return more;
}

// Nodes that must run because of others that do: a version that was changed in place since is made
// again for its reader, and whoever changes a version that is made again changes it again. What
// histories and host images held before is gone; it is for their owners to know. True if any was added.
static bool add_in_place(const tyn_graph *g, bool *run_node)
{
    bool more = false;
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        for (uint32_t p = 0; run_node[i] && p < n->pass->num_ports; p++) {
            tyn_port_dir dir = n->pass->ports[p].dir;
            const resource *r = n->res[p] ? &g->resources[n->res[p] - 1] : NULL;
            if (!r || r->kind == RESOURCE_HISTORY || r->kind == RESOURCE_IMPORT) {
                continue;
            }
            bool gone = dir == TYN_INOUT || (dir == TYN_IN && n->versions[p] < newest_needed(g, r));
            more |= gone && also_run(run_node, r->writers[n->versions[p]]);
        }
    }
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        uint32_t newest = newest_needed(g, r);
        for (uint32_t v = 0; v < newest; v++) {
            more |= r->writers[v] && run_node[r->writers[v] - 1] &&
                    also_run(run_node, r->writers[v + 1]);
        }
    }
    return more;
}

// Does a node that runs have scratch where this resource is?
static bool is_overwritten(const tyn_graph *g, const bool *run_node, uint32_t index)
{
    for (uint32_t i = 0; g->phys[index].shared && i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        for (uint32_t p = 0; run_node[i] && p < n->pass->num_ports; p++) {
            const uint32_t id = graph_port(n, p, 1 << TYN_SCRATCH);
            if (id && graph_overlap(&g->phys[id - 1], &g->phys[index])) {
                return true;
            }
        }
    }
    return false;
}

// Nodes that must run because another's scratch is where they put what they make. True if any was added.
static bool add_overwritten(const tyn_graph *g, bool *run_node)
{
    bool more = false;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        const uint32_t maker = r->kind == RESOURCE_OUT ? r->writers[0] : 0;
        const node *n = maker ? &g->nodes[maker - 1] : NULL;
        const bool can = n && n->needed && (n->media_only || !g->mode.setup_only);
        more |= can && !run_node[maker - 1] && is_overwritten(g, run_node, i) &&
                also_run(run_node, maker);
    }
    return more;
}

// Which needed nodes run: those whose inputs or params changed, and what these need of resources that
// are changed in place.
static void choose_nodes(const tyn_graph *g, bool *run_node)
{
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        bool wanted = n->needed && (n->media_only || !g->mode.setup_only);
        run_node[i] = wanted && ((g->mode.recompute && !n->media_only) ||
                                 g->runs[i].hash != n->hash || !outputs_current(g, n, i));
    }
    while (add_in_place(g, run_node) || add_overwritten(g, run_node)) {
    }
}

// Descriptor sets of all that will be launched. What follows cannot fail, so that a frame that fails appends nothing.
static tyn_result make_sets(tyn_graph *g, const bool *run_node)
{
    TYN_TRY(tyn_vk_check(
        g->dev,
        g->dev->vk.ResetDescriptorPool(g->dev->device, g->slots[g->frame % g->num_slots].pool, 0),
        "vkResetDescriptorPool"));
    g->sets.count = g->sets.next = 0;
    memset(g->sets.made, 0, sizeof g->sets.made);
    return recorder_run_all(&(tyn_recorder){.g = g, .mode = RECORD_SETS}, run_node);
}

static void timestamp(tyn_graph *g, VkCommandBuffer cmd, uint32_t query)
{
    const frame_slot *slot = &g->slots[g->frame % g->num_slots];
    if (slot->queries) {
        g->dev->vk.CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot->queries,
                                      query);
    }
}

// Scratch starts undefined: its layout is forgotten, its dependencies stay. What was in its place is gone; a frame that sets
// up only does not make it again.
static void start_scratch(tyn_graph *g, const node *n)
{
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t id = graph_port(n, p, 1 << TYN_SCRATCH);
        if (id) {
            g->phys[id - 1].track.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        }
        for (uint32_t i = 0; id && i < g->num_resources; i++) {
            if (g->resources[i].kind == RESOURCE_OUT &&
                graph_overlap(&g->phys[id - 1], &g->phys[i])) {
                g->phys[i].content = 0;
            }
        }
    }
}

// Has one of its histories been started and not been run on yet?
static bool starts_history(tyn_graph *g, const node *n)
{
    bool starts = false;
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t id = graph_port(n, p, 1 << TYN_INOUT);
        if (id) {
            starts = starts || g->phys[id - 1].started;
            g->phys[id - 1].started = false;
        }
    }
    return starts;
}

static tyn_result run_one(tyn_graph *g, VkCommandBuffer cmd, uint32_t index)
{
    const node *n = &g->nodes[index];
    node_run *run = &g->runs[index];
    const tyn_device *dev = g->dev;
    double start = tyn_now_ms();
    if (dev->debug_names) {
        dev->vk.CmdBeginDebugUtilsLabelEXT(
            cmd, &(VkDebugUtilsLabelEXT){.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                         .pLabelName = n->pass->name});
    }
    start_scratch(g, n);
    timestamp(g, cmd, index * 2);
    tyn_recorder r = {.g = g, .node = index, .mode = RECORD_LIVE, .cmd = cmd};
    recorder_enter(&r);
    recorder_run(&r);
    timestamp(g, cmd, index * 2 + 1);
    if (dev->debug_names) {
        dev->vk.CmdEndDebugUtilsLabelEXT(cmd);
    }

    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t id = graph_port(n, p, DIR_WRITTEN);
        if (id) {
            g->phys[id - 1].content = r.result == TYN_OK ? tyn_hash_u64(n->hash, p + 1) : 0;
        }
    }
    run->hash = r.result == TYN_OK ? n->hash : 0;
    run->asked = n->asked;
    run->hold = n->hold;
    run->held = 0;
    run->settled = starts_history(g, n) ? UINT32_MAX : n->settled;
    run->stats.state = r.dispatches ? TYN_NODE_RAN : TYN_NODE_EMPTY;
    run->stats.cpu_ms = tyn_now_ms() - start;
    run->stats.dispatches = r.dispatches;
    run->stats.barriers = r.barriers;
    run->stats.num_work = r.num_work;
    run->stats.media_only = n->media_only;
    run->stats.aid = n->aid;
    memcpy(run->stats.work, r.work, sizeof r.work);
    return r.result;
}

// ---- readback ---------------------------------------------------------------------------------

static void record_readbacks(tyn_recorder *rec)
{
    tyn_graph *g = rec->g;
    bool any = false;
    for (uint32_t i = 0; i < g->num_outputs; i++) {
        uint32_t index = g->outputs[i].ref.resource - 1;
        const resource *r = &g->resources[index];
        phys *p = &g->phys[index];
        if (!g->outputs[i].readback || !p->readback.buffer || (p->read && p->read == p->content)) {
            continue;
        }
        recorder_access(rec, index, graph_transfer(r, false));
        if (r->dim == TYN_BUFFER) {
            g->dev->vk.CmdCopyBuffer(rec->cmd, p->buffer, p->readback.buffer, 1,
                                     &(VkBufferCopy){0, 0, p->bytes});
        } else {
            VkBufferImageCopy copy = whole_image(r);
            g->dev->vk.CmdCopyImageToBuffer(rec->cmd, p->image,
                                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                            p->readback.buffer, 1, &copy);
        }
        p->read = p->content;
        any = true;
    }
    if (any) {
        graph_memory_barrier(
            g, rec->cmd,
            &(tyn_barrier){VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                           VK_PIPELINE_STAGE_2_HOST_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                           VK_ACCESS_2_TRANSFER_WRITE_BIT,
                           VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT});
    }
}

// Leaves host images as promised.
static void record_imports_after(tyn_recorder *rec)
{
    tyn_graph *g = rec->g;
    for (uint32_t i = 0; i < g->num_resources; i++) {
        const resource *r = &g->resources[i];
        if (r->kind == RESOURCE_IMPORT) {
            // As a read-modify-write: whatever the host does next is ordered behind us.
            recorder_access(rec, i,
                            (tyn_access){r->image.after.stages, r->image.after.access, true, true,
                                         r->image.after.layout});
        }
    }
}

// ---- record -----------------------------------------------------------------------------------

static void collect_timestamps(tyn_graph *g, frame_slot *slot)
{
    if (!slot->pending || !slot->queries) {
        return;
    }
    bool all = true;
    double frame_ms = 0;
    uint64_t mask =
        g->dev->timestamp_bits == 64 ? UINT64_MAX : (1ull << g->dev->timestamp_bits) - 1;
    for (uint32_t i = 0; i < g->num_runs; i++) {
        uint64_t t[2];
        if (!slot->timed[i]) {
            continue;
        }
        if (g->dev->vk.GetQueryPoolResults(g->dev->device, slot->queries, i * 2, 2, sizeof t, t, 8,
                                           VK_QUERY_RESULT_64_BIT) == VK_SUCCESS) {
            tyn_node_stats *stats = &g->runs[i].stats;
            stats->gpu_ms = (double)((t[1] - t[0]) & mask) *
                            (double)g->dev->properties.limits.timestampPeriod * 1e-6;
            frame_ms += stats->media_only || stats->aid ? 0 : stats->gpu_ms;
        } else {
            all = false; // not finished: ask again later
        }
    }
    slot->pending = !all;
    slot->frame_ms = all ? frame_ms : 0;
}

uint64_t tyn_graph_records(const tyn_graph *g)
{
    return g->frame;
}

uint64_t tyn_graph_finished(tyn_graph *g, double *ms)
{
    *ms = 0;
    if (!g->num_runs || g->frame < g->num_slots) {
        return 0;
    }
    const uint64_t number = g->frame + 1 - g->num_slots;
    frame_slot *slot = &g->slots[(number - 1) % g->num_slots];
    collect_timestamps(g, slot);
    *ms = slot->frame_ms;
    return *ms > 0 ? number : 0;
}

tyn_result tyn_graph_record(tyn_graph *g, VkCommandBuffer cmd)
{
    if (g->status != TYN_OK) {
        return g->status;
    }
    if (!tyn_graph_matches(g)) {
        if (g->mode.background || g->mode.yields) {
            return graph_postpone(g, cmd);
        }
        return TYN_FAULT(&g->dev->log, TYN_ERR_PARAMS,
                         "the frame differs in structure from what was prepared; prepare it first");
    }
    graph_retire_over(g);
    bool *run_node = g->run_node;
    frame_slot *slot = &g->slots[g->frame % g->num_slots];
    choose_nodes(g, run_node);
    TYN_TRY(make_sets(g, run_node));
    collect_timestamps(g, slot);
    if (slot->queries) {
        g->dev->vk.CmdResetQueryPool(cmd, slot->queries, 0, g->num_nodes * 2);
    }

    tyn_recorder rec = {.g = g, .mode = RECORD_LIVE, .cmd = cmd};
    tyn_result result = TYN_OK;
    wait_for_all(g, cmd);
    record_sources(&rec);
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        slot->timed[i] = run_node[i];
        if (run_node[i]) {
            tyn_result ran = run_one(g, cmd, i);
            result = result == TYN_OK ? ran : result;
        } else {
            g->runs[i].stats.state = g->nodes[i].needed ? TYN_NODE_UNCHANGED : TYN_NODE_CULLED;
            g->runs[i].stats.cpu_ms = 0;
            g->runs[i].held = g->nodes[i].held ? g->nodes[i].held : g->runs[i].held;
        }
    }
    if (!g->mode.setup_only) {
        record_readbacks(&rec);
    }
    record_imports_after(&rec);
    slot->pending = true;
    slot->frame_ms = 0;
    g->frame++;
    return result;
}

const void *tyn_graph_map(tyn_graph *g, const char *name, tyn_extent *extent, VkFormat *format)
{
    for (uint32_t i = 0; g->current && i < g->num_outputs; i++) {
        if (g->outputs[i].readback && !strcmp(g->outputs[i].name, name)) {
            const resource *r = &g->resources[g->outputs[i].ref.resource - 1];
            if (extent) {
                *extent = r->extent;
            }
            if (format) {
                *format = r->format;
            }
            return g->phys ? g->phys[g->outputs[i].ref.resource - 1].readback.mapped : NULL;
        }
    }
    return NULL;
}

// ---- what happened ----------------------------------------------------------------------------

uint32_t tyn_graph_stats(tyn_graph *g, const tyn_node_stats **stats)
{
    *stats = NULL;
    if (!g->current) {
        return 0;
    }
    if (g->frame) {
        collect_timestamps(g, &g->slots[(g->frame - 1) % g->num_slots]);
    }
    tyn_node_stats *grown = realloc(g->stats, (g->num_nodes ? g->num_nodes : 1) * sizeof *grown);
    if (!grown) {
        return 0;
    }
    g->stats = grown;
    for (uint32_t i = 0; i < g->num_nodes; i++) {
        const node *n = &g->nodes[i];
        g->stats[i] = g->runs[i].stats;
        g->stats[i].name = n->pass->name;
        g->stats[i].media_only = n->media_only;
        g->stats[i].aid = n->aid;
        graph_node_bytes(g, i, &g->stats[i].bytes, &g->stats[i].shared_bytes);
    }
    *stats = g->stats;
    return g->num_nodes;
}

void tyn_graph_memory(const tyn_graph *g, uint64_t *persistent, uint64_t *transient)
{
    *persistent = g->persistent_bytes;
    *transient = g->transient_bytes;
}
