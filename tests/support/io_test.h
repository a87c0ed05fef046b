// io_test.h -- what the tests of file formats share: a folder of their own, a log that counts.
#pragma once
#include <tyndall/io.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

// Counts lines of each level and keeps the last.
typedef struct io_log {
    tyn_log log;
    int errors, warnings, newlines;
    char last[2048];
} io_log;
void io_log_init(io_log *log);

// "<folder of this test>/<name>"; the folder is made on first use and removed by io_test_clean. The
// string lives until the 16th call after.
const char *io_path(const char *name);
// Writes a file there and returns its path.
const char *io_put(const char *name, const void *data, size_t size);
const char *io_put_text(const char *name, const char *text);
int io_test_clean(void **state); // a cmocka group teardown

// Path of a shared data file ("data/smoke.vdb"), or NULL where it is not there.
const char *io_shared(const char *name);
