// draw.c -- what a pass draws: raster kernels into attachments, by dynamic rendering.
#include "graph/internal.h"
#include <tyndall/extend/hash.h>
#include <stdio.h>

// A draw that keeps what is there reads it; one that clears does not. Depth is tested against anyhow, but
// within the draw.
static tyn_access attachment_access(tyn_use use, bool keep)
{
    if (use == TYN_USE_DEPTH) {
        return (tyn_access){VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                            keep, true, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    }
    return (tyn_access){VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        (keep ? VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT : 0) |
                            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                        keep, true, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
}

// The size that all attachments have; {0} after a failure.
static tyn_extent check_attachments(tyn_recorder *r, const tyn_kernel *k)
{
    const tyn_graph *g = r->g;
    const node *n = &g->nodes[r->node];
    tyn_extent size = {0, 0, 0};
    for (uint32_t i = 0; i < k->raster->num_attachments; i++) {
        const tyn_port *port = &n->pass->ports[k->raster->attachments[i].port];
        const uint32_t id = n->res[k->raster->attachments[i].port];
        const resource *res = id ? &g->resources[id - 1] : NULL;
        if (!res || res->dim != TYN_IMAGE_2D || res->format != port->format ||
            (i && (res->extent.x != size.x || res->extent.y != size.y))) {
            recorder_fail(r, TYN_ERR_PARAMS,
                          "attachments must exist, in the table's format and in one size; not so",
                          port->name);
            return (tyn_extent){0, 0, 0};
        }
        size = res->extent;
    }
    return size;
}

static bool keeps(const tyn_draw *d, tyn_use use)
{
    return d->keep || (d->keep_depth && use == TYN_USE_DEPTH);
}

static void begin_rendering(tyn_recorder *r, const tyn_kernel *k, tyn_extent size,
                            const tyn_draw *d)
{
    const node *n = &r->g->nodes[r->node];
    VkRenderingAttachmentInfo colors[TYN_MAX_ATTACHMENTS], depth;
    uint32_t num_colors = 0;
    bool has_depth = false;
    for (uint32_t i = 0; i < k->raster->num_attachments; i++) {
        const tyn_binding *a = &k->raster->attachments[i];
        const phys *p = &r->g->phys[n->res[a->port] - 1];
        const resource *res = &r->g->resources[n->res[a->port] - 1];
        const VkRenderingAttachmentInfo info = {
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = res->kind == RESOURCE_IMPORT ? res->image.view
                         : p->mip_views[0]            ? p->mip_views[0]
                                                      : p->view,
            .imageLayout = attachment_access(a->use, keeps(d, a->use)).layout,
            .loadOp = keeps(d, a->use) ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
            .clearValue.depthStencil.depth =
                a->use == TYN_USE_DEPTH ? k->raster->clear_depth : 0.0f,
        };
        if (a->use == TYN_USE_DEPTH) {
            depth = info;
            has_depth = true;
        } else {
            colors[num_colors++] = info;
        }
    }
    r->g->dev->vk.CmdBeginRendering(
        r->cmd, &(VkRenderingInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                   .renderArea = {{0, 0}, {size.x, size.y}},
                                   .layerCount = 1,
                                   .colorAttachmentCount = num_colors,
                                   .pColorAttachments = colors,
                                   .pDepthAttachment = has_depth ? &depth : NULL});
}

static void draw_tile(tyn_recorder *r, const tyn_draw *d, const tyn_pipeline *pl,
                      const tyn_tile *tile)
{
    const tyn_kernel *k = &r->g->nodes[r->node].pass->kernels[d->kernel];
    const tyn_procs *vk = &r->g->dev->vk;
    vk->CmdSetViewport(r->cmd, 0, 1,
                       &(VkViewport){(float)tile->x, (float)tile->y, (float)tile->width,
                                     (float)tile->height, 0.0f, 1.0f});
    vk->CmdSetScissor(
        r->cmd, 0, 1,
        &(VkRect2D){{(int32_t)tile->x, (int32_t)tile->y}, {tile->width, tile->height}});
    if (k->args_size) {
        vk->CmdPushConstants(r->cmd, pl->layout, tyn_kernel_stages(k), 0, k->args_size, tile->args);
    }
    const bool part = tile->first + tile->vertices > 0;
    const uint32_t vertices = part ? tile->vertices : d->vertices;
    if (d->indexed) {
        vk->CmdDrawIndexed(r->cmd, vertices, 1, tile->first, 0, 0);
    } else {
        vk->CmdDraw(r->cmd, vertices, 1, tile->first, 0);
    }
}

void tyn_rec_draw(tyn_recorder *r, const tyn_draw *d)
{
    const node *n = &r->g->nodes[r->node];
    const tyn_kernel *k = &n->pass->kernels[d->kernel];
    const tyn_extent size = check_attachments(r, k);
    if (!size.x) {
        return;
    }
    const tyn_tile whole = {0, 0, size.x, size.y, d->args};
    const tyn_tile *tiles = d->tiles ? d->tiles : &whole;
    const uint32_t num_tiles = d->tiles ? d->num_tiles : 1;
    r->dispatches += num_tiles;
    launch l = launch_begin(r, d->kernel, d->ports, NULL, d->spec);
    for (uint32_t i = 0; i < k->raster->num_attachments; i++) {
        const tyn_binding *a = &k->raster->attachments[i];
        const uint32_t index = n->res[a->port] - 1;
        launch_touch(&l, index, attachment_access(a->use, keeps(d, a->use)));
        if (r->mode == RECORD_SURVEY && r->usage) {
            r->usage[index].image_usage |= a->use == TYN_USE_DEPTH
                                               ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                               : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        }
    }
    if (d->indexed && (!n->res[d->indices] || n->pass->ports[d->indices].dim != TYN_BUFFER)) {
        recorder_fail(r, TYN_ERR_PARAMS, "indexed draw: must be a buffer of uint32_t: port",
                      n->pass->ports[d->indices].name);
        return;
    }
    if (d->indexed) {
        const uint32_t index = n->res[d->indices] - 1;
        launch_touch(&l, index,
                     (tyn_access){VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT,
                                  true, false, VK_IMAGE_LAYOUT_UNDEFINED});
        if (r->mode == RECORD_SURVEY && r->usage) {
            r->usage[index].buffer_usage |= VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
        }
    }
    if (!launch_prepare(r, &l)) {
        return;
    }
    if (r->mode == RECORD_PLAN) {
        char line[160];
        snprintf(line, sizeof line, "    draw %s %u vertices, %u tiles",
                 d->label ? d->label : k->name, d->vertices, num_tiles);
        r->print(r->print_user, line);
        return;
    }
    const tyn_pipeline *pl = launch_bind(r, &l);
    if (!pl) {
        return;
    }
    if (d->indexed) {
        r->g->dev->vk.CmdBindIndexBuffer(r->cmd, r->g->phys[n->res[d->indices] - 1].buffer, 0,
                                         VK_INDEX_TYPE_UINT32);
    }
    begin_rendering(r, k, size, d);
    for (uint32_t i = 0; i < num_tiles && d->vertices; i++) {
        draw_tile(r, d, pl, &tiles[i]);
    }
    r->g->dev->vk.CmdEndRendering(r->cmd);
}
