// vdb.cpp -- OpenVDB files. The one place that knows OpenVDB; no exception leaves it.
#include "io/vdb.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <vector>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include "base/fault.h"
#include "io/vdb_check.h"
extern "C" {
#include "io/file.h"
}

namespace {

struct entry {
    std::string name, type;
    bool scalar, vector;
};

std::vector<entry> list_grids(openvdb::io::File &file)
{
    std::vector<entry> entries;
    for (openvdb::io::File::NameIterator name = file.beginName(); name != file.endName(); ++name) {
        openvdb::GridBase::Ptr meta = file.readGridMetadata(name.gridName());
        bool level_set = meta->getGridClass() == openvdb::GRID_LEVEL_SET;
        entries.push_back({name.gridName(), level_set ? "level set" : meta->valueType(),
                           !level_set && meta->isType<openvdb::FloatGrid>(),
                           meta->isType<openvdb::Vec3SGrid>()});
    }
    return entries;
}

int choose(const std::vector<entry> &entries, tyn_grid_job *job, const char *path)
{
    std::vector<tyn_grid_entry> grids;
    for (const entry &e : entries) {
        grids.push_back({e.name.c_str(), e.type.c_str(), e.scalar, e.vector});
    }
    return tyn_volume_choose(job, grids.data(), uint32_t(grids.size()), path);
}

// Index to world, column-major; `lo` is where an index of 0 is to be.
void copy_map(double m[16], const openvdb::math::Transform &transform, const openvdb::Coord &lo)
{
    const openvdb::Vec3d origin = transform.indexToWorld(lo);
    for (int axis = 0; axis < 3; axis++) {
        openvdb::Coord step = lo;
        step[axis] += 1;
        const openvdb::Vec3d column = transform.indexToWorld(step) - origin;
        for (int row = 0; row < 3; row++) {
            m[axis * 4 + row] = column[row];
            m[12 + row] = origin[row];
        }
    }
    m[3] = m[7] = m[11] = 0;
    m[15] = 1;
}

template <typename grid_type>
tyn_result copy_grid(tyn_grid_job *job, const grid_type &grid, const char *path)
{
    typedef typename grid_type::ValueType value;
    const openvdb::math::Transform &transform = grid.transform();
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) {
        return TYN_FAULT(job->log, TYN_ERR_PARAMS, "%s: grid \"%.100s\" has no active voxels", path,
                         grid.getName().c_str());
    }
    if (!transform.isLinear()) {
        return TYN_FAULT(job->log, TYN_ERR_PARAMS, "%s: grid \"%.100s\" has a %s: must be affine",
                         path, grid.getName().c_str(), transform.mapType().c_str());
    }
    const int64_t size[3] = {int64_t(box.max().x()) - box.min().x() + 1,
                             int64_t(box.max().y()) - box.min().y() + 1,
                             int64_t(box.max().z()) - box.min().z() + 1};
    job->channels = sizeof(value) / sizeof(float);
    TYN_TRY(tyn_volume_alloc(&job->volume, size, job->channels, path, job->log));
    // LayoutXYZ: x runs fastest. Copies inactive values as well.
    openvdb::tools::Dense<value, openvdb::tools::LayoutXYZ> dense(
        box, reinterpret_cast<value *>(job->volume.data));
    openvdb::tools::copyToDense(grid, dense);
    copy_map(job->volume.index_to_world, transform, box.min());
    return TYN_OK;
}

// ---- what is in a file ------------------------------------------------------------------------

void widen(tyn_volume_grid *g, bool *finite, double v)
{
    g->least = g->has_range ? std::min(g->least, v) : v; // NaN and infinity: find_range
    g->most = g->has_range ? std::max(g->most, v) : v;
    g->has_range = true;
    *finite = *finite && std::isfinite(v);
}

template <typename number>
void widen(tyn_volume_grid *g, bool *finite, const openvdb::math::Vec3<number> &v)
{
    for (int c = 0; c < 3; c++) {
        widen(g, finite, double(v[c]));
    }
}

// Types whose trees tyn_vdb_check has walked; of others what the writer has noted.
typedef openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                          openvdb::Int64Grid, openvdb::Vec3SGrid, openvdb::Vec3DGrid,
                          openvdb::Vec3IGrid>
    walked;

struct find_range {
    tyn_volume_grid *g;

    template <typename grid_type> void operator()(const grid_type &grid) const
    {
        bool finite = true;
        for (typename grid_type::ValueOnCIter it = grid.cbeginValueOn(); it; ++it) {
            widen(g, &finite, it.getValue());
        }
        g->has_range = g->has_range && finite;
    }
};

