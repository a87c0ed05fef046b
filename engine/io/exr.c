// exr.c -- OpenEXR images through OpenEXRCore: named float channels in and out.
#include "base/given.h"
#include "io/exr.h"
#include "io/exr_attributes.h"
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/half.h"
#include "io/image.h"

// What the library reads from or writes to, and the first thing it complained about.
typedef struct stream {
    uint8_t *bytes;
    uint64_t size, room;
    char message[400];
} stream;

static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    if (context && exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user) {
        stream *s = user;
        if (!s->message[0]) {
            snprintf(s->message, sizeof s->message, "%s",
                     message ? message : exr_get_default_error_message(code));
        }
        for (char *c = s->message; *c; c++) {
            *c = *c == '\n' ? ' ' : *c;
        }
    }
}

// While it writes the library calls this under the lock that exr_get_user_data waits for: the error's number has to do.
static void drop_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static void say(const stream *s, exr_result_t code, const char *file, const tyn_log *log)
{
    tyn_log_print(log, TYN_LOG_ERROR, "%s: %s", file,
                  s->message[0] ? s->message : exr_get_default_error_message(code));
}

// Of a file that is read. The library says EXR_ERR_OUT_OF_MEMORY also of damaged data (PIZ); its own memory is small
// beside the channels, which are not its own.
static tyn_result report(const stream *s, exr_result_t code, const char *file, const tyn_log *log)
{
    say(s, code, file, log);
    return TYN_ERR_PARAMS;
}

// ---- images ---------------------------------------------------------------------------------

void tyn_image_file_finish(tyn_image_file *image)
{
    if (!image) {
        return;
    }
    for (uint32_t i = 0; i < image->num_channels; i++) {
        free(image->channels[i].data);
    }
    free(image->channels);
    for (uint32_t i = 0; i < image->num_attributes; i++) {
        free(image->attributes[i].text);
    }
    free(image->attributes);
    memset(image, 0, sizeof *image);
}

float *tyn_image_file_channel(const tyn_image_file *image, const char *name)
{
    for (uint32_t i = 0; image && name && i < image->num_channels; i++) {
        if (strcmp(image->channels[i].name, name) == 0) {
            return image->channels[i].data;
        }
    }
    return NULL;
}

// ---- reading --------------------------------------------------------------------------------

static int64_t stream_read(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const stream *s = user;
    (void)context, (void)error;
    if (offset >= s->size) {
        return 0;
    }
    uint64_t count = size < s->size - offset ? size : s->size - offset;
    memcpy(buffer, s->bytes + offset, (size_t)count);
    return (int64_t)count;
}

static int64_t stream_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const stream *)user)->size;
}

// A picture being read: the data window starts in line y0.
typedef struct picture {
    exr_context_t context;
    tyn_image_file *image;
    int32_t y0;
    exr_decode_pipeline_t decode;
    bool decoding;
    void *unread; // a line of a channel that is left out
} picture;

