// alias_table.c -- Vose's form of Walker's alias method.
#include "frame/alias_table.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void set_cell(void *cells, size_t stride, size_t i, double keep, size_t alias)
{
    struct {
        float keep;
        uint32_t alias;
    } cell = {(float)keep, (uint32_t)alias};
    memcpy((char *)cells + i * stride, &cell, sizeof cell);
}

bool tyn_alias_build(double *weights, size_t count, void *cells, size_t stride)
{
    uint32_t *small = malloc(count * sizeof(uint32_t)), *large = malloc(count * sizeof(uint32_t));
    if (!small || !large) {
        free(small);
        free(large);
        return false;
    }
    double total = 0;
    for (size_t i = 0; i < count; i++) {
        total += weights[i];
    }
    size_t num_small = 0, num_large = 0;
    for (size_t i = 0; i < count; i++) {
        weights[i] = total > 0 ? weights[i] / total * (double)count : 1.0;
        set_cell(cells, stride, i, 1.0, i);
        if (weights[i] < 1.0) {
            small[num_small++] = (uint32_t)i;
        } else {
            large[num_large++] = (uint32_t)i;
        }
    }
    // Fill each cell below average from one above.
    while (num_small > 0 && num_large > 0) {
        uint32_t poor = small[--num_small], rich = large[num_large - 1];
        set_cell(cells, stride, poor, weights[poor], rich);
        weights[rich] -= 1.0 - weights[poor];
        if (weights[rich] < 1.0) {
            num_large--;
            small[num_small++] = rich;
        }
    }
    free(small);
    free(large);
    return true;
}
