// sequence.h -- --frames: a number of timing frames, or a range of numbered files.
#pragma once
#include "app.h"

typedef struct sequence {
    bool numbered;        // A-B
    uint32_t first, last; // A and B
    uint32_t repeat;      // N; 0 = not given
} sequence;

bool sequence_parse(const char *text, sequence *s); // NULL = one picture

bool sequence_has_number(const char *path);

// The path with its first "%04d" (any width, or "%d") or run of '#' replaced by the number, padded with
// zeros; a new string. A path without either is copied.
char *sequence_path(const char *path, uint32_t number);
