// plan.c -- the barrier planner.
#include "graph/plan.h"
#include <stdio.h>
#include <string.h>

tyn_access tyn_access_join(tyn_access a, tyn_access b)
{
    return (tyn_access){
        .stages = a.stages | b.stages,
        .access = a.access | b.access,
        .read = a.read || b.read,
        .write = a.write || b.write,
        .layout = a.layout == b.layout ? a.layout : VK_IMAGE_LAYOUT_GENERAL,
    };
}

static bool covers(VkFlags64 all, VkFlags64 some)
{
    return !(some & ~all);
}

// Visibility is a set of pairs; keeping the product would claim pairs that no barrier made. Each barrier makes its own pair visible,
// so widen only when one side is equal.
static void make_visible(tyn_track *t, VkPipelineStageFlags2 stages, VkAccessFlags2 access)
{
    const bool widen =
        t->visible_stages == 0 || t->visible_stages == stages || t->visible_access == access;
    t->visible_stages = widen ? t->visible_stages | stages : stages;
    t->visible_access = widen ? t->visible_access | access : access;
}

bool tyn_plan(tyn_track *t, tyn_access a, tyn_barrier *out)
{
    const bool transition = a.layout != t->layout;
    const bool visible = covers(t->visible_stages, a.stages) && covers(t->visible_access, a.access);
    bool needed;
    *out = (tyn_barrier){.dst_stages = a.stages,
                         .dst_access = a.access,
                         .old_layout = t->layout,
                         .new_layout = a.layout};
    if (transition) {
        // Reads since the last write already waited for it, but the transition changes memory under
        // them, so it waits for both.
        needed = true;
        out->src_stages = t->write_stages | t->read_stages;
        out->src_access = t->write_access;
    } else if (a.write) {
        // Reads since the last write have waited for it: who waits for them need not.
        const bool after_reads = t->read_stages && !a.read;
        const bool full = t->write_stages && !visible && !after_reads;
        const bool reads = t->read_stages && !covers(t->after_reads, a.stages);
        needed = full || reads;
        out->src_stages = (reads ? t->read_stages : 0) | (full ? t->write_stages : 0);
        out->src_access = full ? t->write_access : 0;
        out->dst_access = full ? a.access : 0;
    } else {
        needed = a.read && t->write_stages && !visible;
        out->src_stages = t->write_stages;
        out->src_access = t->write_access;
    }
    if (needed && !out->src_stages) {
        out->src_stages = VK_PIPELINE_STAGE_2_NONE; // first use: nothing to wait for
    }

    if (a.write) {
        *t = (tyn_track){.write_stages = a.stages,
                         .write_access =
                             a.access & (VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                         VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                         VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                         VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                                         VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT),
                         .layout = a.layout};
    } else if (transition) {
        // Later readers chain to the transition through the stage that waited for it; its memory is
        // available.
        *t = (tyn_track){.write_stages = a.stages,
                         .visible_stages = a.stages,
                         .visible_access = a.access,
                         .read_stages = a.stages,
                         .layout = a.layout};
    } else {
        t->read_stages |= a.stages;
        t->after_reads = 0;
        if (needed) {
            make_visible(t, a.stages, a.access);
        }
    }
    return needed;
}

void tyn_barrier_join(tyn_barrier *all, const tyn_barrier *b)
{
    all->src_stages |= b->src_stages;
    all->dst_stages |= b->dst_stages;
    all->src_access |= b->src_access;
    all->dst_access |= b->dst_access;
}

void tyn_barrier_widen(tyn_barrier *all)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    if (all->dst_stages & compute) {
        all->dst_stages |= VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    }
    if (all->src_access && (all->dst_stages & compute)) {
        all->dst_access |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                           VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                           VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT |
                           VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    }
    if (all->src_access && (all->src_stages & compute)) {
        all->src_access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    }
}

