/* A 64-bit mark of all values of a case, whatever the order of keys and whether defaults are
 * written out: tells cases apart.
 *
 * Partial results are stored with it, so that a case which could be computed by an earlier version
 * must keep its mark. It is a hash over the rows of the kind's tables, in their order: of each row
 * its number, then its value (numbers as doubles, strings as bytes). Hence:
 *  - rows keep their order, tables theirs within a kind, and defaults do not change;
 *  - a row added after results were stored says so (parameter.h, later). Such rows have no number;
 *    one whose value is its default, or absent, does not count, and any other is hashed with its
 *    path, behind all the numbered rows. */
#ifndef RUGO_JOBS_FINGERPRINT_H
#define RUGO_JOBS_FINGERPRINT_H

#include "schema/study/values.h"
#include <stdint.h>

/* Returns the mark of values; tables are those by which the values were made. */
uint64_t case_fingerprint(const struct values *values, const struct parameter_table *const *tables);

#endif
