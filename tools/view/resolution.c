// resolution.c -- the size of a picture, a whole fraction of the window's, chosen from what earlier pictures took.
#include "view/resolution.h"

static double pixels_ms(const resolution_cost *cost, uint32_t divisor)
{
    const double ratio = (double)cost->divisor / divisor;
    return cost->pixels_ms * ratio * ratio;
}

double resolution_expected_ms(const resolution_cost *cost, uint32_t divisor)
{
    const double fixed = cost->ms - cost->pixels_ms;
    return (fixed > 0 ? fixed : 0) + pixels_ms(cost, divisor);
}

// The smallest divisor that leaves `count` pixels at most.
static uint32_t leaves(uint32_t width, uint32_t height, uint64_t count)
{
    uint32_t divisor = 1;
    while ((uint64_t)width * height > count * divisor * divisor) {
        divisor++;
    }
    return divisor;
}

uint32_t resolution_start(uint32_t width, uint32_t height)
{
    return leaves(width, height, 2048);
}

uint32_t resolution_coarsest(uint32_t width, uint32_t height)
{
    return leaves(width, height, 1024);
}

uint32_t resolution_at_rest(const resolution_cost *last, double bound_ms, uint32_t coarsest)
{
    const bool too_long = last->ms > 2 * bound_ms && !last->cold;
    const uint32_t most = too_long && last->divisor < coarsest ? coarsest : last->divisor;
    uint32_t divisor = 1;
    while (divisor < most && resolution_expected_ms(last, divisor) > bound_ms) {
        divisor++;
    }
    return last->cold && divisor == last->divisor && divisor > 1 ? divisor - 1 : divisor;
}

void resolution_moved(resolution *r, const resolution_cost *last, double target_ms,
                      uint32_t coarsest)
{
    r->divisor = last->divisor;
    if (last->cold) {
        return;
    }
    if (last->ms > 1.5 * target_ms && last->pixels_ms > 0.6 * target_ms) {
        r->easy = 0;
        do {
            r->divisor++;
        } while (r->divisor < coarsest && r->divisor < 2 * last->divisor &&
                 resolution_expected_ms(last, r->divisor) > target_ms);
        r->divisor = r->divisor < coarsest ? r->divisor : coarsest;
        r->divisor = r->divisor < last->divisor ? last->divisor : r->divisor;
        return;
    }
    const bool fits =
        last->divisor > 1 && resolution_expected_ms(last, last->divisor - 1) <= 0.6 * target_ms;
    r->easy = fits ? r->easy + !last->first : 0;
    if (r->easy >= RESOLUTION_EASY) {
        r->easy = 0;
        r->divisor--;
    }
}

void resolution_rested(resolution *r, const resolution_cost *last, double target_ms,
                       uint32_t coarsest)
{
    if (r->divisor &&
        (r->divisor == 1 || last->cold || pixels_ms(last, r->divisor - 1) > 0.4 * target_ms)) {
        return;
    }
    const uint32_t old = r->divisor;
    r->divisor = 1;
    while (r->divisor < coarsest && pixels_ms(last, r->divisor) > 0.7 * target_ms) {
        r->divisor++;
    }
    r->easy = r->divisor == old ? r->easy : 0;
}
