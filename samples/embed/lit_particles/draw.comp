// draw.comp -- the host's picture: a backdrop, grains and balls, each lit by the medium; a thread per pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tyndall/light.glsl"

struct particle {
    vec3 position; // m
    float radius;  // m
    vec3 albedo;
    float g; // of a grain: mean cosine of its lobe; 2: a ball with a diffuse surface
};

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform camera {
    mat4 world_to_texture; // tyn_context_light
    vec3 eye;
    float near; // of a reversed, infinite depth buffer: depth = near / distance
    vec3 right; // of length tan(half the field of view), as `up`
    uint num_particles;
    vec3 up;
    float pad;
    vec3 back;
};
layout(binding = 0) uniform sampler3D red;
layout(binding = 1) uniform sampler3D green;
layout(binding = 2) uniform sampler3D blue;
layout(binding = 3, rgba32f) writeonly uniform image2D color;
layout(binding = 4, std430) writeonly buffer depths { float depth[]; };
layout(binding = 5, std430) readonly buffer particle_list { particle particles[]; };

// Distance along a unit direction; 1e30: it does not meet the particle.
float meet(particle p, vec3 direction)
{
    vec3 to = p.position - eye;
    float along = dot(to, direction), aside2 = dot(to, to) - along * along, inside2 = p.radius * p.radius - aside2;
    return inside2 < 0.0 || along <= p.radius ? 1e30 : along - sqrt(inside2);
}

vec3 shade(particle p, vec3 hit, vec3 direction)
{
    if (p.g <= 1.0) { // so small that its light is that of its middle
        tyn_light light = tyn_light_at(red, green, blue, world_to_texture, p.position);
        return p.albedo * tyn_light_inscatter(light, p.g, -direction);
    }
    tyn_light light = tyn_light_at(red, green, blue, world_to_texture, hit);
    return p.albedo / 3.14159265 * tyn_light_irradiance(light, normalize(hit - p.position));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec2 at = (2.0 * (vec2(pixel) + 0.5) - vec2(size)) / float(size.y);
    vec3 direction = normalize(at.x * right - at.y * up - back);
    float nearest = 1e30;
    uint hit = 0u;
    for (uint i = 0u; i < num_particles; i++) {
        float t = meet(particles[i], direction);
        if (t < nearest) {
            nearest = t;
            hit = i;
        }
    }
    vec3 seen = vec3(0.015, 0.02, 0.03); // the backdrop
    float value = 0.0;                   // infinitely far
    if (nearest < 1e30) {
        seen = shade(particles[hit], eye + nearest * direction, direction);
        value = near / -dot(nearest * direction, back);
    }
    imageStore(color, pixel, vec4(seen, 1.0));
    depth[pixel.y * size.x + pixel.x] = value;
}
