// vdb.cpp -- OpenVDB files. The one place that knows OpenVDB; no exception leaves it.
#include "io/vdb.h"
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <vector>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include "io/vdb_check.h"
extern "C" {
#include "io/file.h"
#include "io/volume.h"
}

namespace {

struct entry {
    std::string name, type;
    bool readable;
};

std::vector<entry> list_grids(openvdb::io::File &file)
{
    std::vector<entry> entries;
    for (openvdb::io::File::NameIterator name = file.beginName(); name != file.endName(); ++name) {
        openvdb::GridBase::Ptr meta = file.readGridMetadata(name.gridName());
        bool level_set = meta->getGridClass() == openvdb::GRID_LEVEL_SET;
        entries.push_back({name.gridName(), level_set ? "level set" : meta->valueType(),
                           !level_set && meta->isType<openvdb::FloatGrid>()});
    }
    return entries;
}

int choose(const std::vector<entry> &entries, const char *grid, const char *path,
           const tyn_log *log)
{
    std::vector<const char *> names, types;
    bool readable[1024] = {};
    for (size_t i = 0; i < entries.size() && i < 1024; i++) {
        names.push_back(entries[i].name.c_str());
        types.push_back(entries[i].type.c_str());
        readable[i] = entries[i].readable;
    }
    return tyn_volume_choose(names.data(), types.data(), readable, uint32_t(names.size()), grid,
                             path, log);
}

tyn_result copy_grid(tyn_volume *volume, const openvdb::FloatGrid &grid, const char *path,
                     const tyn_log *log)
{
    const openvdb::math::Transform &transform = grid.transform();
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: grid \"%.100s\" has no active voxels", path,
                      grid.getName().c_str());
        return TYN_ERR_PARAMS;
    }
    if (!transform.isLinear()) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: grid \"%.100s\" has a %s: must be affine", path,
                      grid.getName().c_str(), transform.mapType().c_str());
        return TYN_ERR_PARAMS;
    }
    const int64_t size[3] = {int64_t(box.max().x()) - box.min().x() + 1,
                             int64_t(box.max().y()) - box.min().y() + 1,
                             int64_t(box.max().z()) - box.min().z() + 1};
    tyn_result r = tyn_volume_alloc(volume, size, path, log);
    if (r) {
        return r;
    }
    // LayoutXYZ: x runs fastest. Copies inactive values as well.
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, volume->data);
    openvdb::tools::copyToDense(grid, dense);
    const openvdb::Vec3d origin = transform.indexToWorld(box.min());
    for (int axis = 0; axis < 3; axis++) {
        openvdb::Coord step = box.min();
        step[axis] += 1;
        const openvdb::Vec3d column = transform.indexToWorld(step) - origin;
        for (int row = 0; row < 3; row++) {
            volume->index_to_world[axis * 4 + row] = column[row];
            volume->index_to_world[12 + row] = origin[row];
        }
    }
    return TYN_OK;
}

// The library believes what a file says of itself.
tyn_result check(const char *path, const tyn_log *log)
{
    const void *bytes;
    size_t size;
    tyn_result r = tyn_file_map(path, TYN_MAX_FILE_BYTES, &bytes, &size, log);
    if (r) {
        return r;
    }
    bool whole = tyn_vdb_check(bytes, size, openvdb::OPENVDB_FILE_VERSION, path, log);
    tyn_file_unmap(bytes, size);
    return whole ? TYN_OK : TYN_ERR_PARAMS;
}

tyn_result load(tyn_volume *volume, const char *path, const char *grid, uint64_t *clamped,
                const tyn_log *log)
{
    static std::once_flag once; // registers the library's own types
    std::call_once(once, openvdb::initialize);
    openvdb::io::File file(path);
    file.open(false);
    std::vector<entry> entries = list_grids(file);
    int chosen = choose(entries, grid, path, log);
    if (chosen < 0) {
        return TYN_ERR_PARAMS;
    }
    const std::string &name = entries[size_t(chosen)].name;
    openvdb::FloatGrid::Ptr found = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
    if (!found) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: grid \"%.100s\" does not hold floats", path,
                      name.c_str());
        return TYN_ERR_PARAMS;
    }
    tyn_result r = copy_grid(volume, *found, path, log);
    return r ? r : tyn_volume_seal(volume, path, name.c_str(), clamped, log);
}

} // namespace

tyn_result tyn_vdb_load(tyn_volume *volume, const char *path, const char *grid,
                        uint64_t *clamped_negative, const tyn_log *log)
{
    tyn_result r = TYN_ERR_PARAMS;
    std::memset(volume, 0, sizeof *volume);
    tyn_result checked = check(path, log);
    if (checked) {
        return checked;
    }
    try {
        return load(volume, path, grid, clamped_negative, log);
    } catch (const std::bad_alloc &) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory to read it", path);
        r = TYN_ERR_MEMORY;
    } catch (const std::exception &e) {
        std::string what = e.what();
        for (char &c : what) {
            c = c == '\n' ? ' ' : c;
        }
        tyn_log_print(log, TYN_LOG_ERROR, "%s: not a .vdb file that can be read: %.300s", path,
                      what.c_str());
    }
    tyn_volume_finish(volume);
    return r;
}
