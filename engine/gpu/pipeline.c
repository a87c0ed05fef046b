// pipeline.c -- layouts and pipelines, derived from kernel tables. Who makes them when: compiler.c.
#include "gpu/compiler.h"
#include "base/fault.h"
#include "gpu/specialize.h"
#include <stdlib.h>
#include <string.h>

VkDescriptorType tyn_descriptor_type(const tyn_pass_desc *pass, const tyn_binding *binding)
{
    switch (binding->use) {
    case TYN_USE_SAMPLED:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case TYN_USE_UNIFORM:
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case TYN_USE_TEXELS_FLOAT:
    case TYN_USE_TEXELS_VEC4:
    case TYN_USE_TEXELS_UINT:
    case TYN_USE_TEXELS_UVEC4:
        return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    default:
        return pass->ports[binding->port].dim == TYN_BUFFER ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                            : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    }
}

VkShaderStageFlags tyn_kernel_stages(const tyn_kernel *kernel)
{
    return kernel->raster ? VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT
                          : VK_SHADER_STAGE_COMPUTE_BIT;
}

static tyn_result create_layouts(tyn_device *dev, const tyn_pass_desc *pass, tyn_pipeline *p)
{
    VkDescriptorSetLayoutBinding bindings[TYN_MAX_BINDINGS] = {0};
    for (uint32_t i = 0; i < p->kernel->num_bindings; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = tyn_descriptor_type(pass, &p->kernel->bindings[i]),
            .descriptorCount = 1,
            .stageFlags = tyn_kernel_stages(p->kernel),
        };
    }
    VkResult made = TYN_VK_MADE(
        &p->set_layout, dev->vk.CreateDescriptorSetLayout(
                            dev->device,
                            &(VkDescriptorSetLayoutCreateInfo){
                                .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                .bindingCount = p->kernel->num_bindings,
                                .pBindings = bindings,
                            },
                            NULL, &p->set_layout));
    if (made == VK_SUCCESS) {
        made = TYN_VK_MADE(
            &p->layout,
            dev->vk.CreatePipelineLayout(
                dev->device,
                &(VkPipelineLayoutCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                    .setLayoutCount = 1,
                    .pSetLayouts = &p->set_layout,
                    .pushConstantRangeCount = p->kernel->args_size ? 1 : 0,
                    .pPushConstantRanges = &(VkPushConstantRange){tyn_kernel_stages(p->kernel), 0,
                                                                  p->kernel->args_size},
                },
                NULL, &p->layout));
    }
    return tyn_vk_check(dev, made, p->kernel->name);
}

// What the tables ask for beyond the device's limits; the first is one log line.
static tyn_result check_limits(const tyn_device *dev, const tyn_pass_desc *pass,
                               const tyn_kernel *k)
{
    const VkPhysicalDeviceLimits *limits = &dev->properties.limits;
    uint32_t threads = 1, images = 0, buffers = 0, textures = 0, texels = 0, uniforms = 0;
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        VkDescriptorType type = tyn_descriptor_type(pass, &k->bindings[i]);
        images += type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        buffers += type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        textures += type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        texels += type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        uniforms += type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    }
    const uint32_t resources = k->num_bindings + (k->raster ? k->raster->num_attachments : 0);
    bool wide = false;
    for (int a = 0; a < 3 && !k->raster; a++) {
        threads *= k->local_size[a];
        wide = wide || k->local_size[a] > limits->maxComputeWorkGroupSize[a];
    }
    const struct {
        bool over;
        uint32_t wanted, limit;
        const char *what;
    } tests[] = {
        {wide || threads > limits->maxComputeWorkGroupInvocations, threads,
         limits->maxComputeWorkGroupInvocations, "threads in a workgroup"},
        {images > limits->maxPerStageDescriptorStorageImages, images,
         limits->maxPerStageDescriptorStorageImages, "storage images"},
        {buffers > limits->maxPerStageDescriptorStorageBuffers, buffers,
         limits->maxPerStageDescriptorStorageBuffers, "storage buffers"},
        {textures + texels > limits->maxPerStageDescriptorSampledImages, textures + texels,
         limits->maxPerStageDescriptorSampledImages, "sampled images"},
        {textures > limits->maxPerStageDescriptorSamplers, textures,
         limits->maxPerStageDescriptorSamplers, "samplers"},
        {uniforms > limits->maxPerStageDescriptorUniformBuffers, uniforms,
         limits->maxPerStageDescriptorUniformBuffers, "uniform buffers"},
        {resources > limits->maxPerStageResources, resources, limits->maxPerStageResources,
         "resources in all"},
        {k->args_size > limits->maxPushConstantsSize, k->args_size, limits->maxPushConstantsSize,
         "bytes of push constants"},
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++) {
        if (tests[i].over) {
            return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED,
                             "kernel '%s' of pass '%s' needs %u %s; the device '%s' has %u",
                             k->name, pass->name, tests[i].wanted, tests[i].what,
                             dev->properties.deviceName, tests[i].limit);
        }
    }
    return TYN_OK;
}

