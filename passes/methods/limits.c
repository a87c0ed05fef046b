// limits.c -- the rows of methods' tables that count in a regime, and a frame's warnings from them.
#include <tyndall/extend/limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- tables -----------------------------------------------------------------------------------

static double figure_of(const tyn_regime *r, size_t offset)
{
    return *(const double *)((const char *)r + offset);
}

static bool hold(const tyn_bound *bounds, size_t count, const tyn_regime *r)
{
    for (size_t i = 0; i < count && bounds[i].above < bounds[i].below; i++) {
        // As floats: what a scene gives as 0.995 is not above 0.995.
        const float x = (float)figure_of(r, bounds[i].figure);
        if (!(x > (float)bounds[i].above && x < (float)bounds[i].below)) {
            return false;
        }
    }
    return true;
}

const tyn_limit *tyn_limit_next(const tyn_limit *table, const tyn_limit *last, const tyn_regime *r)
{
    if (!r || (last && last->level == TYN_LIMIT_REFUSED)) {
        return NULL;
    }
    for (const tyn_limit *row = last ? last + 1 : table; row && row->key; row++) {
        const bool another = !last || strcmp(row->key, last->key) != 0;
        if (another && hold(row->where, TYN_LIMIT_BOUNDS, r)) {
            return row;
        }
    }
    return NULL;
}

double tyn_limit_error(const tyn_limit *limit, const tyn_regime *r)
{
    return limit && r && limit->error ? limit->error(r) : 0;
}

void tyn_limit_say(const tyn_limit *limit, const tyn_limit_text *text, const tyn_regime *r,
                   char *line, size_t size)
{
    double x[3];
    if (line && size) {
        line[0] = 0;
    }
    if (!limit || !text || !text->format || !r || !line || !size) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        if (text->figures[i] == TYN_LIMIT_ERROR) {
            const double percent = 100 * tyn_limit_error(limit, r);
            x[i] = percent < 10 ? round(10 * percent) / 10 : round(percent);
        } else {
            x[i] = figure_of(r, text->figures[i]);
        }
    }
    snprintf(line, size, text->format, x[0], x[1], x[2]);
}

double tyn_limit_along(const tyn_limit_point *curve, size_t count, double x)
{
    if (!(x >= curve[0].x)) {
        return 0;
    }
    for (size_t i = 1; i < count; i++) {
        const tyn_limit_point *a = &curve[i - 1], *b = &curve[i];
        if (x < b->x) {
            const double t = log(x / a->x) / log(b->x / a->x);
            return a->error * pow(b->error / a->error, t);
        }
    }
    return curve[count - 1].error;
}

// Places are single precision.
double tyn_limit_again(const tyn_regime *r)
{
    return r->again;
}

double tyn_limit_floats(const tyn_regime *r)
{
    static const tyn_limit_point curve[] = {{3e6, 0.1}, {1e8, 0.4}}; // depth of the box
    return tyn_limit_along(curve, 2, r->depth);
}

// ---- a frame ----------------------------------------------------------------------------------

// The medium where it matters: in a grid at the density of the average particle of the medium; where several media
// overlap, the sum of their largest values. Largest channel.
typedef struct dense {
    float extinction; // 1/m
    float scaled;     // delta scaled
    float transport;  // sigma_a + (1 - g) sigma_s
    float scattering; // delta scaled
    float absorption;
    float least_g, most_g; // of what scatters
} dense;

static void add_channel(dense *d, float s, float a, tyn_phase phase, float density)
{
    const float f = (float)tyn_phase_delta_fraction(phase);
    const float g = (float)tyn_phase_mean_cosine(phase);
    s *= density;
    a *= density;
    d->extinction = fmaxf(d->extinction, s + a);
    d->scaled = fmaxf(d->scaled, (1 - f) * s + a);
    d->transport = fmaxf(d->transport, (1 - g) * s + a);
    d->scattering = fmaxf(d->scattering, (1 - f) * s);
    d->absorption = fmaxf(d->absorption, a);
    if (s > 0) { // a backward peak beside a forward one counts by its height
        d->least_g = fminf(d->least_g, phase.backward > 0 ? fminf(g, -phase.backward) : g);
        d->most_g = fmaxf(d->most_g, g);
    }
}

