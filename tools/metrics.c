// metrics.c -- how far an image is from a reference.
#include "metrics.h"
#include <math.h>
#include <stdlib.h>

static const double mean_abs_normal = 0.79788456080286536; // sqrt(2/pi): E|z| of a unit normal

// One channel of one block.
typedef struct sample {
    double x, r;
    double se;     // of x - r
    double weight; // pixels
} sample;

typedef struct blocks {
    uint32_t across, down, size;
    sample *samples; // 3 * across * down; weight 0: no finite pixel
    uint64_t nan;
    double mean; // of the reference
} blocks;

static double square_or_0(const float *channel, size_t i)
{
    return channel ? (double)channel[i] * channel[i] : 0;
}

static sample average(const metrics_image *image, const metrics_image *reference, int channel,
                      uint32_t x0, uint32_t y0, uint32_t size, uint64_t *nan)
{
    uint32_t x1 = x0 + size < image->width ? x0 + size : image->width;
    uint32_t y1 = y0 + size < image->height ? y0 + size : image->height;
    sample s = {0};
    double variance = 0;
    for (uint32_t y = y0; y < y1; y++) {
        for (uint32_t x = x0; x < x1; x++) {
            size_t i = (size_t)y * image->width + x;
            float a = image->rgb[channel][i], r = reference->rgb[channel][i];
            if (!isfinite(a) || !isfinite(r)) {
                ++*nan;
                continue;
            }
            s.x += a;
            s.r += r;
            variance += square_or_0(image->se[channel], i) + square_or_0(reference->se[channel], i);
            s.weight += 1;
        }
    }
    if (s.weight > 0) {
        s.x /= s.weight;
        s.r /= s.weight;
        s.se = sqrt(variance) / s.weight; // pixels are independent
    }
    return s;
}

static bool make_blocks(blocks *b, const metrics_image *image, const metrics_image *reference,
                        uint32_t size)
{
    // (width - 1) / size + 1 cannot overflow, whatever the block
    *b = (blocks){.across = (image->width - 1) / size + 1,
                  .down = (image->height - 1) / size + 1,
                  .size = size};
    b->samples = calloc((size_t)3 * b->across * b->down, sizeof *b->samples);
    if (!b->samples) {
        return false;
    }
    double sum = 0, weight = 0;
    sample *s = b->samples;
    for (uint32_t y = 0; y < b->down; y++) {
        for (uint32_t x = 0; x < b->across; x++) {
            for (int c = 0; c < 3; c++, s++) {
                *s = average(image, reference, c, x * size, y * size, size, &b->nan);
                sum += s->weight * s->r;
                weight += s->weight;
            }
        }
    }
    b->mean = weight > 0 ? sum / weight : 0;
    return true;
}

static double relative_difference(const sample *s, double mean)
{
    // a reference may hold negative values, its mean as well: the offset keeps its sign out
    return fabs(s->x - s->r) / (fabs(s->r) + 0.01 * fabs(mean));
}

typedef struct ranked {
    double value, weight;
} ranked;

static int by_value(const void *a, const void *b)
{
    double x = ((const ranked *)a)->value, y = ((const ranked *)b)->value;
    return (x > y) - (x < y);
}

// The smallest value that at least 95 % of the weight does not exceed.
static bool percentile_95(const blocks *b, double total, double *result)
{
    size_t num = (size_t)3 * b->across * b->down;
    ranked *rank = malloc(num * sizeof *rank);
    if (!rank) {
        return false;
    }
    for (size_t i = 0; i < num; i++) {
        const sample *s = &b->samples[i];
        rank[i] = (ranked){s->weight > 0 ? relative_difference(s, b->mean) : 0, s->weight};
    }
    qsort(rank, num, sizeof *rank, by_value);
    double below = 0;
    *result = 0;
    for (size_t i = 0; i < num && below < 0.95 * total * (1 - 1e-12); i++) {
        below += rank[i].weight;
        *result = rank[i].value;
    }
    free(rank);
    return true;
}

