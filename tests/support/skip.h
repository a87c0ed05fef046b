// skip.h -- cases that cannot run on this machine: data or a feature are missing. They count as skipped, not as passed.
//
// Each prints a line "skipped: CASE (WHY)", which tools/totals counts; a test of which all cases are skipped exits with 77.
#pragma once
#include <stddef.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <cmocka.h>

// Ends the case that is running as skipped. The arguments are a format and its values: why.
#define skip_case(...) skip_from(__func__, __VA_ARGS__)
// The same for want of a file of the shared data; the words are those that tools/totals knows.
#define skip_without(file) skip_case("no shared data: %s", file)

// Ends the whole test as skipped, before its first case.
_Noreturn void skip_all(const char *why, ...) __attribute__((format(printf, 1, 2)));

// Runs the cases of an array of CMUnitTest. Returns what main returns.
#define run_cases(cases, setup, teardown)                                                          \
    skip_result(cmocka_run_group_tests(cases, setup, teardown), sizeof(cases) / sizeof *(cases))

void skip_from(const char *name, const char *why, ...) __attribute__((format(printf, 2, 3)));
int skip_result(int failed, size_t num_cases);
