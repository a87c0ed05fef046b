// ordinates_columns.comp -- sums of the rows' sums down the columns; a thread per column.
#include "shaders/light/sky.glsl"

layout(local_size_x = 64) in;
TYN_UPDATE(0, weights, float weights[]);

void main()
{
    const uint row = SKY_SUMS_WIDTH + 1, x = gl_GlobalInvocationID.x;
    if (x >= row) {
        return;
    }
    float sum = 0.0;
    weights[x] = 0.0;
    for (uint y = 1u; y <= SKY_SUMS_HEIGHT; y++) {
        sum += weights[y * row + x];
        weights[y * row + x] = sum;
    }
}
