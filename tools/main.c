// main.c -- the tyndall tool: picks the subcommand.
#include "app.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const command *const commands[] = {
    &cmd_render, &cmd_compare, &cmd_merge, &cmd_probe,    &cmd_balance, &cmd_fluxes,
    &cmd_bench,  &cmd_graph,   &cmd_info,  &cmd_selftest, &cmd_view,
};

static void print_help(FILE *to)
{
    fprintf(to, "usage: tyndall COMMAND [arguments]\n\n"
                "Light in participating media (smoke, cloud, fog, milk) with Vulkan compute.\n\n");
    for (size_t i = 0; i < ARRAY_SIZE(commands); i++) {
        fprintf(to, "  %-10s %s\n", commands[i]->name, commands[i]->summary);
    }
    fprintf(to, "\n'tyndall help COMMAND' lists the arguments; 'tyndall --version' the version;\n"
                "'tyndall --completion SHELL' completes them in bash, zsh or fish; 'tyndall --man\n"
                "[COMMAND]' is a manual page.\n"
                "Exit codes: 0 done; 2 the arguments or the input are wrong; 1 anything else;\n"
                "130 interrupted.\n");
}

static void print_markdown(void)
{
    printf(
        "# The command line\n\n"
        "This page is made by `tyndall --help-markdown` from the tables behind `--help`.\n\n"
        "Progress goes to stderr, results to stdout or to files; machine-readable results are "
        "JSON. Files are\nwritten under a temporary name and renamed. The same inputs, seed and "
        "device give the same bytes.\n\n"
        "Exit codes: 0 done; 2 the arguments or the input are wrong (one line: what, where, what "
        "would be right);\n1 anything else; 130 interrupted: what `render` has of a method that "
        "samples is "
        "written, of all else nothing.\n\n");
    for (size_t i = 0; i < ARRAY_SIZE(commands); i++) {
        options_markdown(commands[i]);
    }
}

// Of one command, or of the program. False: there is no such command.
static bool print_man(const char *name)
{
    for (size_t i = 0; name && i < ARRAY_SIZE(commands); i++) {
        if (strcmp(name, commands[i]->name) == 0) {
            options_man(commands[i]);
            return true;
        }
    }
    if (name) {
        return false;
    }
    options_man_title("tyndall",
                      "light in participating media (smoke, cloud, fog, milk) with Vulkan compute");
    printf(".SH SYNOPSIS\n.B tyndall COMMAND [arguments]\n.SH COMMANDS\n");
    for (size_t i = 0; i < ARRAY_SIZE(commands); i++) {
        printf(".TP\n.BR tyndall\\-%s (1)\n%s\n", commands[i]->name, commands[i]->summary);
    }
    printf(
        ".SH EXIT STATUS\n0 done; 2 the arguments or the input are wrong (one line: what, where, "
        "what would be right); 1 anything else; 130 interrupted.\n");
    return true;
}

static bool print_completion(const char *shell)
{
    static const struct {
        const char *shell;
        void (*print)(const command *const *commands, size_t count);
    } shells[] = {{"bash", options_bash}, {"zsh", options_zsh}, {"fish", options_fish}};
    for (size_t i = 0; shell && i < ARRAY_SIZE(shells); i++) {
        if (strcmp(shell, shells[i].shell) == 0) {
            shells[i].print(commands, ARRAY_SIZE(commands));
            return true;
        }
    }
    return false;
}

static const char *command_at(const void *user, uint32_t i)
{
    (void)user;
    return i < ARRAY_SIZE(commands) ? commands[i]->name : NULL;
}

static void unknown_command(app *a, const char *name)
{
    const char *near = options_nearest(name, command_at, NULL);
    app_error(a, "unknown command '%s'; %s%s%s'tyndall --help' lists them", name,
              near ? "did you mean '" : "", near ? near : "", near ? "'? " : "");
}

// 'help' alone or with the name of a command. Gives the exit code.
static int print_help_of(app *a, const char *name)
{
    for (size_t i = 0; name && i < ARRAY_SIZE(commands); i++) {
        if (strcmp(name, commands[i]->name) == 0) {
            options_help(commands[i]);
            return EXIT_DONE;
        }
    }
    if (name) {
        unknown_command(a, name);
        return EXIT_WRONG;
    }
    print_help(stdout);
    return EXIT_DONE;
}

static int run_command(app *a, const command *cmd, int argc, char **argv)
{
    a->command = cmd->name;
    void *args = calloc(1, cmd->args_size);
    if (!args) {
        app_error(a, "out of memory");
        return EXIT_FAILED;
    }
    int code = EXIT_WRONG;
    switch (options_parse(cmd, argc, argv, args, &a->log)) {
    case OPT_HELP:
        options_help(cmd);
        code = EXIT_DONE;
        break;
    case OPT_RUN:
        code = cmd->run(a, args);
        break;
    case OPT_WRONG:
        break;
    }
    progress_stop(&a->bar);
    free(args);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        app_error(a, "the results cannot be written to stdout");
        code = code == EXIT_DONE ? EXIT_FAILED : code;
    }
    return code;
}

int main(int argc, char **argv)
{
    app a;
    app_init(&a);
    const char *name = argc > 1 ? argv[1] : "";
    for (size_t i = 0; i < ARRAY_SIZE(commands); i++) {
        if (strcmp(name, commands[i]->name) == 0) {
            return run_command(&a, commands[i], argc - 2, argv + 2);
        }
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        return print_help_of(&a, argc > 2 ? argv[2] : NULL);
    }
    if (strcmp(name, "--version") == 0) {
        printf("tyndall %s\n", tyn_version_string());
        return EXIT_DONE;
    }
    if (strcmp(name, "--help-markdown") == 0) {
        print_markdown();
        return EXIT_DONE;
    }
    if (strcmp(name, "--man") == 0 && print_man(argc > 2 ? argv[2] : NULL)) {
        return EXIT_DONE;
    }
    if (strcmp(name, "--completion") == 0) {
        if (print_completion(argc > 2 ? argv[2] : NULL)) {
            return EXIT_DONE;
        }
        app_error(&a, "--completion: must be bash, zsh or fish");
        return EXIT_WRONG;
    }
    if (argc < 2) {
        print_help(stderr);
    } else {
        unknown_command(&a, name);
    }
    return EXIT_WRONG;
}
