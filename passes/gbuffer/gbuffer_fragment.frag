// gbuffer_fragment.frag -- which triangle it is. Everything else is computed once a sample, not once a fragment.
#version 460

layout(location = 0) flat in uint triangle;
layout(location = 0) out uint seen; // triangle + 1; 0: none

void main()
{
    seen = triangle + 1u;
}
