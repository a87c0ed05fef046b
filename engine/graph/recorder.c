// recorder.c -- what a pass records: dispatches and small transfers (draw.c: draws). The same code surveys
// (what will be needed), makes pipelines, plans (for dumps) and records.
#include "graph/internal.h"
#include <tyndall/extend/hash.h>
#include <stdio.h>
#include <string.h>

static node *node_of(const tyn_recorder *r)
{
    return &r->g->nodes[r->node];
}

static resource *resource_at(const tyn_recorder *r, uint8_t port)
{
    uint32_t res = node_of(r)->res[port];
    return res ? &r->g->resources[res - 1] : NULL;
}

// The resource that is bound at a port.
static uint32_t bound(const tyn_recorder *r, uint8_t port)
{
    const tyn_port *p = &node_of(r)->pass->ports[port];
    const uint32_t res = node_of(r)->res[port];
    return res ? res - 1 : p->format == VK_FORMAT_R32G32_UINT ? ZERO_WORDS : (uint32_t)p->dim;
}

bool tyn_rec_has(const tyn_recorder *r, uint8_t port)
{
    return resource_at(r, port) != NULL;
}

tyn_extent tyn_rec_extent(const tyn_recorder *r, uint8_t port)
{
    const resource *res = resource_at(r, port);
    return res ? res->extent : (tyn_extent){0, 0, 0};
}

const uint8_t *tyn_ports_exchanged(const tyn_kernel *kernel, const uint8_t (*pairs)[2],
                                   uint32_t num_pairs, uint8_t out[TYN_MAX_BINDINGS])
{
    for (uint32_t i = 0; i < kernel->num_bindings; i++) {
        const uint8_t port = kernel->bindings[i].port;
        out[i] = port;
        for (uint32_t k = 0; k < num_pairs; k++) {
            if (port == pairs[k][0]) {
                out[i] = pairs[k][1];
                break;
            }
        }
    }
    return out;
}

void tyn_rec_work(tyn_recorder *r, const char *name, double amount)
{
    for (uint32_t i = 0; i < r->num_work; i++) {
        if (!strcmp(r->work[i].name, name)) {
            r->work[i].amount += amount;
            return;
        }
    }
    if (r->num_work < TYN_MAX_WORK) {
        r->work[r->num_work].name = name;
        r->work[r->num_work++].amount = amount;
    }
}

void recorder_fail(tyn_recorder *r, tyn_result result, const char *what, const char *which)
{
    if (r->result == TYN_OK) {
        r->result = result;
        tyn_log_print(&r->g->dev->log, TYN_LOG_ERROR, "node '%s': %s '%s'", node_of(r)->pass->name,
                      what, which);
    }
}

// ---- barriers ---------------------------------------------------------------------------------

VkImageMemoryBarrier2 graph_image_barrier(const resource *r, VkImage image, const tyn_barrier *b)
{
    const bool lent = r->kind == RESOURCE_IMPORT;
    const VkImageAspectFlags aspect =
        lent && r->image.aspect ? r->image.aspect : graph_aspect(r->format);
    return (VkImageMemoryBarrier2){
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = b->src_stages,
        .srcAccessMask = b->src_access,
        .dstStageMask = b->dst_stages,
        .dstAccessMask = b->dst_access,
        .oldLayout = b->old_layout,
        .newLayout = b->new_layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        // Of a host's image only mip 0 of layer 0 is ours.
        .subresourceRange = {aspect, 0, lent ? 1 : VK_REMAINING_MIP_LEVELS, 0, 1},
    };
}

void graph_memory_barrier(const tyn_graph *g, VkCommandBuffer cmd, const tyn_barrier *b)
{
    g->dev->vk.CmdPipelineBarrier2(
        cmd, &(VkDependencyInfo){
                 .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                 .memoryBarrierCount = 1,
                 .pMemoryBarriers = &(VkMemoryBarrier2){.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                                        .srcStageMask = b->src_stages,
                                                        .srcAccessMask = b->src_access,
                                                        .dstStageMask = b->dst_stages,
                                                        .dstAccessMask = b->dst_access}});
}

