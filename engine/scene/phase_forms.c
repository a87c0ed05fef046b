// phase_forms.c -- tables of phase functions, from lobes, Legendre moments or values at angles.
#include "base/fault.h"
#include "base/given.h"
#include "scene/phase_table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 0.01; // of an integral of 1

// ---- lobes ------------------------------------------------------------------------------------

tyn_result tyn_phase_droplets(double d, tyn_phase_lobe lobes[2])
{
    if (!lobes || !(d >= 5 && d <= 50)) {
        return TYN_ERR_PARAMS;
    }
    const double of_draine = exp(-0.599085 / (d - 0.641583) - 0.665888);
    lobes[0] = (tyn_phase_lobe){.weight = (float)(1 - of_draine),
                                .g = (float)exp(-0.0990567 / (d - 1.67154))};
    lobes[1] = (tyn_phase_lobe){.weight = (float)of_draine,
                                .g = (float)exp(-2.20679 / (d + 3.91029) - 0.428934),
                                .alpha = (float)exp(3.62489 - 8.29288 / (d + 5.52825))};
    return TYN_OK;
}

// `away`: 1 - mu. As hg.glsl: s^2 from terms that do not cancel.
static double lobe_value(const tyn_phase_lobe *lobe, double away)
{
    const double g = (double)lobe->g, a = fabs(g), alpha = (double)lobe->alpha;
    const double mu = 1 - away, s2 = (1 - a) * (1 - a) + 2 * a * (g >= 0 ? away : 2 - away);
    const double rest = (1 + alpha * mu * mu) / (1 + alpha * (1 + 2 * g * g) / 3);
    return (double)lobe->weight * (1 - g * g) / (4 * M_PI * s2 * sqrt(s2)) * rest;
}

static tyn_result check_lobes(const tyn_phase_form *form, const char *of, const tyn_log *log)
{
    double sum = 0;
    if (form->count > TYN_MAX_PHASE_LOBES) {
        FAULT("%s: %u lobes: at most %d", of, form->count, TYN_MAX_PHASE_LOBES);
    }
    for (uint32_t i = 0; i < form->count; i++) {
        const tyn_phase_lobe *lobe = &form->lobes[i];
        const double weight = (double)lobe->weight, g = (double)lobe->g,
                     alpha = (double)lobe->alpha;
        if (!(weight >= 0 && weight <= 1 + tolerance)) {
            FAULT("%s.lobes[%u].weight = %g: must be between 0 and 1", of, i, weight);
        }
        if (!(fabs(g) <= (double)0.999f)) {
            FAULT("%s.lobes[%u].g = %g: must be between -0.999 and 0.999", of, i, g);
        }
        if (!(alpha >= 0 && alpha <= 1e6)) {
            FAULT("%s.lobes[%u].alpha = %g: must be between 0 and 1e6", of, i, alpha);
        }
        sum += weight;
    }
    if (!(fabs(sum - 1) <= tolerance)) {
        FAULT("%s.lobes: their weights add up to %g: must be 1, within 1 %%", of, sum);
    }
    return TYN_OK;
}

static void fill_lobes(const tyn_phase_form *form, double values[TYN_PHASE_NODES])
{
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        values[k] = 0;
        for (uint32_t i = 0; i < form->count; i++) {
            values[k] += lobe_value(&form->lobes[i], tyn_phase_node_away(k));
        }
    }
}

// ---- Legendre moments -------------------------------------------------------------------------

static tyn_result check_moments(const tyn_phase_form *form, const char *of, const tyn_log *log)
{
    for (uint32_t l = 0; l < form->count; l++) {
        const double chi = form->moments[l];
        if (!(fabs(chi) <= 1 + tolerance)) {
            FAULT("%s.legendre[%u] = %g: must be between -1 and 1", of, l, chi);
        }
    }
    if (!(fabs(form->moments[0] - 1) <= tolerance)) {
        FAULT("%s.legendre[0] = %g: it is the integral over the sphere, which must be 1", of,
              form->moments[0]);
    }
    return TYN_OK;
}

// P_l by differences (phase_table.c); behind P_l(-mu) = (-1)^l P_l(mu).
static void fill_moments(const tyn_phase_form *form, double values[TYN_PHASE_NODES])
{
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        const double away = tyn_phase_node_away(k), y = fmin(away, 2 - away);
        double p = 1, d = 0, sum = 0;
        for (uint32_t l = 0; l < form->count; l++) {
            const double sign = away > 1 && l % 2 ? -1 : 1;
            sum += sign * (2 * l + 1) / (4 * M_PI) * form->moments[l] * p;
            d = (l * d - (2 * l + 1) * y * p) / (l + 1);
            p += d;
        }
        values[k] = sum;
    }
}

// ---- values at angles -------------------------------------------------------------------------

static tyn_result check_angles(const tyn_phase_form *form, const char *of, const tyn_log *log)
{
    const double degree = M_PI / 180;
    const uint32_t last = form->count - 1;
    if (form->count < 2) {
        FAULT("%s.angles: %u of them: at least 2, from 0 to 180 degrees", of, form->count);
    }
    for (uint32_t i = 0; i <= last; i++) {
        if (!isfinite(form->angles[i])) {
            FAULT("%s.angles[%u] = %g: must be finite", of, i, form->angles[i] / degree);
        }
        if (i > 0 && !(form->angles[i] > form->angles[i - 1])) {
            FAULT("%s.angles[%u] = %g: must be greater than the one before it, %g", of, i,
                  form->angles[i] / degree, form->angles[i - 1] / degree);
        }
        if (!(form->values[i] >= 0 && form->values[i] <= 1e12)) {
            FAULT("%s.values[%u] = %g: must be >= 0 and finite, in 1/sr", of, i, form->values[i]);
        }
    }
    if (!(form->angles[0] == 0)) {
        FAULT("%s.angles[0] = %g: must be 0", of, form->angles[0] / degree);
    }
    if (!(fabs(form->angles[last] - M_PI) < 1e-6)) {
        FAULT("%s.angles[%u] = %g: the last one must be 180", of, last,
              form->angles[last] / degree);
    }
    return TYN_OK;
}

