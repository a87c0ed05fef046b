// phase_table.glsl -- evaluation and sampling of phase functions that are tables. Included by phase.glsl where the kernel
// defines PHASE_TABLES, the binding of its port "phases".
//
// A table is linear in the cosine between its nodes, the angles 4 atan((k / (TYN_PHASE_NODES - 1))^4). What is drawn and
// what is evaluated is the same function.
#ifndef TYN_PHASE_TABLE_GLSL
#define TYN_PHASE_TABLE_GLSL

layout(set = 0, binding = PHASE_TABLES) uniform samplerBuffer phases_texels; // TYN_PHASE_NODES rows of each table

// Of a node: 1 - mu, value in 1/sr, part of the scattering below the angle.
vec3 phase_row(uint row)
{
    return texelFetch(phases_texels, int(row)).xyz;
}

// `table`: of a phase, > 0.
float phase_table_near(uint table, float one_minus_mu)
{
    // tan(theta / 4) from the half angle's sine and cosine, without a cancellation at either end.
    float half_away = clamp(0.5 * one_minus_mu, 0.0, 1.0);
    float quarter = sqrt(half_away) / (1.0 + sqrt(1.0 - half_away));
    float at = sqrt(sqrt(quarter)) * float(TYN_PHASE_NODES - 1);
    uint row = (table - 1u) * TYN_PHASE_NODES + min(uint(at), uint(TYN_PHASE_NODES - 2));
    vec3 from = phase_row(row), to = phase_row(row + 1u);
    float t = clamp((one_minus_mu - from.x) / (to.x - from.x), 0.0, 1.0);
    return mix(from.y, to.y, t);
}

// 1 - mu of an angle below which the part u of the scattering is.
float phase_table_sample(uint table, float u)
{
    uint row = (table - 1u) * TYN_PHASE_NODES, at = 0u;
    [[unroll]] for (uint stride = TYN_PHASE_NODES / 2; stride > 0u; stride >>= 1u) {
        uint next = min(at + stride, uint(TYN_PHASE_NODES - 2));
        at = phase_row(row + next).z <= u ? next : at;
    }
    vec3 from = phase_row(row + at), to = phase_row(row + at + 1u);
    float part = to.z - from.z, r = part > 0.0 ? clamp((u - from.z) / part, 0.0, 1.0) : 0.5;
    // The integral of a + (b - a) t is r of its whole.
    float a = from.y, b = to.y, root = a + sqrt(max(a * a + r * (b * b - a * a), 0.0));
    float t = root > 0.0 ? min(r * (a + b) / root, 1.0) : r;
    return mix(from.x, to.x, t);
}

#endif