static void print_barrier(tyn_recorder *r, const char *name, const tyn_barrier *b)
{
    char src[128], dst[128], src_access[128], dst_access[128], line[640];
    tyn_print_stages(src, sizeof src, b->src_stages);
    tyn_print_stages(dst, sizeof dst, b->dst_stages);
    tyn_print_access(src_access, sizeof src_access, b->src_access);
    tyn_print_access(dst_access, sizeof dst_access, b->dst_access);
    int n = snprintf(line, sizeof line, "    barrier %s: %s %s -> %s %s", name, src, src_access,
                     dst, dst_access);
    if (b->old_layout != b->new_layout) {
        snprintf(line + n, sizeof line - (size_t)n, ", %s -> %s", tyn_layout_name(b->old_layout),
                 tyn_layout_name(b->new_layout));
    }
    r->print(r->print_user, line);
}

static tyn_track *track_of(tyn_recorder *r, uint32_t index)
{
    return r->mode == RECORD_PLAN ? &r->tracks[index] : &r->g->phys[index].track;
}

// One barrier for all memory in place of one for each touched resource, without transitions. It costs the same, and other
// resources need none later. Where others lay before an image, it is for that, too: the image's own says nothing of their memory.
// False: none is needed.
// `first`: it must be a command of its own, before the transition of such an image.
static bool join_barriers(tyn_recorder *r, const touch *touches, uint32_t count, tyn_barrier *all,
                          bool *first)
{
    bool any = false;
    *all = (tyn_barrier){0};
    *first = false;
    for (uint32_t i = 0; i < count; i++) {
        tyn_track track = *track_of(r, touches[i].resource);
        tyn_barrier own;
        const bool needed = tyn_plan(&track, touches[i].access, &own);
        const bool entered = needed && own.old_layout != own.new_layout &&
                             own.src_stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        *first = *first || entered;
        if (needed && (own.old_layout == own.new_layout || entered)) {
            tyn_barrier_join(all, &own);
            any = true;
        }
    }
    tyn_barrier_widen(all);
    for (uint32_t i = 0; any && i < r->g->num_resources; i++) {
        tyn_track_barrier(track_of(r, i), all);
    }
    return any;
}

static void put_barriers(tyn_recorder *r, const tyn_barrier *all,
                         const VkImageMemoryBarrier2 *images, uint32_t num_images)
{
    r->barriers++;
    if (r->mode == RECORD_PLAN) {
        return;
    }
    const VkMemoryBarrier2 memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                     .srcStageMask = all ? all->src_stages : 0,
                                     .srcAccessMask = all ? all->src_access : 0,
                                     .dstStageMask = all ? all->dst_stages : 0,
                                     .dstAccessMask = all ? all->dst_access : 0};
    r->g->dev->vk.CmdPipelineBarrier2(
        r->cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .memoryBarrierCount = all != NULL,
                                    .pMemoryBarriers = &memory,
                                    .imageMemoryBarrierCount = num_images,
                                    .pImageMemoryBarriers = images});
}

// Puts what the touched resources need into the stream: one command, or two where other resources lay in an image's memory. The
// parts of a command are not ordered, and a transition must not come before the others' writes have left the caches.
static void synchronise(tyn_recorder *r, const touch *touches, uint32_t count)
{
    VkImageMemoryBarrier2 images[TYN_MAX_BINDINGS + TYN_MAX_ATTACHMENTS + 1];
    uint32_t num_images = 0;
    tyn_barrier all;
    bool first;
    const bool any = join_barriers(r, touches, count, &all, &first);
    if (any && r->mode == RECORD_PLAN) {
        print_barrier(r, "memory", &all);
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t index = touches[i].resource;
        const resource *res = &r->g->resources[index];
        tyn_barrier own;
        tyn_plan(track_of(r, index), touches[i].access, &own);
        if (own.old_layout == own.new_layout) {
            continue;
        }
        if (r->mode == RECORD_PLAN) {
            print_barrier(r, res->name, &own);
            num_images++;
        } else {
            images[num_images++] = graph_image_barrier(res, r->g->phys[index].image, &own);
        }
    }
    if (first) {
        put_barriers(r, &all, NULL, 0);
        put_barriers(r, NULL, images, num_images);
    } else if (any || num_images) {
        put_barriers(r, any ? &all : NULL, images, num_images);
    }
}

