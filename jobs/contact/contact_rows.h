/* What each realisation gave on the finest level, a row each: differences between cases of the same
 * random numbers are known by pairs of realisations, which sums over them do not tell.
 *
 * A row holds, by model, the measures that contact_rows_column knows, by load; then, of a case that
 * is like a measured surface, the areas by edges and the gaps of the mirrored piece. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ROWS_H
#define RUGO_JOBS_CONTACT_CONTACT_ROWS_H

#include "jobs/contact/contact_case.h"
#include "schema/result/bytes.h"

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
/* Finds where in a row the values of a measure with a model stand, one a load; false where they are
 * not kept. */
bool contact_rows_column(const struct contact_case *one_case, size_t model,
                         enum contact_measure measure, size_t *column);
/* Returns where the values of a mirrored piece (contact_like.h) stand, one a load, of a case that
 * has them; measure: MEASURE_EDGES or MEASURE_GAP. */
size_t contact_rows_like_column(const struct contact_case *one_case, enum contact_measure measure);
void contact_rows_clear(struct contact_rows *rows);
/* Makes room for so many more rows, whatever the number of those that follow. */
int contact_rows_reserve(struct contact_rows *rows, size_t more, struct error *err);

/* Appends a row of a later realisation than all so far, from values by measure and cell (as those
 * of a tally), into room that was reserved. */
void contact_rows_append(struct contact_rows *rows, const struct contact_case *one_case,
                         uint64_t realisation, const double *values);
/* Merges rows of other realisations, in their order, into room that was reserved. */
void contact_rows_merge(struct contact_rows *into, const struct contact_rows *from);

void contact_rows_put(struct bytes *bytes, const struct contact_rows *rows);
/* Reads into empty rows. Fails the reader where they are not what put makes. */
void contact_rows_get(struct byte_reader *reader, struct contact_rows *rows);

#endif
