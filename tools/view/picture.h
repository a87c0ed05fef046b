// picture.h -- pictures in host memory, as they are seen: uploaded, scaled to the window, tone mapped.
#pragma once
#include "view/gpu.h"
#include "view/picture_args.h"

typedef enum picture_slot { PICTURE_METHOD = 0, PICTURE_REFERENCE, PICTURE_NUM_SLOTS } picture_slot;

typedef struct picture {
    gpu *gpu;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkSampler sampler;
    struct {
        gpu_image image;
        gpu_buffer staging;
        bool fresh; // the staging buffer is to be copied
    } slots[PICTURE_NUM_SLOTS];
} picture;

bool picture_open(picture *p, gpu *g, VkRenderPass pass);
void picture_close(picture *p);

// Takes `rgba`, four floats a pixel, rows from the top. The device must be done with earlier frames.
bool picture_set(picture *p, picture_slot slot, uint32_t width, uint32_t height, const float *rgba);
void picture_record_upload(picture *p, VkCommandBuffer cmd); // outside of a render pass
void picture_record_draw(picture *p, VkCommandBuffer cmd, const struct picture_args *args);
