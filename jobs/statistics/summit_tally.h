/* What summits add up to: those of a surface, or its pits, which are the summits of the mirrored
 * surface -z.
 *
 * z* = z/sqrt(m0) and t1 are measured in the scale of the case's discrete spectrum, the same for
 * all realisations. Histograms have an underflow cell, one cell a bin, and an overflow cell. */
#ifndef RUGO_JOBS_STATISTICS_SUMMIT_TALLY_H
#define RUGO_JOBS_STATISTICS_SUMMIT_TALLY_H

#include "jobs/statistics/statistics_case.h"
#include "jobs/tally.h"

struct summit_tally {
    struct tally_total total;
    /* `below` cell b: heights under the upper edge of bin b - 1 (cell 0: underflow alone) */
    struct tally height, below;
    struct tally equivalent;     /* t1 */
    struct tally joint;          /* cell zb * (equivalent.size) + tb */
    struct tally_sums curvature; /* by height cell: kappa_m/sqrt(m4) of its summits */
};
int summit_tally_create(struct summit_tally *out, const struct statistics_case *one_case,
                        struct error *err);
void summit_tally_clear(struct summit_tally *tally);
double summit_tally_bytes(const struct statistics_case *one_case);

/* Workspace of one realisation, zero in between, in which its counts are gathered. */
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
/* Adds the summits of a realisation. Its counts by height, by t1 and its curvatures are left in
 * `counts` for the caller, who zeroes them (summit_counts_zero). */
void summit_tally_add(struct summit_tally *tally, const struct statistics_case *one_case,
                      const struct summit_scales *scales, const struct summit_list *summits,
                      struct summit_counts *counts);
void summit_counts_zero(struct summit_counts *counts, const struct summit_tally *tally);

/* As job_kind has them. */
void summit_tally_put(struct bytes *bytes, const struct summit_tally *tally);
void summit_tally_get(struct byte_reader *reader, struct summit_tally *tally);
bool summit_tally_adds_up(const struct summit_tally *tally);
void summit_tally_merge(struct summit_tally *into, const struct summit_tally *from);

/* Adds one realisation's counts of the cells of a histogram, n_r of its `things`, and of those
 * below each edge (NULL: not wanted). */
void histogram_tally_add(struct tally *cells, struct tally *below, const uint64_t *count,
                         uint64_t things);
/* Returns whether every thing of a histogram is in one of its cells. */
bool histogram_tally_adds_up(const struct tally *tally, const struct tally_total *total);

/* Returns the cell of the joint tally, which has cells for under- and overflow around the bins, of
 * a cell of the matrix of bins. There is at least one bin. */
static inline size_t summit_joint_cell(const struct statistics_case *one_case, size_t cell) {
    size_t columns = one_case->equivalent.count > 0 ? one_case->equivalent.count : 1;
    return (cell / columns + 1) * (columns + 2) + cell % columns + 1;
}

/* Cells of a histogram over these bins. */
static inline size_t cells_of(const struct bins *bins) {
    return bins->count + 2;
}

#endif
