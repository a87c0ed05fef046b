// composite.comp -- the medium over a host image; built for each of its formats, COLOUR_FORMAT.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D transmittance;
layout(binding = 2, COLOUR_FORMAT) uniform image2D color;

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(color)))) {
        return;
    }
    vec4 c = imageLoad(color, p);
    c.rgb = c.rgb * texelFetch(transmittance, p, 0).rgb + texelFetch(radiance, p, 0).rgb;
    imageStore(color, p, c);
}
