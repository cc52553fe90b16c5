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

int tally_create(struct tally *out, size_t size, size_t row, struct error *err) {
    *out = (struct tally){.size = size,
                          .row = row,
                          .count = array_create(size, sizeof *out->count),
                          .some = array_create(size, sizeof *out->some),
                          .all = array_create(size, sizeof *out->all),
                          .square = array_create(size, sizeof *out->square),
                          .cross = array_create(size, sizeof *out->cross)};
    if (out->count != NULL && out->some != NULL && out->all != NULL && out->square != NULL &&
        out->cross != NULL)
        return 0;
    tally_clear(out);
    return error_memory(err, (size_t)tally_bytes(size), "a tally");
}

void tally_clear(struct tally *tally) {
    free(tally->count);
    free(tally->some);
    free(tally->all);
    free(tally->square);
    free(tally->cross);
    *tally = (struct tally){0};
}

void tally_merge(struct tally *into, const struct tally *from) {
    for (size_t cell = 0; cell < into->size; cell++) {
        if (from->count[cell] == 0) /* then all are; most cells of a sparse tally */
            continue;
        into->count[cell] += from->count[cell];
        into->some[cell] += from->some[cell];
        into->all[cell] += from->all[cell];
        into->square[cell] += from->square[cell];
        into->cross[cell] += from->cross[cell];
    }
}

void tally_put(struct bytes *bytes, const struct tally *tally) {
    bytes_put_counts(bytes, tally->size, tally->count);
    for (size_t cell = 0; cell < tally->size; cell++) {
        if (tally->count[cell] == 0)
            continue;
        bytes_put_unsigned(bytes, tally->some[cell]);
        bytes_put_unsigned(bytes, tally->all[cell]);
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
        tally->some[cell] = bytes_get_unsigned(reader);
        tally->all[cell] = bytes_get_unsigned(reader);
        if (tally->some[cell] == 0 || tally->some[cell] > (uint64_t)count ||
            tally->all[cell] > tally->some[cell])
            reader->failed = true;
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

void exact_sum_put(struct bytes *bytes, const struct exact_sum *sum) {
    bytes_put_fixed(bytes, sum->total);
    bytes_put_unsigned(bytes, sum->lost);
}

void exact_sum_get(struct byte_reader *reader, struct exact_sum *sum) {
    sum->total = get_sum(reader, -EXACT_MOST, EXACT_MOST);
    sum->lost = bytes_get_unsigned(reader);
}

void tally_sums_put(struct bytes *bytes, const struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size; cell++) {
        exact_sum_put(bytes, &sums->sum[cell]);
        exact_sum_put(bytes, &sums->square[cell]);
        exact_sum_put(bytes, &sums->cross[cell]);
    }
}

void tally_sums_get(struct byte_reader *reader, struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size && !reader->failed; cell++) {
        exact_sum_get(reader, &sums->sum[cell]);
        exact_sum_get(reader, &sums->square[cell]);
        exact_sum_get(reader, &sums->cross[cell]);
    }
}
