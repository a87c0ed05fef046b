// fault.c -- preloaded into the viewer: a fatal signal first prints "fault:" and the libraries of the thread's frames.
#include <execinfo.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static void say(const char *text)
{
    if (write(STDERR_FILENO, text, strlen(text)) < 0) {
        return; // nobody listens
    }
}

// SA_RESETHAND: the signal raised again ends the process as it would have.
static void fault(int number)
{
    void *frames[64];
    say("fault:\n");
    backtrace_symbols_fd(frames, backtrace(frames, 64), STDERR_FILENO);
    say("fault ends\n");
    raise(number);
}

__attribute__((constructor)) static void watch(void)
{
    void *frame[1];
    backtrace(frame, 1); // loads what it needs now, not in a handler
    struct sigaction action = {.sa_handler = fault, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGSEGV, &action, NULL);
    sigaction(SIGBUS, &action, NULL);
    sigaction(SIGABRT, &action, NULL);
}
