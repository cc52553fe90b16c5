/* What a block of realisations adds up to: exact counts and sums, encoded into a partial result.
 *
 * z* = z/sqrt(m0) and t1 are measured in the scale of the case's discrete spectrum, the same for
 * all realisations. Histograms have an underflow cell, one cell a bin, and an overflow cell. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H

#include "jobs/statistics/statistics_case.h"
#include "jobs/tally.h"

struct statistics_tally {
    const struct statistics_case *one_case; /* borrowed */
    double height_scale;                    /* 1/sqrt(m0) */
    double curvature_scale;                 /* t1 = curvature_scale * curvature; negative */
    struct tally_total points, summits;
    /* `below` cell b: values under the upper edge of bin b - 1 (cell 0: underflow alone) */
    struct tally height, height_below, summit, summit_below;
    struct tally equivalent;     /* t1 of summits */
    struct tally joint;          /* cell zb * (equivalent.size) + tb */
    struct tally_sums curvature; /* by height bin: kappa_m/sqrt(m4) of its summits */
    /* Where the spectrum is not exact: measured density over the prescribed one, and correlation */
    struct tally_sums density, correlation;
    /* scratch of one realisation */
    uint64_t *count;       /* owned, zero in between; joint, summit, equivalent cells */
    size_t *touched;       /* owned, joint.size: joint cells in use */
    double *bin_curvature; /* owned, summit.size */
};

/* densities, correlations: sizes of psd and acf, 0 where the spectrum is exact. */
int statistics_tally_create(struct statistics_tally *out, const struct statistics_case *one_case,
                            const struct moments *moments, size_t densities, size_t correlations,
                            struct error *err);
void statistics_tally_clear(struct statistics_tally *tally);
double statistics_tally_bytes(const struct statistics_case *one_case);

void statistics_tally_heights(struct statistics_tally *tally, size_t n, const double *z);
void statistics_tally_summits(struct statistics_tally *tally, const struct summit_list *summits);

/* As job_kind has them. A tally adds up where every thing of a histogram is in one of its cells. */
void statistics_tally_put(struct bytes *bytes, const struct statistics_tally *tally);
void statistics_tally_get(struct byte_reader *reader, struct statistics_tally *tally);
bool statistics_tally_adds_up(const struct statistics_tally *tally);
/* Merges exactly: any order gives the same bits. */
void statistics_tally_merge(struct statistics_tally *into, const struct statistics_tally *from);

#endif