// ---- the table ----------------------------------------------------------------------------------

static void free_pipeline(tyn_device *dev, tyn_pipeline *p)
{
    for (tyn_variant *v = p->variants; v; v = p->variants) {
        p->variants = v->next;
        dev->vk.DestroyPipeline(dev->device, v->handle, NULL);
        free(v);
    }
    dev->vk.DestroyPipelineLayout(dev->device, p->layout, NULL);
    dev->vk.DestroyDescriptorSetLayout(dev->device, p->set_layout, NULL);
    free(p);
}

// Under the lock.
static tyn_pipeline *find_pipeline(const tyn_device *dev, const tyn_kernel *k)
{
    for (uint32_t i = 0; i < dev->num_pipelines; i++) {
        if (dev->pipelines[i]->kernel == k) {
            return dev->pipelines[i];
        }
    }
    return NULL;
}

// Puts `p` into the table, unless another thread has put one there meanwhile; the one that is there, or NULL.
static tyn_pipeline *keep_pipeline(tyn_device *dev, tyn_pipeline *p)
{
    pthread_mutex_lock(&dev->compiler->lock);
    tyn_pipeline *kept = find_pipeline(dev, p->kernel);
    void *grown =
        kept ? NULL : realloc(dev->pipelines, (dev->num_pipelines + 1) * sizeof *dev->pipelines);
    if (grown) {
        dev->pipelines = grown;
        dev->pipelines[dev->num_pipelines++] = kept = p;
    }
    pthread_mutex_unlock(&dev->compiler->lock);
    return kept;
}

tyn_result tyn_pipeline_get(tyn_device *dev, const tyn_pass_desc *pass, uint32_t kernel,
                            tyn_pipeline **out)
{
    const tyn_kernel *k = &pass->kernels[kernel];
    pthread_mutex_lock(&dev->compiler->lock);
    *out = find_pipeline(dev, k);
    pthread_mutex_unlock(&dev->compiler->lock);
    if (*out) {
        return TYN_OK;
    }
    TYN_TRY(check_limits(dev, pass, k));
    tyn_pipeline *p = calloc(1, sizeof *p);
    if (!p) {
        return TYN_ERR_MEMORY;
    }
    *p = (tyn_pipeline){.compiler = dev->compiler, .pass = pass, .kernel = k};
    tyn_result result = create_layouts(dev, pass, p);
    if (result == TYN_OK) {
        *out = keep_pipeline(dev, p);
        result = *out ? TYN_OK : TYN_ERR_MEMORY;
    }
    if (*out != p) {
        free_pipeline(dev, p);
    }
    return result;
}

// Under the lock.
static tyn_variant *find_variant(const tyn_pipeline *p, const uint32_t *spec)
{
    tyn_variant *v = p->variants;
    while (v && memcmp(v->spec, spec, p->kernel->num_spec * sizeof *spec) != 0) {
        v = v->next;
    }
    return v;
}

