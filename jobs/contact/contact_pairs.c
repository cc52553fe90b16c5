#include "jobs/contact/contact_pairs.h"
#include "jobs/contact/contact_measure.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* These curves are means of measures that rows keep. */
static const struct {
    const char *quantity, *series;
    enum contact_measure measure;
} KEPT[] = {{"contact_area", "edges", MEASURE_EDGES},
            {"contact_area", "edges_stretched", MEASURE_EDGES_STRETCHED},
            {"contact_area", "nodes", MEASURE_NODES},
            {"contact_area", "perimeter", MEASURE_PERIMETER},
            {"mean_gap", "", MEASURE_GAP},
            {"stiffness", "", MEASURE_STIFFNESS}};

static bool measure_of(const struct curve *curve, enum contact_measure *measure) {
    for (size_t a = 0; a < sizeof KEPT / sizeof *KEPT; a++)
        if (strcmp(KEPT[a].quantity, curve->quantity) == 0 &&
            strcmp(KEPT[a].series, curve->series) == 0) {
            *measure = KEPT[a].measure;
            return true;
        }
    return false;
}

bool contact_point_values(const struct contact_tally *tally, const struct curve *curve, size_t at,
                          struct point_values *out) {
    const struct contact_case *one_case = tally->one_case;
    enum contact_measure measure;
    size_t column, model = 0;
    while (model < one_case->model_count &&
           !same_text(contact_model_name(one_case->models[model]), curve->model))
        model++;
    if (model == one_case->model_count || at >= one_case->load_count ||
        !same_number(curve->level, contact_case_finest(one_case)->points) ||
        !measure_of(curve, &measure) || !contact_rows_column(one_case, model, measure, &column))
        return false;
    *out = (struct point_values){tally->rows.values + column + at, tally->rows.width};
    return true;
}

/* The fit of the first model over its first n loads, n > 0, anew of every realisation. */
static int fit_rows(const struct contact_tally *tally, enum contact_measure fit, size_t n,
                    double *values, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    const struct contact_rows *rows = &tally->rows;
    double *fits = array_create(3 * n, sizeof *fits);
    size_t column = 0;
    if (fits == NULL)
        return error_memory(err, 3 * n * sizeof *fits, "fits");
    contact_rows_column(one_case, 0, MEASURE_EDGES, &column);
    for (size_t r = 0; r < rows->count; r++) {
        contact_measure_fits(n, one_case->loads, rows->values + r * rows->width + column, fits,
                             fits + n, fits + 2 * n);
        values[r] = fits[(size_t)(fit - MEASURE_KAPPA) * n + n - 1];
    }
    free(fits);
    return 0;
}

int contact_scalar_values(const struct contact_tally *tally,
                          const struct realisations *realisations, size_t scalar, double *values,
                          struct error *err) {
    enum contact_measure fit;
    size_t loads;
    if (!contact_scalar_fit(tally, scalar, &fit, &loads)) {
        realisations_column(realisations, scalar, values);
        return 0;
    }
    for (size_t r = 0; r < tally->rows.count; r++)
        values[r] = NAN;
    return loads > 0 ? fit_rows(tally, fit, loads, values, err) : 0;
}
