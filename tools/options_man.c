// options_man.c -- the tables as manual pages (man, section 1).
#include "options.h"
#include <stdio.h>
#include <string.h>

// Text in which nothing is a request or an escape of roff; lines stay lines.
static void man_text(const char *text)
{
    bool start = true;
    for (; *text; text++) {
        if (start && (*text == '.' || *text == '\'')) {
            printf("\\&");
        }
        printf(*text == '\\' ? "\\e" : *text == '-' ? "\\-" : "%c", *text);
        start = *text == '\n';
    }
}

void options_man_title(const char *name, const char *summary)
{
    printf(".TH %s 1 \"\" \"tyndall %s\" \"User Commands\"\n.SH NAME\n%s \\- ", name,
           tyn_version_string(), name);
    man_text(summary);
    printf("\n");
}

static void man_option(const option *o)
{
    char left[128], range[128];
    options_left_side(o, left, sizeof left);
    options_right_side(o, range, sizeof range);
    printf(".TP\n.B ");
    man_text(left);
    printf("\n");
    man_text(o->doc);
    if (range[0]) {
        printf(" [");
        man_text(range);
        printf("]");
    }
    printf("\n");
}

void options_man(const command *cmd)
{
    char name[64];
    snprintf(name, sizeof name, "tyndall-%s", cmd->name);
    options_man_title(name, cmd->summary);
    printf(".SH SYNOPSIS\n.B tyndall %s", cmd->name);
    for (uint32_t i = 0; i < cmd->num_positionals; i++) {
        printf(cmd->positionals[i].required ? " %s" : " [%s]", cmd->positionals[i].name);
    }
    printf("%s\n", cmd->num_groups ? " [options]" : "");
    if (cmd->num_positionals) {
        printf(".SH ARGUMENTS\n");
    }
    for (uint32_t i = 0; i < cmd->num_positionals; i++) {
        printf(".TP\n.I %s\n", cmd->positionals[i].name);
        man_text(cmd->positionals[i].doc);
        printf("\n");
    }
    if (cmd->num_groups) {
        printf(".SH OPTIONS\n");
    }
    for (uint32_t i = 0; i < cmd->num_groups; i++) {
        printf(".SS ");
        man_text(cmd->groups[i].title);
        printf("\n");
        for (uint32_t k = 0; k < cmd->groups[i].num_options; k++) {
            man_option(&cmd->groups[i].options[k]);
        }
    }
    if (cmd->details) {
        printf(".SH DETAILS\n.nf\n");
        man_text(cmd->details);
        printf("\n.fi\n");
    }
    printf(".SH EXIT STATUS\n0 done; 2 the arguments or the input are wrong; 1 anything else; 130 "
           "interrupted.\n"
           ".SH SEE ALSO\n.BR tyndall (1)\n");
}