static dense dense_of(const tyn_job *job)
{
    const tyn_frame_scene *frame = job->frame;
    const struct medium_block *m = &frame->medium;
    dense sum = {.least_g = 1, .most_g = -1};
    if (m->mode == TYN_MEDIUM_DENSITY) {
        float density = frame->typical_density > 0 ? frame->typical_density : m->max_density;
        for (int c = 0; c < 3; c++) {
            add_channel(&sum, m->sigma_s[c], m->sigma_a[c], m->phase[c], density);
        }
        return sum;
    }
    for (uint32_t i = 0; i < m->num_shapes; i++) {
        const tyn_scene *scene = job->scene;
        const int32_t volume = scene->media[scene->shapes[i].medium].volume;
        const float density = volume < 0 ? 1 : scene->volumes[volume].max_density;
        const struct shape_block *s = &frame->shapes[i];
        dense one = {.least_g = sum.least_g, .most_g = sum.most_g};
        for (int c = 0; c < 3; c++) {
            add_channel(&one, s->sigma_s[c], s->sigma_a[c], s->phase[c], density);
        }
        sum.extinction += one.extinction;
        sum.scaled += one.scaled;
        sum.transport += one.transport;
        sum.scattering += one.scattering;
        sum.absorption += one.absorption;
        sum.least_g = one.least_g;
        sum.most_g = one.most_g;
    }
    return sum;
}

static float longest_side(const tyn_job *job)
{
    const float *e = job->frame->medium.extent;
    return fmaxf(e[0], fmaxf(e[1], e[2]));
}

static float shortest_side(const tyn_job *job)
{
    const struct medium_block *m = &job->frame->medium;
    float shortest = INFINITY;
    for (int a = 0; a < 3; a++) {
        shortest = m->repeat[a] ? shortest : fminf(shortest, m->extent[a]);
    }
    return shortest;
}

float tyn_limit_scatterings(const tyn_job *job)
{
    return dense_of(job).scattering * longest_side(job);
}

void tyn_limits_warn(const tyn_job *job, float cell)
{
    const dense d = dense_of(job);
    const float *sky = job->frame->environment.sky;
    const float longest = longest_side(job), shortest = shortest_side(job);
    const bool lit = sky[0] + sky[1] + sky[2] > 0.0f;
    const tyn_regime r = {
        .depth = d.extinction * longest,
        .mean_free_path = 1 / (d.extinction * longest),
        .mean_depth = d.extinction * longest,
        .scatterings = d.scattering * longest,
        .all_scatterings = (d.extinction - d.absorption) * longest,
        .thickness = d.scaled * shortest,
        .albedo = d.extinction > 0 ? 1 - d.absorption / d.extinction : 0,
        .scaled_albedo = d.scaled > 0 ? 1 - d.absorption / d.scaled : 0,
        .least_g = d.least_g,
        .most_g = d.most_g,
        .g = NAN, // this, and what else is NAN, takes more than a frame's figures
        .transport_depth = NAN,
        .again = NAN,
        .cell_depth = d.scaled * cell,
        .cell_transport = d.transport * cell,
        .cells_through = cell > 0 ? shortest / cell : INFINITY,
        .cells_needed = NAN,
        .cells_most = NAN,
        .cells_spare = NAN,
        .lamps = NAN,
        .map = NAN,
        .sky_on_surfaces = lit && !job->frame->empty && tyn_has_walls(job->frame),
        .glow_on_surfaces = NAN,
        .surfaces = job->frame->num_triangles > 0,
        .repeats = tyn_is_periodic(job->frame),
    };
    const tyn_limit *row = NULL;
    while ((row = tyn_limit_next(job->method->limits, row, &r)) != NULL) {
        if (row->warning.format && hold(row->warned, TYN_LIMIT_BOUNDS, &r)) {
            char line[256];
            tyn_limit_say(row, &row->warning, &r, line, sizeof line);
            tyn_job_warn(job, "%s", line);
        }
    }
}
