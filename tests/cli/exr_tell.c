// exr_tell.c -- `exr_tell FILE`: what the header of an EXR file says, a line each: "channel NAME half|float",
// "attribute NAME VALUE...". `exr_tell FILE NAME X Y`: a pixel of a channel.
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <tyndall/io.h>

static int tell_pixel(const char *path, const char *name, uint32_t x, uint32_t y)
{
    tyn_image_file file;
    if (tyn_exr_read(&file, path, NULL) != TYN_OK) {
        return 1;
    }
    const float *plane = tyn_image_file_channel(&file, name);
    const bool there = plane && x < file.width && y < file.height;
    if (there) {
        printf("%.9g\n", (double)plane[(size_t)y * file.width + x]);
    }
    tyn_image_file_finish(&file);
    return there ? 0 : 1;
}

static void tell_attributes(const char *path)
{
    tyn_image_file file;
    if (tyn_exr_read(&file, path, NULL) != TYN_OK) {
        exit(1);
    }
    for (uint32_t i = 0; i < file.num_attributes; i++) {
        static const int counts[] = {0, 1, 1, 16, 8};
        const tyn_attribute *a = &file.attributes[i];
        printf("attribute %s%s%s", a->name, a->text ? " " : "", a->text ? a->text : "");
        for (int k = 0; k < counts[a->kind]; k++) {
            printf(" %.9g", a->values[k]);
        }
        printf("\n");
    }
    printf("attribute screenWindowWidth %.9g\n", (double)file.screen_width);
    tyn_image_file_finish(&file);
}

int main(int argc, char **argv)
{
    if (argc == 5) {
        return tell_pixel(argv[1], argv[2], (uint32_t)atoi(argv[3]), (uint32_t)atoi(argv[4]));
    }
    exr_context_t context = NULL;
    const exr_attr_chlist_t *list;
    if (argc != 2 || exr_start_read(&context, argv[1], NULL) != EXR_ERR_SUCCESS ||
        exr_get_channels(context, 0, &list) != EXR_ERR_SUCCESS) {
        fprintf(stderr, "usage: exr_tell FILE.exr [CHANNEL X Y]\n");
        return 2;
    }
    for (int i = 0; i < list->num_channels; i++) {
        printf("channel %s %s\n", list->entries[i].name.str,
               list->entries[i].pixel_type == EXR_PIXEL_FLOAT ? "float" : "half");
    }
    exr_finish(&context);
    tell_attributes(argv[1]);
    return 0;
}
