/* What a block of realisations adds up to: exact counts and sums, encoded into a partial result. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H

#include "jobs/statistics/statistics_groups.h"
#include "jobs/statistics/summit_tally.h"

/* Pits are the summits of the mirrored surface. Of a surface that is as its mirror image in law,
 * as Gaussian ones are, they are summits among the others; else they have a tally of their own. */
enum summit_side { SIDE_SUMMITS, SIDE_PITS, SIDES };

struct statistics_tally {
    const struct statistics_case *one_case; /* borrowed */
    struct summit_scales scales;
    struct tally_total points;
    struct tally height, height_below; /* as of summit_tally, of all points */
    size_t sides;                      /* 1, or 2 where pits are told apart */
    struct summit_tally summits[SIDES];
    /* Where the spectrum is not exact: measured density over the prescribed one, and correlation */
    struct tally_sums density, correlation;
    /* What they are more than of every second point, at rings and every second lag that both have
     */
    struct tally_sums density_change, correlation_change;
    struct statistics_groups groups; /* of the histograms, in the order of statistics_group_at */
    struct summit_counts counts;     /* scratch */
};

/* Sizes of psd and acf, and of their changes: 0 where nothing is measured. */
struct spectra_sizes {
    size_t densities, correlations, density_changes, correlation_changes;
};
int statistics_tally_create(struct statistics_tally *out, const struct statistics_case *one_case,
                            const struct moments *moments, const struct spectra_sizes *sizes,
                            struct error *err);
void statistics_tally_clear(struct statistics_tally *tally);
double statistics_tally_bytes(const struct statistics_case *one_case);

/* Adds a realisation: its n heights, which have been counted in counts.height of the tally, and of
 * each side its summits. */
void statistics_tally_add(struct statistics_tally *tally, uint64_t realisation, size_t n,
                          const struct summit_list summits[]);

/* Where the counts (of curvature: the sums) of a histogram stand in a group. */
struct group_place {
    size_t height, summit[SIDES], equivalent[SIDES], counts;
    size_t curvature[SIDES], sums;
};
struct group_place statistics_group_place(const struct statistics_case *one_case);

/* As job_kind has them. A tally adds up where every thing of a histogram is in one of its cells. */
void statistics_tally_put(struct bytes *bytes, const struct statistics_tally *tally);
void statistics_tally_get(struct byte_reader *reader, struct statistics_tally *tally);
bool statistics_tally_adds_up(const struct statistics_tally *tally);
/* Merges exactly: any order gives the same bits. */
void statistics_tally_merge(struct statistics_tally *into, const struct statistics_tally *from);

#endif