void tyn_track_barrier(tyn_track *t, const tyn_barrier *all)
{
    const bool waits = all->src_stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const bool flushes = all->src_access & VK_ACCESS_2_MEMORY_WRITE_BIT;
    if (t->read_stages && (waits || covers(all->src_stages, t->read_stages))) {
        t->after_reads |= all->dst_stages;
    }
    if (t->write_stages && (waits || covers(all->src_stages, t->write_stages)) &&
        (flushes || covers(all->src_access, t->write_access)) && all->dst_access) {
        make_visible(t, all->dst_stages, all->dst_access);
    }
}

// ---- names ------------------------------------------------------------------------------------

typedef struct bit_name {
    uint64_t bit;
    const char *name;
} bit_name;

static void print_bits(char *text, size_t size, uint64_t bits, const bit_name *names)
{
    size_t at = 0;
    text[0] = 0;
    for (const bit_name *n = names; n->name && at < size; n++) {
        if (bits & n->bit) {
            at += (size_t)snprintf(text + at, size - at, "%s%s", at ? "|" : "", n->name);
            bits &= ~n->bit;
        }
    }
    if (bits && at < size) {
        at += (size_t)snprintf(text + at, size - at, "%s0x%llx", at ? "|" : "",
                               (unsigned long long)bits);
    }
    if (!at) {
        snprintf(text, size, "NONE");
    }
}

void tyn_print_stages(char *text, size_t size, VkPipelineStageFlags2 stages)
{
    static const bit_name names[] = {
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "COMPUTE"},
        {VK_PIPELINE_STAGE_2_COPY_BIT, "COPY"},
        {VK_PIPELINE_STAGE_2_CLEAR_BIT, "CLEAR"},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "TRANSFER"},
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "INDIRECT"},
        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "INDEX_INPUT"},
        {VK_PIPELINE_STAGE_2_HOST_BIT, "HOST"},
        {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "VERTEX"},
        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "FRAGMENT"},
        {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "COLOR_OUTPUT"},
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "EARLY_TESTS"},
        {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "LATE_TESTS"},
        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "ALL"},
        {0, NULL}};
    print_bits(text, size, stages, names);
}

void tyn_print_access(char *text, size_t size, VkAccessFlags2 access)
{
    static const bit_name names[] = {
        {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "SAMPLED_READ"},
        {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "STORAGE_READ"},
        {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "STORAGE_WRITE"},
        {VK_ACCESS_2_UNIFORM_READ_BIT, "UNIFORM_READ"},
        {VK_ACCESS_2_TRANSFER_READ_BIT, "TRANSFER_READ"},
        {VK_ACCESS_2_TRANSFER_WRITE_BIT, "TRANSFER_WRITE"},
        {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, "INDIRECT_READ"},
        {VK_ACCESS_2_INDEX_READ_BIT, "INDEX_READ"},
        {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "COLOR_READ"},
        {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "COLOR_WRITE"},
        {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "DEPTH_READ"},
        {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "DEPTH_WRITE"},
        {VK_ACCESS_2_HOST_READ_BIT, "HOST_READ"},
        {VK_ACCESS_2_HOST_WRITE_BIT, "HOST_WRITE"},
        {VK_ACCESS_2_MEMORY_READ_BIT, "MEMORY_READ"},
        {VK_ACCESS_2_MEMORY_WRITE_BIT, "MEMORY_WRITE"},
        {0, NULL}};
    print_bits(text, size, access, names);
}

const char *tyn_layout_name(VkImageLayout layout)
{
    static const struct {
        VkImageLayout layout;
        const char *name;
    } names[] = {{VK_IMAGE_LAYOUT_UNDEFINED, "UNDEFINED"},
                 {VK_IMAGE_LAYOUT_GENERAL, "GENERAL"},
                 {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, "READ_ONLY"},
                 {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "TRANSFER_SRC"},
                 {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "TRANSFER_DST"},
                 {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, "COLOR_ATTACHMENT"},
                 {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, "DEPTH_ATTACHMENT"},
                 {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, "DEPTH_READ_ONLY"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].layout == layout) {
            return names[i].name;
        }
    }
    return "OTHER";
}
