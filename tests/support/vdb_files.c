// vdb_files.c -- OpenVDB files in every way that the library stores values.
#include "vdb_files.h"
#include "vdb_writer.h"

float vdb_file_density(int x, int y, int z)
{
    const bool corner =
        (x == 0 || x == VDB_NX - 1) && (y == 0 || y == VDB_NY - 1) && (z == 0 || z == VDB_NZ - 1);
    const int value = (x * 7 + y * 5 + z * 3) % 16;
    return corner ? 1 : value < 9 ? 0 : (float)value / 16;
}

// The voxels begin at (-3, 2, 1): some are negative.
enum { AT_X = -3, AT_Y = 2, AT_Z = 1 };

static float density(int32_t i, int32_t j, int32_t k, int c)
{
    (void)c;
    return vdb_file_density(i - AT_X, j - AT_Y, k - AT_Z);
}

static float color(int32_t i, int32_t j, int32_t k, int c)
{
    const float value = density(i, j, k, 0);
    return c == 0 ? value : value > 0 ? 0.5f / (float)c : 0; // 0.5, 0.25
}

bool vdb_file_write(int i, const char *path)
{
    static const uint32_t compressions[VDB_FILES / 2] = {VDB_PLAIN, VDB_ACTIVE_MASK, VDB_ZIP,
                                                         VDB_ZIP | VDB_ACTIVE_MASK,
                                                         VDB_BLOSC | VDB_ACTIVE_MASK};
    vdb_spec grids[] = {{.name = "density", .values = VDB_FLOATS, .value = density},
                        {.name = "Cd", .values = VDB_VECTORS, .value = color},
                        {.name = "mask", .values = VDB_BOOLS, .value = density}};
    const int32_t lo[3] = {AT_X, AT_Y, AT_Z}, size[3] = {VDB_NX, VDB_NY, VDB_NZ};
    for (int g = 0; g < 3; g++) {
        for (int a = 0; a < 3; a++) {
            grids[g].lo[a] = lo[a];
            grids[g].hi[a] = lo[a] + size[a] - 1;
            grids[g].voxel[a] = 0.1;
        }
        grids[g].sparse = true;
        grids[g].half = i % 2 == 1;
    }
    return !vdb_write(path, grids, 3, compressions[i / 2]);
}
