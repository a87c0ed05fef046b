// painter.h -- the host's own pass: draw.comp and what it reads and writes.
#pragma once
#include "../host.h"

enum { WIDTH = 384, HEIGHT = 512, MOST_PARTICLES = 256 };

// As in draw.comp.
typedef struct particle {
    float position[3], radius; // m, in the world
    float albedo[3];
    float g; // of a grain: mean cosine of its lobe; SURFACE: a ball with a diffuse surface
} particle;
#define SURFACE 2.0f

typedef struct camera_args {
    float world_to_texture[16]; // tyn_context_light
    float eye[3], near_plane;
    float right[3]; // of length tan(half the field of view), as `up`
    uint32_t num_particles;
    float up[3], pad;
    float back[3];
} camera_args;

typedef struct painter {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkSampler sampler;
    host_image light[3]; // one a colour: tyn_frame.light
    host_image color, depth;
    host_buffer particles; // particle[MOST_PARTICLES]
    host_buffer depths;    // what draw.comp writes; copied into the depth image
} painter;

// Images have no content and no layout yet. What fails ends the program.
painter painter_new(host *h);
void painter_free(host *h, painter *p);
// Paints `color` and `depth`; the light images are in a state to be sampled by compute shaders. Leaves `color` as compute
// shaders write it and `depth` as copies do.
void painter_draw(host *h, painter *p, VkCommandBuffer cmd, const camera_args *args);
