// raster_test_fragment.frag -- the colour of the triangle, plus an optional image; or one by a constant.
#version 460
layout(constant_id = 0) const uint FLAT = 0u;
layout(set = 0, binding = 1) uniform sampler2D addition;
layout(location = 0) in vec3 color;
layout(location = 0) out vec4 result;
layout(location = 1) out vec2 facing;

void main()
{
    vec3 c = FLAT != 0u ? vec3(float(FLAT)) : color;
    result = vec4(c + texelFetch(addition, ivec2(0), 0).rgb, 1.0);
    facing = vec2(gl_FrontFacing ? 1.0 : -1.0, gl_FragCoord.z);
}
