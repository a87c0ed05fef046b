// phase_table.glsl -- evaluation and sampling of phase functions that are tables. Included by phase.glsl where the kernel
// defines PHASE_TABLES, the binding of its port "phases".
//
// A table is linear in the cosine between its nodes, the angles 4 atan((k / (TYN_PHASE_NODES - 1))^4). What is drawn and
// what is evaluated is the same function.
#ifndef TYN_PHASE_TABLE_GLSL
#define TYN_PHASE_TABLE_GLSL

struct phase_row { // of a node
    float away;  // 1 - mu
    float value; // 1/sr
    float below; // part of the scattering below the angle
    float pad;
};
TYN_READ(PHASE_TABLES, phases, phase_row phase_rows[]); // TYN_PHASE_NODES of each table

// `table`: of a phase, > 0.
float phase_table_near(uint table, float one_minus_mu)
{
    // tan(theta / 4) from the half angle's sine and cosine, without a cancellation at either end.
    float half_away = clamp(0.5 * one_minus_mu, 0.0, 1.0);
    float quarter = sqrt(half_away) / (1.0 + sqrt(1.0 - half_away));
    float at = sqrt(sqrt(quarter)) * float(TYN_PHASE_NODES - 1);
    uint row = (table - 1u) * TYN_PHASE_NODES + min(uint(at), uint(TYN_PHASE_NODES - 2));
    float from = phase_rows[row].away, to = phase_rows[row + 1u].away;
    float t = clamp((one_minus_mu - from) / (to - from), 0.0, 1.0);
    return mix(phase_rows[row].value, phase_rows[row + 1u].value, t);
}

// 1 - mu of an angle below which the part u of the scattering is.
float phase_table_sample(uint table, float u)
{
    uint row = (table - 1u) * TYN_PHASE_NODES, at = 0u;
    for (uint stride = TYN_PHASE_NODES / 2; stride > 0u; stride >>= 1u) {
        uint next = min(at + stride, uint(TYN_PHASE_NODES - 2));
        at = phase_rows[row + next].below <= u ? next : at;
    }
    row += at;
    float from = phase_rows[row].below, part = phase_rows[row + 1u].below - from;
    float r = part > 0.0 ? clamp((u - from) / part, 0.0, 1.0) : 0.5;
    // The integral of a + (b - a) t is r of its whole.
    float a = phase_rows[row].value, b = phase_rows[row + 1u].value;
    float root = a + sqrt(max(a * a + r * (b * b - a * a), 0.0));
    float t = root > 0.0 ? min(r * (a + b) / root, 1.0) : r;
    return mix(phase_rows[row].away, phase_rows[row + 1u].away, t);
}

#endif
