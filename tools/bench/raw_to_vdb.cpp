// raw_to_vdb.cpp -- a density in a .raw file (docs/scene-format.md) as an OpenVDB grid that fills the unit box.
//
// usage: tyndall-raw-to-vdb IN.raw NX NY NZ f32|f16|u8 OUT.vdb
//
// The grid "density" holds a float at the centre of every voxel, (i + 0.5) / n - 0.5 on each axis, between which
// OpenVDB's readers interpolate as the library does. Voxels that are 0 stay inactive. In the outer half voxel a reader
// goes over to the 0 outside where the library keeps the value of the edge: the voxels at the faces must be 0, and a
// file of which this does not hold is refused.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>
#include <openvdb/openvdb.h>

namespace {

float value_at(const std::vector<char> &bytes, size_t i, const std::string &type)
{
    if (type == "f32") {
        float value;
        std::memcpy(&value, &bytes[4 * i], sizeof value);
        return value;
    }
    if (type == "f16") {
        uint16_t bits;
        std::memcpy(&bits, &bytes[2 * i], sizeof bits);
        return static_cast<float>(openvdb::math::half(openvdb::math::half::FromBits, bits));
    }
    return static_cast<float>(static_cast<unsigned char>(bytes[i])) / 255;
}

// Gives what is wrong, or "".
std::string convert(const char *in, const openvdb::Coord &size, const std::string &type,
                    const char *out)
{
    const size_t width = type == "f32" ? 4 : type == "f16" ? 2 : type == "u8" ? 1 : 0;
    if (width == 0) {
        return "the type must be f32, f16 or u8";
    }
    std::ifstream file(in, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)),
                                  std::istreambuf_iterator<char>());
    const size_t count = static_cast<size_t>(size.x()) * size.y() * size.z();
    if (bytes.size() != count * width) {
        return std::string(in) + ": has " + std::to_string(bytes.size()) + " bytes, not " +
               std::to_string(count * width);
    }
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
    openvdb::FloatGrid::Accessor voxels = grid->getAccessor();
    size_t i = 0;
    for (int z = 0; z < size.z(); z++) {
        for (int y = 0; y < size.y(); y++) {
            for (int x = 0; x < size.x(); x++, i++) {
                const float value = value_at(bytes, i, type);
                const bool face = x == 0 || y == 0 || z == 0 || x == size.x() - 1 ||
                                  y == size.y() - 1 || z == size.z() - 1;
                if (value != 0 && face) {
                    return std::string(in) + ": its voxels at the faces of the box are not all 0";
                }
                if (value != 0) {
                    voxels.setValue(openvdb::Coord(x, y, z), value);
                }
            }
        }
    }
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
    matrix.preScale(openvdb::Vec3d(1.0 / size.x(), 1.0 / size.y(), 1.0 / size.z()));
    matrix.postTranslate(
        openvdb::Vec3d(0.5 / size.x() - 0.5, 0.5 / size.y() - 0.5, 0.5 / size.z() - 0.5));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName("density");
    openvdb::io::File(out).write({grid});
    return "";
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 7) {
        std::cerr << "usage: tyndall-raw-to-vdb IN.raw NX NY NZ f32|f16|u8 OUT.vdb\n";
        return 2;
    }
    try {
        openvdb::initialize();
        const openvdb::Coord size(std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]));
        if (size.x() < 1 || size.y() < 1 || size.z() < 1) {
            std::cerr << "tyndall-raw-to-vdb: NX, NY and NZ must be above 0\n";
            return 2;
        }
        const std::string wrong = convert(argv[1], size, argv[5], argv[6]);
        if (!wrong.empty()) {
            std::cerr << "tyndall-raw-to-vdb: " << wrong << "\n";
            return 2;
        }
    } catch (const std::exception &e) {
        std::cerr << "tyndall-raw-to-vdb: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
