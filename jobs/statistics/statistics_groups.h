/* Sums of statistics over groups of realisations, and what curves are in each. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GROUPS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GROUPS_H

#include "core/statistics/heights/histogram.h"
#include "jobs/kind.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/tally.h"
#include "schema/result/result.h"

/* Returns the number of cells of a histogram over these bins. */
static inline size_t cells_of(const struct bins *bins) {
    return bins->count + 2;
}

/* Pits are the summits of the mirrored surface. Where a surface has the same distribution as its
 * mirror image, as Gaussian ones have, they are counted as summits; else they have a tally of their
 * own. */
enum summit_side { SIDE_SUMMITS, SIDE_PITS, SIDES };

/* Workspace of one realisation for its counts, zero in between. */
struct summit_counts {
    uint64_t *joint; /* owned, as all: joint cells */
    size_t *touched; /* joint cells in use */
    uint64_t *height, *equivalent;
    double *curvature; /* by height cell: sum of kappa_m/sqrt(m4) */
};
int summit_counts_create(struct summit_counts *out, const struct statistics_case *one_case,
                         struct error *err);
void summit_counts_clear(struct summit_counts *counts);
double summit_counts_bytes(const struct statistics_case *one_case);

/* z* = height scale * height, t1 = curvature scale * curvature, which is negative. */
struct summit_scales {
    double height, curvature;
};
/* Returns the scales of z/sqrt(m0) and t1 in these moments. */
struct summit_scales summit_scales(const struct statistics_case *one_case,
                                   const struct moments *moments);
/* Counts summits by height and by t1, and adds their curvatures by height; no joint cells. */
void summit_counts_fill(struct summit_counts *counts, const struct statistics_case *one_case,
                        const struct summit_scales *scales, const struct summit_list *summits);
/* Zeroes what summit_counts_fill fills. */
void summit_counts_zero(struct summit_counts *counts, const struct statistics_case *one_case);

/* Sums over groups of realisations, for differences of cases of the same random numbers.
 *
 * The error of a difference of two ratios over pairs of realisations does not follow from sums over
 * all realisations, and rows of single realisations would take thousands of numbers each. So
 * realisation r belongs to group r mod GROUPS, and the groups of both cases are pairs (random
 * groups, Wolter 2007, chapter 2). The value is that of all realisations, its error that of ratios
 * over the groups. Sums are exact: any division into blocks and any order of merging gives the same
 * bits. */

enum { GROUPS = POINT_GROUPS };
struct statistics_groups {
    size_t counts; /* numbers of a group, as many as the caller uses */
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
/* Add n counts or sums of a realisation to a group, from number `at` of the group on. */
void statistics_groups_count(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                             const uint64_t *count);
void statistics_groups_sum(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                           const double *values);
void statistics_groups_merge(struct statistics_groups *into, const struct statistics_groups *from);

void statistics_groups_put(struct bytes *bytes, const struct statistics_groups *groups);
void statistics_groups_get(struct byte_reader *reader, struct statistics_groups *groups);
/* Return whether the sums over all groups equal those of a tally: n counts or sums from `at` on. */
bool statistics_groups_count_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                  const uint64_t *count);
bool statistics_groups_sum_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                const struct exact_sum *sum);
bool statistics_groups_realisations_fit(const struct statistics_groups *groups,
                                        uint64_t realisations);

/* Offsets of the counts (of curvature: the sums) of each histogram in a group. */
struct group_offsets {
    size_t height, summit[SIDES], equivalent[SIDES], counts;
    size_t curvature[SIDES], sums;
};
struct group_offsets statistics_group_offsets(const struct statistics_case *one_case);
/* Adds what a realisation has counted of one side's summits to a group. */
void statistics_groups_side(struct statistics_groups *groups,
                            const struct statistics_case *one_case, size_t group, size_t side,
                            const struct summit_counts *counts);

/* As job_kind has it, in groups of all histograms of a case: for densities, cumulative ones and the
 * mean curvature of summits. */
bool statistics_groups_point(const struct statistics_groups *groups,
                             const struct statistics_case *one_case, const struct curve *curve,
                             size_t at, struct point_groups *out);
/* Returns over what width shares of such a curve are counted: that of a bin of a density, 1 of a
 * cumulative one, 0 where values are no shares. */
double statistics_curve_width(const struct statistics_case *one_case, const struct curve *curve);

#endif
