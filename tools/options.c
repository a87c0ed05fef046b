// options.c -- parses a command line by its table.
#include "options.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SEE_HELP "see 'tyndall %s --help'"

static void *field(void *args, const opt_group *group, const option *o)
{
    return (char *)args + group->offset + o->offset;
}

static void set_defaults(const command *cmd, void *args)
{
    memset(args, 0, cmd->args_size);
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        const opt_group *group = &cmd->groups[i];
        for (uint32_t k = 0; k < group->num_options; k++) {
            const option *o = &group->options[k];
            if (o->kind == OPT_UINT) {
                *(uint32_t *)field(args, group, o) = isnan(o->def) ? 0 : (uint32_t)o->def;
            } else if (o->kind == OPT_NUMBER) {
                *(float *)field(args, group, o) = (float)o->def;
            }
        }
    }
}

static const option *find(const command *cmd, const char *name, size_t length, char letter,
                          const opt_group **group)
{
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        for (uint32_t k = 0; k < cmd->groups[i].num_options; k++) {
            const option *o = &cmd->groups[i].options[k];
            bool by_letter = letter && o->letter == letter;
            bool by_name =
                name && o->name && strlen(o->name) == length && strncmp(o->name, name, length) == 0;
            if (by_letter || by_name) {
                *group = &cmd->groups[i];
                return o;
            }
        }
    }
    return NULL;
}

// One finite number and nothing after it, or up to `end` if that is given.
static bool number(const char *text, double *value, const char **end)
{
    char *stop;
    *value = strtod(text, &stop);
    if (end) {
        *end = stop;
    }
    return stop != text && isfinite(*value) && (end || *stop == '\0');
}

bool options_vector(const char *text, bool spread, float v[3])
{
    double value;
    if (spread && number(text, &value, NULL)) {
        v[0] = v[1] = v[2] = (float)value;
        return true;
    }
    for (int i = 0; i < 3; i++) {
        const char *end;
        if (!number(text, &value, &end) || *end != (i < 2 ? ',' : '\0')) {
            return false;
        }
        v[i] = (float)value;
        text = end + 1;
    }
    return true;
}

static bool whole(const char *text, uint32_t *value, const char **end)
{
    char *stop;
    if (*text < '0' || *text > '9') {
        return false;
    }
    unsigned long long n = strtoull(text, &stop, 10);
    *end = stop;
    *value = (uint32_t)n;
    return n <= UINT32_MAX;
}

static bool is_one_of(const char *text, const char *const *names)
{
    for (; *names; names++) {
        if (strcmp(text, *names) == 0) {
            return true;
        }
    }
    return false;
}

// What would be right, for the message.
static void expectation(const option *o, char *text, size_t size)
{
    switch (o->kind) {
    case OPT_UINT:
        if (o->max > 0) {
            snprintf(text, size, "a whole number from %.0f to %.0f", o->min, o->max);
        } else {
            snprintf(text, size, "a whole number from %.0f on", o->min);
        }
        break;
    case OPT_NUMBER:
        if (o->max > o->min) {
            snprintf(text, size, "a number from %g to %g", o->min, o->max);
        } else {
            snprintf(text, size, "a number");
        }
        break;
    case OPT_VECTOR:
        snprintf(text, size, "three numbers, %s", o->value);
        break;
    case OPT_COLOR:
        snprintf(text, size, "three numbers, %s, or one for all three", o->value);
        break;
    case OPT_SIZE:
        snprintf(text, size, "two whole numbers from 1 to 16384, %s", o->value);
        break;
    default: {
        size_t used = (size_t)snprintf(text, size, "one of:");
        for (const char *const *n = o->names; n && *n && used < size; n++) {
            used +=
                (size_t)snprintf(text + used, size - used, "%s %s", n == o->names ? "" : ",", *n);
        }
    }
    }
}

static bool store(const option *o, void *at, const char *text)
{
    double value;
    const char *end;
    switch (o->kind) {
    case OPT_FLAG:
        *(bool *)at = true;
        return true;
    case OPT_TEXT:
        *(const char **)at = text;
        return !o->names || is_one_of(text, o->names);
    case OPT_LIST: {
        opt_list *list = at;
        if (list->count == OPT_MAX_LIST) {
            return false;
        }
        list->items[list->count++] = text;
        return true;
    }
    case OPT_UINT: {
        uint32_t n;
        if (!whole(text, &n, &end) || *end || n < o->min || (o->max > 0 && n > o->max)) {
            return false;
        }
        *(uint32_t *)at = n;
        return true;
    }
    case OPT_NUMBER:
        if (!number(text, &value, NULL) ||
            (o->max > o->min && (value < o->min || value > o->max))) {
            return false;
        }
        *(float *)at = (float)value;
        return true;
    case OPT_VECTOR:
    case OPT_COLOR: {
        opt_vector *vector = at;
        vector->given = true;
        return options_vector(text, o->kind == OPT_COLOR, vector->v);
    }
    case OPT_SIZE: {
        opt_size *size = at;
        return whole(text, &size->width, &end) && *end == 'x' &&
               whole(end + 1, &size->height, &end) && *end == '\0' && size->width >= 1 &&
               size->width <= 16384 && size->height >= 1 && size->height <= 16384;
    }
    }
    return false;
}