// Reads one chunk (a band of lines or a tile) whose upper left corner is at (x, y) of the image.
static exr_result_t read_chunk(picture *p, const exr_chunk_info_t *chunk, int32_t x, int32_t y)
{
    exr_result_t e = p->decoding ? exr_decoding_update(p->context, 0, chunk, &p->decode)
                                 : exr_decoding_initialize(p->context, 0, chunk, &p->decode);
    bool choose = !p->decoding;
    p->decoding = e == EXR_ERR_SUCCESS || p->decoding;
    if (e != EXR_ERR_SUCCESS) {
        return e;
    }
    if (x < 0 || y < 0 || (uint32_t)x + (uint32_t)chunk->width > p->image->width ||
        (uint32_t)y + (uint32_t)chunk->height > p->image->height) {
        return EXR_ERR_BAD_CHUNK_LEADER;
    }
    for (int16_t c = 0; c < p->decode.channel_count; c++) {
        exr_coding_channel_info_t *channel = &p->decode.channels[c];
        float *data = tyn_image_file_channel(p->image, channel->channel_name);
        if (!data) { // decoded all the same: the library has routines that do so with every channel
            channel->decode_to_ptr = p->unread;
            channel->user_pixel_stride = channel->bytes_per_element;
            channel->user_line_stride = 0;
            channel->user_bytes_per_element = channel->bytes_per_element;
            channel->user_data_type = channel->data_type;
            continue;
        }
        channel->decode_to_ptr = (uint8_t *)(data + (size_t)y * p->image->width + (size_t)x);
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(p->image->width * sizeof(float));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (choose) {
        e = exr_decoding_choose_default_routines(p->context, 0, &p->decode);
    }
    return e == EXR_ERR_SUCCESS ? exr_decoding_run(p->context, 0, &p->decode) : e;
}

// Tiles, or bands of lines, which are tiles as wide as the image.
static exr_result_t read_chunks(picture *p, bool tiled)
{
    int32_t width = (int32_t)p->image->width, height = 0;
    exr_result_t e = tiled ? exr_get_tile_sizes(p->context, 0, 0, 0, &width, &height)
                           : exr_get_scanlines_per_chunk(p->context, 0, &height);
    if (e == EXR_ERR_SUCCESS && (width < 1 || height < 1)) {
        return EXR_ERR_INVALID_ATTR;
    }
    for (int64_t y = 0; e == EXR_ERR_SUCCESS && y < p->image->height; y += height) {
        for (int64_t x = 0; e == EXR_ERR_SUCCESS && x < p->image->width; x += width) {
            exr_chunk_info_t chunk;
            e = tiled ? exr_read_tile_chunk_info(p->context, 0, (int)(x / width), (int)(y / height),
                                                 0, 0, &chunk)
                      : exr_read_scanline_chunk_info(p->context, 0, (int32_t)(p->y0 + y), &chunk);
            e = e == EXR_ERR_SUCCESS ? read_chunk(p, &chunk, (int32_t)x, (int32_t)y) : e;
        }
    }
    return e;
}

// Half and float channels of full resolution become channels of the image; others are left out.
static tyn_result add_channels(picture *p, const char *file, const tyn_log *log)
{
    const exr_attr_chlist_t *list;
    size_t pixels = (size_t)p->image->width * p->image->height;
    if (exr_get_channels(p->context, 0, &list) != EXR_ERR_SUCCESS || list->num_channels > 1024) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: has no list of at most 1024 channels", file);
    }
    p->image->channels = calloc((size_t)list->num_channels + 1, sizeof *p->image->channels);
    for (int c = 0; p->image->channels && c < list->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        if (entry->x_sampling != 1 || entry->y_sampling != 1) {
            return TYN_FAULT(log, TYN_ERR_PARAMS,
                             "%s: channel \"%.47s\" is subsampled: must have every pixel", file,
                             entry->name.str);
        }
        if ((entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT) ||
            (size_t)entry->name.length >= sizeof p->image->channels->name ||
            tyn_image_file_channel(p->image, entry->name.str)) {
            continue;
        }
        tyn_channel *channel = &p->image->channels[p->image->num_channels];
        snprintf(channel->name, sizeof channel->name, "%s", entry->name.str);
        channel->data = calloc(pixels, sizeof *channel->data);
        if (!channel->data) {
            return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for its %zu pixels", file, pixels);
        }
        p->image->num_channels++;
    }
    if (p->image->num_channels == 0) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: has no half or float channel", file);
    }
    return TYN_OK;
}