// Of all values of an image that are finite.
static double sum_of(const metrics_image *image)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
            sum += isfinite(image->rgb[c][i]) ? image->rgb[c][i] : 0;
        }
    }
    return sum;
}

metrics_status metrics_compare(const metrics_image *image, const metrics_image *reference,
                               uint32_t block, metrics *out)
{
    blocks b;
    if (!make_blocks(&b, image, reference, block)) {
        return METRICS_MEMORY;
    }
    if (b.nan) { // none of the measures is a number
        free(b.samples);
        *out = (metrics){.rel_l1 = NAN, .rmse = NAN, .rel_rmse = NAN, .rel_mse = NAN};
        out->smape = out->bias = out->n = out->error = out->p95 = out->mean = NAN;
        out->nan = b.nan;
        return sum_of(reference) != 0 ? METRICS_OK : METRICS_ZERO_REFERENCE;
    }
    double weight = 0, sum_x = 0, sum_r = 0, abs_r = 0, square_r = 0;
    double abs_d = 0, square_d = 0, relative = 0, symmetric = 0, sum_se = 0;
    size_t num = (size_t)3 * b.across * b.down;
    for (size_t i = 0; i < num; i++) {
        const sample *s = &b.samples[i];
        double w = s->weight, d = s->x - s->r, scale = fabs(s->x) + fabs(s->r);
        if (w == 0) {
            continue;
        }
        weight += w;
        sum_x += w * s->x;
        sum_r += w * s->r;
        abs_r += w * fabs(s->r);
        square_r += w * s->r * s->r;
        abs_d += w * fabs(d);
        square_d += w * d * d;
        symmetric += scale > 0 ? w * 2 * fabs(d) / scale : 0;
        sum_se += w * s->se;
        double floor = s->r * s->r + 0.01 * b.mean * b.mean;
        relative += floor > 0 ? w * d * d / floor : 0;
    }
    *out = (metrics){.nan = b.nan, .mean = b.mean};
    metrics_status status = METRICS_ZERO_REFERENCE;
    if (sum_r != 0) {
        out->rel_l1 = abs_d / abs_r;
        out->rmse = sqrt(square_d / weight);
        out->rel_rmse = sqrt(square_d / square_r);
        out->rel_mse = relative / weight;
        out->smape = symmetric / weight;
        out->bias = sum_x / sum_r - 1;
        for (int c = 0; c < 3; c++) {
            out->has_n = out->has_n || image->se[c] || reference->se[c];
        }
        out->n = mean_abs_normal * sum_se / abs_r;
        const double left = out->rel_l1 * out->rel_l1 - out->n * out->n;
        out->error = sqrt(left < 0 ? 0 : left); // of a NaN a NaN
        status = percentile_95(&b, weight, &out->p95) ? METRICS_OK : METRICS_MEMORY;
    }
    free(b.samples);
    return status;
}

double metrics_expected(const float *rgba, const float *error, size_t num_pixels)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < num_pixels; i++) {
        for (size_t c = 0; c < 3; c++) {
            sum += (double)error[4 * i + c];
            all += fabs((double)rgba[4 * i + c]);
        }
    }
    return all > 0 ? mean_abs_normal * sum / all : 0;
}

metrics_status metrics_heat(const metrics_image *image, const metrics_image *reference,
                            uint32_t block, float *heat)
{
    blocks b;
    if (!make_blocks(&b, image, reference, block)) {
        return METRICS_MEMORY;
    }
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            const sample *s = &b.samples[3 * ((size_t)(y / block) * b.across + x / block)];
            double sum = 0, channels = 0;
            for (int c = 0; c < 3; c++) {
                if (s[c].weight > 0) {
                    sum += relative_difference(&s[c], b.mean);
                    channels += 1;
                }
            }
            heat[(size_t)y * image->width + x] = channels > 0 ? (float)(sum / channels) : NAN;
        }
    }
    free(b.samples);
    return b.mean != 0 ? METRICS_OK : METRICS_ZERO_REFERENCE;
}