static void fill_angles(const tyn_phase_form *form, double values[TYN_PHASE_NODES])
{
    for (uint32_t k = 0, i = 0; k < TYN_PHASE_NODES; k++) {
        const double theta = tyn_phase_node_angle(k);
        while (i + 2 < form->count && form->angles[i + 1] <= theta) {
            i++;
        }
        const double width = form->angles[i + 1] - form->angles[i];
        const double t = fmin(fmax((theta - form->angles[i]) / width, 0), 1);
        values[k] = form->values[i] + t * (form->values[i + 1] - form->values[i]);
    }
}

// Over the sphere, as given: linear in the angle between the angles.
static double integral_of_angles(const tyn_phase_form *form)
{
    double sum = 0;
    for (uint32_t i = 0; i + 1 < form->count; i++) {
        const double a = form->angles[i], b = form->angles[i + 1];
        const double slope = (form->values[i + 1] - form->values[i]) / (b - a);
        sum += form->values[i] * cos(a) - form->values[i + 1] * cos(b) + slope * (sin(b) - sin(a));
    }
    return 2 * M_PI * sum;
}

// ---- tables -----------------------------------------------------------------------------------

static tyn_result fill_table(const tyn_phase_form *form, const char *of, tyn_phase_table *table,
                             const tyn_log *log)
{
    double values[TYN_PHASE_NODES];
    if (form->lobes) {
        fill_lobes(form, values);
    } else if (form->moments) {
        fill_moments(form, values);
    } else {
        fill_angles(form, values);
    }
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        // A series is rounded; what is below 0 by more is no phase function.
        if (!(values[k] >= -1e-6 * fmax(fabs(values[0]), 1))) {
            FAULT("%s: it is %g per steradian at %.4g degrees: must be >= 0 everywhere", of,
                  values[k], tyn_phase_node_angle(k) * 180 / M_PI);
        }
        table->values[k] = (float)fmax(values[k], 0);
    }
    const double integral = tyn_phase_table_integral(table);
    if (form->angles && fabs(integral_of_angles(form) - 1) <= tolerance &&
        !(fabs(integral - 1) <= tolerance)) {
        FAULT("%s: has a peak that is narrower than the %d angles that are kept of it: of its "
              "integral of 1 they hold %.6g",
              of, TYN_PHASE_NODES, integral);
    }
    if (!(fabs(integral - 1) <= tolerance)) {
        FAULT("%s: its integral over the sphere is %.6g: must be 1, within 1 %%", of, integral);
    }
    for (uint32_t k = 0; k < TYN_PHASE_NODES; k++) {
        table->values[k] = (float)((double)table->values[k] / integral);
    }
    return TYN_OK;
}

static tyn_result check_form(const tyn_phase_form *form, const char *of, const tyn_log *log)
{
    const int given = (form->lobes != NULL) + (form->moments != NULL) +
                      (form->angles != NULL && form->values != NULL);
    if (given != 1 || form->count == 0 || form->count > TYN_MAX_PHASE_NUMBERS) {
        FAULT("%s: must have one of lobes, legendre, or angles with values, of 1 to %d", of,
              TYN_MAX_PHASE_NUMBERS);
    }
    return form->lobes     ? check_lobes(form, of, log)
           : form->moments ? check_moments(form, of, log)
                           : check_angles(form, of, log);
}

tyn_result tyn_scene_add_phase(tyn_scene *scene, const tyn_phase_form *form, const char *of,
                               tyn_phase *phase, const tyn_log *log)
{
    if (!TYN_GIVEN(log, scene, form, of, phase) || check_form(form, of, log)) {
        return TYN_ERR_PARAMS;
    }
    if (form->lobes && form->count == 1 && form->lobes[0].alpha == 0.0f) {
        *phase = (tyn_phase){.g = form->lobes[0].g};
        return TYN_OK;
    }
    tyn_phase_table table;
    if (fill_table(form, of, &table, log)) {
        return TYN_ERR_PARAMS;
    }
    uint32_t index = 0;
    while (index < scene->num_phase_tables &&
           memcmp(&scene->phase_tables[index], &table, sizeof table) != 0) {
        index++;
    }
    if (index == TYN_MAX_PHASE_TABLES) {
        FAULT("%s: there may be %d different phase functions", of, TYN_MAX_PHASE_TABLES);
    }
    if (index == scene->num_phase_tables) {
        tyn_phase_table *grown = realloc(scene->phase_tables, (index + 1) * sizeof *grown);
        if (!grown) {
            return TYN_FAULT(log, TYN_ERR_MEMORY, "%s: no memory for its table", of);
        }
        grown[index] = table;
        scene->phase_tables = grown;
        scene->num_phase_tables++;
    }
    *phase = tyn_phase_of_table(&table, index);
    return TYN_OK;
}
