// picture.c -- pictures in host memory, as they are seen: uploaded, scaled to the window, tone mapped.
#include "view/picture.h"
#include "picture_show.frag.h"
#include "picture_cover.vert.h"
#include <string.h>

static const VkFormat texel_format = VK_FORMAT_R32G32B32A32_SFLOAT;

// ---- pipeline ---------------------------------------------------------------------------------

static bool make_sets(picture *p)
{
    gpu *g = p->gpu;
    VkDescriptorSetLayoutBinding bindings[PICTURE_NUM_SLOTS];
    for (uint32_t i = 0; i < PICTURE_NUM_SLOTS; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT,
        };
    }
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = PICTURE_NUM_SLOTS,
        .pBindings = bindings,
    };
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                       PICTURE_NUM_SLOTS};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = 1,
        .pPoolSizes = &size,
    };
    if (!gpu_check(g, vkCreateDescriptorSetLayout(g->device, &layout, NULL, &p->set_layout),
                   "vkCreateDescriptorSetLayout") ||
        !gpu_check(g, vkCreateDescriptorPool(g->device, &pool, NULL, &p->pool),
                   "vkCreateDescriptorPool")) {
        return false;
    }
    const VkDescriptorSetAllocateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = p->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &p->set_layout,
    };
    return gpu_check(g, vkAllocateDescriptorSets(g->device, &set, &p->set),
                     "vkAllocateDescriptorSets");
}

static bool make_sampler(picture *p)
{
    VkFormatProperties can;
    vkGetPhysicalDeviceFormatProperties(p->gpu->physical_device, texel_format, &can);
    const bool linear =
        can.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    const VkFilter filter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = filter,
        .minFilter = filter,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
    };
    return gpu_check(p->gpu, vkCreateSampler(p->gpu->device, &info, NULL, &p->sampler),
                     "vkCreateSampler");
}

static bool make_module(gpu *g, const uint32_t *words, size_t size, VkShaderModule *module)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = words};
    return gpu_check(g, vkCreateShaderModule(g->device, &info, NULL, module),
                     "vkCreateShaderModule");
}

static bool make_pipeline_of(picture *p, VkRenderPass pass, VkShaderModule vertex,
                             VkShaderModule fragment)
{
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"},
    };
    const VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1,
    };
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    const VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 15};
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
    };
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states,
    };
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &vertices,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = p->layout,
        .renderPass = pass,
    };
    return gpu_check(
        p->gpu,
        vkCreateGraphicsPipelines(p->gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &p->pipeline),
        "vkCreateGraphicsPipelines");
}

static bool make_pipeline(picture *p, VkRenderPass pass)
{
    gpu *g = p->gpu;
    const VkPushConstantRange range = {VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                       sizeof(struct picture_args)};
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &p->set_layout,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &range,
    };
    VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    const bool made = gpu_check(g, vkCreatePipelineLayout(g->device, &layout, NULL, &p->layout),
                                "vkCreatePipelineLayout") &&
                      make_module(g, picture_cover_spirv, sizeof picture_cover_spirv, &vertex) &&
                      make_module(g, picture_show_spirv, sizeof picture_show_spirv, &fragment) &&
                      make_pipeline_of(p, pass, vertex, fragment);
    vkDestroyShaderModule(g->device, vertex, NULL);
    vkDestroyShaderModule(g->device, fragment, NULL);
    return made;
}

bool picture_open(picture *p, gpu *g, VkRenderPass pass)
{
    *p = (picture){.gpu = g};
    bool made = make_sets(p) && make_sampler(p) && make_pipeline(p, pass);
    const float black[4] = {0, 0, 0, 1};
    for (int i = 0; made && i < PICTURE_NUM_SLOTS; i++) {
        made = picture_set(p, (picture_slot)i, 1, 1, black);
    }
    return made;
}

void picture_close(picture *p)
{
    if (!p->gpu || !p->gpu->device) {
        return;
    }
    VkDevice device = p->gpu->device;
    gpu_wait_idle(p->gpu);
    for (int i = 0; i < PICTURE_NUM_SLOTS; i++) {
        gpu_image_free(p->gpu, &p->slots[i].image);
        gpu_buffer_free(p->gpu, &p->slots[i].staging);
    }
    vkDestroyPipeline(device, p->pipeline, NULL);
    vkDestroyPipelineLayout(device, p->layout, NULL);
    vkDestroySampler(device, p->sampler, NULL);
    vkDestroyDescriptorPool(device, p->pool, NULL);
    vkDestroyDescriptorSetLayout(device, p->set_layout, NULL);
    *p = (picture){0};
}

// ---- pictures ---------------------------------------------------------------------------------

static bool resize(picture *p, picture_slot slot, uint32_t width, uint32_t height)
{
    gpu *g = p->gpu;
    gpu_image *image = &p->slots[slot].image;
    gpu_buffer *staging = &p->slots[slot].staging;
    if (image->width == width && image->height == height && staging->data) {
        return true;
    }
    gpu_image_free(g, image);
    gpu_buffer_free(g, staging);
    if (!gpu_image_make(g, width, height, texel_format, image) ||
        !gpu_buffer_make(g, (VkDeviceSize)16 * width * height, staging)) {
        return false;
    }
    const VkDescriptorImageInfo info = {p->sampler, image->view,
                                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = p->set,
        .dstBinding = slot,
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        .pImageInfo = &info,
    };
    vkUpdateDescriptorSets(g->device, 1, &write, 0, NULL);
    return true;
}

bool picture_set(picture *p, picture_slot slot, uint32_t width, uint32_t height, const float *rgba)
{
    if (!resize(p, slot, width, height)) {
        return false;
    }
    memcpy(p->slots[slot].staging.data, rgba, (size_t)16 * width * height);
    p->slots[slot].fresh = true;
    return true;
}

static void change_layout(VkCommandBuffer cmd, const gpu_image *image, bool for_copy)
{
    const VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask =
            for_copy ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_2_COPY_BIT,
        .srcAccessMask = for_copy ? 0 : VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .dstStageMask =
            for_copy ? VK_PIPELINE_STAGE_2_COPY_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
        .dstAccessMask =
            for_copy ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
        .oldLayout = for_copy ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .newLayout = for_copy ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
                              : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    const VkDependencyInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .imageMemoryBarrierCount = 1,
        .pImageMemoryBarriers = &barrier,
    };
    vkCmdPipelineBarrier2(cmd, &info);
}

void picture_record_upload(picture *p, VkCommandBuffer cmd)
{
    for (int i = 0; i < PICTURE_NUM_SLOTS; i++) {
        if (!p->slots[i].fresh) {
            continue;
        }
        p->slots[i].fresh = false;
        const gpu_image *image = &p->slots[i].image;
        const VkBufferImageCopy copy = {
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .imageExtent = {image->width, image->height, 1},
        };
        change_layout(cmd, image, true);
        vkCmdCopyBufferToImage(cmd, p->slots[i].staging.buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        change_layout(cmd, image, false);
    }
}

void picture_record_draw(picture *p, VkCommandBuffer cmd, const struct picture_args *args)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->layout, 0, 1, &p->set, 0,
                            NULL);
    vkCmdPushConstants(cmd, p->layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof *args, args);
    vkCmdDraw(cmd, 3, 1, 0, 0);
}
