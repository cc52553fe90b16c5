/* Whether a tally that was read can be. */
#include "jobs/contact/contact_tally.h"
#include <math.h>

/* Returns whether a cell has as many values as it can: none more than there are realisations, one
 * of each where all have one, and of a model that may fail no more than at the load before. */
static bool count_fits(const struct contact_tally *tally, enum contact_measure measure,
                       size_t cell) {
    const struct contact_case *one_case = tally->one_case;
    const uint64_t *count = tally->sums[measure].counts.count;
    size_t model = cell / (one_case->level_count * one_case->load_count);
    bool always = measure == MEASURE_NODES || measure == MEASURE_EDGES || measure == MEASURE_GAP ||
                  measure == MEASURE_ITERATIONS;
    if (!always)
        return count[cell] <= tally->realisations;
    if (one_case->models[model]->may_fail)
        return count[cell] <=
               (cell % one_case->load_count > 0 ? count[cell - 1] : tally->realisations);
    return count[cell] == tally->realisations;
}

/* Realisations and levels that a model which may fail did not bring to the last load: a note each.
 */
static uint64_t unsolved(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    size_t last = one_case->load_count - 1;
    uint64_t count = 0;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; l < one_case->level_count && one_case->models[m]->may_fail; l++)
            count += contact_tally_valueless(tally, MEASURE_NODES,
                                             contact_case_cell(one_case, m, l, last));
    return count;
}

/* Returns whether the pressures of a load lie on the area by edges, but for rounding. */
static bool pressures_fit(const struct contact_tally *tally, size_t model, size_t level,
                          size_t at) {
    const struct contact_case *one_case = tally->one_case;
    size_t cell = contact_case_cell(one_case, model, level, one_case->pdf_loads[at]);
    const uint64_t *count =
        tally->pressures.count + contact_tally_pressure_cell(tally, model, level, at);
    double parts = (double)CONTACT_AREA_PARTS * (double)grid_points(&one_case->levels[level].grid);
    double area = parts * contact_tally_total(tally, MEASURE_EDGES, cell), sum = 0;
    for (size_t b = 0; b < contact_case_bins(one_case); b++)
        sum += (double)count[b];
    return fabs(sum - area) <= 1e-6 * area + (double)tally->realisations;
}

/* Returns whether the values of a column of the rows add up to the sum of a cell. */
static bool column_fits(const struct contact_tally *tally, size_t column,
                        enum contact_measure measure, size_t cell) {
    const struct contact_rows *rows = &tally->rows;
    const struct exact_sum *told = &tally->sums[measure].sums.sum[cell];
    double scale =
        contact_tally_scale(tally->one_case, measure, cell % tally->one_case->load_count);
    struct exact_sum sum = {0};
    uint64_t count = 0;
    for (size_t r = 0; r < rows->count; r++) {
        double value = rows->values[r * rows->width + column];
        if (isnan(value))
            continue;
        exact_sum_add(&sum, value * scale);
        count++;
    }
    return count == tally->sums[measure].counts.count[cell] && sum.total == told->total &&
           sum.lost == told->lost;
}

static bool rows_fit(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    size_t column;
    bool fit = tally->rows.count == tally->realisations;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (enum contact_measure a = 0; a < MEASURE_COUNT; a++) {
            if (!contact_rows_column(one_case, m, a, &column))
                continue;
            for (size_t k = 0; k < one_case->load_count && fit; k++)
                fit = column_fits(tally, column + k, a,
                                  contact_case_cell(one_case, m, one_case->level_count - 1, k));
        }
    for (size_t k = 0; k < one_case->load_count && contact_case_has_like(one_case) && fit; k++)
        fit = column_fits(tally, contact_rows_like_column(one_case, MEASURE_EDGES) + k,
                          MEASURE_EDGES, contact_case_like_cell(one_case, k)) &&
              column_fits(tally, contact_rows_like_column(one_case, MEASURE_GAP) + k, MEASURE_GAP,
                          contact_case_like_cell(one_case, k));
    return fit;
}

bool contact_tally_adds_up(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    for (size_t a = 0; a < MEASURE_COUNT; a++)
        for (size_t cell = 0; cell < contact_case_cells(one_case); cell++)
            if (!count_fits(tally, (enum contact_measure)a, cell))
                return false;
    for (size_t a = MEASURE_COUNT; a < CONTACT_SUMS; a++) {
        const struct tally *counts = &tally->sums[a].counts;
        for (size_t cell = 0; cell < counts->size; cell++)
            if (counts->count[cell] > tally->realisations)
                return false;
    }
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; l < one_case->level_count; l++)
            for (size_t a = 0; a < one_case->pdf_count && contact_tally_counts(one_case, l); a++)
                if (!pressures_fit(tally, m, l, a))
                    return false;
    return tally->points.realisations == tally->realisations && rows_fit(tally) &&
           tally->notes.count == unsolved(tally);
}
