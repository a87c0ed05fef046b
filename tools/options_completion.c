// options_completion.c -- the tables as completions of bash, zsh and fish.
#include "options.h"
#include <stdio.h>
#include <string.h>

// In single quotes of a shell; brackets and colons end parts of a specification of zsh.
static void quoted(const char *text, bool zsh)
{
    for (; *text; text++) {
        if (*text == '\'') {
            printf("'\\''");
        } else if (zsh && (*text == '[' || *text == ']' || *text == ':')) {
            printf("\\%c", *text);
        } else {
            printf("%c", *text);
        }
    }
}

static void bash_options(const command *cmd)
{
    for (uint32_t g = 0; g < cmd->num_groups; g++) {
        for (uint32_t i = 0; i < cmd->groups[g].num_options; i++) {
            const option *o = &cmd->groups[g].options[i];
            if (o->name) {
                printf(" --%s", o->name);
            } else {
                printf(" -%c", o->letter);
            }
        }
    }
}

// A case for each option that allows certain words.
static void bash_words(const command *cmd)
{
    for (uint32_t g = 0; g < cmd->num_groups; g++) {
        for (uint32_t i = 0; i < cmd->groups[g].num_options; i++) {
            const option *o = &cmd->groups[g].options[i];
            if (!o->names || !o->name) {
                continue;
            }
            printf("    %s:--%s", cmd->name, o->name);
            if (o->letter) {
                printf(" | %s:-%c", cmd->name, o->letter);
            }
            printf(") words='");
            for (const char *const *n = o->names; *n; n++) {
                printf("%s%s", n == o->names ? "" : " ", *n);
            }
            printf("' ;;\n");
        }
    }
}

void options_bash(const command *const *commands, size_t count)
{
    printf("# bash completion of tyndall, made by 'tyndall --completion bash'\n"
           "_tyndall() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=''\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
           "        COMPREPLY=($(compgen -W '--help --version");
    for (size_t i = 0; i < count; i++) {
        printf(" %s", commands[i]->name);
    }
    printf("' -- \"$word\"))\n        return\n    fi\n    case ${COMP_WORDS[1]}:$before in\n");
    for (size_t i = 0; i < count; i++) {
        bash_words(commands[i]);
    }
    printf("    esac\n    if [ -z \"$words\" ]; then\n        case $word in\n"
           "        -*) case ${COMP_WORDS[1]} in\n");
    for (size_t i = 0; i < count; i++) {
        printf("            %s) words='--help", commands[i]->name);
        bash_options(commands[i]);
        printf("' ;;\n");
    }
    printf("            esac ;;\n        esac\n    fi\n"
           "    if [ -n \"$words\" ]; then\n"
           "        COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
           "    else\n        COMPREPLY=($(compgen -f -- \"$word\"))\n    fi\n}\n"
           "complete -o filenames -F _tyndall tyndall\n");
}

static void zsh_option(const option *o)
{
    const bool flag = o->kind == OPT_FLAG, list = o->kind == OPT_LIST;
    printf(" \\\n            ");
    if (o->letter && o->name) {
        printf("'%s'{-%c,--%s}'", list ? "*" : "", o->letter, o->name);
    } else if (o->name) {
        printf("'%s--%s", list ? "*" : "", o->name);
    } else {
        printf("'%s-%c", list ? "*" : "", o->letter);
    }
    printf("[");
    quoted(o->doc, true);
    printf("]");
    if (!flag) {
        printf(":");
        quoted(o->value ? o->value : "value", true);
        printf(":");
        if (o->names) {
            printf("(");
            for (const char *const *n = o->names; *n; n++) {
                printf("%s%s", n == o->names ? "" : " ", *n);
            }
            printf(")");
        } else {
            printf("_files");
        }
    }
    printf("'");
}

void options_zsh(const command *const *commands, size_t count)
{
    printf("#compdef tyndall\n# zsh completion of tyndall, made by 'tyndall --completion zsh'\n"
           "local -a commands\ncommands=(\n");
    for (size_t i = 0; i < count; i++) {
        printf("    '%s:", commands[i]->name);
        quoted(commands[i]->summary, true);
        printf("'\n");
    }
    printf(")\nif (( CURRENT == 2 )); then\n    _describe command commands\nelse\n"
           "    case $words[2] in\n");
    for (size_t i = 0; i < count; i++) {
        const command *cmd = commands[i];
        printf("    %s)\n        _arguments '--help[list the arguments]'", cmd->name);
        for (uint32_t g = 0; g < cmd->num_groups; g++) {
            for (uint32_t k = 0; k < cmd->groups[g].num_options; k++) {
                zsh_option(&cmd->groups[g].options[k]);
            }
        }
        printf(" '*:file:_files' ;;\n");
    }
    printf("    esac\nfi\n");
}

void options_fish(const command *const *commands, size_t count)
{
    printf("# fish completion of tyndall, made by 'tyndall --completion fish'\n");
    for (size_t i = 0; i < count; i++) {
        const command *cmd = commands[i];
        printf("complete -c tyndall -n __fish_use_subcommand -f -a %s -d '", cmd->name);
        quoted(cmd->summary, false);
        printf("'\n");
        for (uint32_t g = 0; g < cmd->num_groups; g++) {
            for (uint32_t k = 0; k < cmd->groups[g].num_options; k++) {
                const option *o = &cmd->groups[g].options[k];
                printf("complete -c tyndall -n '__fish_seen_subcommand_from %s'", cmd->name);
                if (o->letter) {
                    printf(" -s %c", o->letter);
                }
                if (o->name) {
                    printf(" -l %s", o->name);
                }
                printf(o->kind == OPT_FLAG ? "" : " -r");
                if (o->names) {
                    printf(" -f -a '");
                    for (const char *const *n = o->names; *n; n++) {
                        printf("%s%s", n == o->names ? "" : " ", *n);
                    }
                    printf("'");
                }
                printf(" -d '");
                quoted(o->doc, false);
                printf("'\n");
            }
        }
    }
}