void tell(tyn_volume_grid *g, openvdb::io::File &file, const std::string &name)
{
    openvdb::GridBase::Ptr grid = file.readGridMetadata(name);
    openvdb::CoordBBox box;
    if (grid->apply<walked>([](const auto &) {})) {
        grid = file.readGrid(name);
        g->active_voxels = grid->activeVoxelCount();
        box = grid->evalActiveVoxelBoundingBox();
        grid->apply<walked>(find_range{g});
    } else if (grid->getMetadata<openvdb::Int64Metadata>("file_voxel_count") &&
               grid->getMetadata<openvdb::Vec3IMetadata>("file_bbox_min") &&
               grid->getMetadata<openvdb::Vec3IMetadata>("file_bbox_max")) {
        g->active_voxels = uint64_t(grid->metaValue<int64_t>("file_voxel_count"));
        box = openvdb::CoordBBox(openvdb::Coord(grid->metaValue<openvdb::Vec3i>("file_bbox_min")),
                                 openvdb::Coord(grid->metaValue<openvdb::Vec3i>("file_bbox_max")));
    }
    std::snprintf(g->name, sizeof g->name, "%s", name.c_str());
    std::snprintf(g->type, sizeof g->type, "%s", grid->valueType().c_str());
    std::snprintf(g->grid_class, sizeof g->grid_class, "%s",
                  openvdb::GridBase::gridClassToString(grid->getGridClass()).c_str());
    for (int a = 0; a < 3; a++) {
        g->lo[a] = box.min()[a];
        g->hi[a] = box.max()[a];
    }
    g->affine = grid->transform().isLinear();
    if (g->affine) {
        copy_map(g->index_to_world, grid->transform(), openvdb::Coord(0, 0, 0));
    }
    tyn_volume_grid_place(g);
}

tyn_result tell_all(tyn_grid_job *job, openvdb::io::File &file, const char *path)
{
    std::vector<std::string> names;
    for (openvdb::io::File::NameIterator name = file.beginName(); name != file.endName(); ++name) {
        names.push_back(name.gridName());
    }
    TYN_TRY(tyn_grid_begin_list(job, uint32_t(names.size()), path));
    for (size_t i = 0; i < names.size(); i++) {
        tell(&job->list[i], file, names[i]);
    }
    return TYN_OK;
}

// The library believes what a file says of itself.
tyn_result check(const char *path, const tyn_log *log)
{
    const void *bytes;
    size_t size;
    TYN_TRY(tyn_file_map(path, TYN_MAX_FILE_BYTES, &bytes, &size, log));
    bool whole = tyn_vdb_check(bytes, size, openvdb::OPENVDB_FILE_VERSION, path, log);
    tyn_file_unmap(bytes, size);
    return whole ? TYN_OK : TYN_ERR_PARAMS;
}

tyn_result load(tyn_grid_job *job, const char *path)
{
    static std::once_flag once; // registers the library's own types
    std::call_once(once, openvdb::initialize);
    openvdb::io::File file(path);
    file.open(false);
    if (job->use == TYN_GRID_LIST) {
        return tell_all(job, file, path);
    }
    std::vector<entry> entries = list_grids(file);
    int chosen = choose(entries, job, path);
    if (chosen < 0) {
        return TYN_ERR_PARAMS;
    }
    const std::string &name = entries[size_t(chosen)].name;
    openvdb::GridBase::Ptr found = file.readGrid(name);
    openvdb::FloatGrid::Ptr floats = openvdb::gridPtrCast<openvdb::FloatGrid>(found);
    openvdb::Vec3SGrid::Ptr vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(found);
    tyn_result r = TYN_ERR_PARAMS;
    if (floats) {
        r = copy_grid(job, *floats, path);
    } else if (vectors && job->use == TYN_GRID_COLOR) {
        r = copy_grid(job, *vectors, path);
    } else {
        tyn_log_print(job->log, TYN_LOG_ERROR, "%s: grid \"%.100s\" does not hold floats", path,
                      name.c_str());
    }
    return r ? r : tyn_grid_seal(job, path, name.c_str());
}

} // namespace

tyn_result tyn_vdb_read_file(tyn_grid_job *job, const char *path)
{
    tyn_result r = TYN_ERR_PARAMS;
    std::memset(&job->volume, 0, sizeof job->volume);
    TYN_TRY(check(path, job->log));
    try {
        return load(job, path);
    } catch (const std::bad_alloc &) {
        r = TYN_FAULT(job->log, TYN_ERR_MEMORY, "%s: no memory to read it", path);
    } catch (const std::exception &e) {
        std::string what = e.what();
        for (char &c : what) {
            c = c == '\n' ? ' ' : c;
        }
        tyn_log_print(job->log, TYN_LOG_ERROR, "%s: not a .vdb file that can be read: %.300s", path,
                      what.c_str());
    }
    tyn_grid_drop(job);
    return r;
}