void recorder_enter(tyn_recorder *r)
{
    const node *n = node_of(r);
    for (uint32_t p = 0; p < n->pass->num_ports; p++) {
        const uint32_t index = graph_port(n, p, DIR_MADE) - 1;
        if (index == UINT32_MAX || !r->g->phys[index].shared) {
            continue;
        }
        VkPipelineStageFlags2 others = 0;
        for (uint32_t i = 0; i < r->g->num_resources; i++) {
            const tyn_track *t = track_of(r, i);
            if (i != index && graph_overlap(&r->g->phys[i], &r->g->phys[index])) {
                others |= t->write_stages | t->read_stages;
            }
        }
        if (others) {
            *track_of(r, index) = (tyn_track){.write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                              .write_access = VK_ACCESS_2_MEMORY_WRITE_BIT};
        }
    }
}

void recorder_access(tyn_recorder *r, uint32_t index, tyn_access access)
{
    synchronise(r, &(touch){index, access}, 1);
}

void launch_touch(launch *l, uint32_t index, tyn_access access)
{
    for (uint32_t i = 0; i < l->num_touches; i++) {
        if (l->touches[i].resource == index) {
            l->touches[i].access = tyn_access_join(l->touches[i].access, access);
            return;
        }
    }
    l->touches[l->num_touches++] = (touch){index, access};
}

static tyn_access access_of(const tyn_port *port, tyn_use use, VkPipelineStageFlags2 stages)
{
    const VkAccessFlags2 reads = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    const VkAccessFlags2 writes = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    bool image = port->dim != TYN_BUFFER;
    VkImageLayout general = image ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED;
    switch (use) {
    case TYN_USE_SAMPLED:
        // A port that its own node writes stays in GENERAL: it would flip at every dispatch.
        return (tyn_access){stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, true, false,
                            port->dir == TYN_IN ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                                                : VK_IMAGE_LAYOUT_GENERAL};
    case TYN_USE_TEXELS_FLOAT:
    case TYN_USE_TEXELS_VEC4:
    case TYN_USE_TEXELS_UINT:
    case TYN_USE_TEXELS_UVEC4:
        return (tyn_access){stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, true, false, general};
    case TYN_USE_UNIFORM:
        return (tyn_access){stages, VK_ACCESS_2_UNIFORM_READ_BIT, true, false, general};
    case TYN_USE_STORAGE_READ:
        return (tyn_access){stages, reads, true, false, general};
    case TYN_USE_STORAGE_WRITE:
        return (tyn_access){stages, writes, false, true, general};
    default:
        return (tyn_access){stages, reads | writes, true, true, general};
    }
}

static const uint32_t no_spec[TYN_MAX_SPEC]; // zeros

// ---- descriptors ------------------------------------------------------------------------------

static const phys *physical(const tyn_recorder *r, uint8_t port)
{
    return &r->g->phys[bound(r, port)];
}

static VkImageView view_of(const tyn_recorder *r, uint8_t port, uint8_t mip, bool sampled)
{
    const resource *res = resource_at(r, port);
    if (res && res->kind == RESOURCE_IMPORT) {
        return res->image.view;
    }
    const phys *p = physical(r, port);
    return sampled || !p->mip_views[mip] ? p->view : p->mip_views[mip];
}

