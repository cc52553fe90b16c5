#include "jobs/contact/companion/companion_tally.h"
#include "jobs/contact/contact_measure.h"
#include <math.h>
#include <stdlib.h>

int companion_tally_create(struct companion_tally *out, const struct contact_case *one_case,
                           const struct companion_plan *plan, struct error *err) {
    size_t cells = companion_cell(one_case, plan->series, 0, 0);
    size_t room = cells * companion_draws_most(plan);
    out->values = array_create(room, sizeof *out->values);
    int status = out->values != NULL
                     ? contact_sums_create(&out->sums, cells, err)
                     : error_memory(err, room * sizeof *out->values, "a tally of a companion");
    if (status == 0)
        status = contact_sums_create(&out->differences,
                                     companion_cell(one_case, plan->pair_count, 0, 0), err);
    out->draws = companion_draws_most(plan);
    if (status == 0)
        companion_tally_begin(out);
    return status;
}

void companion_tally_clear(struct companion_tally *tally) {
    contact_sums_clear(&tally->sums);
    contact_sums_clear(&tally->differences);
    free(tally->values);
    *tally = (struct companion_tally){0};
}

double companion_tally_bytes(const struct contact_case *one_case,
                             const struct companion_plan *plan) {
    size_t cells = companion_cell(one_case, plan->series, 0, 0);
    size_t pairs = companion_cell(one_case, plan->pair_count, 0, 0);
    return sizeof(double) * (double)cells * (double)companion_draws_most(plan) +
           contact_sums_bytes(cells) + contact_sums_bytes(pairs);
}

void companion_tally_begin(struct companion_tally *tally) {
    for (size_t a = 0; a < tally->draws * tally->sums.counts.size; a++)
        tally->values[a] = NAN;
    tally->draw = 0;
    tally->draws = 1;
}

/* Computes the fits of a series of loads from its areas. */
static void fill_fits(const struct contact_case *one_case, double *series) {
    const size_t n = contact_case_slots(one_case);
    contact_measure_fits(one_case->load_count, one_case->loads, series + MEASURE_EDGES * n,
                         series + MEASURE_KAPPA * n, n);
}

static void add_pair(struct companion_tally *tally, const struct contact_case *one_case,
                     const struct companion_plan *plan, size_t pair) {
    const double *of = companion_series(one_case, tally, plan->pairs[pair].of);
    const double *less = companion_series(one_case, tally, plan->pairs[pair].less);
    for (enum contact_measure a = 0; a < measure_paired(one_case); a++)
        for (size_t k = 0; k < contact_case_values(one_case, measure_row(a)->by); k++) {
            size_t cell = companion_cell(one_case, 0, a, k);
            contact_sums_add(&tally->differences, companion_cell(one_case, pair, a, k),
                             (of[cell] - less[cell]) * contact_sums_scale(one_case, a, k));
        }
}

/* Adds the draw at which the tally stands. */
static void add_draw(struct companion_tally *tally, const struct contact_case *one_case,
                     const struct companion_plan *plan) {
    for (size_t series = 0; series < plan->series; series++) {
        double *values = companion_series(one_case, tally, series);
        fill_fits(one_case, values);
        for (enum contact_measure a = 0; a < measure_paired(one_case); a++)
            for (size_t k = 0; k < contact_case_values(one_case, measure_row(a)->by); k++)
                contact_sums_add(&tally->sums, companion_cell(one_case, series, a, k),
                                 values[companion_cell(one_case, 0, a, k)] *
                                     contact_sums_scale(one_case, a, k));
    }
    for (size_t pair = 0; pair < plan->pair_count; pair++)
        add_pair(tally, one_case, plan, pair);
}

void companion_tally_add(struct companion_tally *tally, const struct contact_case *one_case,
                         const struct companion_plan *plan) {
    for (tally->draw = 0; tally->draw < tally->draws; tally->draw++)
        add_draw(tally, one_case, plan);
    tally->draw = 0;
}

bool companion_tally_fits(const struct companion_tally *tally, const struct companion_plan *plan,
                          uint64_t realisations) {
    uint64_t extra = companion_draws_most(plan) - 1;
    uint64_t many = realisations < plan->due.first ? realisations : plan->due.first;
    uint64_t draws = realisations + many * extra;
    return contact_sums_fit(&tally->sums, draws) && contact_sums_fit(&tally->differences, draws);
}

void companion_tally_put(struct bytes *bytes, const struct companion_tally *tally) {
    contact_sums_put(bytes, &tally->sums);
    contact_sums_put(bytes, &tally->differences);
}

void companion_tally_get(struct byte_reader *reader, struct companion_tally *tally) {
    contact_sums_get(reader, &tally->sums);
    contact_sums_get(reader, &tally->differences);
}

void companion_tally_merge(struct companion_tally *into, const struct companion_tally *from) {
    contact_sums_merge(&into->sums, &from->sums);
    contact_sums_merge(&into->differences, &from->differences);
}
