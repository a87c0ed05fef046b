// gradient_sample.comp -- samples of a level: source radiance, its gradient (Ren et al. 2008, Sec 4) and their error (Eq 6).
//
// A thread for each point that a sample traces: itself, six a difference apart for the gradient and, where it may be split, six at the
// valid radius, and one that looks to the eye.
#include "gradient_bindings.glsl"
#include "gradient_grid.glsl"

// Threads of a sample: 16, or 8 on the last level, where nothing is split.
layout(constant_id = 2) const uint gradient_threads = 16u;

layout(local_size_x = 64) in;
TYN_READ(16, heads, gradient_head heads);
TYN_READ(17, entries, uint entries[]);
TYN_UPDATE(18, states, uint states[]);
TYN_WRITE(19, samples, gradient_sample samples[]);

shared vec3 traced[GRADIENT_GROUP];   // light; of the last thread, transmittance to the eye
shared vec3 scatters[GRADIENT_GROUP]; // sigma_s there

const uint OF_DIFFERENCES = 1u, OF_ERRORS = 7u, TO_EYE = 13u;

// Along +x, -x, +y, -y, +z, -z.
vec3 axis_of(uint i)
{
    return vec3(equal(uvec3(i / 2u), uvec3(0u, 1u, 2u))) * ((i & 1u) == 0u ? 1.0 : -1.0);
}

vec3 offset_of(uint thread, float radius)
{
    vec3 offset = vec3(0.0);
    if (thread >= OF_DIFFERENCES && thread < OF_ERRORS) {
        offset = args.apart * axis_of(thread - OF_DIFFERENCES);
    } else if (thread >= OF_ERRORS && thread < TO_EYE) {
        offset = radius * axis_of(thread - OF_ERRORS);
    }
    return offset;
}

float mean3(vec3 v)
{
    return dot(v, vec3(1.0 / 3.0));
}

// `x`: where it is.
gradient_sample sample_of(uint from, const gradient_grid grid, vec3 x)
{
    gradient_sample s;
    s.light = traced[from];
    const vec3 over = 1.0 / (within_box(x + args.apart) - within_box(x - args.apart));
    vec3 slope[3];
    [[unroll]] for (uint a = 0u; a < 3u; a++) {
        slope[a] = over[a] * (traced[from + OF_DIFFERENCES + 2u * a] - traced[from + OF_DIFFERENCES + 2u * a + 1u]);
    }
    s.error = s.seen = s.pad0 = s.pad1 = 0.0;
    if (gradient_threads > 8u) {
        const float through = mean3(traced[from + TO_EYE]);
        float error = 0.0, seen = mean3(scatters[from] * s.light);
        [[unroll]] for (uint i = 0u; i < 6u; i++) {
            const vec3 there = traced[from + OF_ERRORS + i];
            const float away = dot(axis_of(i), within_box(x + grid.radius * axis_of(i)) - x);
            const vec3 taken = gradient_extrapolated(s.light, ((i & 1u) == 0u ? away : -away) * slope[i / 2u]);
            error += mean3(scatters[from + OF_ERRORS + i] * abs(taken - there)) / 6.0;
            seen += mean3(scatters[from + OF_ERRORS + i] * there);
        }
        const float relative = grid.radius / args.longest, volume = relative * relative * relative;
        s.error = volume * through * error;
        s.seen = volume * through * seen / 7.0;
    }
    s.dx = slope[0];
    s.dy = slope[1];
    s.dz = slope[2];
    return s;
}

void main()
{
    const gradient_grid grid = gradient_grid_of(args.level);
    const uint thread = gl_LocalInvocationIndex % gradient_threads;
    const uint number = (gl_WorkGroupID.y * GRADIENT_ROW + gl_WorkGroupID.x) * (GRADIENT_GROUP / gradient_threads) +
                        gl_LocalInvocationIndex / gradient_threads;
    const uint count = args.level == 0u ? gradient_points(grid) : heads.levels[args.level].count;
    const bool is = number < count;
    uint point = is ? number : 0u;
    if (args.level > 0u) {
        point = entries[grid.first + point];
    }
    const vec3 x = gradient_place(grid, gradient_at(grid, point));
    // Beyond the box is nothing; its faces are where light enters.
    const vec3 p = within_box(x + offset_of(thread, grid.radius));
    vec3 found = vec3(0.0);
    if (is && thread < TO_EYE) {
        found = finite_light(light_at(p, 0.5 * grid.radius));
    }
    if (gradient_threads > 8u) {
        scatters[gl_LocalInvocationIndex] = medium_sample(p).sigma_s;
        if (is && thread == TO_EYE) {
            found = transmittance_along(x, -view_at(x), distance_to_eye(x));
        }
    }
    traced[gl_LocalInvocationIndex] = found;
    barrier();
    if (is && thread == 0u) {
        samples[grid.first + point] = sample_of(gl_LocalInvocationIndex, grid, x);
        states[grid.first + point] = GRADIENT_IS_LISTED | GRADIENT_IS_SAMPLE;
        atomicAdd(counters.pixels, 1u);
        atomicAdd(counters.steps, 1u);
    }
}
