// hilbert.glsl -- a curve through a square whose neighbours are neighbours in the square. No bindings.
#ifndef TYN_HILBERT_GLSL
#define TYN_HILBERT_GLSL

// Texel d of a Hilbert curve through side x side texels, a power of two.
uvec2 hilbert_texel(uint side, uint d)
{
    uvec2 p = uvec2(0u);
    for (uint s = 1u; s < side; s *= 2u) {
        uint rx = 1u & (d / 2u), ry = 1u & (d ^ rx);
        if (ry == 0u) {
            p = rx == 1u ? s - 1u - p : p;
            p = p.yx;
        }
        p += s * uvec2(rx, ry);
        d /= 4u;
    }
    return p;
}

#endif
