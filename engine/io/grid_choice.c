// grid_choice.c -- which grid of a file is meant: by name, and by what names mean.
#include "io/volume.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

// As OpenVDB's samples, Houdini, Blender and EmberGen call them. The first that fits counts.
static const struct {
    const char *word; // what a name begins with, in either case; "=": is
    tyn_grid_role role;
} words[] = {
    {"density", TYN_ROLE_DENSITY},    {"=dens", TYN_ROLE_DENSITY},
    {"smoke", TYN_ROLE_DENSITY},      {"soot", TYN_ROLE_DENSITY},
    {"fog", TYN_ROLE_DENSITY},        {"cloud", TYN_ROLE_DENSITY},
    {"extinction", TYN_ROLE_DENSITY}, {"temp", TYN_ROLE_HEAT},
    {"heat", TYN_ROLE_HEAT},          {"flame", TYN_ROLE_HEAT},
    {"fire", TYN_ROLE_HEAT},          {"fuel", TYN_ROLE_HEAT},
    {"burn", TYN_ROLE_HEAT},          {"react", TYN_ROLE_HEAT},
    {"blackbody", TYN_ROLE_HEAT},     {"emission", TYN_ROLE_EMISSION},
    {"emit", TYN_ROLE_EMISSION},      {"incandescence", TYN_ROLE_EMISSION},
    {"=cd", TYN_ROLE_COLOR},          {"color", TYN_ROLE_COLOR},
    {"colour", TYN_ROLE_COLOR},       {"albedo", TYN_ROLE_COLOR},
    {"scatter", TYN_ROLE_COLOR},      {"vel", TYN_ROLE_VELOCITY},
    {"=v", TYN_ROLE_VELOCITY},        {"v.", TYN_ROLE_VELOCITY},
    {"motion", TYN_ROLE_VELOCITY},    {"=vx", TYN_ROLE_VELOCITY},
    {"=vy", TYN_ROLE_VELOCITY},       {"=vz", TYN_ROLE_VELOCITY},
    {"pressure", TYN_ROLE_OTHER},     {"diverg", TYN_ROLE_OTHER},
    {"vort", TYN_ROLE_OTHER},         {"surface", TYN_ROLE_OTHER},
    {"distance", TYN_ROLE_OTHER},     {"sdf", TYN_ROLE_OTHER},
    {"collision", TYN_ROLE_OTHER},    {"rest", TYN_ROLE_OTHER},
    {"shadow", TYN_ROLE_OTHER},
};

tyn_grid_role tyn_grid_role_of(const char *name)
{
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        const char *word = words[k].word;
        if (word[0] == '=' ? strcasecmp(name, word + 1) == 0
                           : strncasecmp(name, word, strlen(word)) == 0) {
            return words[k].role;
        }
    }
    return TYN_ROLE_UNKNOWN;
}

static void add(char *text, size_t room, const char *separator, const char *name, const char *type)
{
    const size_t used = strlen(text);
    snprintf(text + used, room - used, "%s\"%.60s\" (%s)", used ? separator : "", name, type);
}

static int find(const tyn_grid_entry *grids, uint32_t count, const tyn_grid_job *job)
{
    int best = -1, rank = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (job->grid) {
            if (strcmp(grids[i].name, job->grid) == 0) {
                return (int)i;
            }
            continue;
        }
        const tyn_grid_role role = tyn_grid_role_of(grids[i].name);
        const int now = !grids[i].scalar                        ? 0
                        : strcmp(grids[i].name, "density") == 0 ? 3
                        : role == TYN_ROLE_DENSITY              ? 2
                        : role == TYN_ROLE_UNKNOWN              ? 1
                                                                : 0;
        if (now > rank) {
            rank = now;
            best = (int)i;
        }
    }
    return best;
}

// Of the other grids those that somebody may look for.
static void tell_others(tyn_grid_job *job, const tyn_grid_entry *grids, uint32_t count, int chosen)
{
    static const char *const words_of[] = {
        [TYN_ROLE_HEAT] =
            "heat: \"temperature\" of a scene's medium, or \"emission_density\", has it glow",
        [TYN_ROLE_EMISSION] = "\"emission_density\" of a scene's medium has it glow",
        [TYN_ROLE_COLOR] = "\"albedo\" of a scene's medium reads it",
        [TYN_ROLE_VELOCITY] = "velocity: media do not move while a picture is taken",
    };
    job->left_out[0] = '\0';
    for (int role = TYN_ROLE_HEAT; role <= TYN_ROLE_VELOCITY; role++) {
        char names[160] = "";
        for (uint32_t i = 0; i < count; i++) {
            const bool is = (int)i != chosen && !(job->used >> role & 1) &&
                            (int)tyn_grid_role_of(grids[i].name) == role;
            if (is && strlen(names) < 100) {
                const size_t used = strlen(names);
                snprintf(names + used, sizeof names - used, "%s\"%.40s\"", used ? ", " : "",
                         grids[i].name);
            }
        }
        const size_t used = strlen(job->left_out);
        if (names[0]) {
            snprintf(job->left_out + used, sizeof job->left_out - used, "%s%s (%s)",
                     used ? "; " : "", names, words_of[role]);
        }
    }
}

int tyn_volume_choose(tyn_grid_job *job, const tyn_grid_entry *grids, uint32_t count,
                      const char *file)
{
    const int chosen = find(grids, count, job);
    if (chosen >= 0 && !job->grid && tyn_grid_role_of(grids[chosen].name) == TYN_ROLE_UNKNOWN) {
        for (uint32_t i = 0; i < count; i++) {
            job->guessed |= (int)i != chosen && grids[i].scalar;
        }
    }
    if (chosen >= 0 &&
        (grids[chosen].scalar || (job->use == TYN_GRID_COLOR && grids[chosen].vector))) {
        tell_others(job, grids, count, chosen);
        return chosen;
    }
    if (chosen >= 0) {
        return TYN_FAULT(job->log, -1,
                         "%s: grid \"%.100s\" holds %s values: must be float, half or quantised "
                         "float%s",
                         file, grids[chosen].name, grids[chosen].type,
                         job->use == TYN_GRID_COLOR ? ", or vectors of three floats" : "");
    }
    char list[512] = "";
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        add(list, sizeof list, ", ", grids[i].name, grids[i].type);
        any |= grids[i].scalar;
    }
    if (job->grid) {
        return TYN_FAULT(job->log, -1, "%s: no grid \"%.100s\": there are %s", file, job->grid,
                         count ? list : "none");
    }
    if (any) {
        return TYN_FAULT(
            job->log, -1,
            "%s: no grid that is a density by its name: there are %s; name the one that "
            "is, as \"grid\" of a scene's density",
            file, list);
    }
    return TYN_FAULT(job->log, -1, "%s: no grid of float values: there are %s", file,
                     count ? list : "none");
}
