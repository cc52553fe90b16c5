#include "jobs/like/like_percentile.h"
#include "jobs/estimate.h"
#include "jobs/like/like_verdict.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct like_place like_place_of(size_t n, const double *values, double measured) {
    struct like_place place = {0};
    for (size_t r = 0; r < n; r++) {
        place.below += values[r] < measured;
        place.equal += values[r] == measured;
        place.above += values[r] > measured;
    }
    return place;
}

double like_percentile(const struct like_place *place, double *standard_error) {
    double others = (double)(place->below + place->equal + place->above);
    double share = ((double)place->below + ((double)place->equal + 1) / 2) / (others + 1);
    *standard_error = others > 0 ? 100 * sqrt(share * (1 - share) / others) : (double)NAN;
    return others > 0 ? 100 * share : (double)NAN;
}

static int add(struct case_result *out, const char *before, const char *name, double value,
               double standard_error, double effective, struct error *err) {
    char text[80];
    snprintf(text, sizeof text, "%s_%s", before, name);
    const char *kept = result_text(out, text);
    if (kept == NULL)
        return error_memory(err, sizeof text, "a scalar's name");
    struct scalar scalar = scalar_named(kept, value, standard_error, NAN);
    scalar.effective = effective;
    return result_add_scalar(out, &scalar, err);
}

static int add_quantity(const struct like_case *like, enum patch_quantity quantity, size_t n,
                        const double *values, double difference, struct case_result *out,
                        struct error *err) {
    const struct like_place place = like_place_of(n, values, like->measured[quantity]);
    const struct estimate mean = estimate_mean(n, values);
    double standard_error, percentile = like_percentile(&place, &standard_error);
    const char *name = PATCH_NAMES[quantity];
    const double effective = estimate_effective(n, values, NULL);
    int status = add(out, "piece", name, mean.value, mean.standard_error, effective, err);
    if (status == 0)
        status = add(out, "measured", name, like->measured[quantity], 0, 0, err);
    if (status == 0)
        status = add(out, "percentile", name, percentile, standard_error, 0, err);
    if (status == 0)
        status = add(out, "difference", name, difference, NAN, 0, err);
    return status;
}

static int add_all(const struct like_case *like, size_t n, const double *values,
                   struct case_result *out, struct error *err) {
    struct like_verdict verdict;
    int status = like_verdict_measure(n, values, like->measured, &verdict, err);
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT && status == 0; a++)
        if (isfinite(like->measured[a]))
            status = add_quantity(like, (enum patch_quantity)a, n, values + a * n,
                                  verdict.difference[a], out, err);
    return status == 0
               ? add(out, "like", "p_value", verdict.p_value, verdict.standard_error, 0, err)
               : status;
}

int like_scalars(const struct like_case *like, const struct realisations *realisations,
                 size_t first, struct case_result *out, struct error *err) {
    size_t n = (size_t)realisations->count;
    if (!like_case_is_cut(like))
        return 0;
    double *values = array_create(n + 1, PATCH_QUANTITY_COUNT * sizeof *values);
    if (values == NULL)
        return error_memory(err, n * PATCH_QUANTITY_COUNT * sizeof *values, "sub-maps of surfaces");
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++)
        realisations_column(realisations, first + a, values + a * n);
    int status = add_all(like, n, values, out, err);
    free(values);
    return status;
}