static tyn_result read_picture(picture *p, stream *s, const char *file, const tyn_log *log)
{
    exr_attr_box2i_t window;
    exr_storage_t storage;
    int parts = 0;
    exr_result_t e = exr_get_count(p->context, &parts);
    if (e == EXR_ERR_SUCCESS && parts != 1) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: has %d parts: must have one", file, parts);
    }
    e = e != EXR_ERR_SUCCESS ? e : exr_get_storage(p->context, 0, &storage);
    e = e != EXR_ERR_SUCCESS ? e : exr_get_data_window(p->context, 0, &window);
    if (e != EXR_ERR_SUCCESS) {
        return report(s, e, file, log);
    }
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: holds deep data: must be a flat image", file);
    }
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    // A compressed pixel takes some bits at least: a huge image in a small file is damage.
    if (width < 1 || height < 1 || width > TYN_MAX_IMAGE_SIDE || height > TYN_MAX_IMAGE_SIDE ||
        (uint64_t)(width * height) > TYN_MAX_PIXELS ||
        (uint64_t)(width * height) / 8192 > s->size) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: an image of %lld x %lld pixels in %llu bytes cannot be", file,
                         (long long)width, (long long)height, (unsigned long long)s->size);
    }
    p->image->width = (uint32_t)width;
    p->image->height = (uint32_t)height;
    p->y0 = window.min.y;
    exr_attr_box2i_t shown;
    if (exr_get_display_window(p->context, 0, &shown) == EXR_ERR_SUCCESS &&
        memcmp(&shown, &window, sizeof shown) != 0) {
        p->image->x = (int32_t)((int64_t)window.min.x - shown.min.x);
        p->image->y = (int32_t)((int64_t)window.min.y - shown.min.y);
        p->image->whole_width = (uint32_t)((int64_t)shown.max.x - shown.min.x + 1);
        p->image->whole_height = (uint32_t)((int64_t)shown.max.y - shown.min.y + 1);
    }
    tyn_result r = tyn_exr_read_attributes(p->context, p->image);
    s->message[0] = '\0'; // attributes that are missing are no fault
    r = r ? r : add_channels(p, file, log);
    if (r) {
        return r;
    }
    p->unread = malloc((size_t)width * sizeof(float));
    if (!p->unread) {
        return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory to read it", file);
    }
    e = read_chunks(p, storage == EXR_STORAGE_TILED);
    return e == EXR_ERR_SUCCESS ? TYN_OK : report(s, e, file, log);
}

tyn_result tyn_exr_parse(tyn_image_file *image, const void *bytes, size_t size, const char *file,
                         const tyn_log *log)
{
    stream s = {.bytes = (uint8_t *)(uintptr_t)bytes, .size = size}; // only read
    picture p = {.image = image};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_message;
    init.user_data = &s;
    init.read_fn = stream_read;
    init.size_fn = stream_size;
    init.max_image_width = init.max_image_height = TYN_MAX_IMAGE_SIDE;
    init.max_tile_width = init.max_tile_height = 4096;
    memset(image, 0, sizeof *image);
    exr_result_t e = exr_start_read(&p.context, file, &init);
    if (e == EXR_ERR_SUCCESS && s.message[0]) {
        e = EXR_ERR_INVALID_ATTR; // it complained, and went on with a guess
    }
    tyn_result r =
        e == EXR_ERR_SUCCESS ? read_picture(&p, &s, file, log) : report(&s, e, file, log);
    free(p.unread);
    if (p.decoding) {
        exr_decoding_destroy(p.context, &p.decode);
    }
    if (p.context) {
        exr_finish(&p.context);
    }
    if (r) {
        tyn_image_file_finish(image);
    }
    return r;
}

tyn_result tyn_exr_read(tyn_image_file *image, const char *path, const tyn_log *log)
{
    void *bytes;
    size_t size;
    if (!TYN_GIVEN(log, image, path)) {
        return TYN_ERR_PARAMS;
    }
    memset(image, 0, sizeof *image);
    tyn_result r = tyn_file_read(path, 1ull << 34, &bytes, &size, log);
    if (!r) {
        r = tyn_exr_parse(image, bytes, size, path, log);
        free(bytes);
    }
    return r;
}

// ---- writing --------------------------------------------------------------------------------

