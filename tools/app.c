// app.c -- messages, exit codes, interruption, small text helpers.
#include "app.h"
#include <ctype.h>
#include <signal.h>
#include <stdarg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// The only state a signal handler can reach.
static volatile sig_atomic_t interrupted;

enum { GRACE_SECONDS = 2 };

static void on_interrupt(int number)
{
    (void)number;
    interrupted = 1;
    alarm(GRACE_SECONDS);
}

// What computes does not stop: a large frame in one submission, a driver that compiles. Files appear whole or not at all.
static void on_alarm(int number)
{
    (void)number;
    _exit(EXIT_INTERRUPTED);
}

bool app_interrupted(void)
{
    return interrupted != 0;
}

static void print_line(app *a, const char *kind, const char *message)
{
    progress_hold(&a->bar);
    fprintf(stderr, "tyndall%s%s: %s%s%s%s\n", a->command[0] ? " " : "", a->command, kind,
            a->within ? a->within : "", a->within ? ": " : "", message);
    progress_release(&a->bar);
}

static void print_log(void *user, tyn_log_level level, const char *message)
{
    app *a = user;
    if (level == TYN_LOG_ERROR) {
        a->num_errors++;
        snprintf(a->last_error, sizeof a->last_error, "%s", message);
        print_line(a, "", message);
    } else if (!a->quiet) {
        print_line(a, level == TYN_LOG_WARN ? "warning: " : "", message);
    }
}

void app_init(app *a)
{
    memset(a, 0, sizeof *a);
    a->command = "";
    progress_init(&a->bar);
    a->log = (tyn_log){print_log, a, TYN_LOG_WARN};
    signal(SIGALRM, on_alarm);
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND}, before;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) { // nohup
        sigaction(SIGHUP, &action, NULL);
    }
    signal(SIGXFSZ, SIG_IGN); // then writing says that the file would get too large
}

#define FORMAT_LINE(line, format)                                                                  \
    char line[2048];                                                                               \
    va_list arguments;                                                                             \
    va_start(arguments, format);                                                                   \
    vsnprintf(line, sizeof line, format, arguments);                                               \
    va_end(arguments)

void app_error(app *a, const char *format, ...)
{
    FORMAT_LINE(line, format);
    print_log(a, TYN_LOG_ERROR, line);
}

void app_warn(app *a, const char *format, ...)
{
    FORMAT_LINE(line, format);
    print_log(a, TYN_LOG_WARN, line);
}

void app_note(app *a, const char *format, ...)
{
    FORMAT_LINE(line, format);
    print_log(a, TYN_LOG_INFO, line);
}

const char *app_word(const app *a, const char *by_option, const char *by_key)
{
    return a->within ? by_key : by_option;
}

int app_exit_code(app *a, tyn_result result, bool input)
{
    if (app_interrupted()) {
        alarm(0); // it has stopped
        return EXIT_INTERRUPTED;
    }
    if (result == TYN_OK) {
        return EXIT_DONE;
    }
    if (a->num_errors == 0) { // the library says why; this is for the case that it does not
        static const char *const reasons[] = {"",
                                              "an argument or the input is wrong",
                                              "this device or this build cannot do it",
                                              "out of memory",
                                              "no Vulkan device, or a Vulkan call failed",
                                              "a file cannot be read or written",
                                              "stopped"};
        int reason = -(int)result;
        app_error(a, "%s", reason > 0 && reason < (int)ARRAY_SIZE(reasons) ? reasons[reason] : "?");
    }
    bool wrong = result == TYN_ERR_PARAMS || (input && result == TYN_ERR_IO) ||
                 (input && result == TYN_ERR_UNSUPPORTED);
    return wrong ? EXIT_WRONG : EXIT_FAILED;
}

double app_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

char *text_format(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}

bool text_ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    if (length < tail) {
        return false;
    }
    for (size_t i = 0; i < tail; i++) {
        if (tolower((unsigned char)text[length - tail + i]) != tolower((unsigned char)end[i])) {
            return false;
        }
    }
    return true;
}

char *text_stem(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    int length = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    return text_format("%.*s", length, name);
}

uint64_t text_hash(const void *data, size_t size, uint64_t seed)
{
    uint64_t hash = 0xcbf29ce484222325u ^ seed;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
    }
    return hash;
}

double text_fraction(const char *text, bool *percent)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text) {
        return NAN;
    }
    const char *sign = end + strspn(end, " ");
    *percent = strcmp(sign, "%") == 0;
    if (*percent) {
        value /= 100;
    } else if (*end) {
        return NAN;
    }
    return value > 0 && value < INFINITY ? value : NAN;
}
