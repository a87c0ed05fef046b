// options_help.c -- the tables as `--help` and as a page of the documentation.
#include "options.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEFT_COLUMN = 27 };

static void usage_line(const command *cmd, const char *before, const char *after)
{
    printf("%styndall %s", before, cmd->name);
    for (uint32_t i = 0; i < cmd->num_positionals; i++) {
        const opt_positional *p = &cmd->positionals[i];
        printf(p->required ? " %s" : " [%s]", p->name);
    }
    printf("%s%s", cmd->num_groups ? " [options]" : "", after);
}

void options_left_side(const option *o, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    if (o->letter) {
        used += (size_t)snprintf(text, size, "-%c%s", o->letter, o->name ? ", " : "");
    }
    if (o->name) {
        used += (size_t)snprintf(text + used, size - used, "--%s", o->name);
    }
    if (o->value) {
        snprintf(text + used, size - used, " %s", o->value);
    }
}

void options_right_side(const option *o, char *text, size_t size)
{
    bool number = o->kind == OPT_UINT || o->kind == OPT_NUMBER;
    size_t used = 0;
    text[0] = '\0';
    if (!number) {
        return;
    }
    if (!isnan(o->def)) {
        used += (size_t)snprintf(text, size, "default %.10g", o->def);
    }
    if (o->max > o->min) {
        used += (size_t)snprintf(text + used, size - used, "%s%.10g to %.10g", used ? ", " : "",
                                 o->min, o->max);
    } else if (o->kind == OPT_UINT && o->min > 0) {
        used += (size_t)snprintf(text + used, size - used, "%sat least %.10g", used ? ", " : "",
                                 o->min);
    }
}

static void help_row(const char *left, const char *doc, const char *range)
{
    if (strlen(left) <= LEFT_COLUMN) {
        printf("  %-*s %s", LEFT_COLUMN, left, doc);
    } else {
        printf("  %s\n  %-*s %s", left, LEFT_COLUMN, "", doc);
    }
    if (range[0]) {
        printf(" [%s]", range);
    }
    printf("\n");
}

void options_help(const command *cmd)
{
    usage_line(cmd, "usage: ", "\n");
    printf("\n%s\n", cmd->summary);
    if (cmd->num_positionals) {
        printf("\narguments:\n");
        for (uint32_t i = 0; i < cmd->num_positionals; i++) {
            help_row(cmd->positionals[i].name, cmd->positionals[i].doc, "");
        }
    }
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        printf("\n%s:\n", cmd->groups[i].title);
        for (uint32_t k = 0; k < cmd->groups[i].num_options; k++) {
            char left[128], range[128];
            options_left_side(&cmd->groups[i].options[k], left, sizeof left);
            options_right_side(&cmd->groups[i].options[k], range, sizeof range);
            help_row(left, cmd->groups[i].options[k].doc, range);
        }
    }
    if (cmd->details) {
        printf("\n%s\n", cmd->details);
    }
}

// A bar would end the cell of a Markdown table.
static void markdown_text(const char *text)
{
    for (; *text; text++) {
        printf(*text == '|' ? "\\%c" : "%c", *text);
    }
}

void options_markdown(const command *cmd)
{
    printf("## tyndall %s\n\n%s\n\n", cmd->name, cmd->summary);
    usage_line(cmd, "    ", "\n\n");
    if (cmd->num_positionals) {
        printf("| argument | |\n|---|---|\n");
        for (uint32_t i = 0; i < cmd->num_positionals; i++) {
            printf("| `%s` | ", cmd->positionals[i].name);
            markdown_text(cmd->positionals[i].doc);
            printf(" |\n");
        }
        printf("\n");
    }
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        const opt_group *group = &cmd->groups[i];
        printf("| %s | | default, range |\n|---|---|---|\n", group->title);
        for (uint32_t k = 0; k < group->num_options; k++) {
            char left[128], range[128];
            options_left_side(&group->options[k], left, sizeof left);
            options_right_side(&group->options[k], range, sizeof range);
            printf("| `");
            markdown_text(left);
            printf("` | ");
            markdown_text(group->options[k].doc);
            printf(" | %s |\n", range);
        }
        printf("\n");
    }
    if (cmd->details) {
        printf("%s\n\n", cmd->details);
    }
}
