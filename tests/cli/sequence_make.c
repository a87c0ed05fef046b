// sequence_make.c -- writes an animated volume: sequence_make FOLDER puts puff.0002.nvdb to
// puff.0005.nvdb there, a puff that rises, grows and thins out, and puffs.gltf, a scene that names them
// "puff.####.nvdb".
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>
#include "nvdb_write.h"

static float centre[3], radius, peak; // voxels

static float density(int32_t i, int32_t j, int32_t k)
{
    const float d[3] = {(float)i - centre[0], (float)j - centre[1], (float)k - centre[2]};
    const float t = 1.0f - (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / (radius * radius);
    return t > 0.0f ? peak * t * t : 0.0f;
}

static bool write_frame(const char *folder, int frame)
{
    radius = 8.0f + (float)frame;
    peak = 12.0f / radius;
    centre[0] = 20.0f;
    centre[1] = 12.0f + 2.0f * (float)frame;
    centre[2] = 20.0f - (float)frame;
    nvdb_spec spec = {.name = "density",
                      .type = NVDB_FLOAT,
                      .codec = NVDB_ZIP,
                      .grid_class = 2,
                      .value = density,
                      .voxel = 0.05};
    for (int a = 0; a < 3; a++) {
        spec.lo[a] = (int32_t)(centre[a] - radius);
        spec.hi[a] = (int32_t)(centre[a] + radius);
    }
    char path[1024];
    size_t size;
    uint8_t *bytes = nvdb_write(&spec, &size, NULL);
    snprintf(path, sizeof path, "%s/puff.%04d.nvdb", folder, frame);
    bool written = bytes && tyn_file_write(path, bytes, size, NULL) == TYN_OK;
    free(bytes);
    return written;
}

static const char scene[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0, 1, 2]}],\n"
    "\"extensionsUsed\": [\"TYN_participating_media\", \"KHR_lights_punctual\"],\n"
    "\"nodes\": [{\"extensions\": {\"TYN_participating_media\": {\"medium\": 0, \"shape\": "
    "\"grid\"}}},\n"
    "  {\"rotation\": [-0.7071068, 0, 0, 0.7071068],\n"
    "   \"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}},\n"
    "  {\"translation\": [1, 1, 4.5], \"camera\": 0}],\n"
    "\"cameras\": [{\"type\": \"perspective\", \"perspective\":\n"
    "  {\"yfov\": 0.6, \"aspectRatio\": 1, \"znear\": 0.1}}],\n"
    "\"extensions\": {\n"
    "  \"KHR_lights_punctual\": {\"lights\": [{\"type\": \"directional\", \"intensity\": 4}]},\n"
    "  \"TYN_participating_media\": {\"media\": [{\"scattering\": 8, \"absorption\": 0.2,\n"
    "    \"anisotropy\": 0.5, \"density\": {\"uri\": \"puff.####.nvdb\"}}]}}}\n";

int main(int argc, char **argv)
{
    bool written = argc == 2;
    for (int frame = 2; written && frame <= 5; frame++) {
        written = write_frame(argv[1], frame);
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/puffs.gltf", argc == 2 ? argv[1] : ".");
    written = written && tyn_file_write(path, scene, strlen(scene), NULL) == TYN_OK;
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}
