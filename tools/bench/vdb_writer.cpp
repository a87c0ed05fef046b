// vdb_writer.cpp -- see vdb_writer.h.
#include "vdb_writer.h"
#include <exception>
#include <openvdb/openvdb.h>
#include <string>

namespace {

void set(openvdb::FloatGrid &grid, const openvdb::Coord &c, const vdb_spec &s)
{
    grid.tree().setValue(c, s.value(c.x(), c.y(), c.z(), 0));
}

void set(openvdb::BoolGrid &grid, const openvdb::Coord &c, const vdb_spec &s)
{
    grid.tree().setValue(c, s.value(c.x(), c.y(), c.z(), 0) != 0);
}

void set(openvdb::Vec3SGrid &grid, const openvdb::Coord &c, const vdb_spec &s)
{
    grid.tree().setValue(c, openvdb::Vec3s(s.value(c.x(), c.y(), c.z(), 0),
                                           s.value(c.x(), c.y(), c.z(), 1),
                                           s.value(c.x(), c.y(), c.z(), 2)));
}

void place(openvdb::GridBase &grid, const vdb_spec &s)
{
    openvdb::math::Mat4d m = openvdb::math::Mat4d::identity();
    m.preScale(openvdb::Vec3d(s.voxel));
    m.postRotate(openvdb::math::Z_AXIS, s.turn);
    m.postTranslate(openvdb::Vec3d(s.origin));
    grid.setTransform(openvdb::math::Transform::createLinearTransform(m));
}

template <typename grid_type> openvdb::GridBase::Ptr fill(const vdb_spec &s)
{
    const typename grid_type::Ptr grid = grid_type::create();
    for (int32_t k = s.lo[2]; k <= s.hi[2]; k++) {
        for (int32_t j = s.lo[1]; j <= s.hi[1]; j++) {
            for (int32_t i = s.lo[0]; i <= s.hi[0]; i++) {
                if (!s.sparse || s.value(i, j, k, 0) != 0) {
                    set(*grid, openvdb::Coord(i, j, k), s);
                }
            }
        }
    }
    return grid;
}

openvdb::GridBase::Ptr make(const vdb_spec &s)
{
    const openvdb::GridBase::Ptr grid = s.values == VDB_VECTORS ? fill<openvdb::Vec3SGrid>(s)
                                        : s.values == VDB_BOOLS ? fill<openvdb::BoolGrid>(s)
                                                                : fill<openvdb::FloatGrid>(s);
    place(*grid, s);
    grid->setName(s.name);
    grid->setSaveFloatAsHalf(s.half);
    if (s.values != VDB_BOOLS) {
        grid->setGridClass(s.values == VDB_FLOATS ? openvdb::GRID_FOG_VOLUME
                                                  : openvdb::GRID_STAGGERED);
    }
    return grid;
}

} // namespace

const char *vdb_write(const char *path, const vdb_spec *specs, int count, uint32_t compression)
{
    static std::string wrong;
    try {
        openvdb::initialize();
        openvdb::GridPtrVec grids;
        for (int i = 0; i < count; i++) {
            grids.push_back(make(specs[i]));
        }
        openvdb::io::File file(path);
        file.setCompression(compression);
        file.write(grids);
        return nullptr;
    } catch (const std::exception &e) {
        wrong = e.what();
        return wrong.c_str();
    }
}
