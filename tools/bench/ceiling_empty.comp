// ceiling_empty.comp -- what a dispatch costs that does nothing, and waits for the one before it.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0, std430) buffer Result
{
    float result[];
};

void main()
{
    if (gl_GlobalInvocationID.x == 0u) {
        result[0] = result[0] + 1.0;
    }
}
