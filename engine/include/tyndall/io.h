// io.h -- files in and out: scenes, volumes, environments, images. No Vulkan. Tier 1.
//
// Every fault of a file is one log line (file, place, value, what would be right) and a negative
// result: TYN_ERR_IO if it cannot be opened, TYN_ERR_PARAMS if its content is wrong,
// TYN_ERR_UNSUPPORTED if this build was made without what it needs, TYN_ERR_MEMORY. Nothing is left
// half-loaded. Files are written under a temporary name and renamed. What is read and written:
// docs/file-formats.md.
#pragma once
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

// Formats of volume files, by their extensions: each has a reader in the library.
#define TYN_VOLUME_FORMATS(X) X(nvdb) X(vdb)
#define TYN_VOLUME_ENDING(name) ", ." #name
#define TYN_VOLUME_ENDINGS                                                                         \
    "" TYN_VOLUME_FORMATS(TYN_VOLUME_ENDING) // to end a list of extensions with
TYN_API bool tyn_is_volume(const char *path);

// Loads a scene: .gltf, .glb, or a bare volume, which is framed and given a sun and a
// sky (docs/scene-format.md, "A volume alone"). `environment` (may be NULL) replaces the scene's
// map whole, and lights a bare volume in place of sun and sky. `scene` is initialised first; give
// it back with tyn_scene_finish. What is no fault but should be known is in scene->warnings and is
// not logged.
TYN_API tyn_result tyn_scene_load(tyn_scene *scene, const char *path, const char *environment,
                                  const tyn_log *log);

// The same for picture `frame` of a sequence: in the names of the files that a glTF scene refers to
// a run of '#' stands for the number, padded with zeros to as many digits. `path` and `environment`
// are taken as they are.
TYN_API tyn_result tyn_scene_load_frame(tyn_scene *scene, const char *path, const char *environment,
                                        uint32_t frame, const tyn_log *log);

// Which picture of a sequence, and where animations of a glTF file put its nodes and cameras.
typedef struct tyn_moment {
    bool numbered, timed; // `frame` is given; `seconds` is
    uint32_t frame;       // as of tyn_scene_load_frame
    double seconds;       // finite
} tyn_moment;
// The same at a moment; NULL: none. Without a time nodes are where the file puts them, with a warning if it has animations.
TYN_API tyn_result tyn_scene_load_moment(tyn_scene *scene, const char *path,
                                         const char *environment, const tyn_moment *moment,
                                         const tyn_log *log);

// The files that a scene is read from: `path` itself, then each that a .gltf or .glb names (buffers, pictures, volumes,
// maps), as they are opened, whether they are there or not; one that is named twice is told twice. `frame`: the picture of
// a sequence, NULL: none. TYN_ERR_IO and TYN_ERR_PARAMS, with a line, where a glTF file cannot be read.
typedef void (*tyn_file_found)(void *user, const char *path);
TYN_API tyn_result tyn_scene_files(const char *path, const uint32_t *frame, tyn_file_found found,
                                   void *user, const tyn_log *log);

// Loads one grid of a volume file by its extension; `grid` NULL = "density", else the
// first float grid. Negative values are set to 0 and added to `clamped_negative` (may be NULL).
TYN_API tyn_result tyn_volume_load(tyn_volume *volume, const char *path, const char *grid,
                                   uint64_t *clamped_negative, const tyn_log *log);
TYN_API void tyn_volume_finish(tyn_volume *volume);

// A grid of a volume file, as it is listed.
typedef struct tyn_volume_grid {
    char name[128];            // cut where it is longer
    char type[24];             // "float", "vec3s", ...: as the format calls it
    char grid_class[24];       // "fog volume", "level set", "staggered", "unknown", ...
    uint64_t active_voxels;    // 0: none, and no box
    int32_t lo[3], hi[3];      // box of the active voxels in the file's index space, inclusive
    double index_to_world[16]; // column-major; index (i, j, k) is the centre of a voxel
    double voxel[3];           // its edges, in units of the file's world
    double world_lo[3], world_hi[3]; // box around the outer corners of those voxels
    bool affine; // else the transform is a frustum, and the last four are not known
    // Least and largest value; of vectors, of any component. OpenVDB: of active voxels. NanoVDB: of all in the box.
    bool
        has_range; // false if a value is not finite; else of floats, doubles, integers and vectors of them (NanoVDB: of what can be read)
    double least, most;
} tyn_volume_grid;

// All grids of a .nvdb or .vdb file, in its order: `grids` from malloc. Reads every grid once.
TYN_API tyn_result tyn_volume_list(const char *path, tyn_volume_grid **grids, uint32_t *count,
                                   const tyn_log *log);

// Loads a grid of colours of a .nvdb or .vdb file: `grid` (Required) of vectors of three floats, or of scalars, which are
// grey. Negative values are set to 0 and added to `clamped_negative` (may be NULL). `index_to_world` (may be NULL): as
// that of tyn_volume.
TYN_API tyn_result tyn_color_grid_load(tyn_color_grid *colors, const char *path, const char *grid,
                                       double index_to_world[16], uint64_t *clamped_negative,
                                       const tyn_log *log);
TYN_API void tyn_color_grid_finish(tyn_color_grid *colors);