tyn_result tyn_variant_get(tyn_pipeline *p, const uint32_t *spec, tyn_variant **out)
{
    const tyn_device *dev = p->compiler->dev;
    const tyn_kernel *k = p->kernel;
    *out = NULL;
    if (k->raster && !dev->graphics) {
        return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED,
                         "kernel '%s' draws surfaces: it needs a queue family with graphics, which "
                         "family %u is not",
                         k->name, dev->queue_family);
    }
    if (k->raster && !dev->depth) {
        return TYN_FAULT(&dev->log, TYN_ERR_UNSUPPORTED,
                         "kernel '%s' draws surfaces: it needs depth in format D32_SFLOAT, which "
                         "the device '%s' lacks",
                         k->name, dev->properties.deviceName);
    }
    pthread_mutex_lock(&p->compiler->lock);
    tyn_variant *v = find_variant(p, spec);
    if (!v && (v = calloc(1, sizeof *v))) {
        v->pipeline = p;
        memcpy(v->spec, spec, k->num_spec * sizeof *spec);
        v->next = p->variants;
        p->variants = v;
    }
    pthread_mutex_unlock(&p->compiler->lock);
    *out = v;
    return v ? TYN_OK : TYN_ERR_MEMORY;
}

VkPipeline tyn_pipeline_find(const tyn_pipeline *p, const uint32_t *spec)
{
    pthread_mutex_lock(&p->compiler->lock);
    const tyn_variant *v = find_variant(p, spec);
    const VkPipeline made = v && v->state == TYN_VARIANT_READY ? v->handle : VK_NULL_HANDLE;
    pthread_mutex_unlock(&p->compiler->lock);
    return made;
}

void tyn_pipelines_destroy(tyn_device *dev)
{
    for (uint32_t i = 0; i < dev->num_pipelines; i++) {
        free_pipeline(dev, dev->pipelines[i]);
    }
    free(dev->pipelines);
    dev->pipelines = NULL;
    dev->num_pipelines = 0;
}

// ---- compiling ----------------------------------------------------------------------------------

// With the specialization constants filled in: pipelines are given none.
static VkResult create_module(const tyn_device *dev, const uint32_t *spirv, size_t size,
                              const uint32_t *spec, uint32_t num_spec, VkShaderModule *out)
{
    uint32_t *words = malloc(size);
    const size_t count =
        words ? tyn_spirv_specialize(spirv, size / sizeof *spirv, spec, num_spec, words) : 0;
    VkResult made = VK_ERROR_OUT_OF_HOST_MEMORY;
    if (count) {
        made = TYN_VK_MADE(out, dev->vk.CreateShaderModule(
                                    dev->device,
                                    &(VkShaderModuleCreateInfo){
                                        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = count * sizeof *words,
                                        .pCode = words},
                                    NULL, out));
    }
    free(words);
    return made;
}

static VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, VkShaderModule module)
{
    return (VkPipelineShaderStageCreateInfo){
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = which,
        .module = module,
        .pName = "main",
    };
}

static VkResult create_compute(const tyn_device *dev, const tyn_pipeline *p, VkShaderModule module,
                               const void *feedback, VkPipeline *out)
{
    return dev->vk.CreateComputePipelines(
        dev->device, dev->cache, 1,
        &(VkComputePipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .pNext = feedback,
            .stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module),
            .layout = p->layout,
        },
        NULL, out);
}

