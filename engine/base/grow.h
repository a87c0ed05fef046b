// grow.h -- arrays that get longer.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Room for `count` elements of so many bytes in the array from malloc that `array` points to, at least twice as much as
// there was. False: no memory; the array stays as it is.
static inline bool tyn_grow(void *array, uint32_t *room, size_t count, size_t element)
{
    void *at;
    const size_t twice = 2 * (size_t)*room, wanted = count > twice ? count : twice;
    if (count <= *room) {
        return true;
    }
    memcpy(&at, array, sizeof at);
    void *grown = wanted <= UINT32_MAX ? realloc(at, wanted * element) : NULL;
    if (grown) {
        memcpy(array, &grown, sizeof grown);
        *room = (uint32_t)wanted;
    }
    return grown != NULL;
}
