// broken_make.c -- writes files that no loader may take: broken_make FOLDER. Prints, for every one,
// the file to hand to the tool (for a volume or a map the scene that names it).
#include <tyndall/io.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "nvdb_write.h"

#define ASSET "{\"asset\":{\"version\":\"2.0\"},"

static const char *folder;
static int number;

static const char *path_of(const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void put(const char *name, const void *data, size_t size)
{
    if (tyn_file_write(path_of(name), data, size, NULL)) {
        fprintf(stderr, "cannot write %s\n", path_of(name));
        exit(1);
    }
}

static void list(const char *name)
{
    puts(path_of(name));
}

// ---- glTF -----------------------------------------------------------------------------------

static void scene(const char *format, ...)
{
    char text[4096], name[64];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    snprintf(name, sizeof name, "scene-%02d.gltf", number++);
    put(name, text, strlen(text));
    list(name);
}

static void make_gltf(void)
{
    scene("%s", "");
    scene("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{},");
    scene("{\"asset\":{\"version\":\"1.0\"}}");
    scene(ASSET "\"extensionsRequired\":[\"KHR_none\"]}");
    scene(ASSET "\"nodes\":[{\"children\":[0]}]}");
    scene(ASSET "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}");
    scene(ASSET "\"nodes\":[{\"children\":[7]}]}");
    scene(ASSET "\"nodes\":[{\"scale\":[1,1e999,1]}]}");
    scene(ASSET "\"buffers\":[{\"byteLength\":4,\"uri\":\"none.bin\"}]}");
    scene(ASSET "\"buffers\":[{\"byteLength\":4e18,\"uri\":\"none.bin\"}]}");
    scene(ASSET "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":9}}]}]}");
    scene(ASSET "\"extensions\":{\"TYN_participating_media\":{\"media\":[{\"absorption\":-1}]}}}");
    scene(ASSET "\"extensions\":{\"TYN_participating_media\":{\"media\":[{\"anisotropy\":1}]}}}");
    // A triangle of 36 bytes, with one thing wrong.
    static const char buffer[] =
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAAAA\"}],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":36}],\"nodes\":[{\"mesh\":0}]";
    static const char *const wrong[][2] = {
        {"\"count\":4,\"componentType\":5126,\"type\":\"VEC3\"", ""}, // beyond the buffer
        {"\"count\":3,\"componentType\":5126,\"type\":\"SCALAR\"", ""},
        {"\"count\":3,\"componentType\":5126,\"type\":\"VEC3\"", ",\"indices\":0"},
        {"\"count\":3,\"componentType\":5126,\"type\":\"VEC3\"", ",\"material\":0"},
        {"\"count\":3,\"componentType\":5126,\"type\":\"VEC3\"", ",\"mode\":9"},
        {"\"count\":2,\"componentType\":5126,\"type\":\"VEC3\"", ""}, // no triangle
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        scene(ASSET "%s,\"accessors\":[{\"bufferView\":0,%s}],\"meshes\":[{\"primitives\":[{"
                    "\"attributes\":{\"POSITION\":0}%s}]}]}",
              buffer, wrong[i][0], wrong[i][1]);
    }
    char deep[2100];
    memset(deep, '[', 1000);
    memset(deep + 1000, ']', 1000);
    deep[2000] = 0;
    scene(ASSET "\"extras\":%s}", deep);
    const uint8_t glb[20] = {'g', 'l', 'T', 'F', 2,   0,   0,   0,   255, 255,
                             255, 255, 255, 255, 255, 127, 'J', 'S', 'O', 'N'};
    put("short.glb", glb, sizeof glb);
    list("short.glb");
    put("magic.glb", "PK\3\4 something else", 20);
    list("magic.glb");
}

// ---- volumes --------------------------------------------------------------------------------

static void raw(const char *bytes, size_t size, const char *grid)
{
    char name[64];
    snprintf(name, sizeof name, "grid-%02d.raw", number);
    put(name, bytes, size);
    scene(ASSET "\"extensions\":{\"TYN_participating_media\":{\"media\":[{\"density\":{\"uri\":\"%"
                "s\",%s}}]}}}",
          name, grid);
}

static void make_raw(void)
{
    const char *one = "\"size\":[1,1,1],\"type\":\"f32\"";
    raw("", 0, one);
    raw("\0\0\0", 3, one);
    raw("\0\0\0\0\0", 5, one);
    raw("\0\0\xc0\x7f", 4, one); // NaN
    raw("\0\0\x80\x7f", 4, one); // infinity
    raw("\0\x7c", 2, "\"size\":[1,1,1],\"type\":\"f16\"");
    raw("\0\0\0\0", 4, "\"size\":[0,1,1],\"type\":\"f32\"");
    raw("\0\0\0\0", 4, "\"size\":[-1,1,1],\"type\":\"f32\"");
    raw("\0\0\0\0", 4, "\"size\":[65536,65536,65536],\"type\":\"u8\"");
    raw("\0\0\0\0", 4, "\"size\":[1e300,1,1],\"type\":\"f32\"");
    raw("\0\0\0\0", 4, "\"size\":[1,1,1],\"type\":\"f64\"");
    raw("\0\0\0\0", 4, "\"size\":[1,1],\"type\":\"f32\"");
    raw("\0\0\0\0", 4, "\"type\":\"f32\"");
}

static float value(int32_t i, int32_t j, int32_t k)
{
    return (float)((i + j + k) & 7) / 7.0f;
}