static void printed_name(const option *o, char *text, size_t size)
{
    if (o->name) {
        snprintf(text, size, "--%s", o->name);
    } else {
        snprintf(text, size, "-%c", o->letter);
    }
}

// The long names of all options, one after another.
static const char *option_at(const void *user, uint32_t i)
{
    const command *cmd = user;
    for (uint32_t g = 0; g < cmd->num_groups; g++) {
        for (uint32_t k = 0; k < cmd->groups[g].num_options; k++) {
            const char *name = cmd->groups[g].options[k].name;
            if (name && i-- == 0) {
                return name;
            }
        }
    }
    return NULL;
}

// Takes the option at argv[*i] and moves *i past its value. False: wrong.
static opt_outcome take_option(const command *cmd, int argc, char **argv, int *i, void *args,
                               const tyn_log *log)
{
    const char *arg = argv[*i], *text = NULL;
    const opt_group *group;
    const option *o;
    if (strcmp(arg, "--help") == 0 || strcmp(arg, "-h") == 0) {
        return OPT_HELP;
    }
    if (arg[1] == '-') {
        const char *equals = strchr(arg, '=');
        size_t length = equals ? (size_t)(equals - arg - 2) : strlen(arg + 2);
        o = find(cmd, arg + 2, length, 0, &group);
        text = equals ? equals + 1 : NULL;
    } else {
        o = find(cmd, NULL, 0, arg[1], &group);
        text = arg[2] ? arg + 2 : NULL; // -Dname=value
    }
    if (!o) {
        char typed[64];
        snprintf(typed, sizeof typed, "%.*s", (int)strcspn(arg, "="), arg);
        const char *near = arg[1] == '-' ? options_nearest(typed + 2, option_at, cmd) : NULL;
        tyn_log_print(log, TYN_LOG_ERROR, "unknown option '%s'; %s%s%s" SEE_HELP, typed,
                      near ? "did you mean --" : "", near ? near : "", near ? "? " : "", cmd->name);
        return OPT_WRONG;
    }
    char name[64];
    printed_name(o, name, sizeof name);
    if (o->kind == OPT_FLAG) {
        if (text) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s takes no value; '%s' was given", name, text);
            return OPT_WRONG;
        }
    } else if (!text) {
        if (*i + 1 >= argc) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s needs a value, %s", name, o->value);
            return OPT_WRONG;
        }
        text = argv[++*i];
    }
    if (!store(o, field(args, group, o), text)) {
        if (o->kind == OPT_LIST) {
            tyn_log_print(log, TYN_LOG_ERROR, "%s: given more than %d times", name, OPT_MAX_LIST);
        } else {
            char right[256];
            expectation(o, right, sizeof right);
            tyn_log_print(log, TYN_LOG_ERROR, "%s: '%s' is not %s", name, text, right);
        }
        return OPT_WRONG;
    }
    return o->given && o->given(text, log) != TYN_OK ? OPT_WRONG : OPT_RUN;
}

opt_outcome options_parse(const command *cmd, int argc, char **argv, void *args, const tyn_log *log)
{
    set_defaults(cmd, args);
    uint32_t num_positionals = 0;
    bool only_positionals = false;
    for (int i = 0; i < argc; i++) {
        if (!only_positionals && strcmp(argv[i], "--") == 0) {
            only_positionals = true;
        } else if (!only_positionals && argv[i][0] == '-' && argv[i][1]) {
            opt_outcome outcome = take_option(cmd, argc, argv, &i, args, log);
            if (outcome != OPT_RUN) {
                return outcome;
            }
        } else if (num_positionals < cmd->num_positionals) {
            const opt_positional *p = &cmd->positionals[num_positionals++];
            *(const char **)((char *)args + p->offset) = argv[i];
            if (p->repeat) {
                ((opt_list *)((char *)args + p->offset))->count = 1;
            }
        } else if (num_positionals > 0 && cmd->positionals[num_positionals - 1].repeat) {
            const opt_positional *p = &cmd->positionals[num_positionals - 1];
            opt_list *list = (opt_list *)((char *)args + p->offset);
            if (list->count == OPT_MAX_LIST) {
                tyn_log_print(log, TYN_LOG_ERROR, "%s: given more than %d times", p->name,
                              OPT_MAX_LIST);
                return OPT_WRONG;
            }
            list->items[list->count++] = argv[i];
        } else {
            tyn_log_print(log, TYN_LOG_ERROR, "'%s' is one argument too many; " SEE_HELP, argv[i],
                          cmd->name);
            return OPT_WRONG;
        }
    }
    if (num_positionals < cmd->num_positionals && cmd->positionals[num_positionals].required) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s is missing (%s); " SEE_HELP,
                      cmd->positionals[num_positionals].name, cmd->positionals[num_positionals].doc,
                      cmd->name);
        return OPT_WRONG;
    }
    return options_check_files(cmd, args, log) ? OPT_RUN : OPT_WRONG;
}
