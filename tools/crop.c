// crop.c -- see crop.h.
#include "crop.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

bool crop_take(app *a, const char *text, tyn_view *view)
{
    uint32_t n[4];
    char more;
    if (!text) {
        return true;
    }
    if (strchr(text, '-') ||
        sscanf(text, "%9u,%9u,%9ux%9u%c", &n[0], &n[1], &n[2], &n[3], &more) != 4) {
        app_error(a,
                  "--crop: '%s' is not X,Y,WxH: column and row of the upper left pixel, and a size",
                  text);
        return false;
    }
    if (n[2] < 1 || n[3] < 1 || n[0] + n[2] > view->width || n[1] + n[3] > view->height) {
        app_error(
            a, "--crop: %ux%u pixels from column %u, row %u on are not within the picture's %ux%u",
            n[2], n[3], n[0], n[1], view->width, view->height);
        return false;
    }
    view->whole[0] = view->width;
    view->whole[1] = view->height;
    view->corner[0] = n[0];
    view->corner[1] = n[1];
    view->width = n[2];
    view->height = n[3];
    return true;
}

static uint32_t smaller(uint32_t pixels, float shrink)
{
    return (uint32_t)fmaxf(1, roundf((float)pixels * shrink));
}

void crop_shrink(tyn_view *view, float shrink)
{
    uint32_t *size[2] = {&view->width, &view->height};
    for (int a = 0; a < 2; a++) {
        const float corner = (float)view->corner[a] * shrink;
        *size[a] = smaller(*size[a], shrink);
        if (view->whole[a]) {
            const uint32_t whole = smaller(view->whole[a], shrink);
            view->whole[a] = whole > *size[a] ? whole : *size[a];
            const uint32_t most = view->whole[a] - *size[a];
            view->corner[a] = (uint32_t)fminf(corner, (float)most);
        }
    }
}
