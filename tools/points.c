// points.c -- probe points from a CSV file.
#include "points.h"
#include <stdlib.h>
#include <string.h>
#include <tyndall/io.h>

static const uint64_t file_limit = 256u << 20;

static void trim(char *line)
{
    size_t length = strlen(line);
    while (length && strchr(" \t\r", line[length - 1])) {
        line[--length] = '\0';
    }
}

static bool is_header(const char *line)
{
    char *end;
    strtod(line, &end);
    return end == line;
}

static bool append(points *p, uint32_t *capacity, const float xyz[3])
{
    if (p->count == *capacity) {
        uint32_t more = *capacity ? 2 * *capacity : 64;
        void *grown = realloc(p->xyz, more * sizeof *p->xyz);
        if (!grown) {
            return false;
        }
        p->xyz = grown;
        *capacity = more;
    }
    memcpy(p->xyz[p->count++], xyz, sizeof *p->xyz);
    return true;
}

static int parse(app *a, const char *path, char *text, points *p)
{
    uint32_t capacity = 0, number = 0;
    bool first = true;
    for (char *line = text, *next; line; line = next) {
        next = strchr(line, '\n');
        if (next) {
            *next++ = '\0';
        }
        number++;
        line += strspn(line, " \t");
        trim(line);
        if (*line == '\0' || *line == '#') {
            continue;
        }
        float xyz[3];
        bool header = first && is_header(line);
        first = false;
        if (header) {
            continue;
        }
        if (!options_vector(line, false, xyz)) {
            app_error(a, "%s:%u: '%.60s' is not x,y,z, three finite numbers", path, number, line);
            return EXIT_WRONG;
        }
        if (!append(p, &capacity, xyz)) {
            return app_exit_code(a, TYN_ERR_MEMORY, false);
        }
    }
    if (p->count == 0) {
        app_error(a, "%s: holds no points; each line is x,y,z", path);
        return EXIT_WRONG;
    }
    return EXIT_DONE;
}

int points_read(app *a, const char *path, points *p)
{
    *p = (points){0};
    void *data = NULL;
    size_t size = 0;
    tyn_result result = tyn_file_read(path, file_limit, &data, &size, &a->log);
    if (result != TYN_OK) {
        return app_exit_code(a, result, true);
    }
    char *text = malloc(size + 1);
    int code = EXIT_FAILED;
    if (text) {
        memcpy(text, data, size);
        text[size] = '\0';
        code = parse(a, path, text, p);
        free(text);
    } else {
        app_error(a, "out of memory");
    }
    free(data);
    return code;
}

void points_finish(points *p)
{
    free(p->xyz);
    *p = (points){0};
}
