// gpu_test.c -- runs single passes on the device, with validation on.
#include "gpu_test.h"
#include "bound.h"
#include "graph/internal.h"
#include "base/half.h"
#include <tyndall/extend/hash.h>
#include "shaders/common/counters.h"
#include "skip.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void on_log(void *user, tyn_log_level level, const char *message)
{
    gpu_test *t = user;
    if (level == TYN_LOG_ERROR) {
        t->errors++;
        snprintf(t->last_error, sizeof t->last_error, "%s", message);
    }
    if (!t->quiet) {
        fprintf(stderr, "%s\n", message);
    }
}

int gpu_setup(void **state)
{
    gpu_test *t = calloc(1, sizeof *t);
    t->log = (tyn_log){on_log, t, TYN_LOG_INFO};
    bool validation = !getenv("TYN_TEST_NO_VALIDATION");
    if (tyn_device_open(tyn_device_open_params(.validation = validation, .log = t->log), &t->dev) !=
        TYN_OK) {
        if (getenv("CI")) {
            fprintf(stderr, "no Vulkan device with validation layers\n");
            exit(1);
        }
        skip_all("no Vulkan device with validation layers");
    }
    const tyn_procs *vk = &t->dev->vk;
    VkDevice dev = t->dev->device;
    vk->CreateCommandPool(
        dev,
        &(VkCommandPoolCreateInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                   .queueFamilyIndex = t->dev->queue_family},
        NULL, &t->pool);
    vk->AllocateCommandBuffers(
        dev,
        &(VkCommandBufferAllocateInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                       .commandPool = t->pool,
                                       .commandBufferCount = 1},
        &t->cmd);
    vk->CreateFence(dev, &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO}, NULL,
                    &t->fence);
    if (tyn_graph_create(t->dev, 1, &t->graph) != TYN_OK) {
        return -1;
    }
    t->graph->poison = true; // reading what nobody wrote must show
    tyn_graph_begin(t->graph);
    *state = t;
    return 0;
}

static bool is_software(const gpu_test *t)
{
    return t->dev->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

double gpu_filter_shift(const gpu_test *t)
{
    const int bits = (int)t->dev->properties.limits.subTexelPrecisionBits;
    return is_software(t) ? 0 : ldexp(0.5, -bits);
}

double gpu_ulps(const gpu_test *t, double allowed)
{
    return is_software(t) ? 0 : allowed * (double)FLT_EPSILON;
}

int gpu_teardown(void **state)
{
    gpu_test *t = *state;
    // Bounds are near what is observed on a CPU device, whose figures are the same every time.
    const bool near = bounds_near(is_software(t) && !getenv("TYN_TEST_FILTER"));
    tyn_graph_destroy(&t->graph);
    t->dev->vk.DestroyFence(t->dev->device, t->fence, NULL);
    t->dev->vk.DestroyCommandPool(t->dev->device, t->pool, NULL);
    tyn_device_destroy(&t->dev);
    free(t);
    if (!near) { // cmocka does not count what a teardown gives back
        exit(EXIT_FAILURE);
    }
    return 0;
}

tyn_result gpu_try(gpu_test *t)
{
    const tyn_procs *vk = &t->dev->vk;
    tyn_result result = tyn_graph_status(t->graph);
    if (result == TYN_OK && !tyn_graph_matches(t->graph)) {
        result = tyn_graph_compile(t->graph);
    }
    if (result == TYN_OK) {
        vk->ResetCommandPool(t->dev->device, t->pool, 0);
        vk->BeginCommandBuffer(t->cmd, &(VkCommandBufferBeginInfo){
                                           .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO});
        result = tyn_graph_record(t->graph, t->cmd);
        vk->EndCommandBuffer(t->cmd);
        vk->QueueSubmit2(
            t->dev->queue, 1,
            &(VkSubmitInfo2){.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos =
                                 &(VkCommandBufferSubmitInfo){
                                     .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                     .commandBuffer = t->cmd}},
            t->fence);
        vk->WaitForFences(t->dev->device, 1, &t->fence, VK_TRUE, UINT64_MAX);
        vk->ResetFences(t->dev->device, 1, &t->fence);
    }
    assert_int_equal(tyn_device_validation_messages(t->dev), 0);
    return result;
}

void gpu_run(gpu_test *t)
{
    assert_int_equal(gpu_try(t), TYN_OK);
}

const void *gpu_map(gpu_test *t, const char *name)
{
    const void *data = tyn_graph_map(t->graph, name, NULL, NULL);
    assert_non_null(data);
    return data;
}

uint32_t gpu_non_finite(gpu_test *t)
{
    return ((const struct counters_block *)gpu_map(t, "counters"))->non_finite;
}

// What gpu_image hands to the graph; kept until the process ends.
typedef struct pixels {
    size_t bytes;
    void *data;
} pixels;

static void fill(void *user, void *staging)
{
    const pixels *p = user;
    memcpy(staging, p->data, p->bytes);
}

tyn_ref gpu_image(gpu_test *t, const char *name, tyn_dim dim, tyn_extent extent, int channels,
                  const float *data)
{
    size_t texels = (size_t)extent.x * extent.y * extent.z;
    pixels *p = malloc(sizeof *p);
    VkFormat format = channels == -1   ? VK_FORMAT_R16_SFLOAT
                      : channels == 1  ? VK_FORMAT_R32_SFLOAT
                      : channels == 2  ? VK_FORMAT_R32G32_SFLOAT
                      : channels == -2 ? VK_FORMAT_R32_UINT
                      : channels == -4 ? VK_FORMAT_R32G32B32A32_UINT
                                       : VK_FORMAT_R32G32B32A32_SFLOAT;
    if (channels == -1) {
        p->bytes = texels * 2;
        uint16_t *half = malloc(p->bytes);
        for (size_t i = 0; i < texels; i++) {
            half[i] = tyn_half_from_float(data[i]);
        }
        p->data = half;
    } else {
        p->bytes = texels * (channels == -2 ? 4 : (size_t)abs(channels) * 4);
        p->data = malloc(p->bytes);
        memcpy(p->data, data, p->bytes);
    }
    uint64_t hash = tyn_hash_bytes(TYN_HASH_SEED, p->data, p->bytes);
    return tyn_graph_upload_image(t->graph, name, dim, format, extent, fill, p, hash);
}

tyn_ref gpu_buffer(gpu_test *t, const char *name, const void *data, size_t size)
{
    void *copy = malloc(size);
    memcpy(copy, data, size);
    return tyn_graph_upload_buffer(t->graph, name, copy, size, 0);
}

tyn_ref *gpu_port(const tyn_pass_desc *pass, tyn_ref *refs, const char *name)
{
    uint32_t port = 0;
    while (port < pass->num_ports && strcmp(pass->ports[port].name, name) != 0) {
        port++;
    }
    if (port == pass->num_ports) {
        fail_msg("pass %s has no port %s", pass->name, name);
    }
    return &refs[port];
}

double gpu_ms(gpu_test *t, const char *name)
{
    const tyn_node_stats *stats;
    uint32_t count = tyn_graph_stats(t->graph, &stats);
    for (uint32_t i = 0; i < count; i++) {
        if (!strcmp(stats[i].name, name)) {
            return stats[i].gpu_ms;
        }
    }
    return 0;
}
