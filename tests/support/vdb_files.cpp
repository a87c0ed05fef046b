// vdb_files.cpp -- OpenVDB files in every way that the library stores values.
#include "vdb_files.h"
#include <openvdb/openvdb.h>

float vdb_file_density(int x, int y, int z)
{
    const bool corner =
        (x == 0 || x == VDB_NX - 1) && (y == 0 || y == VDB_NY - 1) && (z == 0 || z == VDB_NZ - 1);
    const int value = (x * 7 + y * 5 + z * 3) % 16;
    return corner ? 1 : value < 9 ? 0 : static_cast<float>(value) / 16;
}

bool vdb_file_write(int i, const char *path)
{
    static const uint32_t compressions[VDB_FILES / 2] = {
        openvdb::io::COMPRESS_NONE, openvdb::io::COMPRESS_ACTIVE_MASK, openvdb::io::COMPRESS_ZIP,
        openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
        openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK};
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr density = openvdb::FloatGrid::create(0);
    const openvdb::Vec3SGrid::Ptr color = openvdb::Vec3SGrid::create();
    const openvdb::BoolGrid::Ptr mask = openvdb::BoolGrid::create();
    for (int z = 0; z < VDB_NZ; z++) {
        for (int y = 0; y < VDB_NY; y++) {
            for (int x = 0; x < VDB_NX; x++) {
                const float value = vdb_file_density(x, y, z);
                const openvdb::Coord at(x - 3, y + 2, z + 1); // some are negative
                if (value > 0) {
                    density->tree().setValue(at, value);
                    color->tree().setValue(at, openvdb::Vec3s(value, 0.5f, 0.25f));
                    mask->tree().setValue(at, true);
                }
            }
        }
    }
    density->setName("density");
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    color->setName("Cd");
    mask->setName("mask");
    const openvdb::GridPtrVec grids = {density, color, mask};
    for (const openvdb::GridBase::Ptr &grid : grids) {
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
        grid->setSaveFloatAsHalf(i % 2 == 1);
    }
    try {
        openvdb::io::File file(path);
        file.setCompression(compressions[i / 2]);
        file.write(grids);
        return true;
    } catch (const std::exception &) {
        return false;
    }
}
