// flip.c -- LDR-FLIP and HDR-FLIP.
//
// A pixel's error is c^(1 - f). c is the distance of its colours after filters that take away what the eye cannot
// resolve; f is the difference of edges and points there, which the eye is drawn to. Symbols are those of the papers.
#include "flip.h"
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double pixels_per_degree = 67;

// ---- filters ----------------------------------------------------------------------------------

enum { MAX_RADIUS = 16, LANES = 16 };

// One direction of a separable filter.
typedef struct taps {
    int radius;
    float weights[2 * MAX_RADIUS + 1];
} taps;

// The contrast sensitivity of the eye to one opponent colour, as a filter over x degrees:
// sum of a sqrt(pi / b) exp(-(pi x)^2 / b).
typedef struct sensitivity {
    int num_terms;
    double a[2], b[2];
} sensitivity;

static const sensitivity achromatic = {1, {1}, {0.0047}};
static const sensitivity red_green = {1, {1}, {0.0053}};
static const sensitivity blue_yellow = {2, {34.1, 13.5}, {0.04, 0.025}};
// All three filters reach as far as three standard deviations of the widest term.
static const double widest_b = 0.04;

static const double feature_width = 0.082; // of the filters that find edges and points, degrees

typedef struct filters {
    taps achromatic, red_green, blue_yellow[2];
    taps smooth, edge, point; // a Gaussian and its first and second derivative
} filters;

// The filter over the plane is the sum over terms of the product of one term's taps in x and in y, and sums to 1.
static void make_sensitivity(const sensitivity *s, taps *terms)
{
    const int radius = (int)ceil(3 * sqrt(widest_b / (2 * pi * pi)) * pixels_per_degree);
    double total = 0;
    for (int i = 0; i < s->num_terms; i++) {
        double sum = 0;
        for (int t = -radius; t <= radius; t++) {
            const double x = t / pixels_per_degree;
            sum += exp(-pi * pi * x * x / s->b[i]);
        }
        total += s->a[i] * sqrt(pi / s->b[i]) * sum * sum;
    }
    for (int i = 0; i < s->num_terms; i++) {
        const double scale = sqrt(s->a[i] * sqrt(pi / s->b[i]) / total);
        terms[i].radius = radius;
        for (int t = -radius; t <= radius; t++) {
            const double x = t / pixels_per_degree;
            terms[i].weights[t + radius] = (float)(scale * exp(-pi * pi * x * x / s->b[i]));
        }
    }
}

// Positive weights are scaled to sum to 1, negative ones to -1.
static taps make_derivative(int order)
{
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = (int)ceil(3 * sigma);
    double weights[2 * MAX_RADIUS + 1], positive = 0, negative = 0;
    for (int t = -radius; t <= radius; t++) {
        const double x = t / sigma;
        const double factor = order == 0 ? 1 : order == 1 ? -x : x * x - 1;
        const double w = weights[t + radius] = factor * exp(-x * x / 2);
        *(w > 0 ? &positive : &negative) += fabs(w);
    }
    taps k = {.radius = radius};
    for (int i = 0; i <= 2 * radius; i++) {
        k.weights[i] = (float)(weights[i] / (weights[i] > 0 ? positive : fmax(negative, DBL_MIN)));
    }
    return k;
}

static filters make_filters(void)
{
    filters f;
    make_sensitivity(&achromatic, &f.achromatic);
    make_sensitivity(&red_green, &f.red_green);
    make_sensitivity(&blue_yellow, f.blue_yellow);
    f.smooth = make_derivative(0);
    f.edge = make_derivative(1);
    f.point = make_derivative(2);
    return f;
}

// out = (or +=) the sum of rows[i] times weights[i]; a fixed number of sums at once stays in registers.
static void weigh(const float *const *rows, const taps *k, size_t width, bool add, float *out)
{
    const int num = 2 * k->radius + 1;
    for (size_t x = 0; x < width; x += LANES) {
        float sums[LANES] = {0};
        const size_t lanes = width - x < LANES ? width - x : LANES;
        if (lanes == LANES) {
            for (int i = 0; i < num; i++) {
                for (size_t l = 0; l < LANES; l++) {
                    sums[l] += k->weights[i] * rows[i][x + l];
                }
            }
        } else {
            for (int i = 0; i < num; i++) {
                for (size_t l = 0; l < lanes; l++) {
                    sums[l] += k->weights[i] * rows[i][x + l];
                }
            }
        }
        for (size_t l = 0; l < lanes; l++) {
            out[x + l] = add ? out[x + l] + sums[l] : sums[l];
        }
    }
}

// ---- pictures ---------------------------------------------------------------------------------

