// submission.c -- see submission.h.
#include "frame/submission.h"

tyn_result tyn_submission_create(tyn_device *dev, tyn_submission *s)
{
    *s = (tyn_submission){.dev = dev};
    const tyn_procs *vk = &dev->vk;
    VkResult r = TYN_VK_MADE(
        &s->pool, vk->CreateCommandPool(dev->device,
                                        &(VkCommandPoolCreateInfo){
                                            .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .queueFamilyIndex = dev->queue_family},
                                        NULL, &s->pool));
    tyn_result result = tyn_vk_check(dev, r, "vkCreateCommandPool");
    if (result == TYN_OK) {
        r = vk->AllocateCommandBuffers(
            dev->device,
            &(VkCommandBufferAllocateInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = s->pool,
                                           .commandBufferCount = 1},
            &s->cmd);
        result = tyn_vk_check(dev, r, "vkAllocateCommandBuffers");
    }
    if (result == TYN_OK) {
        r = TYN_VK_MADE(
            &s->fence,
            vk->CreateFence(dev->device,
                            &(VkFenceCreateInfo){.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO},
                            NULL, &s->fence));
        result = tyn_vk_check(dev, r, "vkCreateFence");
    }
    return result;
}

void tyn_submission_destroy(tyn_submission *s)
{
    const tyn_procs *vk = &s->dev->vk;
    vk->DestroyFence(s->dev->device, s->fence, NULL);
    vk->DestroyCommandPool(s->dev->device, s->pool, NULL);
    *s = (tyn_submission){.dev = s->dev};
}

tyn_result tyn_submission_begin(tyn_submission *s)
{
    const tyn_procs *vk = &s->dev->vk;
    VkResult r = vk->ResetCommandPool(s->dev->device, s->pool, 0);
    if (r == VK_SUCCESS) {
        r = vk->BeginCommandBuffer(
            s->cmd,
            &(VkCommandBufferBeginInfo){.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT});
    }
    return tyn_vk_check(s->dev, r, "vkBeginCommandBuffer");
}

tyn_result tyn_submission_run(tyn_submission *s, const char *what)
{
    const tyn_procs *vk = &s->dev->vk;
    VkResult r = vk->EndCommandBuffer(s->cmd);
    if (r == VK_SUCCESS) {
        r = vk->ResetFences(s->dev->device, 1, &s->fence);
    }
    if (r == VK_SUCCESS) {
        r = vk->QueueSubmit2(
            s->dev->queue, 1,
            &(VkSubmitInfo2){.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos =
                                 &(VkCommandBufferSubmitInfo){
                                     .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                     .commandBuffer = s->cmd}},
            s->fence);
    }
    if (r == VK_SUCCESS) {
        r = vk->WaitForFences(s->dev->device, 1, &s->fence, VK_TRUE, UINT64_MAX);
        if (r != VK_SUCCESS) {
            vk->QueueWaitIdle(s->dev->queue); // what it runs is used again, or destroyed
        }
    }
    return tyn_vk_check(s->dev, r, what);
}
