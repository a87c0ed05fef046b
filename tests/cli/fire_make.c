// fire_make.c -- `fire_make FIRE.vdb HOT.vdb`: a fire of OpenVDB grids, and one without its density.
#include "vdb_writer.h"
#include <math.h>

static float smoke(int32_t i, int32_t j, int32_t k, int c)
{
    (void)c;
    const float x = (float)i - 5.5f, y = (float)j - 9.5f, z = (float)k - 5.5f;
    return 3 * expf(-(x * x + 0.5f * y * y + z * z) / 20);
}

static float heat(int32_t i, int32_t j, int32_t k, int c)
{
    (void)c;
    const float x = (float)i - 5.5f, y = (float)j - 3.5f, z = (float)k - 5.5f;
    return expf(-(x * x + 0.3f * y * y + z * z) / 12);
}

static float wind(int32_t i, int32_t j, int32_t k, int c)
{
    (void)i, (void)k;
    return c == 1 ? (float)j - 4 : 0.25f;
}

static float tint(int32_t i, int32_t j, int32_t k, int c)
{
    (void)i, (void)k;
    return c == 0 ? 0.9f : 0.9f - 0.04f * (float)j;
}

int main(int argc, char **argv)
{
    const vdb_spec specs[] = {
        {"temperature",
         VDB_FLOATS,
         {0, 0, 0},
         {11, 15, 11},
         {0.1, 0.1, 0.1},
         0,
         {-0.55, 0.05, -0.55},
         heat},
        {"vel",
         VDB_VECTORS,
         {0, 0, 0},
         {11, 19, 11},
         {0.1, 0.1, 0.1},
         0,
         {-0.55, 0.05, -0.55},
         wind},
        {"density",
         VDB_FLOATS,
         {0, 3, 0},
         {11, 19, 11},
         {0.1, 0.1, 0.1},
         0,
         {-0.55, 0.05, -0.55},
         smoke},
        {"Cd",
         VDB_VECTORS,
         {0, 3, 0},
         {11, 19, 11},
         {0.1, 0.1, 0.1},
         0,
         {-0.55, 0.05, -0.55},
         tint},
    };
    const uint32_t packed = VDB_BLOSC | VDB_ACTIVE_MASK;
    return argc == 3 && !vdb_write(argv[1], specs, 4, packed) &&
                   !vdb_write(argv[2], specs, 2, packed)
               ? 0
               : 1;
}
