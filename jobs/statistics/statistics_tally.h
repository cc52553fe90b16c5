/* The tally of statistics: exact counts and sums, encoded into a partial result. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_TALLY_H

#include "core/statistics/heights/histogram.h"
#include "jobs/kind.h"
#include "jobs/statistics/statistics_groups.h"
#include "jobs/tally.h"

/* The tally of summits: those of a surface, or its pits, which are the summits of the mirrored
 * surface -z.
 *
 * z* = z/sqrt(m0) and t1 are in the scale of the case's discrete spectrum, the same for all
 * realisations. Histograms have an underflow cell, one cell a bin, and an overflow cell. */

struct summit_tally {
    struct tally_total total;
    /* `below` cell b: heights under the upper edge of bin b - 1 (cell 0: underflow alone) */
    struct tally height, below;
    struct tally equivalent;     /* t1 */
    struct tally joint;          /* cell zb * (equivalent.size) + tb */
    struct tally_sums curvature; /* by height cell: kappa_m/sqrt(m4) of its summits */
};

/* Returns the cell of the joint tally for a cell of the matrix of bins. The tally has cells for
 * under- and overflow around the bins. There is at least one bin. */
static inline size_t summit_joint_cell(const struct statistics_case *one_case, size_t cell) {
    size_t columns = one_case->equivalent.count > 0 ? one_case->equivalent.count : 1;
    return (cell / columns + 1) * (columns + 2) + cell % columns + 1;
}

struct statistics_tally {
    const struct statistics_case *one_case; /* borrowed */
    struct summit_scales scales;
    struct tally_total points;
    struct tally height, height_below; /* as in summit_tally, of all points */
    size_t sides;                      /* 1, or 2 where pits have a tally of their own */
    struct summit_tally summits[SIDES];
    /* Where the spectrum is not exact: measured density over the prescribed one, and
     * correlation. */
    struct tally_sums density, correlation;
    /* These less those of every second point, at rings and every second lag that both have. */
    struct tally_sums density_change, correlation_change;
    struct statistics_groups groups; /* of the histograms, in the order of
                                      * statistics_group_offsets */
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

/* Adds a realisation: its n heights, which are already counted in counts.height of the tally, and
 * the summits of each side. */
void statistics_tally_add(struct statistics_tally *tally, uint64_t realisation, size_t n,
                          const struct summit_list summits[]);

/* As job_kind has them. A tally adds up where every thing of a histogram is in one of its cells. */
void statistics_tally_put(struct bytes *bytes, const struct statistics_tally *tally);
void statistics_tally_get(struct byte_reader *reader, struct statistics_tally *tally);
bool statistics_tally_adds_up(const struct statistics_tally *tally);
/* Merges exactly: any order gives the same bits. */
void statistics_tally_merge(struct statistics_tally *into, const struct statistics_tally *from);

#endif
