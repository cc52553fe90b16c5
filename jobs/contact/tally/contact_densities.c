#include "jobs/contact/tally/contact_densities.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shares of the cell resolve so many parts: products of two of a million realisations stay below
 * 2^84. */
#define SHARE_PARTS ((uint64_t)1 << 32)

/* --- offsets --- */

static size_t cells_of(const struct contact_densities *densities) {
    return densities->loads * densities->bins;
}

/* Returns the offset of a pair of states s <= t among those of a cell. */
static size_t pair_of(size_t s, size_t t) {
    return t * (t + 1) / 2 + s;
}

static size_t states_of(const struct contact_case *one_case) {
    return one_case->model_count * one_case->level_count;
}

static size_t pairs_of(size_t states) {
    return pair_of(0, states);
}

/* --- the moments --- */

double contact_densities_size(const struct contact_case *one_case) {
    size_t states = states_of(one_case);
    double cells = (double)one_case->pdf_count * (double)one_case->pressure.count;
    return one_case->pdf_pairs ? cells * (double)(2 * states + pairs_of(states) + 1) : 0;
}

double contact_densities_bytes(const struct contact_case *one_case) {
    return (double)sizeof(fixed_point) * contact_densities_size(one_case);
}

int contact_densities_create(struct contact_densities *out, const struct contact_case *one_case,
                             struct error *err) {
    *out = (struct contact_densities){0};
    if (!one_case->pdf_pairs)
        return 0;
    out->states = states_of(one_case);
    out->pairs = pairs_of(out->states);
    out->loads = one_case->pdf_count;
    out->bins = one_case->pressure.count;
    size_t cells = cells_of(out);
    out->shares = array_create(cells, out->states * sizeof *out->shares);
    out->solved = array_create(out->loads, out->states * sizeof *out->solved);
    out->realisations = array_create(out->loads, sizeof *out->realisations);
    out->some = array_create(cells, sizeof *out->some);
    out->sum = array_create(cells, out->states * sizeof *out->sum);
    out->product = array_create(cells, out->pairs * sizeof *out->product);
    if (out->shares != NULL && out->solved != NULL && out->realisations != NULL &&
        out->some != NULL && out->sum != NULL && out->product != NULL)
        return 0;
    contact_densities_clear(out);
    return error_memory(err, (size_t)contact_densities_bytes(one_case), "pairs of densities");
}

void contact_densities_clear(struct contact_densities *densities) {
    free(densities->shares);
    free(densities->solved);
    free(densities->realisations);
    free(densities->some);
    free(densities->sum);
    free(densities->product);
    *densities = (struct contact_densities){0};
}

void contact_densities_set(struct contact_densities *densities, size_t state, size_t at,
                           const double *shares) {
    if (densities->states == 0)
        return;
    uint64_t *out = densities->shares + state * cells_of(densities) + at * densities->bins;
    for (size_t b = 0; b < densities->bins; b++)
        out[b] = (uint64_t)llround(shares[b + 1] * (double)SHARE_PARTS);
    densities->solved[state * densities->loads + at] = true;
}

static void add_cell(struct contact_densities *densities, size_t cell) {
    const size_t states = densities->states;
    const uint64_t *shares = densities->shares + cell;
    size_t step = cells_of(densities);
    uint64_t *sum = densities->sum + cell * states;
    fixed_point *product = densities->product + cell * densities->pairs;
    bool any = false;
    for (size_t t = 0; t < states; t++) {
        uint64_t share = shares[t * step];
        any = any || share > 0;
        sum[t] += share;
        for (size_t s = 0; s <= t; s++)
            product[pair_of(s, t)] += (fixed_point)share * shares[s * step];
    }
    densities->some[cell] += any;
}

void contact_densities_add(struct contact_densities *densities) {
    for (size_t at = 0; at < densities->loads; at++) {
        bool all = true;
        for (size_t s = 0; s < densities->states; s++)
            all = all && densities->solved[s * densities->loads + at];
        densities->realisations[at] += all;
        for (size_t b = 0; b < densities->bins && all; b++)
            add_cell(densities, at * densities->bins + b);
    }
    if (densities->states > 0)
        memset(densities->solved, 0,
               densities->states * densities->loads * sizeof *densities->solved);
}

void contact_densities_merge(struct contact_densities *into, const struct contact_densities *from) {
    size_t cells = cells_of(into);
    for (size_t at = 0; at < into->loads; at++)
        into->realisations[at] += from->realisations[at];
    for (size_t cell = 0; cell < cells; cell++)
        into->some[cell] += from->some[cell];
    for (size_t a = 0; a < cells * into->states; a++)
        into->sum[a] += from->sum[a];
    for (size_t a = 0; a < cells * into->pairs; a++)
        into->product[a] += from->product[a];
}

/* --- bytes: by load the realisations; the cells with things; the moments of these --- */

void contact_densities_put(struct bytes *bytes, const struct contact_densities *densities) {
    size_t cells = cells_of(densities);
    if (cells == 0)
        return;
    for (size_t at = 0; at < densities->loads; at++)
        bytes_put_unsigned(bytes, densities->realisations[at]);
    bytes_put_counts(bytes, cells, densities->some);
    for (size_t cell = 0; cell < cells; cell++) {
        if (densities->some[cell] == 0)
            continue;
        for (size_t s = 0; s < densities->states; s++)
            bytes_put_unsigned(bytes, densities->sum[cell * densities->states + s]);
        for (size_t a = 0; a < densities->pairs; a++)
            bytes_put_fixed(bytes, densities->product[cell * densities->pairs + a]);
    }
}

