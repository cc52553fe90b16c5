#include "jobs/tally.h"
#include <stdbool.h>
#include <stdlib.h>

/* No honest sum comes near (a million realisations of 2^31 points: 2^82); 2^26 blocks of such sums
 * still add up without overflow. */
static const fixed_point SUM_MOST = (fixed_point)1 << 100;

/* exact_sum keeps values below 2^60 in units of 2^-60. */
static const fixed_point EXACT_MOST = (fixed_point)1 << 120;

static fixed_point get_sum(struct byte_reader *reader, fixed_point least, fixed_point most) {
    fixed_point value = bytes_get_fixed(reader);
    if (value < least || value > most) {
        reader->failed = true;
        return 0;
    }
    return value;
}

void tally_total_add(struct tally_total *total, uint64_t things) {
    total->realisations++;
    total->sum += things;
    total->square += (fixed_point)things * things;
}

void tally_total_merge(struct tally_total *into, const struct tally_total *from) {
    into->realisations += from->realisations;
    into->sum += from->sum;
    into->square += from->square;
}

void tally_total_put(struct bytes *bytes, const struct tally_total *total) {
    bytes_put_unsigned(bytes, total->realisations);
    bytes_put_fixed(bytes, total->sum);
    bytes_put_fixed(bytes, total->square);
}

void tally_total_get(struct byte_reader *reader, struct tally_total *total) {
    total->realisations = bytes_get_unsigned(reader);
    total->sum = get_sum(reader, 0, SUM_MOST);
    total->square = get_sum(reader, total->sum, SUM_MOST);
}

int tally_create(struct tally *out, size_t size, struct error *err) {
    *out = (struct tally){.size = size,
                          .count = array_create(size, sizeof *out->count),
                          .square = array_create(size, sizeof *out->square),
                          .cross = array_create(size, sizeof *out->cross)};
    if (out->count != NULL && out->square != NULL && out->cross != NULL)
        return 0;
    tally_clear(out);
    return error_memory(err, (size_t)tally_bytes(size), "a tally");
}

void tally_clear(struct tally *tally) {
    free(tally->count);
    free(tally->square);
    free(tally->cross);
    *tally = (struct tally){0};
}

void tally_merge(struct tally *into, const struct tally *from) {
    for (size_t cell = 0; cell < into->size; cell++) {
        if (from->count[cell] == 0) /* then all three are; most cells of a sparse tally */
            continue;
        into->count[cell] += from->count[cell];
        into->square[cell] += from->square[cell];
        into->cross[cell] += from->cross[cell];
    }
}

void tally_put(struct bytes *bytes, const struct tally *tally) {
    bytes_put_counts(bytes, tally->size, tally->count);
    for (size_t cell = 0; cell < tally->size; cell++) {
        if (tally->count[cell] == 0)
            continue;
        bytes_put_fixed(bytes, tally->square[cell]);
        bytes_put_fixed(bytes, tally->cross[cell]);
    }
}

static void get_tally(struct byte_reader *reader, struct tally *tally, bool within) {
    bytes_get_counts(reader, tally->size, tally->count);
    for (size_t cell = 0; cell < tally->size && !reader->failed; cell++) {
        fixed_point count = tally->count[cell];
        if (count == 0)
            continue;
        tally->square[cell] = get_sum(reader, count, SUM_MOST);
        tally->cross[cell] = get_sum(reader, within ? tally->square[cell] : count, SUM_MOST);
    }
}

void tally_get(struct byte_reader *reader, struct tally *tally) {
    get_tally(reader, tally, true);
}

void tally_get_weighed(struct byte_reader *reader, struct tally *tally) {
    get_tally(reader, tally, false);
}

/* Returns a b - c d of integers, exact unless a product passes 2^127. */
static double cross_difference(fixed_point a, fixed_point b, fixed_point c, fixed_point d) {
    fixed_point left, right;
    if (__builtin_mul_overflow(a, b, &left) || __builtin_mul_overflow(c, d, &right))
        return (double)a * (double)b - (double)c * (double)d;
    return (double)(left - right);
}

