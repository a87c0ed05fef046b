// uri.c -- resolves uris; joins what a reader says with the place that named its file.
#include "io/uri.h"
#include <tyndall/io.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int hex(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

// Puts the number in the place of the first run of '#' behind `base`, which there must be; a new string.
static char *put_number(const char *path, size_t base, uint32_t number)
{
    const char *at = strchr(path + base, '#');
    const int width = (int)strspn(at, "#"), before = (int)(at - path);
    char *out = malloc(strlen(path) + 16);
    if (out) {
        sprintf(out, "%.*s%0*u%s", before, path, width, number, at + width);
    }
    return out;
}

char *tyn_uri_path(const json_doc *doc, const cJSON *uri)
{
    if (!cJSON_IsString(uri) || !uri->valuestring[0]) {
        tyn_json_fault(doc, uri, "must be the name of a file");
        return NULL;
    }
    const char *p = uri->valuestring;
    if (strncmp(p, "data:", 5) == 0 || strstr(p, "://")) {
        tyn_json_fault(doc, uri, "must be a file beside the scene, not data or a web address");
        return NULL;
    }
    const char *slash = strrchr(doc->file, '/');
    size_t base = slash && p[0] != '/' ? (size_t)(slash - doc->file) + 1 : 0;
    char *path = malloc(base + strlen(p) + 1), *out = path + base;
    if (!path) {
        tyn_json_fault(doc, uri, "no memory for its path");
        return NULL;
    }
    memcpy(path, doc->file, base);
    for (; *p; p++) {
        if (*p == '%' && hex(p[1]) >= 0 && hex(p[2]) >= 0) {
            *out = (char)(hex(p[1]) * 16 + hex(p[2]));
            p += 2;
        } else {
            *out = *p;
        }
        if (!*out++) {
            tyn_json_fault(doc, uri, "a file name holds no zero byte");
            free(path);
            return NULL;
        }
    }
    *out = 0;
    if (doc->frame && strchr(path + base, '#')) {
        char *numbered = put_number(path, base, *doc->frame);
        free(path);
        path = numbered;
        if (!path) {
            tyn_json_fault(doc, uri, "no memory for its path");
        }
    }
    if (path && !doc->frame && strchr(path + base, '#') && access(path, F_OK) != 0) {
        tyn_json_fault(doc, uri,
                       "names the pictures of a sequence: say which (--frame N), or render "
                       "a range (--frames A-B)");
        free(path);
        path = NULL;
    }
    return path;
}

static void keep(void *user, tyn_log_level level, const char *message)
{
    tyn_capture *capture = user;
    if (level == TYN_LOG_ERROR && !capture->message[0]) {
        snprintf(capture->message, sizeof capture->message, "%s", message);
    }
}

void tyn_capture_init(tyn_capture *capture)
{
    *capture = (tyn_capture){.log = {keep, capture, TYN_LOG_ERROR}};
}

tyn_result tyn_uri_read(const json_doc *doc, const cJSON *uri, void **bytes, size_t *size,
                        bool *missing)
{
    tyn_capture capture;
    tyn_capture_init(&capture);
    char *path = tyn_uri_path(doc, uri);
    if (!path) {
        return TYN_ERR_PARAMS;
    }
    const tyn_result r = tyn_file_read(path, 1ull << 31, bytes, size, &capture.log);
    const bool there = access(path, F_OK) == 0 || (errno != ENOENT && errno != ENOTDIR);
    free(path);
    if (missing && r == TYN_ERR_IO && !there) {
        *missing = true;
        return TYN_OK;
    }
    return r ? tyn_capture_fault(&capture, doc, uri, r) : TYN_OK;
}

tyn_result tyn_capture_fault(const tyn_capture *capture, const json_doc *doc, const cJSON *uri,
                             tyn_result r)
{
    tyn_json_fault(doc, uri, "%.400s", capture->message);
    return r;
}
