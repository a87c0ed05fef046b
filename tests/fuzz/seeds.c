// seeds.c -- writes small valid files for the fuzzers to start from: fuzz_seeds FOLDER.
#include <tyndall/io.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "nvdb_write.h"
#include "vdb_files.h"

static const char *root;

static void put(const char *kind, const char *name, const void *data, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", root, kind);
    mkdir(path, 0777);
    snprintf(path, sizeof path, "%s/%s/%s", root, kind, name);
    tyn_file_write(path, data, size, NULL);
}

static float ramp(int32_t i, int32_t j, int32_t k)
{
    return (float)((i * 7 + j * 5 + k * 3) & 15) / 15.0f;
}

static void put_nvdb(void)
{
    static const uint32_t types[] = {NVDB_FLOAT, NVDB_VEC3F, NVDB_HALF, NVDB_FP4,
                                     NVDB_FP8,   NVDB_FP16,  NVDB_FPN};
    for (uint32_t t = 0; t < sizeof types / sizeof types[0]; t++) {
        for (uint32_t codec = NVDB_ZIP; codec <= NVDB_BLOSC; codec++) {
            nvdb_spec spec = {"density", types[t], codec, 2,    {-3, 2, 1}, {9, 8, 6},
                              ramp,      0.0f,     {0},   0.0f, 0.1};
            size_t size;
            char name[32];
            snprintf(name, sizeof name, "%u-%u", types[t], codec);
            uint8_t *file = nvdb_write(&spec, &size, NULL);
            put("nvdb", name, file, size);
            free(file);
        }
    }
}

static void put_exr(void)
{
    float data[3 * 20 * 18];
    tyn_channel channels[3] = {{"R", data}, {"G", data + 360}, {"depth.Z", data + 720}};
    tyn_image_file image = {20, 18, 3, channels};
    for (int i = 0; i < 3 * 20 * 18; i++) {
        data[i] = (float)(i % 37) * 0.1f;
    }
    for (int full = 0; full < 2; full++) {
        char path[512];
        put("exr", full ? "float" : "half", "", 0);
        snprintf(path, sizeof path, "%s/exr/%s", root, full ? "float" : "half");
        tyn_exr_write(&image, path, full, NULL);
    }
}

static void put_hdr(void)
{
    static const char head[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 8\n";
    uint8_t file[256];
    size_t n = sizeof head - 1;
    memcpy(file, head, n);
    for (int y = 0; y < 2; y++) { // runs and literals
        const uint8_t line[] = {2, 2, 0, 8, 136, 7, 136, 9, 136, 3, 8, 1, 2, 3, 4, 5, 6, 7, 8};
        memcpy(file + n, line, sizeof line);
        n += sizeof line;
    }
    put("hdr", "new", file, n);
    n = sizeof head - 1;
    for (int i = 0; i < 4; i++) { // a pixel, then repeated
        const uint8_t pixels[] = {10, 20, 30, 130, 1, 1, 1, 3};
        memcpy(file + n, pixels, sizeof pixels);
        n += sizeof pixels;
    }
    put("hdr", "old", file, n);
}

static void put_gltf(void)
{
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1],\"extensions\":{"
        "\"TYN_environment_map\":{\"environment\":0}}}],\"nodes\":[{\"scale\":[2,1,1],\"children\":"
        "[2],\"extensions\":{\"TYN_participating_media\":{\"medium\":0,\"repeat\":[true,false,true]"
        "}}},{\"camera\":0},{\"mesh\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
        "\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}],\"bufferViews\":[{"
        "\"buffer\":0,\"byteLength\":12}],\"buffers\":[{\"byteLength\":12,\"uri\":"
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA\"}],\"cameras\":[{\"type\":"
        "\"perspective\",\"perspective\":{\"yfov\":0.7,\"znear\":0.1}}],\"extensions\":{"
        "\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"spot\":{\"outerConeAngle\":0.5}}"
        "]},\"TYN_environment_map\":{\"environments\":[{\"radiance\":[0.1,0.2,0.3]}]},"
        "\"TYN_participating_media\":{\"media\":[{\"scattering\":[1,2,3],\"anisotropy\":0.5}]}}}";
    uint8_t glb[2048] = "glTF";
    uint32_t json = (uint32_t)(sizeof text - 1 + 3) / 4 * 4, total = 20 + json, version = 2;
    put("gltf", "text", text, sizeof text - 1);
    static const char phases[] =
        "{\"asset\":{\"version\":\"2.0\"},\"extensions\":{\"TYN_participating_media\":{\"media\":["
        "{\"phase\":{\"lobes\":[{\"weight\":0.9,\"g\":0.8},{\"weight\":0.1,\"g\":-0.3,\"alpha\":1}]"
        "}},"
        "{\"phase\":[{\"droplets\":20},{\"legendre\":[1,0.2,0.1]},"
        "{\"angles\":[0,90,180],\"values\":[0.0796,0.0796,0.0796]}]}]}}}";
    put("gltf", "phases", phases, sizeof phases - 1);
    memset(glb + 20, ' ', json);
    memcpy(glb + 4, &version, 4);
    memcpy(glb + 8, &total, 4);
    memcpy(glb + 12, &json, 4);
    memcpy(glb + 16, "JSON", 4);
    memcpy(glb + 20, text, sizeof text - 1);
    put("gltf", "binary", glb, total);
}