static VkSampler sampler_of(tyn_recorder *r, uint8_t port, const tyn_binding *binding)
{
    const resource *res = resource_at(r, port);
    if (res && graph_aspect(res->format) & VK_IMAGE_ASPECT_DEPTH_BIT) {
        return r->g->dev->nearest;
    }
    return binding->repeat ? r->g->dev->repeat_x : r->g->dev->clamp;
}

// VK_NULL_HANDLE: the recorder has failed.
static VkDescriptorSet find_or_make_set(tyn_recorder *r, const launch *l, const tyn_pipeline *pl)
{
    const uint8_t *ports = l->ports;
    tyn_graph *g = r->g;
    const tyn_kernel *k = pl->kernel;
    uint64_t h = tyn_hash_u64(TYN_HASH_SEED, (uint64_t)(uintptr_t)k);
    VkDescriptorImageInfo images[TYN_MAX_BINDINGS];
    VkDescriptorBufferInfo buffers[TYN_MAX_BINDINGS];
    VkBufferView views[TYN_MAX_BINDINGS];
    VkWriteDescriptorSet writes[TYN_MAX_BINDINGS];
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        const tyn_port *port = &node_of(r)->pass->ports[ports[i]];
        tyn_use use = k->bindings[i].use;
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = tyn_descriptor_type(node_of(r)->pass, &k->bindings[i]),
        };
        const int texels = graph_texel_index(use);
        if (texels >= 0) {
            views[i] = physical(r, ports[i])->texels[texels];
            writes[i].pTexelBufferView = &views[i];
            h = tyn_hash_u64(h, (uint64_t)views[i]);
        } else if (port->dim == TYN_BUFFER) {
            buffers[i] = (VkDescriptorBufferInfo){physical(r, ports[i])->buffer, 0, VK_WHOLE_SIZE};
            writes[i].pBufferInfo = &buffers[i];
            h = tyn_hash_u64(h, (uint64_t)buffers[i].buffer);
        } else {
            uint32_t t = 0; // two bindings may share the image, and its layout
            while (l->touches[t].resource != bound(r, ports[i])) {
                t++;
            }
            const VkImageLayout layout = l->touches[t].access.layout;
            uint8_t mip = l->mips ? l->mips[i] : 0;
            images[i] = (VkDescriptorImageInfo){
                use == TYN_USE_SAMPLED ? sampler_of(r, ports[i], &k->bindings[i]) : VK_NULL_HANDLE,
                view_of(r, ports[i], mip, use == TYN_USE_SAMPLED), layout};
            writes[i].pImageInfo = &images[i];
            h = tyn_hash_u64(h, (uint64_t)images[i].imageView);
            h = tyn_hash_u64(h, layout);
        }
    }
    const uint32_t mask = sizeof g->sets.made / sizeof g->sets.made[0] - 1;
    set_key *entry = &g->sets.made[h & mask];
    if (entry->set && entry->hash == h) {
        return entry->set;
    }
    VkDescriptorSet set;
    VkResult made = g->dev->vk.AllocateDescriptorSets(
        g->dev->device,
        &(VkDescriptorSetAllocateInfo){.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                       .descriptorPool = g->slots[g->frame % g->num_slots].pool,
                                       .descriptorSetCount = 1,
                                       .pSetLayouts = &pl->set_layout},
        &set);
    if (made != VK_SUCCESS) {
        char what[192];
        snprintf(what, sizeof what, "node '%s': vkAllocateDescriptorSets for kernel '%s'",
                 node_of(r)->pass->name, k->name);
        r->result = tyn_vk_check(g->dev, made, what);
        return VK_NULL_HANDLE;
    }
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        writes[i].dstSet = set;
    }
    g->dev->vk.UpdateDescriptorSets(g->dev->device, k->num_bindings, writes, 0, NULL);
    *entry = (set_key){h, set};
    return set;
}