// What filters are applied to, the axes of YCxCz without their factors and offset, which filters that sum to 1 leave
// alone: Y/Yn, X/Xn - Y/Yn and Y/Yn - Z/Zn. The first is what features are looked for in.
enum { AXIS_Y, AXIS_CX, AXIS_CZ, NUM_AXES };

// What is known of each pixel of a row: the filtered axes and derivatives of Y/Yn.
enum { ROW_Y, ROW_CX, ROW_CZ, ROW_EDGE_X, ROW_EDGE_Y, ROW_POINT_X, ROW_POINT_Y, NUM_ROWS };

typedef struct work {
    size_t width, height;
    filters filters;
    float *axes[2][NUM_AXES]; // of the image and the reference
    float *rows[2][NUM_ROWS];
    float *padded; // a row with MAX_RADIUS more values on both sides
    float *memory; // all of these
} work;

static bool open_work(work *w, const metrics_image *image)
{
    *w = (work){.width = image->width, .height = image->height, .filters = make_filters()};
    const size_t num = w->width * w->height;
    const size_t size = 2 * NUM_AXES * num + (2 * NUM_ROWS + 1) * w->width + 2 * MAX_RADIUS;
    float *at = w->memory = malloc(size * sizeof *at);
    if (!at) {
        return false;
    }
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < NUM_AXES; i++, at += num) {
            w->axes[p][i] = at;
        }
        for (int i = 0; i < NUM_ROWS; i++, at += w->width) {
            w->rows[p][i] = at;
        }
    }
    w->padded = at;
    return true;
}

// Keeps NaN.
static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

// The primaries of sRGB and D65, from R, G, B to X, Y, Z and back; Xn, Yn, Zn is the sum over a row.
static const float rgb_to_xyz[3][3] = {{0.4123907993f, 0.3575843394f, 0.1804807884f},
                                       {0.2126390059f, 0.7151686788f, 0.0721923154f},
                                       {0.0193308187f, 0.1191947798f, 0.9505321522f}};
static const float xyz_to_rgb[3][3] = {{3.2409699419f, -1.5373831776f, -0.4986107603f},
                                       {-0.9692436363f, 1.8759675015f, 0.0415550574f},
                                       {0.0556300797f, -0.2039769589f, 1.0569715142f}};
static const float white[3] = {0.9504559271f, 1, 1.0890577507f};

static float dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Narkowicz's fit (2015) to the ACES reference and output transforms, made for 0.6 times the value:
// (aces[0] x^2 + aces[1] x) / (aces[2] x^2 + aces[3] x + aces[4]).
static const float aces[5] = {0.36f * 2.51f, 0.6f * 0.03f, 0.36f * 2.43f, 0.6f * 0.59f, 0.14f};

static float tone_map(float x)
{
    x = clamp(x, 0, 1e6f); // far above what the curve takes to 1
    return (aces[0] * x + aces[1]) * x / ((aces[2] * x + aces[3]) * x + aces[4]);
}

// The axes of a picture as the display shows it.
static void show(work *w, int p, const metrics_image *image, float scale, bool toned)
{
    const size_t num = w->width * w->height;
    for (size_t i = 0; i < num; i++) {
        float rgb[3];
        for (int c = 0; c < 3; c++) {
            const float x = image->rgb[c][i];
            const float scaled = toned ? tone_map(x * scale) : x * scale;
            rgb[c] = isfinite(x) ? clamp(scaled, 0, 1) : NAN;
        }
        const float x = dot3(rgb_to_xyz[0], rgb) / white[0], y = dot3(rgb_to_xyz[1], rgb);
        const float z = dot3(rgb_to_xyz[2], rgb) / white[2];
        w->axes[p][AXIS_Y][i] = y;
        w->axes[p][AXIS_CX][i] = x - y;
        w->axes[p][AXIS_CZ][i] = y - z;
    }
}

// Row y of an axis after a filter; beyond the edges lie the values at the edges.
static void filter_row(work *w, const float *axis, size_t y, const taps *vertical,
                       const taps *horizontal, bool add, float *out)
{
    const float *rows[2 * MAX_RADIUS + 1];
    for (int t = -vertical->radius; t <= vertical->radius; t++) {
        const ptrdiff_t at = (ptrdiff_t)y + t, last = (ptrdiff_t)w->height - 1;
        rows[t + vertical->radius] = axis + w->width * (size_t)(at < 0 ? 0 : at > last ? last : at);
    }
    float *inner = w->padded + MAX_RADIUS;
    weigh(rows, vertical, w->width, false, inner);
    for (int i = 0; i < MAX_RADIUS; i++) {
        w->padded[i] = inner[0];
        inner[w->width + (size_t)i] = inner[w->width - 1];
    }
    for (int t = -horizontal->radius; t <= horizontal->radius; t++) {
        rows[t + horizontal->radius] = inner + t;
    }
    weigh(rows, horizontal, w->width, add, out);
}

