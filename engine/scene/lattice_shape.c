// lattice_shape.c -- size of the lattice, and whether one channel is enough.
#include <tyndall/extend/lattice_shape.h>
#include <math.h>

tyn_extent tyn_lattice_dims(const float extent[3], int32_t cells)
{
    float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    uint32_t n[3];
    for (int a = 0; a < 3; a++) {
        // A side that is a multiple of the cell up to rounding gets no extra cell.
        double exact = longest > 0 ? (double)extent[a] / longest * cells : 1;
        n[a] = (uint32_t)fmax(1, ceil(exact - 1e-4));
    }
    return (tyn_extent){n[0], n[1], n[2]};
}

int32_t tyn_lattice_fit(const float extent[3], const uint32_t repeat[3], int32_t cells)
{
    float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    for (; cells > 0; cells--) {
        const tyn_extent n = tyn_lattice_dims(extent, cells);
        bool fits = (uint64_t)n.x * n.y * n.z <= TYN_LATTICE_MAX_ALL;
        for (int a = 0; a < 3; a++) {
            double exact = longest > 0 ? (double)extent[a] / longest * cells : 1;
            double whole = fmax(1, round(exact));
            fits = fits && (!repeat[a] || fabs(exact - whole) <= 1e-4 * whole);
        }
        if (fits) {
            break;
        }
    }
    return cells;
}

bool tyn_lattice_tint(const float (*colors)[3], uint32_t n, float tint[3])
{
    bool found = false;
    for (uint32_t i = 0; i < n; i++) {
        float scale = fmaxf(colors[i][0], fmaxf(colors[i][1], colors[i][2]));
        if (!(scale > 0)) {
            continue;
        }
        for (int c = 0; c < 3; c++) {
            float share = colors[i][c] / scale;
            if (found && fabsf(share - tint[c]) > 1e-5f) {
                tint[0] = tint[1] = tint[2] = 1;
                return false;
            }
            tint[c] = found ? tint[c] : share;
        }
        found = true;
    }
    if (!found) {
        tint[0] = tint[1] = tint[2] = 1;
    }
    return true;
}
