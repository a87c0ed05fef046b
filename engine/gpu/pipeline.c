// pipeline.c -- layouts and pipelines, derived from kernel tables.
#include "gpu/device.h"
#include <stdlib.h>
#include <string.h>

VkDescriptorType tyn_descriptor_type(const tyn_pass_desc *pass, const tyn_binding *binding)
{
    switch (binding->use) {
    case TYN_USE_SAMPLED:
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case TYN_USE_UNIFORM:
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    default:
        return pass->ports[binding->port].dim == TYN_BUFFER ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                            : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    }
}

static tyn_result create_layouts(tyn_device *dev, const tyn_pass_desc *pass, tyn_pipeline *p)
{
    VkDescriptorSetLayoutBinding bindings[TYN_MAX_BINDINGS] = {0};
    for (uint32_t i = 0; i < p->kernel->num_bindings; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = tyn_descriptor_type(pass, &p->kernel->bindings[i]),
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    }
    VkResult made = dev->vk.CreateDescriptorSetLayout(
        dev->device,
        &(VkDescriptorSetLayoutCreateInfo){
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
            .bindingCount = p->kernel->num_bindings,
            .pBindings = bindings,
        },
        NULL, &p->set_layout);
    if (made == VK_SUCCESS) {
        made = dev->vk.CreatePipelineLayout(
            dev->device,
            &(VkPipelineLayoutCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                .setLayoutCount = 1,
                .pSetLayouts = &p->set_layout,
                .pushConstantRangeCount = p->kernel->args_size ? 1 : 0,
                .pPushConstantRanges =
                    &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, p->kernel->args_size},
            },
            NULL, &p->layout);
    }
    return tyn_vk_check(dev, made, p->kernel->name);
}

tyn_result tyn_pipeline_get(tyn_device *dev, const tyn_pass_desc *pass, uint32_t kernel,
                            tyn_pipeline **out)
{
    *out = NULL;
    const tyn_kernel *k = &pass->kernels[kernel];
    for (uint32_t i = 0; i < dev->num_pipelines; i++) {
        if (dev->pipelines[i]->kernel == k) {
            *out = dev->pipelines[i];
            return TYN_OK;
        }
    }
    tyn_pipeline *p = calloc(1, sizeof *p);
    tyn_pipeline **grown =
        realloc(dev->pipelines, (dev->num_pipelines + 1) * sizeof *dev->pipelines);
    if (grown) {
        dev->pipelines = grown;
    }
    if (!p || !grown) {
        free(p);
        return TYN_ERR_MEMORY;
    }
    p->kernel = k;
    dev->pipelines[dev->num_pipelines++] = p;
    *out = p;
    return create_layouts(dev, pass, p);
}

VkPipeline tyn_pipeline_find(const tyn_pipeline *p, const uint32_t *spec)
{
    for (uint32_t i = 0; i < p->num_variants; i++) {
        if (!memcmp(p->variants[i].spec, spec, p->kernel->num_spec * sizeof *spec)) {
            return p->variants[i].pipeline;
        }
    }
    return VK_NULL_HANDLE;
}

tyn_result tyn_pipeline_variant(tyn_device *dev, tyn_pipeline *p, const uint32_t *spec,
                                VkPipeline *out)
{
    *out = tyn_pipeline_find(p, spec);
    if (*out) {
        return TYN_OK;
    }
    void *grown = realloc(p->variants, (p->num_variants + 1) * sizeof *p->variants);
    if (!grown) {
        return TYN_ERR_MEMORY;
    }
    p->variants = grown;

    VkShaderModule module;
    tyn_result result = tyn_vk_check(
        dev,
        dev->vk.CreateShaderModule(
            dev->device,
            &(VkShaderModuleCreateInfo){.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = p->kernel->spirv_size,
                                        .pCode = p->kernel->spirv},
            NULL, &module),
        p->kernel->name);
    if (result != TYN_OK) {
        return result;
    }
    VkSpecializationMapEntry entries[TYN_MAX_SPEC];
    for (uint32_t i = 0; i < p->kernel->num_spec; i++) {
        entries[i] = (VkSpecializationMapEntry){i, i * 4, 4};
    }
    const VkSpecializationInfo info = {p->kernel->num_spec, entries, p->kernel->num_spec * 4, spec};
    VkResult made = dev->vk.CreateComputePipelines(
        dev->device, dev->cache, 1,
        &(VkComputePipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                      .module = module,
                      .pName = "main",
                      .pSpecializationInfo = p->kernel->num_spec ? &info : NULL},
            .layout = p->layout,
        },
        NULL, out);
    dev->vk.DestroyShaderModule(dev->device, module, NULL);
    result = tyn_vk_check(dev, made, p->kernel->name);
    if (result == TYN_OK) {
        tyn_device_name_object(dev, VK_OBJECT_TYPE_PIPELINE, (uint64_t)*out, p->kernel->name);
        memset(p->variants[p->num_variants].spec, 0, sizeof p->variants[0].spec);
        memcpy(p->variants[p->num_variants].spec, spec, p->kernel->num_spec * 4);
        p->variants[p->num_variants++].pipeline = *out;
    }
    return result;
}

void tyn_pipelines_destroy(tyn_device *dev)
{
    for (uint32_t i = 0; i < dev->num_pipelines; i++) {
        tyn_pipeline *p = dev->pipelines[i];
        for (uint32_t v = 0; v < p->num_variants; v++) {
            dev->vk.DestroyPipeline(dev->device, p->variants[v].pipeline, NULL);
        }
        dev->vk.DestroyPipelineLayout(dev->device, p->layout, NULL);
        dev->vk.DestroyDescriptorSetLayout(dev->device, p->set_layout, NULL);
        free(p->variants);
        free(p);
    }
    free(dev->pipelines);
    dev->pipelines = NULL;
    dev->num_pipelines = 0;
}