static void filter_rows(work *w, int p, size_t y)
{
    const filters *f = &w->filters;
    float *const *axes = w->axes[p], *const *rows = w->rows[p];
    filter_row(w, axes[AXIS_Y], y, &f->achromatic, &f->achromatic, false, rows[ROW_Y]);
    filter_row(w, axes[AXIS_CX], y, &f->red_green, &f->red_green, false, rows[ROW_CX]);
    for (int i = 0; i < 2; i++) {
        const taps *term = &f->blue_yellow[i];
        filter_row(w, axes[AXIS_CZ], y, term, term, i > 0, rows[ROW_CZ]);
    }
    filter_row(w, axes[AXIS_Y], y, &f->smooth, &f->edge, false, rows[ROW_EDGE_X]);
    filter_row(w, axes[AXIS_Y], y, &f->edge, &f->smooth, false, rows[ROW_EDGE_Y]);
    filter_row(w, axes[AXIS_Y], y, &f->smooth, &f->point, false, rows[ROW_POINT_X]);
    filter_row(w, axes[AXIS_Y], y, &f->point, &f->smooth, false, rows[ROW_POINT_Y]);
}

// ---- errors -----------------------------------------------------------------------------------

static const float colour_power = 0.7f;      // q_c
static const float colour_knee[2] = {0.4f,   // p_c: this part of the largest difference
                                     0.95f}; // p_t: becomes this error
static const float feature_power = 0.5f;     // q_f

// L*, a* and b*, of which the chroma is scaled by the Hunt effect: dim colours are less colourful.
static void lab_of_rgb(const float rgb[3], float lab[3])
{
    const float knee = 6.0f / 29;
    float f[3];
    for (int c = 0; c < 3; c++) {
        const float t = dot3(rgb_to_xyz[c], rgb) / white[c];
        f[c] = t > knee * knee * knee ? cbrtf(t) : t / (3 * knee * knee) + 4.0f / 29;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01f * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01f * lab[0] * 200 * (f[1] - f[2]);
}

static void lab_of_axes(float *const *rows, size_t x, float lab[3])
{
    const float y = rows[ROW_Y][x];
    const float xyz[3] = {(rows[ROW_CX][x] + y) * white[0], y, (y - rows[ROW_CZ][x]) * white[2]};
    float rgb[3];
    for (int c = 0; c < 3; c++) {
        rgb[c] = clamp(dot3(xyz_to_rgb[c], xyz), 0, 1);
    }
    lab_of_rgb(rgb, lab);
}

// The HyAB distance, to the power of q_c.
static float colour_distance(const float a[3], const float b[3])
{
    const float distance = fabsf(a[0] - b[0]) + hypotf(a[1] - b[1], a[2] - b[2]);
    return powf(distance, colour_power);
}

// The largest distance is that of green and blue.
static float largest_distance(void)
{
    float green[3], blue[3];
    lab_of_rgb((const float[3]){0, 1, 0}, green);
    lab_of_rgb((const float[3]){0, 0, 1}, blue);
    return colour_distance(green, blue);
}

// Distances below the knee take most of the range of errors.
static float colour_error(const float a[3], const float b[3], float largest)
{
    const float distance = colour_distance(a, b), knee = colour_knee[0] * largest;
    return distance < knee
               ? colour_knee[1] / knee * distance
               : colour_knee[1] + (distance - knee) / (largest - knee) * (1 - colour_knee[1]);
}

// The strength of an edge or a point.
static float strength(float *const *rows, int row, size_t x)
{
    return hypotf(rows[row][x], rows[row + 1][x]);
}

static float feature_error(float *const *a, float *const *b, size_t x)
{
    const float edge = fabsf(strength(a, ROW_EDGE_X, x) - strength(b, ROW_EDGE_X, x));
    const float point = fabsf(strength(a, ROW_POINT_X, x) - strength(b, ROW_POINT_X, x));
    return powf((edge > point ? edge : point) / sqrtf(2), feature_power);
}

// LDR-FLIP of what `show` has shown; `map` keeps what is larger.
static void raise_map(work *w, float largest, float *map)
{
    for (size_t y = 0; y < w->height; y++) {
        for (int p = 0; p < 2; p++) {
            filter_rows(w, p, y);
        }
        for (size_t x = 0; x < w->width; x++, map++) {
            float a[3], b[3];
            lab_of_axes(w->rows[0], x, a);
            lab_of_axes(w->rows[1], x, b);
            const float colour = colour_error(a, b, largest);
            const float feature = feature_error(w->rows[0], w->rows[1], x);
            const float error = powf(colour, 1 - feature);
            *map = error <= *map ? *map : error;
        }
    }
}

// Over `num` factors of both pictures.
static bool evaluate(const metrics_image *image, const metrics_image *reference, uint32_t num,
                     const float *scales, bool toned, float *map, double *mean)
{
    const size_t size = (size_t)image->width * image->height;
    work w;
    float *values = map ? map : malloc(size * sizeof *values);
    const bool opened = open_work(&w, image) && values;
    if (opened) {
        const float largest = largest_distance();
        for (size_t i = 0; i < size; i++) {
            values[i] = 0;
        }
        for (uint32_t k = 0; k < num; k++) {
            show(&w, 0, image, scales[k], toned);
            show(&w, 1, reference, scales[k], toned);
            raise_map(&w, largest, values);
        }
        double sum = 0;
        for (size_t i = 0; i < size; i++) {
            sum += values[i];
        }
        *mean = sum / (double)size;
    }
    free(w.memory);
    if (!map) {
        free(values);
    }
    return opened;
}

bool flip_ldr(const metrics_image *image, const metrics_image *reference, float scale, float *map,
              double *mean)
{
    return evaluate(image, reference, 1, &scale, false, map, mean);
}

bool flip_hdr(const metrics_image *image, const metrics_image *reference,
              const flip_exposures *exposures, float *map, double *mean)
{
    float *scales = malloc(exposures->count * sizeof *scales);
    for (uint32_t k = 0; scales && k < exposures->count; k++) {
        const float part = (float)k / (float)(exposures->count - 1);
        const float stops = exposures->start + part * (exposures->stop - exposures->start);
        scales[k] = clamp(exp2f(stops), 0, FLT_MAX);
    }
    const bool done =
        scales && evaluate(image, reference, exposures->count, scales, true, map, mean);
    free(scales);
    return done;
}

// ---- what the reference needs -----------------------------------------------------------------

// The value that stands at place k of the sorted values (Hoare's FIND); reorders them.
static float value_at_rank(float *values, size_t num, size_t k)
{
    ptrdiff_t low = 0, high = (ptrdiff_t)num - 1, rank = (ptrdiff_t)k;
    while (low < high) {
        const float pivot = values[rank];
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (values[i] < pivot) {
                i++;
            }
            while (values[j] > pivot) {
                j--;
            }
            if (i <= j) {
                const float swapped = values[i];
                values[i++] = values[j];
                values[j--] = swapped;
            }
        }
        low = j < rank ? i : low;
        high = rank < i ? j : high;
    }
    return values[rank];
}

