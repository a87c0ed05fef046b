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

// Loads a scene: .gltf, .glb, or a bare volume (.nvdb, .vdb), which is framed and given a sun and a
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

// Loads one grid of a volume file (.nvdb, .vdb) by its extension; `grid` NULL = "density", else the
// first float grid. Negative values are set to 0 and added to `clamped_negative` (may be NULL).
TYN_API tyn_result tyn_volume_load(tyn_volume *volume, const char *path, const char *grid,
                                   uint64_t *clamped_negative, const tyn_log *log);
TYN_API void tyn_volume_finish(tyn_volume *volume);

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