/* Returns whether the moments of a cell are those of shares that M realisations could have: none is
 * above that of a whole cell, and no product above the root of the products of squares. */
static bool cell_fits(const struct contact_densities *densities, size_t cell, uint64_t m) {
    const uint64_t *sum = densities->sum + cell * densities->states;
    const fixed_point *product = densities->product + cell * densities->pairs;
    const fixed_point most = (fixed_point)m * SHARE_PARTS;
    static const double ROUNDING = 1e-9;
    bool fits = densities->some[cell] <= m;
    for (size_t t = 0; t < densities->states && fits; t++) {
        double own = (double)product[pair_of(t, t)];
        fits = sum[t] <= most && product[pair_of(t, t)] >= (fixed_point)sum[t] &&
               product[pair_of(t, t)] <= (fixed_point)sum[t] * (fixed_point)SHARE_PARTS;
        for (size_t s = 0; s < t && fits; s++) {
            double other = (double)product[pair_of(s, s)], both = (double)product[pair_of(s, t)];
            fits = both >= 0 && both <= sqrt(own) * sqrt(other) * (1 + ROUNDING);
        }
    }
    return fits;
}

void contact_densities_get(struct byte_reader *reader, struct contact_densities *densities) {
    static const uint64_t REALISATIONS_MOST = (uint64_t)1 << 24;
    size_t cells = cells_of(densities);
    if (cells == 0)
        return;
    for (size_t at = 0; at < densities->loads; at++) {
        densities->realisations[at] = bytes_get_unsigned(reader);
        if (densities->realisations[at] > REALISATIONS_MOST)
            reader->failed = true;
    }
    bytes_get_counts(reader, cells, densities->some);
    for (size_t cell = 0; cell < cells && !reader->failed; cell++) {
        if (densities->some[cell] == 0)
            continue;
        for (size_t s = 0; s < densities->states; s++)
            densities->sum[cell * densities->states + s] = bytes_get_unsigned(reader);
        for (size_t a = 0; a < densities->pairs; a++)
            densities->product[cell * densities->pairs + a] = bytes_get_fixed(reader);
        if (!cell_fits(densities, cell, densities->realisations[cell / densities->bins]))
            reader->failed = true;
    }
}

double contact_densities_total(const struct contact_densities *densities, size_t state, size_t at,
                               size_t bin) {
    size_t cell = at * densities->bins + bin;
    return (double)densities->sum[cell * densities->states + state] / (double)SHARE_PARTS;
}

/* --- differences --- */

/* What a bin shows of a difference, in shares: its mean, the variance of one realisation, and the
 * mean share of the states that it is of. */
struct bin_moments {
    double mean, variance, share;
};

/* The variance is M/(M-1) (mean of squares - square of the mean): an exact integer over M (M-1). */
static struct bin_moments moments_of(const struct contact_densities *densities, size_t cell,
                                     fixed_point m, const int *weights) {
    const uint64_t *sum = densities->sum + cell * densities->states;
    const fixed_point *product = densities->product + cell * densities->pairs;
    const double parts = (double)SHARE_PARTS, n = (double)m;
    fixed_point mean = 0, square = 0, share = 0;
    double states = 0;
    for (size_t t = 0; t < densities->states; t++) {
        if (weights[t] == 0)
            continue;
        states++;
        share += sum[t];
        mean += (fixed_point)sum[t] * weights[t];
        for (size_t s = 0; s <= t; s++)
            square += product[pair_of(s, t)] * (weights[s] * weights[t] * (s < t ? 2 : 1));
    }
    return (struct bin_moments){.mean = (double)mean / n / parts,
                                .variance = (double)(m * square - mean * mean) / n / (n - 1) /
                                            parts / parts,
                                .share = (double)share / states / n / parts};
}

static bool is_rare(uint64_t some, uint64_t m) {
    return some < TALLY_RARE && some < m;
}

/* Returns variance over share of all rare bins together, or of all bins where too few realisations
 * have things in rare ones. */
static double dispersion_of(const struct contact_densities *densities, size_t first, uint64_t m,
                            const int *weights) {
    struct bin_moments rare = {0}, all = {0};
    uint64_t some = 0;
    for (size_t cell = first; cell < first + densities->bins; cell++) {
        if (densities->some[cell] == 0)
            continue;
        struct bin_moments own = moments_of(densities, cell, (fixed_point)m, weights);
        all.variance += own.variance;
        all.share += own.share;
        if (!is_rare(densities->some[cell], m))
            continue;
        some += densities->some[cell];
        rare.variance += own.variance;
        rare.share += own.share;
    }
    const struct bin_moments *of = some >= TALLY_RARE ? &rare : &all;
    return of->share > 0 ? of->variance / of->share : 0;
}

void contact_densities_difference(const struct contact_densities *densities, size_t at,
                                  const int *weights, const double *expected,
                                  struct estimate *out) {
    const size_t first = at * densities->bins;
    const uint64_t m = densities->realisations[at];
    double dispersion = m > 1 ? dispersion_of(densities, first, m, weights) : (double)NAN;
    for (size_t b = 0; b < densities->bins; b++) {
        if (m < 2) {
            out[b] = (struct estimate){NAN, NAN};
            continue;
        }
        struct bin_moments own = moments_of(densities, first + b, (fixed_point)m, weights);
        double variance = own.variance;
        if (is_rare(densities->some[first + b], m))
            variance = fmax(variance, dispersion * fmax(own.share, expected[b]));
        out[b] = (struct estimate){own.mean, sqrt(fmax(0, variance) / (double)m)};
    }
}
