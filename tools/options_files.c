// options_files.c -- what a command line reads and writes: nothing is written over an input, nor two results to one file.
#include "app.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_FILES = 2 * OPT_MAX_LIST };

// A file that the command line names, and by which option or argument.
typedef struct named_file {
    const char *path;
    const opt_positional *positional; // NULL: by an option
    const option *option;
    bool written;
} named_file;

typedef struct named_files {
    named_file files[MAX_FILES];
    uint32_t count;
} named_files;

static void add(named_files *all, named_file file)
{
    if (file.path && all->count < MAX_FILES) {
        all->files[all->count++] = file;
    }
}

static void add_options(named_files *all, const opt_group *group, const void *args)
{
    for (uint32_t i = 0; i < group->num_options; i++) {
        const option *o = &group->options[i];
        const void *at = (const char *)args + group->offset + o->offset;
        if (o->file == OPT_NO_FILE) {
            continue;
        }
        const opt_list *list = o->kind == OPT_LIST ? at : NULL;
        for (uint32_t k = 0; k < (list ? list->count : 1); k++) {
            add(all, (named_file){list ? list->items[k] : *(const char *const *)at, NULL, o,
                                  o->file == OPT_WRITES});
        }
    }
}

// The folder's real name and the file's: what a file has that is not there yet.
static bool whole_name(const char *path, char whole[PATH_MAX])
{
    const char *slash = strrchr(path, '/');
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1,
             slash ? path : ".");
    char *real = realpath(folder, NULL);
    const int length =
        real ? snprintf(whole, PATH_MAX, "%s/%s", real, slash ? slash + 1 : path) : PATH_MAX;
    free(real);
    return length < PATH_MAX;
}

// Devices may be written to by all.
static bool is_same_file(const char *a, const char *b)
{
    struct stat x, y;
    char whole_a[PATH_MAX], whole_b[PATH_MAX];
    const bool there_a = stat(a, &x) == 0, there_b = stat(b, &y) == 0;
    if (there_a && there_b) {
        return S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    }
    return !there_a && !there_b && whole_name(a, whole_a) && whole_name(b, whole_b) &&
           strcmp(whole_a, whole_b) == 0;
}

static void print_name(const named_file *file, char *text, size_t size)
{
    if (file->positional) {
        snprintf(text, size, "%s", file->positional->name);
    } else if (file->option->letter) {
        snprintf(text, size, "-%c", file->option->letter);
    } else {
        snprintf(text, size, "--%s", file->option->name);
    }
}

bool options_check_files(const command *cmd, const void *args, const tyn_log *log)
{
    named_files all = {.count = 0};
    for (uint32_t i = 0; i < cmd->num_positionals; i++) {
        const opt_positional *p = &cmd->positionals[i];
        const void *at = (const char *)args + p->offset;
        const opt_list *list = p->repeat ? at : NULL;
        for (uint32_t k = 0; k < (list ? list->count : 1); k++) {
            add(&all,
                (named_file){list ? list->items[k] : *(const char *const *)at, p, NULL, false});
        }
    }
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        add_options(&all, &cmd->groups[i], args);
    }
    for (uint32_t i = 0; i < all.count; i++) {
        for (uint32_t k = i + 1; k < all.count; k++) {
            const named_file *a = &all.files[i], *b = &all.files[k];
            if (!(a->written || b->written) || !is_same_file(a->path, b->path)) {
                continue;
            }
            char first[64], second[64];
            print_name(a, first, sizeof first);
            print_name(b, second, sizeof second);
            tyn_log_print(log, TYN_LOG_ERROR, "%s '%s' and %s '%s' are the same file: %s", first,
                          a->path, second, b->path,
                          a->written && b->written ? "the second would replace the first"
                                                   : "the input would be lost");
            return false;
        }
    }
    return true;
}
