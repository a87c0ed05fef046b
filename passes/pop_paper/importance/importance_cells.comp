// importance_cells.comp -- the medium of each cell, and the importance before the first hop: a picture
// of power 1, evenly over its area, enters the first layer.
#define MEDIUM_AT 0
#include "shaders/common/uniform_branch.glsl"
#include "shaders/medium/medium.glsl"
#include "importance.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
TYN_UNIFORM(5, grid, importance_grid grid);
TYN_WRITE(6, cells, importance_cell cells[]);
TYN_WRITE(7, light, importance_light light[]);
TYN_WRITE(8, tracks, vec2 tracks[]);
TYN_ARGS(importance_args args);

const int SAMPLES = 3; // along each edge of a cell

float mean(vec3 v)
{
    return (v.r + v.g + v.b) / 3.0;
}

// Part of the picture that the column covers.
float coverage(vec2 low, vec2 high)
{
    vec2 both = min(high, grid.window_high) - max(low, grid.window_low);
    vec2 window = grid.window_high - grid.window_low;
    return both.x > 0.0 && both.y > 0.0 ? both.x * both.y / (window.x * window.y) : 0.0;
}

// Coordinate in the grid, in [0, 1], of a sample of a cell.
float layer(float cell, int sample_index)
{
    return (cell + (float(sample_index) + 0.5) / float(SAMPLES)) / float(args.cells);
}

// Part of the power left after half the way, loss of mean cosine (Eq 4 at its exact rate).
vec2 half_hop(float sigma_a, float decay, float way)
{
    return vec2(exp(-0.5 * sigma_a * way), propagate_loss(0.5 * decay * way));
}

void main()
{
    uvec3 cell = gl_GlobalInvocationID;
    if (any(greaterThanEqual(cell, uvec3(args.cells)))) {
        return;
    }
    uint index = (cell.z * args.cells + cell.y) * args.cells + cell.x;
    importance_cell here = importance_cell(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec2(0.0), vec2(0.0));
    float power = 0.0;
    if (uniform_branch(grid.empty == 0u)) {
        vec3 scattered = vec3(0.0), absorbed = vec3(0.0), turned = vec3(0.0);
        float density = 0.0;
        for (int k = 0; k < SAMPLES; k++) {
            float z = importance_depth(grid, layer(float(cell.z), k));
            float widening = importance_widening(grid, z);
            for (int i = 0; i < SAMPLES * SAMPLES; i++) {
                vec2 at = vec2(layer(float(cell.x), i % SAMPLES), layer(float(cell.y), i / SAMPLES));
                vec2 across = mix(grid.low, grid.high, at) * widening;
                vec3 p = grid.origin + grid.right * across.x + grid.up * across.y + grid.forward * z;
                if (medium_mode == TYN_MEDIUM_DENSITY) {
                    density += medium_density(p);
                } else {
                    medium_point m = medium_sample(p);
                    scattered += m.sigma_s;
                    absorbed += m.sigma_a;
                    turned += m.sigma_s * phase_mean_cosine(m.phase);
                }
            }
        }
        if (medium_mode == TYN_MEDIUM_DENSITY) {
            scattered = density * medium.sigma_s;
            absorbed = density * medium.sigma_a;
            turned = scattered * phase_mean_cosine(medium.phase);
        }
        const float each = 1.0 / float(SAMPLES * SAMPLES * SAMPLES);
        float sigma_s = mean(scattered) * each, g = mean(turned) * each / max(sigma_s, 1e-30);
        float sigma_a = mean(absorbed) * each;
        float decay = (1.0 - g) * sigma_s; // of the mean cosine
        float f = args.scaled != 0u ? delta_fraction(g) : 0.0;
        here.sigma_s = (1.0 - f) * sigma_s;
        here.sigma_t = here.sigma_s + sigma_a;
        here.g = (g - f) / (1.0 - f);

        vec2 low = mix(grid.low, grid.high, vec2(cell.xy) / float(args.cells));
        vec2 high = mix(grid.low, grid.high, vec2(cell.xy + 1u) / float(args.cells));
        vec2 centre = grid.orthographic != 0u ? vec2(0.0) : 0.5 * (low + high);
        float z_low = importance_depth(grid, float(cell.z) / float(args.cells));
        float z_high = importance_depth(grid, float(cell.z + 1u) / float(args.cells));
        // The mean over the layer of the square of the widening.
        float area = (high.x - low.x) * (high.y - low.y) *
                     (grid.orthographic != 0u ? 1.0
                                              : (z_low * z_low + z_low * z_high + z_high * z_high) / 3.0);
        here.along = (z_high - z_low) * sqrt(1.0 + dot(centre, centre));
        here.across = sqrt(area);
        here.volume = area * (z_high - z_low);
        here.hop_along = half_hop(sigma_a, decay, here.along);
        here.hop_across = half_hop(sigma_a, decay, here.across);
        power = cell.z == 0u ? coverage(low, high) : 0.0;
    }
    cells[index] = here;
    vec2 track = vec2(0.0);
    light[index] = importance_leave(here, power, 0.0, track);
    tracks[index] = track;
}
