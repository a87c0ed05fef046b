// options_nearest.c -- "did you mean": the name with the fewest letters changed.
#include "options.h"
#include <string.h>

enum { MAX_LENGTH = 31 };

static uint32_t least(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

// Letters to change, put in, leave out, or to exchange with the next (Damerau and Levenshtein).
static uint32_t distance(const char *a, const char *b)
{
    const size_t n = strlen(a), m = strlen(b);
    uint32_t rows[MAX_LENGTH + 1][MAX_LENGTH + 1];
    if (n > MAX_LENGTH || m > MAX_LENGTH) {
        return MAX_LENGTH;
    }
    for (size_t i = 0; i <= n; i++) {
        for (size_t k = 0; k <= m; k++) {
            if (i == 0 || k == 0) {
                rows[i][k] = (uint32_t)(i + k);
                continue;
            }
            rows[i][k] = least(rows[i - 1][k] + 1, rows[i][k - 1] + 1,
                               rows[i - 1][k - 1] + (a[i - 1] != b[k - 1]));
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1]) {
                rows[i][k] = least(rows[i][k], rows[i - 2][k - 2] + 1, MAX_LENGTH);
            }
        }
    }
    return rows[n][m];
}

const char *options_nearest(const char *typed, const char *(*name_at)(const void *user, uint32_t i),
                            const void *user)
{
    const char *name, *best = NULL;
    const size_t length = strlen(typed);
    uint32_t fewest = length < 4 ? 2 : length < 8 ? 3 : 4; // as many are another word
    for (uint32_t i = 0; (name = name_at(user, i)) != NULL; i++) {
        const uint32_t changes = distance(typed, name);
        if (changes < fewest) {
            fewest = changes;
            best = name;
        }
    }
    return best;
}
