// harmonics.glsl -- real spherical harmonics of a direction, by recurrence. No bindings.
//
// Orthonormal; number l^2 + l + m, cosines at m > 0, sines at m < 0; Y_1 = sqrt(3 / (4 pi)) (y, z, x). Define HARMONICS_VISIT(l, k, y)
// before including: it is given each with its band l and its number k.

void harmonics_visit(vec3 d, int bands)
{
    float diagonal = 0.28209479; // of P_mm, without its power of the sine, which is in (x + i y)^m
    vec2 turn = vec2(1.0, 0.0);  // (x + i y)^m
    for (int m = 0; m < bands; m++) {
        if (m > 0) {
            diagonal *= sqrt(1.0 + 0.5 / float(m));
            turn = vec2(turn.x * d.x - turn.y * d.y, turn.x * d.y + turn.y * d.x);
        }
        float before = 0.0, p = diagonal, scale = m > 0 ? 1.41421356 : 1.0;
        for (int l = m; l < bands; l++) {
            if (l > m) {
                float a = float(4 * l * l - 1) / float(l * l - m * m);
                float b = float((l - 1) * (l - 1) - m * m) / float(4 * (l - 1) * (l - 1) - 1);
                float next = sqrt(a) * (d.z * p - sqrt(max(b, 0.0)) * before);
                before = p;
                p = next;
            }
            HARMONICS_VISIT(l, l * l + l + m, scale * turn.x * p);
            if (m > 0) {
                HARMONICS_VISIT(l, l * l + l - m, scale * turn.y * p);
            }
        }
    }
}