// The kernel's layouts, and its pipeline if it was prepared; else the recorder fails.
static VkPipeline find_pipeline(tyn_recorder *r, const launch *l, tyn_pipeline **pl)
{
    const tyn_result result = tyn_pipeline_get(r->g->dev, node_of(r)->pass, l->kernel, pl);
    const VkPipeline pipeline =
        result == TYN_OK ? tyn_pipeline_find(*pl, l->spec ? l->spec : no_spec) : VK_NULL_HANDLE;
    if (!pipeline) {
        recorder_fail(r, TYN_ERR_PARAMS, "a pipeline was not prepared for kernel",
                      node_of(r)->pass->kernels[l->kernel].name);
    }
    return pipeline;
}

// The set of a launch, kept for when it is recorded.
static void make_set(tyn_recorder *r, const launch *l)
{
    if (r->result != TYN_OK) {
        return; // said
    }
    launch_sets *sets = &r->g->sets;
    tyn_pipeline *pl;
    VkDescriptorSet set = find_pipeline(r, l, &pl) ? find_or_make_set(r, l, pl) : VK_NULL_HANDLE;
    if (!set) {
        return;
    }
    if (sets->count == sets->cap) {
        recorder_fail(r, TYN_ERR_PARAMS, "more launches than were prepared, at kernel",
                      pl->kernel->name);
        return;
    }
    sets->items[sets->count++] = set;
}

// ---- surveying --------------------------------------------------------------------------------

static void survey_launch(tyn_recorder *r, const launch *l)
{
    const node *n = node_of(r);
    const tyn_kernel *k = &n->pass->kernels[l->kernel];
    const uint8_t *ports = l->ports;
    survey *s = r->survey;
    s->hash = tyn_hash_u64(s->hash, (uint64_t)(uintptr_t)k);
    s->hash = tyn_hash_bytes(s->hash, ports, k->num_bindings);
    if (l->spec) {
        s->hash = tyn_hash_bytes(s->hash, l->spec, k->num_spec * 4);
    }
    s->sets++;
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        tyn_use use = k->bindings[i].use;
        const int texels = graph_texel_index(use);
        s->descriptors[tyn_descriptor_type(n->pass, &k->bindings[i])]++;
        if (r->usage) {
            phys *p = &r->usage[bound(r, ports[i])];
            p->image_usage |=
                use == TYN_USE_SAMPLED ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT;
            p->buffer_usage |= texels >= 0              ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT
                               : use == TYN_USE_UNIFORM ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT
                                                        : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
            p->texel_uses |= texels >= 0 ? 1u << texels : 0u;
        }
    }
}

static void survey_transfer(tyn_recorder *r, uint8_t port, bool source)
{
    uint32_t res = node_of(r)->res[port];
    r->survey->hash = tyn_hash_u64(r->survey->hash, port);
    if (r->usage && res) {
        r->usage[res - 1].buffer_usage |=
            source ? VK_BUFFER_USAGE_TRANSFER_SRC_BIT : VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        r->usage[res - 1].image_usage |=
            source ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    }
}

static void make_pipeline(tyn_recorder *r, const launch *l)
{
    tyn_pipeline *pl;
    tyn_variant *v;
    tyn_result result = tyn_pipeline_get(r->g->dev, node_of(r)->pass, l->kernel, &pl);
    if (result == TYN_OK) {
        result = tyn_variant_get(pl, l->spec ? l->spec : no_spec, &v);
    }
    if (result == TYN_OK) {
        result = graph_want_pipeline(r->g, v);
    }
    if (result != TYN_OK) {
        recorder_fail(r, result, "no pipeline for kernel",
                      node_of(r)->pass->kernels[l->kernel].name);
    }
}

// ---- launching --------------------------------------------------------------------------------

