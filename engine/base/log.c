// log.c -- the one place that formats messages; versions of the library.
#include <tyndall/base.h>
#include <stdarg.h>
#include <stdio.h>

#define STR2(x) #x
#define STR(x) STR2(x)

uint32_t tyn_version(void)
{
    return TYN_VERSION;
}

const char *tyn_version_string(void)
{
    return STR(TYN_VERSION_MAJOR) "." STR(TYN_VERSION_MINOR) "." STR(TYN_VERSION_PATCH);
}

void tyn_log_print(const tyn_log *log, tyn_log_level level, const char *format, ...)
{
    if (!log || !log->fn || level > log->level) {
        return;
    }
    char line[2048];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    log->fn(log->user, level, line);
}
