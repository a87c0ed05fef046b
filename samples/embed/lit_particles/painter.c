// painter.c -- see painter.h.
#include "painter.h"
#include <stdio.h>
#include <stdlib.h>

#include "draw.comp.h"

enum { LIGHT_TEXELS = 32, NUM_BINDINGS = 6 };

static const tyn_sync untouched = {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE,
                                   VK_IMAGE_LAYOUT_UNDEFINED};
static const tyn_sync written = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};
static const tyn_sync copied_to = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};

static void require(VkResult result, const char *what)
{
    if (result != VK_SUCCESS) {
        fprintf(stderr, "lit-particles: %s failed with VkResult %d\n", what, (int)result);
        exit(1);
    }
}

// A function that host.h does not list.
#define PROC(h, name) ((PFN_##name)(h)->vk.GetDeviceProcAddr((h)->device, #name))

static void make_images(host *h, painter *p)
{
    const VkExtent3D light = {LIGHT_TEXELS, LIGHT_TEXELS, LIGHT_TEXELS}, size = {WIDTH, HEIGHT, 1};
    for (int c = 0; c < 3; c++) {
        p->light[c] = host_image_new(h, VK_FORMAT_R16G16B16A16_SFLOAT, light,
                                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    }
    p->color = host_image_new(h, VK_FORMAT_R32G32B32A32_SFLOAT, size,
                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    p->depth = host_image_new(h, VK_FORMAT_D32_SFLOAT, size,
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    p->particles = host_buffer_new(h, MOST_PARTICLES * sizeof(particle));
    p->depths = host_buffer_new(h, WIDTH * HEIGHT * sizeof(float));
    require(PROC(h, vkCreateSampler)(
                h->device,
                &(VkSamplerCreateInfo){.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .magFilter = VK_FILTER_LINEAR,
                                       .minFilter = VK_FILTER_LINEAR,
                                       .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
                NULL, &p->sampler),
            "vkCreateSampler");
}

static VkDescriptorType type_of(uint32_t binding)
{
    return binding < 3    ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
           : binding == 3 ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                          : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static void make_set(host *h, painter *p)
{
    VkDescriptorSetLayoutBinding bindings[NUM_BINDINGS];
    for (uint32_t i = 0; i < NUM_BINDINGS; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                     .descriptorType = type_of(i),
                                                     .descriptorCount = 1,
                                                     .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    }
    require(PROC(h, vkCreateDescriptorSetLayout)(
                h->device,
                &(VkDescriptorSetLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                    .bindingCount = NUM_BINDINGS,
                    .pBindings = bindings},
                NULL, &p->set_layout),
            "vkCreateDescriptorSetLayout");
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 3},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2}};
    require(
        PROC(h, vkCreateDescriptorPool)(
            h->device,
            &(VkDescriptorPoolCreateInfo){.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 1,
                                          .poolSizeCount = 3,
                                          .pPoolSizes = sizes},
            NULL, &p->pool),
        "vkCreateDescriptorPool");
    require(
        PROC(h, vkAllocateDescriptorSets)(
            h->device,
            &(VkDescriptorSetAllocateInfo){.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                           .descriptorPool = p->pool,
                                           .descriptorSetCount = 1,
                                           .pSetLayouts = &p->set_layout},
            &p->set),
        "vkAllocateDescriptorSets");
}

static void fill_set(host *h, painter *p)
{
    VkDescriptorImageInfo images[4] = {
        [3] = {VK_NULL_HANDLE, p->color.view, VK_IMAGE_LAYOUT_GENERAL}};
    for (int c = 0; c < 3; c++) {
        images[c] = (VkDescriptorImageInfo){p->sampler, p->light[c].view,
                                            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    }
    const VkDescriptorBufferInfo buffers[2] = {{p->depths.buffer, 0, VK_WHOLE_SIZE},
                                               {p->particles.buffer, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet writes[NUM_BINDINGS];
    for (uint32_t i = 0; i < NUM_BINDINGS; i++) {
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = p->set,
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = type_of(i),
                                           .pImageInfo = i < 4 ? &images[i] : NULL,
                                           .pBufferInfo = i < 4 ? NULL : &buffers[i - 4]};
    }
    PROC(h, vkUpdateDescriptorSets)(h->device, NUM_BINDINGS, writes, 0, NULL);
}

static void make_pipeline(host *h, painter *p)
{
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(camera_args)};
    require(
        PROC(h, vkCreatePipelineLayout)(
            h->device,
            &(VkPipelineLayoutCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = 1,
                                          .pSetLayouts = &p->set_layout,
                                          .pushConstantRangeCount = 1,
                                          .pPushConstantRanges = &range},
            NULL, &p->layout),
        "vkCreatePipelineLayout");
    VkShaderModule module;
    require(PROC(h, vkCreateShaderModule)(
                h->device,
                &(VkShaderModuleCreateInfo){.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = sizeof draw_spirv,
                                            .pCode = draw_spirv},
                NULL, &module),
            "vkCreateShaderModule");
    require(PROC(h, vkCreateComputePipelines)(
                h->device, VK_NULL_HANDLE, 1,
                &(VkComputePipelineCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                    .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                              .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                              .module = module,
                              .pName = "main"},
                    .layout = p->layout},
                NULL, &p->pipeline),
            "vkCreateComputePipelines");
    PROC(h, vkDestroyShaderModule)(h->device, module, NULL);
}

painter painter_new(host *h)
{
    painter p = {0};
    make_images(h, &p);
    make_set(h, &p);
    fill_set(h, &p);
    make_pipeline(h, &p);
    return p;
}

void painter_free(host *h, painter *p)
{
    PROC(h, vkDestroyPipeline)(h->device, p->pipeline, NULL);
    PROC(h, vkDestroyPipelineLayout)(h->device, p->layout, NULL);
    PROC(h, vkDestroyDescriptorPool)(h->device, p->pool, NULL);
    PROC(h, vkDestroyDescriptorSetLayout)(h->device, p->set_layout, NULL);
    PROC(h, vkDestroySampler)(h->device, p->sampler, NULL);
    for (int c = 0; c < 3; c++) {
        host_image_free(h, &p->light[c]);
    }
    host_image_free(h, &p->color);
    host_image_free(h, &p->depth);
    host_buffer_free(h, &p->particles);
    host_buffer_free(h, &p->depths);
}

void painter_draw(host *h, painter *p, VkCommandBuffer cmd, const camera_args *args)
{
    // What was in the picture is painted over.
    p->color.state.layout = p->depth.state.layout = untouched.layout;
    host_transition(h, cmd, &p->color, written);
    PROC(h, vkCmdBindPipeline)(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    PROC(h, vkCmdBindDescriptorSets)
    (cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0, 1, &p->set, 0, NULL);
    PROC(h, vkCmdPushConstants)(cmd, p->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *args, args);
    PROC(h, vkCmdDispatch)(cmd, WIDTH / 8, HEIGHT / 8, 1);
    // A compute shader writes no depth images.
    const VkMemoryBarrier2 copied = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_HOST_READ_BIT};
    h->vk.CmdPipelineBarrier2(cmd, &(VkDependencyInfo){.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                       .memoryBarrierCount = 1,
                                                       .pMemoryBarriers = &copied});
    host_transition(h, cmd, &p->depth, copied_to);
    host_upload(h, cmd, &p->depths, &p->depth);
}