launch launch_begin(tyn_recorder *r, uint32_t kernel, const uint8_t *ports, const uint8_t *mips,
                    const uint32_t *spec)
{
    const node *n = node_of(r);
    const tyn_kernel *k = &n->pass->kernels[kernel];
    const VkPipelineStageFlags2 stages =
        k->raster ? VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                  : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    launch l = {.kernel = kernel, .spec = spec, .mips = mips};
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        l.ports[i] = ports ? ports[i] : k->bindings[i].port;
        launch_touch(&l, bound(r, l.ports[i]),
                     access_of(&n->pass->ports[l.ports[i]], k->bindings[i].use, stages));
    }
    return l;
}

bool launch_prepare(tyn_recorder *r, const launch *l)
{
    if (r->mode == RECORD_SURVEY) {
        survey_launch(r, l);
        return false;
    }
    if (r->mode == RECORD_PIPELINES) {
        make_pipeline(r, l);
        return false;
    }
    if (r->mode == RECORD_SETS) {
        make_set(r, l);
        return false;
    }
    synchronise(r, l->touches, l->num_touches);
    return true;
}

const tyn_pipeline *launch_bind(tyn_recorder *r, const launch *l)
{
    const tyn_procs *vk = &r->g->dev->vk;
    const tyn_kernel *k = &node_of(r)->pass->kernels[l->kernel];
    const VkPipelineBindPoint point =
        k->raster ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
    tyn_pipeline *pl;
    launch_sets *sets = &r->g->sets;
    VkPipeline pipeline = find_pipeline(r, l, &pl);
    if (!pipeline || sets->next == sets->count) {
        return NULL;
    }
    const VkDescriptorSet set = sets->items[sets->next++];
    vk->CmdBindPipeline(r->cmd, point, pipeline);
    vk->CmdBindDescriptorSets(r->cmd, point, pl->layout, 0, 1, &set, 0, NULL);
    return pl;
}

static void dispatch(tyn_recorder *r, const tyn_dispatch *d, int indirect_port, uint64_t offset)
{
    const node *n = node_of(r);
    const tyn_kernel *k = &n->pass->kernels[d->kernel];
    const uint32_t cells[3] = {d->cells.x ? d->cells.x : 1, d->cells.y ? d->cells.y : 1,
                               d->cells.z ? d->cells.z : 1};
    uint32_t groups[3];
    for (int a = 0; a < 3; a++) {
        uint32_t local = k->local_size[a] ? k->local_size[a] : 1;
        groups[a] = (cells[a] + local - 1) / local;
        if (groups[a] > r->g->dev->properties.limits.maxComputeWorkGroupCount[a]) {
            recorder_fail(r, TYN_ERR_UNSUPPORTED,
                          "more workgroups than the device takes for kernel", k->name);
            return;
        }
    }
    r->dispatches++;
    launch l = launch_begin(r, d->kernel, d->ports, d->mips, d->spec);
    if (indirect_port >= 0 && n->res[indirect_port]) {
        uint32_t index = n->res[indirect_port] - 1;
        launch_touch(&l, index,
                     (tyn_access){VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                  VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, true, false,
                                  VK_IMAGE_LAYOUT_UNDEFINED});
        if (r->mode == RECORD_SURVEY && r->usage) {
            r->usage[index].buffer_usage |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
        }
    }
    if (!launch_prepare(r, &l)) {
        return;
    }
    if (r->mode == RECORD_PLAN) {
        char line[160];
        snprintf(line, sizeof line, "    dispatch %s %u x %u x %u", d->label ? d->label : k->name,
                 groups[0], groups[1], groups[2]);
        r->print(r->print_user, line);
        return;
    }
    const tyn_procs *vk = &r->g->dev->vk;
    const tyn_pipeline *pl = launch_bind(r, &l);
    if (!pl) {
        return;
    }
    if (k->args_size) {
        vk->CmdPushConstants(r->cmd, pl->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, k->args_size,
                             d->args);
    }
    if (indirect_port >= 0) {
        vk->CmdDispatchIndirect(r->cmd, physical(r, (uint8_t)indirect_port)->buffer, offset);
    } else {
        vk->CmdDispatch(r->cmd, groups[0], groups[1], groups[2]);
    }
}

