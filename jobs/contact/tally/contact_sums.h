/* Sums of values over the realisations that have one. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SUMS_H
#define RUGO_JOBS_CONTACT_CONTACT_SUMS_H

#include "jobs/contact/case/contact_case.h"
#include "jobs/tally.h"

struct contact_sums {
    struct tally_sums sums;
    struct tally counts;
};
int contact_sums_create(struct contact_sums *out, size_t size, struct error *err);
void contact_sums_clear(struct contact_sums *sums);
double contact_sums_bytes(size_t size);
/* Adds the value of a realisation, unless it is NaN: then it has none. */
void contact_sums_add(struct contact_sums *sums, size_t cell, double value);
/* Returns the mean of values that were multiplied by `scale`; NaN of none. */
struct estimate contact_sums_mean(const struct contact_sums *sums, size_t cell, double scale);
/* Returns whether no cell has values of more realisations. */
bool contact_sums_fit(const struct contact_sums *sums, uint64_t realisations);
void contact_sums_put(struct bytes *bytes, const struct contact_sums *sums);
void contact_sums_get(struct byte_reader *reader, struct contact_sums *sums);
void contact_sums_merge(struct contact_sums *into, const struct contact_sums *from);

/* Returns the factor by which values are multiplied before they are summed. Exact sums resolve
 * 2^-60; a measure that falls with the load is divided by a power of two near it, which is exact,
 * so that light loads keep their digits. */
double contact_sums_scale(const struct contact_case *one_case, enum contact_measure measure,
                          size_t load);

#endif
