/* Counts in cells over many realisations, with the sums that their standard errors need, as exact
 * integers. Any division into blocks and any order of merging gives the same bits.
 *
 * Realisation r puts n_r(cell) of its N_r things into a cell. The share of a cell is R = sum n_r /
 * sum N_r. As things of one realisation are not independent, its error is that of a ratio over
 * realisations (Cochran 1977, section 2.11): variance = M/(M-1) sum (n_r - R N_r)^2 / (sum N_r)^2.
 *
 * The variance of a cell cannot be estimated from few realisations with things in it; from none the
 * estimate would be 0. Such rare cells take the dispersion (variance over mean of a count,
 * McCullagh & Nelder 1989, section 4.5) of them and their neighbours; FORMULAS.md, F15.8. Below two
 * realisations there is no error. */
#ifndef RUGO_JOBS_TALLY_H
#define RUGO_JOBS_TALLY_H

#include "jobs/estimate.h"
#include "schema/result/bytes/bytes.h"

void exact_sum_put(struct bytes *bytes, const struct exact_sum *sum);
/* Reads any total: merging marks sums that overflow as lost. */
void exact_sum_get(struct byte_reader *reader, struct exact_sum *sum);

/* All cells of a tally share these sums. */
struct tally_total {
    uint64_t realisations;   /* M */
    fixed_point sum, square; /* sum of N_r, of N_r^2 */
};
void tally_total_add(struct tally_total *total, uint64_t things);
void tally_total_merge(struct tally_total *into, const struct tally_total *from);
void tally_total_put(struct bytes *bytes, const struct tally_total *total);
void tally_total_get(struct byte_reader *reader, struct tally_total *total);

struct tally {
    size_t size;
    size_t row;          /* cells side by side are neighbours within rows of so many */
    uint64_t *count;     /* owned, as all: sum of n_r */
    uint64_t *some;      /* realisations with n_r > 0 */
    uint64_t *all;       /* of these, with n_r = N_r */
    fixed_point *square; /* sum of n_r^2 */
    fixed_point *cross;  /* sum of n_r N_r */
};
/* row: a divisor of size. */
int tally_create(struct tally *out, size_t size, size_t row, struct error *err);
void tally_clear(struct tally *tally);
static inline double tally_bytes(size_t size) {
    return 56.0 * (double)size;
}
/* Adds one realisation's n of its N things to a cell. Call it once a cell and realisation, and not
 * for n = 0. */
static inline void tally_add(struct tally *tally, size_t cell, uint64_t n, uint64_t things) {
    tally->count[cell] += n;
    tally->some[cell]++;
    tally->all[cell] += n == things;
    tally->square[cell] += (fixed_point)n * n;
    tally->cross[cell] += (fixed_point)n * things;
}
void tally_merge(struct tally *into, const struct tally *from);
void tally_put(struct bytes *bytes, const struct tally *tally);
/* Fails the reader for sums that no realisations could have, or that could overflow in merging. */
void tally_get(struct byte_reader *reader, struct tally *tally);
/* Reads a tally of things with weights, so that n_r may exceed N_r. */
void tally_get_weighed(struct byte_reader *reader, struct tally *tally);

/* Cells with things of fewer realisations than this, but not of all, are rare. */
enum { TALLY_RARE = 10 };
/* If none was seen, the expected count is below this at the confidence of one standard deviation,
 * 84.1 % (Gehrels 1986, table 1). */
#define TALLY_NONE_SEEN 1.841
/* Estimates the share of a cell and its error. For an empty cell, and one with all things, the
 * error is the bound of the share at the confidence of one standard deviation. */
struct estimate tally_share(const struct tally *tally, size_t cell,
                            const struct tally_total *total);
/* Estimates the shares of cells first to first + n - 1, in one pass over them. */
void tally_shares(const struct tally *tally, size_t first, size_t n,
                  const struct tally_total *total, struct estimate *out);
/* Returns the bound of empty cells from the dispersion of all rare cells. */
double tally_empty_bound(const struct tally *tally, const struct tally_total *total);

/* Exact sums of a quantity k over realisations with cell counts n_r. They give the ratio sum k_r /
 * sum n_r, such as the mean curvature of the summits of a bin. */
struct tally_sums {
    size_t size;
    struct exact_sum *sum, *square, *cross; /* owned: k_r, k_r^2, k_r n_r */
};
int tally_sums_create(struct tally_sums *out, size_t size, struct error *err);
void tally_sums_clear(struct tally_sums *sums);
static inline double tally_sums_bytes(size_t size) {
    return 96.0 * (double)size;
}
void tally_sums_add(struct tally_sums *sums, size_t cell, double k, uint64_t n);
void tally_sums_merge(struct tally_sums *into, const struct tally_sums *from);
void tally_sums_put(struct bytes *bytes, const struct tally_sums *sums);
void tally_sums_get(struct byte_reader *reader, struct tally_sums *sums);
/* Estimates the ratio in a cell over the realisations that have things there, n_r of `counts`. */
struct estimate tally_sums_ratio(const struct tally_sums *sums, const struct tally *counts,
                                 size_t cell);
/* Estimates the ratios of n cells; a rare cell takes the variance per thing of its neighbours. */
void tally_sums_ratios_pooled(const struct tally_sums *sums, const struct tally *counts,
                              size_t first, size_t n, struct estimate *out);
/* Estimates the mean of k a realisation where every n_r was 1. */
struct estimate tally_sums_mean(const struct tally_sums *sums, size_t cell, uint64_t realisations);

#endif