bool flip_scale(const metrics_image *reference, float *scale)
{
    const size_t size = (size_t)reference->width * reference->height;
    float *values = malloc(3 * size * sizeof *values);
    size_t num = 0;
    *scale = 1;
    for (size_t i = 0; values && i < 3 * size; i++) {
        const float x = reference->rgb[i / size][i % size];
        if (isfinite(x)) {
            values[num++] = x;
        }
    }
    if (num > 0) {
        float white_point = value_at_rank(values, num, (size_t)ceil(0.995 * (double)num) - 1);
        white_point = white_point > 0 ? white_point : value_at_rank(values, num, num - 1);
        *scale = white_point > FLT_MIN ? 1 / white_point : 1;
    }
    free(values);
    return values != NULL;
}

// What the tone map takes to t.
static double tone_map_inverse(double t)
{
    const double a = aces[0] - t * aces[2], b = aces[1] - t * aces[3], c = -t * aces[4];
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

bool flip_find_exposures(const metrics_image *reference, flip_exposures *exposures)
{
    const size_t size = (size_t)reference->width * reference->height;
    float *values = malloc(size * sizeof *values), largest = 0;
    size_t num = 0;
    *exposures = (flip_exposures){.count = 2};
    for (size_t i = 0; values && i < size; i++) {
        const float rgb[3] = {reference->rgb[0][i], reference->rgb[1][i], reference->rgb[2][i]};
        const float luminance = dot3(rgb_to_xyz[1], rgb);
        if (luminance > 0 && isfinite(luminance)) {
            values[num++] = luminance;
            largest = fmaxf(largest, luminance);
        }
    }
    if (num > 0) {
        const double bright = log2(tone_map_inverse(0.85));
        const double start = bright - log2(largest);
        const double stop = bright - log2(value_at_rank(values, num, (num - 1) / 2));
        exposures->start = (float)start;
        exposures->stop = (float)stop;
        exposures->count = (uint32_t)fmax(2, ceil(stop - start));
    }
    free(values);
    return values != NULL;
}