// Indices, sparse values, quantised coordinates, a strip, a texture in the document.
static void put_mesh(void)
{
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"scale\":[-1,2,1]}],\"mes"
        "hes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indice"
        "s\":1,\"material\":0},{\"attributes\":{\"POSITION\":0,\"NORMAL\":3,\"COLOR_0\":3},"
        "\"mode\":5}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4"
        ",\"type\":\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":2,\"compone"
        "ntType\":5121},\"values\":{\"bufferView\":3}}},{\"bufferView\":1,\"componentType\""
        ":5121,\"count\":6,\"type\":\"SCALAR\"},{\"bufferView\":4,\"componentType\":5121,\""
        "count\":4,\"type\":\"VEC2\",\"normalized\":true},{\"bufferView\":0,\"componentType"
        "\":5126,\"count\":4,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLengt"
        "h\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":6},{\"buffer\":0,\"byteOffs"
        "et\":56,\"byteLength\":1},{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12},{\"bu"
        "ffer\":0,\"byteOffset\":72,\"byteLength\":8}],\"buffers\":[{\"byteLength\":80,\"ur"
        "i\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwA"
        "AgD8AAAAAAAAAAAAAgD8AAAAAAAECAAIDAAACAAAAAACAPwAAgD8AAAAAAAD/AP//AP8=\"}],\"materi"
        "als\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0.5,\"baseColorTexture\":{\"i"
        "ndex\":0,\"extensions\":{\"KHR_texture_transform\":{\"rotation\":1}}}},\"emissiveF"
        "actor\":[1,1,1],\"emissiveTexture\":{\"index\":0},\"doubleSided\":true}],\"texture"
        "s\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{\"wrapS\":33071}],\"images\":[{"
        "\"uri\":\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0"
        "lEQVR4nGP4z8DA8J8BAAf/Af8Bf4mnAAAAAElFTkSuQmCC\"}]}";
    put("gltf", "mesh", text, sizeof text - 1);
}

static void put_vdb(void)
{
#ifdef HAVE_VDB_FILES
    for (int i = 0; i < VDB_FILES; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/vdb", root);
        mkdir(path, 0777);
        snprintf(path, sizeof path, "%s/vdb/%d.vdb", root, i);
        vdb_file_write(i, path);
    }
#endif
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
        return 2;
    }
    root = argv[1];
    mkdir(root, 0777);
    put_nvdb();
    put_exr();
    put_hdr();
    put_gltf();
    put_mesh();
    put_vdb();
    const uint8_t raw[7 + 8] = {2, 2, 0, 2, 0, 2, 0, 1, 2, 3, 4, 5, 6, 7, 8};
    put("raw", "u8", raw, sizeof raw);
    return 0;
}
