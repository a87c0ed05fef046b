// pass_time.c -- one pass alone on a device of our own, for its time.
#include <tyndall/offline.h>
#include "gpu/device.h"
#include "graph/graph.h"
#include <math.h>
#include <string.h>
#include <time.h>

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// Declares the node, with the first thing it makes as what is wanted.
static tyn_result declare(tyn_graph *g, const tyn_pass_desc *pass, const void *params)
{
    tyn_ref refs[TYN_MAX_PORTS] = {0};
    tyn_graph_begin(g);
    tyn_graph_recompute(g);
    tyn_result result = tyn_graph_add(g, pass, params, refs);
    for (uint32_t i = 0; i < pass->num_ports && result == TYN_OK; i++) {
        if (pass->ports[i].dir == TYN_OUT && refs[i].resource) {
            tyn_graph_output(g, pass->ports[i].name, refs[i], false);
            break;
        }
    }
    return result == TYN_OK ? tyn_graph_status(g) : result;
}

static tyn_result run(tyn_device *dev, tyn_graph *g, VkCommandPool pool, VkCommandBuffer cmd,
                      VkFence fence, double *ms)
{
    const tyn_procs *vk = &dev->vk;
    VkResult r = vk->ResetCommandPool(dev->device, pool, 0);
    if (r == VK_SUCCESS) {
        r = vk->BeginCommandBuffer(
            cmd, &(VkCommandBufferBeginInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO});
    }
    tyn_result result = tyn_vk_check(dev, r, "vkBeginCommandBuffer");
    if (result == TYN_OK) {
        result = tyn_graph_record(g, cmd);
        r = vk->EndCommandBuffer(cmd);
    }
    const double start = now_ms();
    if (result == TYN_OK && r == VK_SUCCESS) {
        r = vk->QueueSubmit2(
            dev->queue, 1,
            &(VkSubmitInfo2){.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos =
                                 &(VkCommandBufferSubmitInfo){
                                     .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                     .commandBuffer = cmd}},
            fence);
        if (r == VK_SUCCESS) {
            r = vk->WaitForFences(dev->device, 1, &fence, VK_TRUE, UINT64_MAX);
        }
        if (r == VK_SUCCESS) {
            r = vk->ResetFences(dev->device, 1, &fence);
        }
    }
    *ms = now_ms() - start;
    const tyn_node_stats *stats;
    if (result == TYN_OK && r == VK_SUCCESS && tyn_graph_stats(g, &stats) && stats->gpu_ms > 0) {
        *ms = stats->gpu_ms;
    }
    return result == TYN_OK ? tyn_vk_check(dev, r, "running a pass") : result;
}

tyn_result tyn_offline_time_pass(tyn_device *dev, const tyn_pass_desc *pass, const void *params,
                                 uint32_t runs, double *best_ms)
{
    *best_ms = NAN;
    if (!dev || !dev->queue || !pass || runs == 0) {
        tyn_log_print(
            dev ? &dev->log : NULL, TYN_LOG_ERROR,
            "tyn_offline_time_pass needs a device from tyn_device_open, a pass, and runs > 0");
        return TYN_ERR_PARAMS;
    }
    const tyn_procs *vk = &dev->vk;
    tyn_graph *graph = NULL;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    tyn_result result = tyn_graph_create(dev, 1, &graph);
    if (result == TYN_OK) {
        VkResult r = vk->CreateCommandPool(
            dev->device,
            &(VkCommandPoolCreateInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = dev->queue_family},
            NULL, &pool);
        if (r == VK_SUCCESS) {
            r = vk->AllocateCommandBuffers(
                dev->device,
                &(VkCommandBufferAllocateInfo){.sType =
                                                   VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool,
                                               .commandBufferCount = 1},
                &cmd);
        }
        if (r == VK_SUCCESS) {
            r = vk->CreateFence(dev->device,
                                &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                                NULL, &fence);
        }
        result = tyn_vk_check(dev, r, "what a pass runs on");
    }
    for (uint32_t i = 0; i < runs && result == TYN_OK; i++) {
        double ms = 0;
        result = declare(graph, pass, params);
        if (result == TYN_OK && !tyn_graph_matches(graph)) {
            result = tyn_graph_compile(graph);
        }
        if (result == TYN_OK) {
            result = run(dev, graph, pool, cmd, fence, &ms);
        }
        if (result == TYN_OK) {
            *best_ms = i == 0 ? ms : fmin(*best_ms, ms);
        }
    }
    tyn_graph_destroy(&graph);
    vk->DestroyFence(dev->device, fence, NULL);
    vk->DestroyCommandPool(dev->device, pool, NULL);
    return result;
}