struct estimate tally_share(const struct tally *tally, size_t cell,
                            const struct tally_total *total) {
    if (total->sum == 0)
        return (struct estimate){NAN, NAN};
    fixed_point n = tally->count[cell];
    double things = (double)total->sum, share = (double)n / things;
    if (total->realisations < 2)
        return (struct estimate){share, NAN};
    /* sum (n_r - R N_r)^2 sum N = A - R B with A = sum n_r (n_r sum N - n N_r), B likewise with
     * N_r: each an exact integer before it is rounded, so that what cancels does so exactly. */
    double a = cross_difference(tally->square[cell], total->sum, n, tally->cross[cell]);
    double b = cross_difference(tally->cross[cell], total->sum, n, total->square);
    double squares = fmax(0, (a - share * b) / things), m = (double)total->realisations;
    return (struct estimate){share, sqrt(m / (m - 1) * squares) / things};
}

int tally_sums_create(struct tally_sums *out, size_t size, struct error *err) {
    *out = (struct tally_sums){.size = size,
                               .sum = array_create(size, sizeof *out->sum),
                               .square = array_create(size, sizeof *out->square),
                               .cross = array_create(size, sizeof *out->cross)};
    if (out->sum != NULL && out->square != NULL && out->cross != NULL)
        return 0;
    tally_sums_clear(out);
    return error_memory(err, (size_t)tally_sums_bytes(size), "sums of a tally");
}

void tally_sums_clear(struct tally_sums *sums) {
    free(sums->sum);
    free(sums->square);
    free(sums->cross);
    *sums = (struct tally_sums){0};
}

void tally_sums_add(struct tally_sums *sums, size_t cell, double k, uint64_t n) {
    exact_sum_add(&sums->sum[cell], k);
    exact_sum_add(&sums->square[cell], k * k);
    exact_sum_add(&sums->cross[cell], k * (double)n);
}

void tally_sums_merge(struct tally_sums *into, const struct tally_sums *from) {
    for (size_t cell = 0; cell < into->size; cell++) {
        exact_sum_merge(&into->sum[cell], &from->sum[cell]);
        exact_sum_merge(&into->square[cell], &from->square[cell]);
        exact_sum_merge(&into->cross[cell], &from->cross[cell]);
    }
}

static void put_exact(struct bytes *bytes, const struct exact_sum *sum) {
    bytes_put_fixed(bytes, sum->total);
    bytes_put_unsigned(bytes, sum->lost);
}

static void get_exact(struct byte_reader *reader, struct exact_sum *sum) {
    sum->total = get_sum(reader, -EXACT_MOST, EXACT_MOST);
    sum->lost = bytes_get_unsigned(reader);
}

void tally_sums_put(struct bytes *bytes, const struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size; cell++) {
        put_exact(bytes, &sums->sum[cell]);
        put_exact(bytes, &sums->square[cell]);
        put_exact(bytes, &sums->cross[cell]);
    }
}

void tally_sums_get(struct byte_reader *reader, struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size && !reader->failed; cell++) {
        get_exact(reader, &sums->sum[cell]);
        get_exact(reader, &sums->square[cell]);
        get_exact(reader, &sums->cross[cell]);
    }
}

/* Ratio of sums of k and n with sums of k^2, k n and n^2 over m realisations. */
static struct estimate ratio(double k, double kk, double kn, double n, double nn, double m) {
    if (!(n > 0))
        return (struct estimate){NAN, NAN};
    double value = k / n;
    if (m < 2)
        return (struct estimate){value, NAN};
    double squares = fmax(0, (kk - value * kn) - value * (kn - value * nn));
    return (struct estimate){value, sqrt(m / (m - 1) * squares) / n};
}

static double exact_value(const struct exact_sum *sum) {
    return sum->lost == 0 ? exact_sum_value(sum) : NAN;
}

struct estimate tally_sums_ratio(const struct tally_sums *sums, const struct tally *counts,
                                 size_t cell, uint64_t realisations) {
    return ratio(exact_value(&sums->sum[cell]), exact_value(&sums->square[cell]),
                 exact_value(&sums->cross[cell]), (double)counts->count[cell],
                 (double)counts->square[cell], (double)realisations);
}

struct estimate tally_sums_mean(const struct tally_sums *sums, size_t cell, uint64_t realisations) {
    double m = (double)realisations, k = exact_value(&sums->sum[cell]);
    return ratio(k, exact_value(&sums->square[cell]), k, m, m, m);
}
