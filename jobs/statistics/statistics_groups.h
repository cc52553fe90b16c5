/* What groups of realisations add up to, for differences of cases of the same random numbers.
 *
 * A difference of two ratios over pairs of realisations has an error that sums over all
 * realisations do not tell, and rows of single realisations would take thousands of numbers each.
 * So realisation r belongs to group r mod GROUPS, and the groups of both cases are pairs (random
 * groups, Wolter 2007, chapter 2): the value is that of all realisations, its error that of ratios
 * over the groups. Exact: any split into blocks and any order of merging gives the same bits. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GROUPS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GROUPS_H

#include "core/statistics/histogram.h"
#include "jobs/kind.h"
#include "jobs/tally.h"

enum { GROUPS = POINT_GROUPS };
struct statistics_groups {
    size_t counts; /* numbers of a group, as many as the caller makes use of */
    size_t sums;
    uint64_t realisations[GROUPS];
    uint64_t *count;       /* owned: GROUPS x counts */
    struct exact_sum *sum; /* owned: GROUPS x sums */
};
int statistics_groups_create(struct statistics_groups *out, size_t counts, size_t sums,
                             struct error *err);
void statistics_groups_clear(struct statistics_groups *groups);
double statistics_groups_bytes(size_t counts, size_t sums);

static inline size_t group_of(uint64_t realisation) {
    return (size_t)(realisation % GROUPS);
}
/* Adds n counts or sums of a realisation of a group, from number `at` of the group on. */
void statistics_groups_count(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                             const uint64_t *count);
void statistics_groups_sum(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                           const double *values);
void statistics_groups_merge(struct statistics_groups *into, const struct statistics_groups *from);

void statistics_groups_put(struct bytes *bytes, const struct statistics_groups *groups);
void statistics_groups_get(struct byte_reader *reader, struct statistics_groups *groups);
/* These return whether the groups together are what a tally has: n counts or sums from `at` on. */
bool statistics_groups_count_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                  const uint64_t *count);
bool statistics_groups_sum_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                const struct exact_sum *sum);
bool statistics_groups_realisations_fit(const struct statistics_groups *groups,
                                        uint64_t realisations);

#endif
