// vdb_mutate.c -- OpenVDB files with some bytes changed: each is read or refused in one line, within seconds.
//
// usage: vdb_mutate FILE.vdb COUNT
//
// Each mutated file is read by a process of its own ("vdb_mutate FILE.vdb"), which an alarm ends and which may take no
// more than so much memory.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <tyndall/io.h>
#include <unistd.h>

enum { SECONDS = 10 };
static const rlim_t memory = (rlim_t)8 << 30; // a dense grid may have 4 GiB

static uint32_t state = 1;

static uint32_t below(uint32_t limit)
{
    state = state * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)state * limit) >> 32);
}

// Lengths and counts stand mostly in the first bytes; a third of the changes is anywhere.
static size_t mutate(uint8_t *bytes, size_t size)
{
    static const uint8_t values[] = {0, 0xff, 0x7f, 0x80, 1};
    const size_t reach[] = {600, 20000, size};
    for (uint32_t changes = 1 + below(3); changes > 0; changes--) {
        size_t end = reach[below(3)];
        end = end < size ? end : size;
        const size_t at = below((uint32_t)end), width = (size_t)1 << below(4);
        const uint8_t value = below(2) ? values[below(sizeof values)] : (uint8_t)below(256);
        const uint32_t kind = below(8);
        if (kind == 0) {
            return at; // cut short there
        }
        if (kind == 1 && at + 16 < size) {
            memmove(bytes + at + 4, bytes + at, size - at - 4); // something too much
        } else {
            memset(bytes + at, value, at + width <= size ? width : size - at);
        }
    }
    return size;
}

static void print(void *user, tyn_log_level level, const char *message)
{
    int *lines = user;
    (void)level;
    *lines += 1 + (strchr(message, '\n') != NULL);
    printf("  %s\n", message);
}

// The child's exit code: 0 read, 2 refused in one line, 3 anything else.
static int read_one(const char *path)
{
    int lines = 0;
    const tyn_log log = {print, &lines, TYN_LOG_ERROR};
    const struct rlimit limit = {memory, memory};
    tyn_volume volume;
    tyn_color_grid colors;
    tyn_volume_grid *grids;
    uint32_t count;
#if !defined(__SANITIZE_ADDRESS__)
    setrlimit(RLIMIT_AS, &limit);
#else
    (void)limit;
#endif
    alarm(SECONDS);
    tyn_result r = tyn_volume_load(&volume, path, NULL, NULL, &log);
    tyn_volume_finish(&volume);
    bool told = lines == (r != TYN_OK);
    lines = 0;
    tyn_result more = tyn_volume_list(path, &grids, &count, &log);
    told = told && lines == (more != TYN_OK);
    for (uint32_t i = 0; more == TYN_OK && i < count && i < 8; i++) {
        lines = 0;
        more = tyn_color_grid_load(&colors, path, grids[i].name, NULL, NULL, &log);
        told = told && lines == (more != TYN_OK);
        tyn_color_grid_finish(&colors);
        more = TYN_OK; // the next may be sound
    }
    free(grids);
    return !told ? 3 : r == TYN_OK ? 0 : 2;
}

int main(int argc, char **argv)
{
    const int count = argc == 3 ? atoi(argv[2]) : 0;
    void *whole;
    size_t size;
    int outcomes[3] = {0};
    double slowest = 0;
    if (argc == 2) {
        return read_one(argv[1]);
    }
    if (count < 1 || tyn_file_read(argv[1], 1u << 30, &whole, &size, NULL) != TYN_OK) {
        fprintf(stderr, "usage: vdb_mutate FILE.vdb COUNT\n");
        return 2;
    }
    uint8_t *bytes = malloc(size);
    for (int i = 0; bytes && i < count; i++) {
        struct timespec from, to;
        int status = 0;
        memcpy(bytes, whole, size);
        const size_t kept = mutate(bytes, size);
        if (tyn_file_write("mutated.vdb", bytes, kept, NULL) != TYN_OK) {
            return 1;
        }
        fflush(stdout);
        clock_gettime(CLOCK_MONOTONIC, &from);
        const pid_t child = fork();
        if (child == 0) {
            execl("/proc/self/exe", argv[0], "mutated.vdb", (char *)NULL);
            _exit(3);
        }
        waitpid(child, &status, 0);
        clock_gettime(CLOCK_MONOTONIC, &to);
        const double s =
            (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
        slowest = s > slowest ? s : slowest;
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 3;
        outcomes[code == 0 ? 0 : code == 2 ? 1 : 2]++;
        if (code != 0 && code != 2) {
            printf("FAILED: mutation %d of %s: %s %d after %.1f s\n", i, argv[1],
                   WIFSIGNALED(status) ? "signal" : "exit",
                   WIFSIGNALED(status) ? WTERMSIG(status) : code, s);
            char name[64];
            snprintf(name, sizeof name, "failed-%d.vdb", i);
            rename("mutated.vdb", name);
        }
    }
    free(bytes);
    free(whole);
    printf("%s: %d read, %d refused, %d failed; the slowest took %.2f s\n", argv[1], outcomes[0],
           outcomes[1], outcomes[2], slowest);
    return outcomes[2] ? 1 : 0;
}
