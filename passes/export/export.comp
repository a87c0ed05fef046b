// export.comp -- a result into a host's image; built for each of its formats, IMAGE_FORMAT.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D result;
layout(binding = 1, IMAGE_FORMAT) uniform writeonly image2D host_image;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, imageSize(host_image)))) {
        vec4 found = texelFetch(result, p, 0);
#ifdef IMAGE_LARGEST // what the format holds: light stays finite
        found = min(found, vec4(IMAGE_LARGEST));
#endif
        imageStore(host_image, p, found);
    }
}
