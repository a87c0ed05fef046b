// portable.c -- exponential, sine and cosine from + - * / alone: the same bits on every machine.
#include "portable.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

double gen_exp(double x)
{
    if (x < -700.0) {
        return 0.0;
    }
    static const double inverse[] = {0,       1.0,     1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5,
                                     1.0 / 6, 1.0 / 7, 1.0 / 8, 1.0 / 9, 1.0 / 10};
    // x = k ln 2 + r, |r| <= ln 2 / 2; the series of e^r by Horner's rule, times 2^k.
    const double k = floor(x * 1.4426950408889634 + 0.5);
    const double r = (x - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10;
    double sum = 1.0;
    for (int n = 10; n >= 1; n--) {
        sum = 1.0 + sum * r * inverse[n];
    }
    const uint64_t bits = (uint64_t)((int64_t)k + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof(power));
    return sum * power;
}

double gen_sin(double x)
{
    // To [-pi, pi], then to [-pi/2, pi/2], where the series to x^21 is exact to the last places.
    x -= 2.0 * GEN_PI * floor(x / (2.0 * GEN_PI) + 0.5);
    x = x > 0.5 * GEN_PI ? GEN_PI - x : x < -0.5 * GEN_PI ? -GEN_PI - x : x;
    double sum = 1.0;
    for (int n = 20; n >= 2; n -= 2) {
        sum = 1.0 - sum * x * x / (double)(n * (n + 1));
    }
    return x * sum;
}

double gen_cos(double x)
{
    return gen_sin(x + 0.5 * GEN_PI);
}
