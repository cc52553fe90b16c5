/* The values of each realisation on the finest level, a row each. Differences between cases of the
 * same random numbers are estimated from pairs of realisations, for which sums do not suffice.
 *
 * A row holds, by model and load, the measures that contact_rows_column knows. Those that the
 * plans of companions keep follow, by companion, series, measure and load. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ROWS_H
#define RUGO_JOBS_CONTACT_CONTACT_ROWS_H

#include "jobs/contact/companion/companion_tally.h"
#include "schema/result/bytes/bytes.h"

struct contact_rows { /* initialise with {0} and a width */
    size_t width;     /* values of a realisation */
    size_t count, capacity;
    uint64_t *realisation; /* owned: count, rising */
    double *values;        /* owned: count x width; NaN: none */
};
/* Returns how many values a realisation of the case has. */
size_t contact_rows_width(const struct contact_case *one_case);
/* Returns the bytes of a row, in memory and in a partial result. */
double contact_rows_bytes(const struct contact_case *one_case);
/* Finds the column with the values of a measure below MEASURE_OWN of a model, one for each load;
 * false where they are not kept. */
bool contact_rows_column(const struct contact_case *one_case, size_t model,
                         enum contact_measure measure, size_t *column);
/* Returns the column with the values of a measure that the plan of a companion keeps, one for each
 * load. */
size_t contact_rows_companion_column(const struct contact_case *one_case,
                                     enum companion_name companion, size_t series,
                                     enum contact_measure measure);
void contact_rows_clear(struct contact_rows *rows);
/* Makes room for so many more rows. */
int contact_rows_reserve(struct contact_rows *rows, size_t more, struct error *err);

/* Appends the row of a realisation that is later than all so far, into reserved room. values: by
 * measure and cell, as those of a tally; companions: all of its tallies. */
void contact_rows_append(struct contact_rows *rows, const struct contact_case *one_case,
                         uint64_t realisation, const double *values,
                         const struct companion_tally *companions);
/* Merges rows of other realisations, in their order, into reserved room. */
void contact_rows_merge(struct contact_rows *into, const struct contact_rows *from);

void contact_rows_put(struct bytes *bytes, const struct contact_rows *rows);
/* Reads into empty rows. Fails the reader for bytes that contact_rows_put does not make. */
void contact_rows_get(struct byte_reader *reader, struct contact_rows *rows);

#endif