void tyn_rec_dispatch(tyn_recorder *r, const tyn_dispatch *d)
{
    dispatch(r, d, -1, 0);
}

void tyn_rec_dispatch_indirect(tyn_recorder *r, const tyn_dispatch *d, uint8_t port,
                               uint64_t offset)
{
    dispatch(r, d, port, offset);
}

// ---- transfers --------------------------------------------------------------------------------

// Surveys or synchronises; true if the command itself is to be recorded.
static bool begin_transfer(tyn_recorder *r, uint8_t port, bool source, const char *what)
{
    uint32_t res = node_of(r)->res[port];
    if (!res) {
        return false;
    }
    if (r->mode == RECORD_SURVEY) {
        survey_transfer(r, port, source);
        return false;
    }
    if (r->mode == RECORD_PIPELINES || r->mode == RECORD_SETS) {
        return false;
    }
    tyn_access access = graph_transfer(&r->g->resources[res - 1], !source);
    if (r->g->resources[res - 1].dim != TYN_BUFFER) {
        access.layout = VK_IMAGE_LAYOUT_GENERAL; // the node may use it otherwise next
    }
    synchronise(r, &(touch){res - 1, access}, 1);
    if (r->mode == RECORD_PLAN) {
        char line[160];
        snprintf(line, sizeof line, "    %s %s", what, r->g->resources[res - 1].name);
        r->print(r->print_user, line);
        return false;
    }
    return true;
}

bool tyn_rec_live(const tyn_recorder *r)
{
    return r->mode == RECORD_LIVE;
}

void tyn_rec_update(tyn_recorder *r, uint8_t port, uint64_t offset, const void *data, size_t size)
{
    if (begin_transfer(r, port, false, "update")) {
        r->g->dev->vk.CmdUpdateBuffer(r->cmd, physical(r, port)->buffer, offset, size, data);
    }
}

void tyn_rec_fill(tyn_recorder *r, uint8_t port, uint32_t value)
{
    if (begin_transfer(r, port, false, "fill")) {
        r->g->dev->vk.CmdFillBuffer(r->cmd, physical(r, port)->buffer, 0, VK_WHOLE_SIZE, value);
    }
}

void tyn_rec_clear(tyn_recorder *r, uint8_t port)
{
    if (begin_transfer(r, port, false, "clear")) {
        r->g->dev->vk.CmdClearColorImage(r->cmd, physical(r, port)->image, VK_IMAGE_LAYOUT_GENERAL,
                                         &(VkClearColorValue){{0}}, 1,
                                         &(VkImageSubresourceRange){VK_IMAGE_ASPECT_COLOR_BIT, 0,
                                                                    VK_REMAINING_MIP_LEVELS, 0, 1});
    }
}

void tyn_rec_copy_buffer(tyn_recorder *r, uint8_t src, uint8_t dst, uint64_t bytes)
{
    bool live = begin_transfer(r, src, true, "copy from");
    if (begin_transfer(r, dst, false, "copy to") && live) {
        r->g->dev->vk.CmdCopyBuffer(r->cmd, physical(r, src)->buffer, physical(r, dst)->buffer, 1,
                                    &(VkBufferCopy){0, 0, bytes});
    }
}

void recorder_run(tyn_recorder *r)
{
    const node *n = node_of(r);
    if (n->pass->counter_bytes) {
        tyn_rec_fill(r, n->pass->counter_port, 0);
    }
    n->pass->record(r, n->params);
}

tyn_result recorder_run_all(const tyn_recorder *like, const bool *run_node)
{
    for (uint32_t i = 0; i < like->g->num_nodes; i++) {
        tyn_recorder r = *like;
        r.node = i;
        if (run_node ? run_node[i] : node_of(&r)->needed) {
            recorder_run(&r);
        }
        if (r.result != TYN_OK) {
            return r.result;
        }
    }
    return TYN_OK;
}