// Triangles without vertex input, viewport and scissor left to the draw, no blending.
static VkResult create_raster(const tyn_device *dev, const tyn_pipeline *p, VkShaderModule vertex,
                              VkShaderModule fragment, const void *feedback, VkPipeline *out)
{
    const tyn_raster *raster = p->kernel->raster;
    VkFormat colors[TYN_MAX_ATTACHMENTS], depth = VK_FORMAT_UNDEFINED;
    VkPipelineColorBlendAttachmentState writes[TYN_MAX_ATTACHMENTS];
    uint32_t num_colors = 0;
    for (uint32_t i = 0; i < raster->num_attachments; i++) {
        VkFormat format = p->pass->ports[raster->attachments[i].port].format;
        if (raster->attachments[i].use == TYN_USE_DEPTH) {
            depth = format;
        } else {
            writes[num_colors] = (VkPipelineColorBlendAttachmentState){
                .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                  VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
            colors[num_colors++] = format;
        }
    }
    const VkPipelineShaderStageCreateInfo stages[2] = {
        stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
        stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment),
    };
    const VkDynamicState dynamic[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    return dev->vk.CreateGraphicsPipelines(
        dev->device, dev->cache, 1,
        &(VkGraphicsPipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
            .pNext =
                &(VkPipelineRenderingCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                    .pNext = feedback,
                    .colorAttachmentCount = num_colors,
                    .pColorAttachmentFormats = colors,
                    .depthAttachmentFormat = depth,
                },
            .stageCount = fragment ? 2 : 1,
            .pStages = stages,
            .pVertexInputState =
                &(VkPipelineVertexInputStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO},
            .pInputAssemblyState =
                &(VkPipelineInputAssemblyStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST},
            .pViewportState =
                &(VkPipelineViewportStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                    .viewportCount = 1,
                    .scissorCount = 1},
            .pRasterizationState =
                &(VkPipelineRasterizationStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
                    .polygonMode = VK_POLYGON_MODE_FILL,
                    .cullMode = raster->cull,
                    .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
                    .lineWidth = 1.0f},
            .pMultisampleState =
                &(VkPipelineMultisampleStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT},
            .pDepthStencilState =
                &(VkPipelineDepthStencilStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                    .depthTestEnable = depth != VK_FORMAT_UNDEFINED,
                    .depthWriteEnable = depth != VK_FORMAT_UNDEFINED,
                    .depthCompareOp = raster->depth},
            .pColorBlendState =
                &(VkPipelineColorBlendStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                    .attachmentCount = num_colors,
                    .pAttachments = writes},
            .pDynamicState =
                &(VkPipelineDynamicStateCreateInfo){
                    .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                    .dynamicStateCount = 2,
                    .pDynamicStates = dynamic},
            .layout = p->layout,
        },
        NULL, out);
}

VkResult tyn_pipeline_compile(const tyn_device *dev, const tyn_pipeline *p, const uint32_t *spec,
                              VkPipeline *out, bool *cached)
{
    const tyn_kernel *k = p->kernel;
    const bool fragments = k->raster && k->raster->fragment;
    VkShaderModule module = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
    VkResult made = create_module(dev, k->spirv, k->spirv_size, spec, k->num_spec, &module);
    if (made == VK_SUCCESS && fragments) {
        made = create_module(dev, k->raster->fragment, k->raster->fragment_size, spec, k->num_spec,
                             &fragment);
    }
    VkPipelineCreationFeedback whole = {0}, stages[2] = {{0}};
    const VkPipelineCreationFeedbackCreateInfo feedback = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO,
        .pPipelineCreationFeedback = &whole,
        .pipelineStageCreationFeedbackCount = fragments ? 2 : 1,
        .pPipelineStageCreationFeedbacks = stages};
    if (made == VK_SUCCESS) {
        made = k->raster ? create_raster(dev, p, module, fragment, &feedback, out)
                         : create_compute(dev, p, module, &feedback, out);
        made = TYN_VK_MADE(out, made);
    }
    dev->vk.DestroyShaderModule(dev->device, module, NULL);
    dev->vk.DestroyShaderModule(dev->device, fragment, NULL);
    if (made == VK_SUCCESS) {
        tyn_device_name_object(dev, VK_OBJECT_TYPE_PIPELINE, (uint64_t)*out, k->name);
    }
    const VkPipelineCreationFeedbackFlags hit =
        VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT |
        VK_PIPELINE_CREATION_FEEDBACK_APPLICATION_PIPELINE_CACHE_HIT_BIT;
    *cached = (whole.flags & hit) == hit;
    return made;
}
