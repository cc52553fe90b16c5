#include "jobs/contact/companion/companion.h"
#include <stdlib.h>

#define ADDRESS(name) &COMPANION_ROW_##name,
const struct companion *const COMPANIONS[COMPANION_COUNT] = {COMPANION_NAMES(ADDRESS)};

struct companion_bench {
    const struct contact_case *one_case;
    void *workspaces[COMPANION_COUNT]; /* owned; NULL: the case has no such companion */
};

const struct companion *companion_of(enum error_source source) {
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        if (COMPANIONS[c]->source == source)
            return COMPANIONS[c];
    return NULL;
}

void companions_plan(struct contact_case *one_case, struct values *values) {
    for (size_t c = 0; c < COMPANION_COUNT; c++) {
        const struct companion *companion = COMPANIONS[c];
        struct companion_plan plan = {0};
        bool wanted = companion->parameter == NULL ||
                      values_choice(values, companion->parameter) != COMPANION_NONE;
        if (wanted && companion->plan(one_case, &plan))
            one_case->companions[c] = plan;
    }
}

double companions_bytes(const struct contact_case *one_case) {
    double bytes = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++)
        if (contact_case_has(one_case, c))
            bytes += COMPANIONS[c]->bytes(one_case, &one_case->companions[c]);
    return bytes;
}

double companions_seconds(const struct contact_case *one_case) {
    double seconds = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++)
        if (contact_case_has(one_case, c))
            seconds += COMPANIONS[c]->seconds(one_case, &one_case->companions[c]) /
                       (double)one_case->companions[c].due.interval;
    return seconds;
}

double companions_beyond_seconds(const struct contact_case *one_case, uint64_t realisation) {
    double seconds = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++) {
        const struct companion_plan *plan = &one_case->companions[c];
        if (contact_case_has(one_case, c))
            seconds +=
                COMPANIONS[c]->seconds(one_case, plan) *
                ((double)companion_draws(plan, realisation) - 1 / (double)plan->due.interval);
    }
    return seconds;
}

int companions_curves(const struct contact_tally *tally, struct case_result *out,
                      struct error *err) {
    int status = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT && status == 0; c++)
        if (contact_case_has(tally->one_case, c) && COMPANIONS[c]->curves != NULL)
            status = COMPANIONS[c]->curves(tally, out, err);
    return status;
}

/* --- the bench --- */

static int add_workspace(struct companion_bench *bench, enum companion_name at,
                         const struct moments *moments, struct error *err) {
    const struct companion *companion = COMPANIONS[at];
    void *workspace = array_create(1, companion->size);
    if (workspace == NULL)
        return error_memory(err, companion->size, companion->what);
    bench->workspaces[at] = workspace;
    return companion->create(workspace, bench->one_case, &bench->one_case->companions[at], moments,
                             err);
}

int companion_bench_create(struct companion_bench **out, const struct contact_case *one_case,
                           const struct moments *moments, struct error *err) {
    struct companion_bench *bench = array_create(1, sizeof *bench);
    if (bench == NULL)
        return error_memory(err, sizeof *bench, "companions");
    bench->one_case = one_case;
    int status = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT && status == 0; c++)
        if (contact_case_has(one_case, c))
            status = add_workspace(bench, c, moments, err);
    if (status != 0)
        companion_bench_destroy(&bench);
    *out = bench;
    return status;
}

void companion_bench_destroy(struct companion_bench **bench) {
    struct companion_bench *gone = *bench;
    if (gone == NULL)
        return;
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        if (gone->workspaces[c] != NULL) {
            COMPANIONS[c]->clear(gone->workspaces[c]);
            free(gone->workspaces[c]);
        }
    free(gone);
    *bench = NULL;
}

/* Solves all draws of a companion. One without a surface has no values. */
static int solve_draws(struct companion_bench *bench, enum companion_name at,
                       const struct contact_surface *surface, struct contact_tally *tally,
                       const struct contact_stopper *stopper, struct error *err) {
    struct companion_tally *out = &tally->companions[at];
    uint64_t draws = companion_draws(&bench->one_case->companions[at], surface->key.realisation);
    out->draws = draws > 1 ? (size_t)draws : 1;
    int status = 0;
    for (out->draw = 0; out->draw < draws && status == 0; out->draw++) {
        struct error reason = {0};
        status =
            COMPANIONS[at]->solve(bench->workspaces[at], surface, tally, out, stopper, &reason);
        status =
            status == ERROR_NUMERIC || status == 0 ? 0 : error_set(err, status, "%s", reason.text);
    }
    out->draw = 0;
    return status;
}

int companion_bench_solve(struct companion_bench *bench, const struct contact_surface *surface,
                          struct contact_tally *tally, const struct contact_stopper *stopper,
                          struct error *err) {
    int status = 0;
    for (enum companion_name c = 0; c < COMPANION_COUNT && status == 0; c++)
        if (bench->workspaces[c] != NULL)
            status = solve_draws(bench, c, surface, tally, stopper, err);
    return status;
}
