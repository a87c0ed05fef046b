// phases.c -- the tables of phase functions that a frame's method knows, and one lobe instead where it does not.
#include "frame/context.h"
#include <tyndall/extend/hash.h>
#include "scene/phase.h"
#include "scene/phase_table.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

uint64_t tyn_phase_tables_hash(const tyn_scene *scene)
{
    return scene->num_phase_tables
               ? tyn_hash_bytes(TYN_HASH_SEED, scene->phase_tables,
                                scene->num_phase_tables * sizeof *scene->phase_tables)
               : 0;
}

static void take_one_lobe(tyn_phase phase[3])
{
    for (int c = 0; c < 3; c++) {
        if (phase[c].table) {
            phase[c] = tyn_phase_of_mean_cosine(phase[c].g);
        }
    }
}

static bool is_tabled(const tyn_frame_scene *frame)
{
    bool tabled = false;
    for (uint32_t i = 0; i < 3 * frame->medium.num_shapes; i++) {
        tabled = tabled || frame->shapes[i / 3].phase[i % 3].table > 0;
    }
    return tabled;
}

static void warn(tyn_context *ctx, bool knows)
{
    tyn_context_warn(
        ctx,
        knows
            ? "media of different phase functions: each counts as the Henyey-Greenstein lobe "
              "of its mean cosine; 'path' knows them"
            : "phase functions that are not one Henyey-Greenstein lobe count as that of their mean "
              "cosine; 'path', 'pop' and 'single' know them");
}

// Forward lobes are sums of Legendre polynomials, of which there are as many as g = 0.995 needs (passes/scatter_lut).
static void warn_of_narrow_lobes(tyn_context *ctx)
{
    const float most = 0.998f;
    float narrowest = 0;
    for (int c = 0; c < 3; c++) {
        const tyn_phase *p = &ctx->frame.medium.phase[c];
        narrowest = p->table ? fmaxf(narrowest, fmaxf(p->forward, p->backward)) : narrowest;
    }
    if (narrowest > most) {
        char line[256];
        snprintf(line, sizeof line,
                 "accuracy: a phase function is as high in its peak as a lobe of g %.5g: beyond %g "
                 "peaks are smeared over some degrees, with rings about them; 'path' knows them",
                 (double)narrowest, (double)most);
        tyn_context_warn(ctx, line);
    }
}

tyn_result tyn_frame_phases(tyn_context *ctx, const tyn_scene *scene)
{
    tyn_frame_scene *frame = &ctx->frame;
    if (!is_tabled(frame)) {
        return TYN_OK;
    }
    const tyn_known_phases known = ctx->method->info.phases;
    const bool one = frame->medium.mode != TYN_MEDIUM_COEFFICIENTS;
    if (known == TYN_PHASES_LOBES || (known == TYN_PHASES_ONE && !one)) {
        warn(ctx, known != TYN_PHASES_LOBES);
        take_one_lobe(frame->medium.phase);
        for (uint32_t i = 0; i < frame->medium.num_shapes; i++) {
            take_one_lobe(frame->shapes[i].phase);
        }
        return TYN_OK;
    }
    if (known == TYN_PHASES_ONE) {
        warn_of_narrow_lobes(ctx);
    }
    frame->phase_tables = scene->phase_tables;
    const uint64_t hash = tyn_phase_tables_hash(scene);
    const size_t size = scene->num_phase_tables * sizeof(float[TYN_PHASE_NODES][4]);
    if (hash != ctx->phase_hash) {
        ctx->phase_hash = 0;
        free(ctx->phase_rows);
        ctx->phase_rows = malloc(size);
        if (!ctx->phase_rows) {
            return TYN_ERR_MEMORY;
        }
        for (uint32_t i = 0; i < scene->num_phase_tables; i++) {
            tyn_phase_table_rows(&scene->phase_tables[i], ctx->phase_rows + i * TYN_PHASE_NODES);
        }
        ctx->phase_hash = hash;
    }
    return TYN_OK;
}