static int64_t stream_write(exr_const_context_t context, void *user, const void *buffer,
                            uint64_t size, uint64_t offset, exr_stream_error_func_ptr_t error)
{
    stream *s = user;
    if (offset + size > s->room) {
        uint64_t room = 2 * (offset + size);
        uint8_t *grown = realloc(s->bytes, (size_t)room);
        if (!grown) {
            error(context, EXR_ERR_OUT_OF_MEMORY, "no memory for the file");
            return -1;
        }
        memset(grown + s->room, 0, (size_t)(room - s->room));
        s->bytes = grown;
        s->room = room;
    }
    memcpy(s->bytes + offset, buffer, (size_t)size);
    s->size = offset + size > s->size ? offset + size : s->size;
    return (int64_t)size;
}

// Channel data as they are stored: halves, where values beyond their range saturate.
static uint16_t *to_half(const float *data, size_t count, uint64_t *saturated)
{
    uint16_t *half = malloc(count * sizeof *half);
    for (size_t i = 0; half && i < count; i++) {
        float v = data[i];
        if (isfinite(v) && fabsf(v) > 65504.0f) {
            ++*saturated;
            v = copysignf(65504.0f, v);
        }
        half[i] = tyn_half_from_float(v);
    }
    return half;
}

typedef exr_result_t (*compressor)(exr_encode_pipeline_t *encode);

// OpenEXR stores rows as they are if that is smaller, and readers tell by the size; but its version 3.1 leaves
// compressed ones that have just that size.
static exr_result_t compress_smaller(exr_encode_pipeline_t *encode)
{
    const compressor *library = encode->encoding_user_data;
    const exr_result_t e = (*library)(encode);
    if (e == EXR_ERR_SUCCESS && encode->compressed_bytes == encode->packed_bytes) {
        memcpy(encode->compressed_buffer, encode->packed_buffer, (size_t)encode->packed_bytes);
    }
    return e;
}

// A channel is stored as halves, or as it is.
static bool is_full(const tyn_channel *channel, bool full_float)
{
    return full_float || channel->exact;
}

static exr_result_t write_chunks(exr_context_t context, const tyn_image_file *image,
                                 void *const *data, bool full_float)
{
    compressor library = NULL;
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    bool encoding = false;
    int32_t step;
    exr_result_t e = exr_get_scanlines_per_chunk(context, 0, &step);
    for (uint32_t y = 0; e == EXR_ERR_SUCCESS && y < image->height; y += (uint32_t)step) {
        exr_chunk_info_t chunk;
        e = exr_write_scanline_chunk_info(context, 0, image->y + (int)y, &chunk);
        if (e != EXR_ERR_SUCCESS) {
            break;
        }
        e = encoding ? exr_encoding_update(context, 0, &chunk, &encode)
                     : exr_encoding_initialize(context, 0, &chunk, &encode);
        for (int16_t c = 0; e == EXR_ERR_SUCCESS && c < encode.channel_count; c++) {
            exr_coding_channel_info_t *channel = &encode.channels[c];
            uint32_t i = 0;
            while (strcmp(image->channels[i].name, channel->channel_name) != 0) {
                i++;
            }
            const size_t element = is_full(&image->channels[i], full_float) ? 4 : 2;
            channel->encode_from_ptr =
                (const uint8_t *)data[i] + (size_t)y * image->width * element;
            channel->user_pixel_stride = (int32_t)element;
            channel->user_line_stride = (int32_t)(image->width * element);
            channel->user_bytes_per_element = (int16_t)element;
            channel->user_data_type = element == 2 ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
        }
        if (e == EXR_ERR_SUCCESS && !encoding) {
            e = exr_encoding_choose_default_routines(context, 0, &encode);
            library = encode.compress_fn;
            encode.compress_fn = library ? compress_smaller : NULL;
            encode.encoding_user_data = &library;
        }
        encoding = true;
        e = e == EXR_ERR_SUCCESS ? exr_encoding_run(context, 0, &encode) : e;
    }
    if (encoding) {
        exr_encoding_destroy(context, &encode);
    }
    return e;
}

static exr_result_t set_windows(exr_context_t context, const tyn_image_file *image)
{
    exr_attr_box2i_t whole, part;
    whole.min.x = whole.min.y = 0;
    whole.max.x = (int32_t)image->whole_width - 1;
    whole.max.y = (int32_t)image->whole_height - 1;
    part.min.x = image->x;
    part.min.y = image->y;
    part.max.x = image->x + (int32_t)image->width - 1;
    part.max.y = image->y + (int32_t)image->height - 1;
    exr_result_t e = exr_set_display_window(context, 0, &whole);
    return e ? e : exr_set_data_window(context, 0, &part);
}

