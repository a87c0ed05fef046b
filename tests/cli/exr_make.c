// exr_make.c -- `exr_make FILE W H NAME=V,V,... ...`: a small float EXR with the values given, for the
// tests of the tool. "NAME=V" fills the channel with one value; V may be nan or inf. `exr_make FILE of OTHER NAME=V`: OTHER, with
// all it says of itself, and V in the first pixel of a channel.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

static int alter(const char *path, const char *other, const char *value)
{
    tyn_image_file image;
    const char *equals = strchr(value, '=');
    char name[48];
    snprintf(name, sizeof name, "%.*s", equals ? (int)(equals - value) : 0, value);
    if (tyn_exr_read(&image, other, NULL) != TYN_OK || !tyn_image_file_channel(&image, name)) {
        fprintf(stderr, "exr_make: '%s' has no channel '%s'\n", other, name);
        return 1;
    }
    tyn_image_file_channel(&image, name)[0] = strtof(equals + 1, NULL);
    tyn_result result = tyn_exr_write(&image, path, true, NULL);
    tyn_image_file_finish(&image);
    return result == TYN_OK ? 0 : 1;
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: exr_make FILE W H NAME=V,V,... ...\n");
        return 2;
    }
    if (strcmp(argv[2], "of") == 0) {
        return alter(argv[1], argv[3], argv[4]);
    }
    tyn_channel channels[16] = {0};
    tyn_image_file image = {
        .width = (uint32_t)atoi(argv[2]), .height = (uint32_t)atoi(argv[3]), .channels = channels};
    const size_t num = (size_t)image.width * image.height;
    for (int i = 4; i < argc && image.num_channels < 16; i++) {
        tyn_channel *c = &channels[image.num_channels++];
        char *at = strchr(argv[i], '=');
        if (!at) {
            fprintf(stderr, "exr_make: '%s' is not NAME=V,V,...\n", argv[i]);
            return 2;
        }
        snprintf(c->name, sizeof c->name, "%.*s", (int)(at - argv[i]), argv[i]);
        c->data = calloc(num, sizeof *c->data);
        for (size_t k = 0; c->data && k < num; k++) {
            c->data[k] = strtof(at + 1, NULL);
            char *comma = strchr(at + 1, ',');
            at = comma ? comma : at;
        }
    }
    tyn_result result = tyn_exr_write(&image, argv[1], true, NULL);
    for (uint32_t i = 0; i < image.num_channels; i++) {
        free(channels[i].data);
    }
    return result == TYN_OK ? 0 : 1;
}