static float nan_value(int32_t i, int32_t j, int32_t k)
{
    return i == 3 ? strtof("nan", NULL) : (float)(j + k);
}

static void patched(const char *name, const uint8_t *file, size_t size, size_t at, uint64_t v,
                    size_t bytes)
{
    uint8_t *copy = malloc(size);
    memcpy(copy, file, size);
    for (size_t i = 0; i < bytes; i++) {
        copy[at + i] = (uint8_t)(v >> (8 * i));
    }
    put(name, copy, size);
    list(name);
    free(copy);
}

static void make_nvdb(void)
{
    nvdb_spec spec = {.name = "density",
                      .type = NVDB_FLOAT,
                      .grid_class = 2,
                      .hi = {9, 9, 9},
                      .value = value,
                      .voxel = 1};
    size_t size, grid;
    uint8_t *file = nvdb_write(&spec, &size, &grid);
    put("empty.nvdb", "", 0);
    list("empty.nvdb");
    put("cut.nvdb", file, size / 2);
    list("cut.nvdb");
    put("head.nvdb", file, 40);
    list("head.nvdb");
    patched("magic.nvdb", file, size, 0, 0x4242, 8);
    patched("version.nvdb", file, size, 8, 1, 4);
    patched("codec.nvdb", file, size, 16 + 168, 9, 2);
    patched("huge.nvdb", file, size, 16, 1ull << 45, 8);
    patched("type.nvdb", file, size, 16 + 32, 7, 4);
    patched("root.nvdb", file, size, grid + 672 + 24, 1ull << 40, 8);
    patched("box.nvdb", file, size, grid + 736 + 12, 0x7fffffff, 4);
    patched("nobox.nvdb", file, size, grid + 736, 0x7fffffff, 4);
    patched("tiles.nvdb", file, size, grid + 736 + 24, 0xffffffff, 4);
    patched("upper.nvdb", file, size, grid + 800 + 8, 1ull << 40, 8);
    patched("leaf.nvdb", file, size, grid + 832 + 270400 + 1088, 1ull << 40, 8);
    free(file);
    spec.value = nan_value;
    file = nvdb_write(&spec, &size, NULL);
    put("nan.nvdb", file, size);
    list("nan.nvdb");
    free(file);
}

// ---- environments ---------------------------------------------------------------------------

static void map(const char *extension, const void *bytes, size_t size)
{
    char name[64];
    snprintf(name, sizeof name, "map-%02d.%s", number, extension);
    put(name, bytes, size);
    scene(ASSET "\"scenes\":[{\"extensions\":{\"TYN_environment_map\":{\"environment\":0}}}],"
                "\"extensions\":{"
                "\"TYN_environment_map\":{\"environments\":[{\"uri\":\"%s\"}]}}}",
          name);
}

static void hdr(const char *text)
{
    map("hdr", text, strlen(text));
}

static void make_hdr(void)
{
    const char *head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    char text[256];
    const char *sizes[] = {
        "-Y 0 +X 8\n", "-Y -1 +X 8\n",    "-Y 9 +X 99999999\n",      "+X 8 -Y 1\n",
        "-Y 9 +X 9\n", "-Y 1 +X 8\n\2\2", "-Y 1 +X 4\n\1\1\1\5....", "-Y x\n"};
    for (int i = 0; i < 8; i++) {
        snprintf(text, sizeof text, "%s%s", head, sizes[i]);
        hdr(text);
    }
    hdr("");
    hdr("#?RADIANCE");
    hdr("P6 1 1 255 abc");
    hdr("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd");
}

static void make_exr(void)
{
    float values[64] = {0};
    tyn_channel channels[3] = {{"R", values}, {"G", values}, {"B", values}};
    tyn_image_file image = {8, 8, 3, channels};
    void *file;
    size_t size;
    tyn_exr_write(&image, path_of("whole.exr"), true, NULL);
    tyn_file_read(path_of("whole.exr"), 1 << 20, &file, &size, NULL);
    const size_t cuts[] = {0, 3, 8, 30, 100, size / 2, size - 1};
    for (int i = 0; i < 7; i++) {
        map("exr", file, cuts[i]);
    }
    uint8_t *window = memmem(file, size, "dataWindow\0box2i", 16);
    const uint8_t wide[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0x7f, 7, 0, 0, 0};
    memcpy(window + 17 + 4, wide, 16); // absurd
    map("exr", file, size);
    memset(window + 17 + 4 + 8, 0xf0, 4); // negative
    map("exr", file, size);
    free(file);
    map("exr", "a text, not a picture", 21);
    values[9] = strtof("inf", NULL);
    tyn_exr_write(&image, path_of("whole.exr"), true, NULL);
    tyn_file_read(path_of("whole.exr"), 1 << 20, &file, &size, NULL);
    map("exr", file, size);
    free(file);
    image.channels = channels + 1; // no red
    image.num_channels = 2;
    values[9] = 0;
    tyn_exr_write(&image, path_of("whole.exr"), true, NULL);
    tyn_file_read(path_of("whole.exr"), 1 << 20, &file, &size, NULL);
    map("exr", file, size);
    free(file);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        return 2;
    }
    folder = argv[1];
    make_gltf();
    make_raw();
    make_nvdb();
    make_hdr();
    make_exr();
    put("text.vdb", "a text, not a volume", 20);
    list("text.vdb");
    return 0;
}
