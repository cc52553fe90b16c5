#include "jobs/contact/quantity/quantity_scalars.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/quantity/quantity.h"
#include "jobs/estimate.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SCALARS_MOST = 8 };

/* Fills what the scalars of realisation `row` are made of; room: loads x (measures + 1). */
static struct quantity_values values_of(const struct contact_tally *tally, size_t row, size_t first,
                                        double *room) {
    const struct contact_case *one_case = tally->one_case;
    const double *kept = tally->rows.values + row * tally->rows.width;
    size_t n = contact_case_slots(one_case), column;
    for (size_t a = 0; a <= QUANTITY_MEASURES_MOST; a++) {
        enum contact_measure measure =
            a == 0 ? MEASURE_EDGES : (enum contact_measure)(first + a - 1);
        bool known = measure < MEASURE_PAIRED && contact_rows_column(one_case, 0, measure, &column);
        for (size_t k = 0; k < n; k++)
            room[a * n + k] = known ? kept[column + k] : (double)NAN;
    }
    return (struct quantity_values){.one_case = one_case,
                                    .load_count = n,
                                    .loads = one_case->loads,
                                    .areas = room,
                                    .of = room + n};
}

/* Sets the errors of a scalar that is over so many effective rows, or all. Those of the quantity's
 * first measure bear on it and are not known. The other realisations, such as those that close at
 * heavier loads, are assumed to differ as those of a curve are. */
static void set_errors(const struct contact_tally *tally, size_t first, size_t rows,
                       double effective, struct scalar *out) {
    const size_t finest = tally->one_case->level_count - 1;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        out->errors[s].applies =
            s != ERROR_MISSING &&
            contact_error_applies(tally, (enum contact_measure)first, 0, finest, s);
    out->effective = effective;
    if (effective == 0)
        return;
    const double deviation = out->standard_error * sqrt(effective);
    const double share = ((double)rows - effective) / (double)rows;
    out->errors[ERROR_MISSING] =
        (struct scalar_error){.applies = true,
                              .known = !isnan(deviation),
                              .bound = share * MISSING_DEVIATIONS * deviation};
}

/* Appends the scalars of one quantity; columns: room for SCALARS_MOST of all realisations. */
static int put(const struct contact_tally *tally, const struct contact_quantity *quantity,
               size_t first, double *room, double *columns, struct case_result *out,
               struct error *err) {
    size_t count = 0, rows = tally->rows.count;
    double scalars[SCALARS_MOST];
    while (count < SCALARS_MOST && quantity->scalars[count] != NULL)
        count++;
    for (size_t r = 0; r < rows; r++) {
        const struct quantity_values values = values_of(tally, r, first, room);
        quantity->summarise(&values, scalars);
        for (size_t a = 0; a < count; a++)
            columns[a * rows + r] = scalars[a];
    }
    int status = 0;
    for (size_t a = 0; a < count && status == 0; a++) {
        struct estimate mean = estimate_mean(rows, columns + a * rows);
        struct scalar scalar =
            scalar_named(quantity->scalars[a], mean.value, mean.standard_error, NAN);
        set_errors(tally, first, rows, estimate_effective(rows, columns + a * rows, NULL), &scalar);
        status = result_add_scalar(out, &scalar, err);
    }
    return status;
}

int quantity_scalars(const struct contact_tally *tally, struct case_result *out,
                     struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t loads = (QUANTITY_MEASURES_MOST + 1) * contact_case_slots(one_case);
    size_t values = SCALARS_MOST * tally->rows.count;
    double *room = array_create(loads + values, sizeof *room);
    int status = room != NULL ? 0 : error_memory(err, (loads + values) * sizeof *room, "scalars");
    for (size_t at = 0; at < CONTACT_QUANTITIES && status == 0; at++) {
        size_t first;
        const struct contact_quantity *quantity = contact_quantity_at(at, &first);
        if (quantity != NULL && one_case->asked.of[at] && quantity->scalars != NULL)
            status = put(tally, quantity, first, room, room + loads, out, err);
    }
    free(room);
    return status;
}