// What the values of a grid of temperatures are, and how bright it is.
typedef struct tyn_temperature {
    double scale, offset; // kelvins = value * scale + offset; scale 0: 1
    double strength;      // multiplies the radiance of black bodies, >= 0; 0: 1
    // > 0: radiance W/(m^2 sr) of this luminance at every temperature from 500 K on, which then is a hue alone; below
    // nothing. 0: as black bodies are.
    double luminance;
} tyn_temperature;
// The radiance of black bodies for a medium's radiance_grid, of size[0]*size[1]*size[2] values, x fastest. Memory: 12 bytes
// a voxel.
TYN_API tyn_result tyn_color_grid_of_temperatures(tyn_color_grid *colors, const uint32_t size[3],
                                                  const float *values, const tyn_temperature *how,
                                                  const tyn_log *log);

// Loads a latitude-longitude map (.exr, .hdr) into `size`, `data` and `hash` and sets `present`;
// radiance, rotation and strength are kept. Negative values are set to 0.
TYN_API tyn_result tyn_environment_load(tyn_environment *env, const char *path, const tyn_log *log);

// Builds `nodes` over the triangles for methods that trace rays ("path"), and puts the triangles into the
// nodes' order; `hash` changes if it is not 0. Uses Embree, the same input always gives the same nodes.
// The surfaces must have passed tyn_scene_check. Nothing happens without triangles.
TYN_API tyn_result tyn_surfaces_build_nodes(tyn_surfaces *surfaces, const tyn_log *log);

// A float image of named channels, planar, row 0 at the top.
typedef struct tyn_channel {
    char name[48]; // "R", "transmittance.R", "depth.Z", ...
    float *data;   // width * height
    bool exact;    // written as 32-bit float in any case: depths, sums
} tyn_channel;

// What a file says of its image beside the pixels, as OpenEXR names it.
typedef enum tyn_attribute_kind {
    TYN_ATTRIBUTE_TEXT = 0,       // string, UTF-8
    TYN_ATTRIBUTE_INTEGER,        // int: values[0]
    TYN_ATTRIBUTE_NUMBER,         // float: values[0]
    TYN_ATTRIBUTE_MATRIX,         // m44f: 16, of row vectors (v M), row after row
    TYN_ATTRIBUTE_CHROMATICITIES, // 8: x and y of red, green, blue, white
} tyn_attribute_kind;
typedef struct tyn_attribute {
    char name[64];
    tyn_attribute_kind kind;
    char *text;        // TEXT, from malloc; else NULL
    double values[16]; // of the others
} tyn_attribute;
typedef struct tyn_image_file {
    uint32_t width, height;
    uint32_t num_channels;
    tyn_channel *channels;
    // Of an EXR file; those of other kinds are not read, those that every file has are not among them.
    uint32_t num_attributes;
    tyn_attribute *attributes;
    // Width of the picture plane at distance 1 ("screenWindowWidth"); 0 when written: 1.
    float screen_width;
    // Of an EXR file: its data window begins at column x, row y of a display window of whole_width x whole_height; {0}: it is
    // all there is.
    int32_t x, y;
    uint32_t whole_width, whole_height;
} tyn_image_file;
// One part, scanlines or tiles, any compression; half and float channels of full resolution.
TYN_API tyn_result tyn_exr_read(tyn_image_file *image, const char *path, const tyn_log *log);
// `full_float` false: half but for exact channels (values beyond 65504 saturate and are counted in one warning).
TYN_API tyn_result tyn_exr_write(const tyn_image_file *image, const char *path, bool full_float,
                                 const tyn_log *log);
TYN_API void tyn_image_file_finish(tyn_image_file *image);
// NULL: not there.
TYN_API float *tyn_image_file_channel(const tyn_image_file *image, const char *name);
TYN_API const tyn_attribute *tyn_image_file_attribute(const tyn_image_file *image,
                                                      const char *name);
TYN_API const char *tyn_image_file_text(const tyn_image_file *image, const char *name);
// Adds an attribute, or gives one that is there another value. False: no memory. Numbers: as many as `kind` has.
TYN_API bool tyn_image_file_set_text(tyn_image_file *image, const char *name, const char *text);
TYN_API bool tyn_image_file_set_numbers(tyn_image_file *image, const char *name,
                                        tyn_attribute_kind kind, const double *values);

// 8-bit RGB(A), row 0 at the top.
TYN_API tyn_result tyn_png_write(const char *path, uint32_t width, uint32_t height,
                                 uint32_t channels, const uint8_t *pixels, const tyn_log *log);
// Any PNG as 8-bit RGBA with at most 16384 pixels a side; `rgba` is freed with free().
TYN_API tyn_result tyn_png_read(const char *path, uint32_t *width, uint32_t *height, uint8_t **rgba,
                                const tyn_log *log);

// Whole files; `size` in bytes; freed with free(). Refuses files above `limit` bytes, and what is not a regular file.
TYN_API tyn_result tyn_file_read(const char *path, uint64_t limit, void **data, size_t *size,
                                 const tyn_log *log);
// A regular file, or a new one, is replaced when all is written, and nothing else is left of it if the process ends
// before. A link is followed and stays; a device, a FIFO and a name of a descriptor (/dev/stdout) are written to.
TYN_API tyn_result tyn_file_write(const char *path, const void *data, size_t size,
                                  const tyn_log *log);
// Whether tyn_file_write could write there; nothing is touched. TYN_ERR_IO: a line says why not.
TYN_API tyn_result tyn_file_writable(const char *path, const tyn_log *log);

#ifdef __cplusplus
}
#endif
