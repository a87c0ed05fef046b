// env_importance_columns.comp -- sums of the rows' sums down the columns; a thread per number.
#include "shaders/light/sky.glsl"

layout(local_size_x = 64) in;
TYN_UPDATE(0, sums, float sums[]); // 8 of each sky_sum

void main()
{
    const uint row = (SKY_SUMS_WIDTH + 1) * 8;
    if (gl_GlobalInvocationID.x >= row) {
        return;
    }
    float sum = 0.0;
    sums[gl_GlobalInvocationID.x] = 0.0;
    for (uint y = 1u; y <= SKY_SUMS_HEIGHT; y++) {
        sum += sums[y * row + gl_GlobalInvocationID.x];
        sums[y * row + gl_GlobalInvocationID.x] = sum;
    }
}
