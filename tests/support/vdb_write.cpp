// vdb_write.cpp -- see vdb_write.h.
#include "vdb_write.h"
#include <exception>
#include <openvdb/openvdb.h>

namespace {

void place(openvdb::GridBase &grid, const vdb_spec &s)
{
    openvdb::math::Mat4d m = openvdb::math::Mat4d::identity();
    m.preScale(openvdb::Vec3d(s.voxel));
    m.postRotate(openvdb::math::Z_AXIS, s.turn);
    m.postTranslate(openvdb::Vec3d(s.origin[0], s.origin[1], s.origin[2]));
    grid.setTransform(openvdb::math::Transform::createLinearTransform(m));
    grid.setGridClass(s.vector ? openvdb::GRID_STAGGERED : openvdb::GRID_FOG_VOLUME);
    grid.setName(s.name);
}

template <typename fill> void each(const vdb_spec &s, fill set)
{
    for (int32_t k = s.lo[2]; k <= s.hi[2]; k++) {
        for (int32_t j = s.lo[1]; j <= s.hi[1]; j++) {
            for (int32_t i = s.lo[0]; i <= s.hi[0]; i++) {
                set(openvdb::Coord(i, j, k));
            }
        }
    }
}

openvdb::GridBase::Ptr make(const vdb_spec &s)
{
    if (s.vector) {
        openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create();
        openvdb::Vec3SGrid::Accessor voxels = grid->getAccessor();
        each(s, [&](const openvdb::Coord &c) {
            voxels.setValue(c, openvdb::Vec3s(s.value(c.x(), c.y(), c.z(), 0),
                                              s.value(c.x(), c.y(), c.z(), 1),
                                              s.value(c.x(), c.y(), c.z(), 2)));
        });
        place(*grid, s);
        return grid;
    }
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
    openvdb::FloatGrid::Accessor voxels = grid->getAccessor();
    each(s, [&](const openvdb::Coord &c) { voxels.setValue(c, s.value(c.x(), c.y(), c.z(), 0)); });
    place(*grid, s);
    return grid;
}

} // namespace

bool vdb_write(const char *path, const vdb_spec *specs, int count)
{
    try {
        openvdb::initialize();
        openvdb::GridPtrVec grids;
        for (int i = 0; i < count; i++) {
            grids.push_back(make(specs[i]));
        }
        openvdb::io::File(path).write(grids);
    } catch (const std::exception &) {
        return false;
    }
    return true;
}
