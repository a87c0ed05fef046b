// todo.h -- checks that are known to fail, with the reason why.
#pragma once
#include <stdbool.h>

// Is a check's outcome the expected one? It must hold, but where its failure is `known`: there it must not, and a line
// "todo: WHAT: REASON" says so. If it holds nevertheless a line says that too: the mark has to go.
bool todo_if(bool known, bool holds, const char *reason, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