static exr_result_t write_picture(exr_context_t *context, const tyn_image_file *image,
                                  void *const *data, bool full_float, stream *s, const char *path)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part;
    init.error_handler_fn = drop_message;
    init.user_data = s;
    init.write_fn = stream_write;
    exr_result_t e = exr_start_write(context, path, EXR_WRITE_FILE_DIRECTLY, &init);
    e = e ? e : exr_set_longname_support(*context, 1);
    e = e ? e : exr_add_part(*context, "", EXR_STORAGE_SCANLINE, &part);
    e = e ? e
          : exr_initialize_required_attr_simple(*context, 0, (int32_t)image->width,
                                                (int32_t)image->height, EXR_COMPRESSION_ZIP);
    e = e || !image->whole_width ? e : set_windows(*context, image);
    for (uint32_t i = 0; !e && i < image->num_channels; i++) {
        e = exr_add_channel(*context, 0, image->channels[i].name,
                            is_full(&image->channels[i], full_float) ? EXR_PIXEL_FLOAT
                                                                     : EXR_PIXEL_HALF,
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    e = e ? e : tyn_exr_write_attributes(*context, image);
    e = e ? e : exr_write_header(*context);
    return e ? e : write_chunks(*context, image, data, full_float);
}

tyn_result tyn_exr_write(const tyn_image_file *image, const char *path, bool full_float,
                         const tyn_log *log)
{
    if (!TYN_GIVEN(log, image, path)) {
        return TYN_ERR_PARAMS;
    }
    size_t pixels = (size_t)image->width * image->height;
    uint64_t saturated = 0;
    stream s = {0};
    exr_context_t context = NULL;
    const void *channels = image->channels;
    if (image->num_channels && !TYN_GIVEN(log, channels)) {
        return TYN_ERR_PARAMS;
    }
    for (uint32_t i = 0; i < image->num_channels; i++) {
        if (!image->channels[i].data) {
            return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: channel '%s' has no data", path,
                             image->channels[i].name);
        }
    }
    if (image->num_channels == 0 || pixels == 0) {
        return TYN_FAULT(log, TYN_ERR_PARAMS,
                         "%s: an image of %u x %u pixels, %u channels: must be > 0", path,
                         image->width, image->height, image->num_channels);
    }
    tyn_result r = TYN_OK;
    void **data = calloc(image->num_channels, sizeof *data);
    for (uint32_t i = 0; data && !r && i < image->num_channels; i++) {
        data[i] = is_full(&image->channels[i], full_float)
                      ? (void *)image->channels[i].data
                      : to_half(image->channels[i].data, pixels, &saturated);
        r = data[i] ? TYN_OK : TYN_ERR_MEMORY;
    }
    if (!data || r) {
        r = TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory to write it", path);
    } else {
        exr_result_t e = write_picture(&context, image, data, full_float, &s, path);
        exr_result_t f = context ? exr_finish(&context) : EXR_ERR_SUCCESS; // writes the offsets
        if (e || f) {
            e = e ? e : f;
            say(&s, e, path, log);
            r = e == EXR_ERR_OUT_OF_MEMORY ? TYN_ERR_MEMORY : TYN_ERR_PARAMS;
        }
    }
    if (!r) {
        r = tyn_file_write(path, s.bytes, (size_t)s.size, log);
    }
    if (!r && saturated) {
        tyn_log_print(log, TYN_LOG_WARN, "%s: %llu values beyond 65504 were cut to fit half floats",
                      path, (unsigned long long)saturated);
    }
    for (uint32_t i = 0; data && i < image->num_channels; i++) {
        if (data[i] != image->channels[i].data) {
            free(data[i]);
        }
    }
    free(data);
    free(s.bytes);
    return r;
}
