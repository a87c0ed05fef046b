// importance_map.comp -- the map: filtered over the sphere, of mean 1, filtered in time. One workgroup.
#include "importance.glsl"

layout(local_size_x = TYN_IMPORTANCE_GROUP) in; // one workgroup, two texels a thread
TYN_READ(0, sent, float sent[]);
TYN_UPDATE(1, history, importance_history history);
layout(set = 0, binding = 2, r32f) uniform writeonly image2D importance_image;
TYN_ARGS(importance_args args);

// Half-height at a texel's height, 11 degrees: exp(-SHARPNESS (1 - cos)) there is a half.
const float SHARPNESS = 36.0;
const int REACH = 2; // rows; beyond, the weight is below 0.07

shared vec3 directions[TYN_IMPORTANCE_TEXELS];
shared float filtered[TYN_IMPORTANCE_TEXELS];
shared float row_means[TYN_IMPORTANCE_HEIGHT];

// The mean around a direction. All texels of the rows near by are asked, so that poles need no care.
float around(uint texel)
{
    vec3 w = directions[texel];
    int row = int(texel / TYN_IMPORTANCE_WIDTH);
    int first = max(row - REACH, 0), last = min(row + REACH, TYN_IMPORTANCE_HEIGHT - 1);
    float sum = 0.0, total = 0.0;
    for (int j = first; j <= last; j++) {
        float share = importance_share(uint(j));
        for (int i = 0; i < TYN_IMPORTANCE_WIDTH; i++) {
            uint other = uint(j * TYN_IMPORTANCE_WIDTH + i);
            float weight = share * exp(SHARPNESS * (dot(w, directions[other]) - 1.0));
            sum += weight * sent[other];
            total += weight;
        }
    }
    return sum / total;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    for (uint texel = me; texel < TYN_IMPORTANCE_TEXELS; texel += TYN_IMPORTANCE_GROUP) {
        directions[texel] = importance_direction(texel);
    }
    barrier();
    for (uint texel = me; texel < TYN_IMPORTANCE_TEXELS; texel += TYN_IMPORTANCE_GROUP) {
        filtered[texel] = around(texel);
    }
    barrier();
    if (me < TYN_IMPORTANCE_HEIGHT) {
        float sum = 0.0;
        for (int i = 0; i < TYN_IMPORTANCE_WIDTH; i++) {
            sum += filtered[me * TYN_IMPORTANCE_WIDTH + i];
        }
        row_means[me] = sum * importance_share(me);
    }
    barrier();
    float mean = 0.0;
    for (int j = 0; j < TYN_IMPORTANCE_HEIGHT; j++) {
        mean += row_means[j];
    }
    // Nothing scatters: all directions are alike. (A NaN is not above 0 either.)
    bool known = mean > 1e-30 && mean < 1e30;
    uint frames = history.frames;
    for (uint texel = me; texel < TYN_IMPORTANCE_TEXELS; texel += TYN_IMPORTANCE_GROUP) {
        float importance = known ? mix(filtered[texel] / mean, 1.0, args.floor) : 1.0;
        if (frames > 0u) {
            importance = mix(importance, history.map[texel], args.smoothing);
        }
        imageStore(importance_image, ivec2(texel % TYN_IMPORTANCE_WIDTH, texel / TYN_IMPORTANCE_WIDTH),
                   vec4(importance, 0.0, 0.0, 0.0));
        history.map[texel] = importance;
    }
    barrier(); // all have read the count
    if (me == 0u) {
        history.frames = min(frames + 1u, 0xffffu);
    }
}
