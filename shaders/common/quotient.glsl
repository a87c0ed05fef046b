// quotient.glsl -- division of whole numbers. No bindings.
//
// By way of floats, as CPU devices divide integers one lane after another: a division costs as much as several loads.
#ifndef TYN_QUOTIENT_GLSL
#define TYN_QUOTIENT_GLSL

// i / n for 0 <= i < 2^22: the half keeps the quotient farther from whole numbers than its rounding error.
int quotient(int i, int n)
{
    return int((float(i) + 0.5) / float(n));
}

// Of element i of a grid in which x is fastest.
ivec3 quotient_place(uint i, ivec3 size)
{
    int row = quotient(int(i), size.x), layer = quotient(row, size.y);
    return ivec3(int(i) - row * size.x, row - layer * size.y, layer);
}

#endif
