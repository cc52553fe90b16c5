/* Tallies and estimates: the errors are those of their definition over realisations, and any split
 * and order of merging gives the same bits. */
#include "jobs/tally.h"
#include "tests/support/seed.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { REALISATIONS = 60, CELLS = 12 };

struct tally_sample {
    uint64_t n[REALISATIONS][CELLS], things[REALISATIONS];
    double k[REALISATIONS][CELLS];
};
static struct tally_sample sample;

static int draw_sample(void **state) {
    (void)state;
    uint64_t seed = seed_of_now();
    for (size_t r = 0; r < REALISATIONS; r++) {
        sample.things[r] = 0;
        for (size_t cell = 0; cell < CELLS; cell++) {
            uint64_t n = next_word(&seed) % (10 * (cell + 1));
            sample.n[r][cell] = cell == 3 ? 0 : n;
            sample.things[r] += sample.n[r][cell];
            sample.k[r][cell] =
                (double)sample.n[r][cell] * (1 + (double)(next_word(&seed) % 1000) / 1e4);
        }
    }
    return 0;
}

struct tally_block {
    struct tally_total total;
    struct tally tally;
    struct tally_sums sums;
};

static void block_create(struct tally_block *block) {
    *block = (struct tally_block){0};
    assert_int_equal(tally_create(&block->tally, CELLS, CELLS, NULL), 0);
    assert_int_equal(tally_sums_create(&block->sums, CELLS, NULL), 0);
}

static void block_clear(struct tally_block *block) {
    tally_clear(&block->tally);
    tally_sums_clear(&block->sums);
}

static void block_fill(struct tally_block *block, size_t first, size_t last) {
    block_create(block);
    for (size_t r = first; r < last; r++) {
        tally_total_add(&block->total, sample.things[r]);
        for (size_t cell = 0; cell < CELLS; cell++) {
            if (sample.n[r][cell] == 0)
                continue;
            tally_add(&block->tally, cell, sample.n[r][cell], sample.things[r]);
            tally_sums_add(&block->sums, cell, sample.k[r][cell], sample.n[r][cell]);
        }
    }
}

static void block_merge(struct tally_block *into, const struct tally_block *from) {
    tally_total_merge(&into->total, &from->total);
    tally_merge(&into->tally, &from->tally);
    tally_sums_merge(&into->sums, &from->sums);
}

static struct bytes block_bytes(const struct tally_block *block) {
    struct bytes bytes = {0};
    tally_total_put(&bytes, &block->total);
    tally_put(&bytes, &block->tally);
    tally_sums_put(&bytes, &block->sums);
    assert_false(bytes.failed);
    return bytes;
}

/* sqrt(M/(M-1) sum (a_r - R b_r)^2) / sum b_r, as it is written. */
static struct estimate brute_force(const double *a, const double *b) {
    long double as = 0, bs = 0, squares = 0;
    for (size_t r = 0; r < REALISATIONS; r++) {
        as += (long double)a[r];
        bs += (long double)b[r];
    }
    for (size_t r = 0; r < REALISATIONS; r++) {
        long double rest = (long double)a[r] - as / bs * (long double)b[r];
        squares += rest * rest;
    }
    long double m = REALISATIONS;
    return (struct estimate){(double)(as / bs), (double)(sqrtl(m / (m - 1) * squares) / bs)};
}

static void assert_close(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g is not %.17g", got, expected);
}

/* 1e-12: rounding of a difference of sums that agree in less than 4 digits. */
static void errors_are_those_of_the_ratio(void **state) {
    (void)state;
    struct tally_block block;
    block_fill(&block, 0, REALISATIONS);
    for (size_t cell = 0; cell < CELLS; cell++) {
        double n[REALISATIONS], things[REALISATIONS], k[REALISATIONS];
        for (size_t r = 0; r < REALISATIONS; r++) {
            n[r] = (double)sample.n[r][cell];
            things[r] = (double)sample.things[r];
            k[r] = sample.k[r][cell];
        }
        struct estimate got = tally_share(&block.tally, cell, &block.total);
        struct estimate expected = brute_force(n, things);
        if (cell == 3) { /* an empty cell: nothing seen, and a bound of that */
            assert_true(got.value == 0 && got.standard_error > 0);
            assert_true(isnan(tally_sums_ratio(&block.sums, &block.tally, cell).value));
            continue;
        }
        assert_close(got.value, expected.value, 1e-14);
        assert_close(got.standard_error, expected.standard_error, 1e-12);
        got = tally_sums_ratio(&block.sums, &block.tally, cell);
        expected = brute_force(k, n);
        assert_true(block.tally.some[cell] >= TALLY_RARE);
        double m = (double)block.tally.some[cell]; /* brute_force counts all realisations */
        expected.standard_error *= sqrt(m / (m - 1) * (REALISATIONS - 1) / REALISATIONS);
        assert_close(got.value, expected.value, 1e-13);
        assert_close(got.standard_error, expected.standard_error, 1e-10);
    }
    block_clear(&block);
}

/* Random splits, merged in random order, against all realisations in one block. */
static void merging_is_exact(void **state) {
    (void)state;
    uint64_t seed = seed_or(99);
    struct tally_block whole, parts[REALISATIONS];
    block_fill(&whole, 0, REALISATIONS);
    struct bytes expected = block_bytes(&whole);
    for (int trial = 0; trial < 50; trial++) {
        size_t count = 0;
        for (size_t first = 0; first < REALISATIONS;) {
            size_t last = first + 1 + next_word(&seed) % 20;
            last = last < REALISATIONS ? last : REALISATIONS;
            block_fill(&parts[count++], first, last);
            first = last;
        }
        struct tally_block merged;
        block_create(&merged);
        for (size_t left = count; left > 0; left--) {
            size_t pick = (size_t)(next_word(&seed) % left);
            block_merge(&merged, &parts[pick]);
            block_clear(&parts[pick]);
            parts[pick] = parts[left - 1];
        }
        struct bytes got = block_bytes(&merged);
        assert_int_equal(got.size, expected.size);
        assert_memory_equal(got.data, expected.data, got.size);
        bytes_clear(&got);
        block_clear(&merged);
    }
    bytes_clear(&expected);
    block_clear(&whole);
}

/* A million realisations of 2^26 points: no overflow, and the share keeps all digits. */
static void a_million_realisations(void **state) {
    (void)state;
    struct tally tally;
    struct tally_total total = {0};
    assert_int_equal(tally_create(&tally, 2, 2, NULL), 0);
    const uint64_t points = UINT64_C(1) << 26, n = UINT64_C(1) << 24;
    for (uint64_t r = 0; r < 1000000; r++) {
        tally_total_add(&total, points);
        tally_add(&tally, 0, n + r % 2, points);
        tally_add(&tally, 1, points - n - r % 2, points);
    }
    /* n_r alternates between n and n + 1: deviation 1/2 about the mean, up to M/(M-1) */
    struct estimate share = tally_share(&tally, 0, &total);
    assert_close(share.value, ((double)n + 0.5) / (double)points, 1e-15);
    assert_close(share.standard_error, 0.5 / (double)points / 999.9995, 1e-9);
    tally_clear(&tally);
}

/* What all lies in one cell may lie elsewhere as rarely as a thing was never seen there: 1.841 of
 * all. One realisation has no known error. */
static void certain_and_alone(void **state) {
    (void)state;
    struct tally tally;
    struct tally_total total = {0};
    assert_int_equal(tally_create(&tally, 1, 1, NULL), 0);
    assert_true(isnan(tally_share(&tally, 0, &total).value));
    for (uint64_t things = 3; things < 10; things++) {
        tally_total_add(&total, things);
        tally_add(&tally, 0, things, things);
        struct estimate share = tally_share(&tally, 0, &total);
        assert_true(share.value == 1);
        if (things == 3)
            assert_true(isnan(share.standard_error));
        else
            assert_close(share.standard_error, 1.841 / (double)total.sum, 1e-15);
    }
    tally_clear(&tally);
}

/* Clusters of 4 things, in one realisation of 100: the rare cell has the dispersion of its
 * neighbours, 4 but for what the ratio takes off, and the empty one its bound. The error of a
 * difference of neighbours is never 0. */
static void rare_and_empty(void **state) {
    (void)state;
    struct tally tally;
    struct tally_total total = {0};
    const uint64_t realisations = 2000, cluster = 4;
    assert_int_equal(tally_create(&tally, 5, 5, NULL), 0);
    for (uint64_t r = 0; r < realisations; r++) {
        uint64_t left = 50;
        tally_total_add(&total, left);
        if (r % 100 == 0) {
            tally_add(&tally, 1, cluster, 50);
            left -= cluster;
        }
        if (r == 7) {
            tally_add(&tally, 2, cluster, 50);
            left -= cluster;
        }
        tally_add(&tally, 0, left, 50);
    }
    double all = (double)total.sum;
    struct estimate rare = tally_share(&tally, 2, &total);
    assert_close(rare.value, 4 / all, 1e-15);
    assert_close(rare.standard_error, 4 * sqrt(2) / all, 0.02);
    assert_close(tally_share(&tally, 3, &total).standard_error, 4 * 1.841 / all, 0.02);
    assert_close(tally_share(&tally, 4, &total).standard_error, 4 * 1.841 / all, 0.02);
    assert_close(tally_empty_bound(&tally, &total), 4 * 1.841 / all, 0.02);
    assert_close(tally_share(&tally, 1, &total).standard_error, 4 * sqrt(20) / all, 0.02);
    tally_clear(&tally);
}

/* Beside a full cell that has nearly as many things in each realisation, the error of a rare cell
 * is the scatter of many studies: of clusters of 8 things in one realisation of five. It was half
 * of it where the full cell took part. The scatter of 400 studies is known within 4 %, and errors
 * of few clusters are up to a third more. */
static void rare_beside_full(void **state) {
    (void)state;
    enum { STUDIES = 400, RUNS = 20, FULL = 400, CLUSTER = 8, ONE_IN = 5 };
    uint64_t seed = seed_of_now();
    double sum = 0, squares = 0, reported = 0;
    for (size_t s = 0; s < STUDIES; s++) {
        struct tally tally;
        struct tally_total total = {0};
        assert_int_equal(tally_create(&tally, 3, 3, NULL), 0);
        for (size_t r = 0; r < RUNS; r++) {
            const uint64_t n = next_word(&seed) % ONE_IN == 0 ? CLUSTER : 0;
            tally_total_add(&total, FULL);
            tally_add(&tally, 0, FULL - n, FULL);
            if (n > 0)
                tally_add(&tally, 1, n, FULL);
        }
        struct estimate share = tally_share(&tally, 1, &total);
        sum += share.value;
        squares += share.value * share.value;
        reported += share.standard_error * share.standard_error;
        tally_clear(&tally);
    }
    const double mean = sum / STUDIES, variance = squares / STUDIES - mean * mean;
    assert_in_range(100 * sqrt(variance / (reported / STUDIES)), 70, 115);
}

/* A ratio that one realisation has is reported without an error; that of two has the error of the
 * variance of all cells: k = 1 + u with u of variance 1/3, many in cell 0. */
static void ratios_of_few(void **state) {
    (void)state;
    struct tally counts;
    struct tally_sums sums;
    uint64_t seed = seed_or(3);
    assert_int_equal(tally_create(&counts, 3, 3, NULL), 0);
    assert_int_equal(tally_sums_create(&sums, 3, NULL), 0);
    for (uint64_t r = 0; r < 20000; r++)
        for (size_t cell = 0; cell < 3; cell++) {
            if (cell > 0 && r >= (cell == 1 ? 2 : 1))
                continue;
            double k = (double)(next_word(&seed) % 1000001) / 500000;
            tally_add(&counts, cell, 1, 1);
            tally_sums_add(&sums, cell, k, 1);
        }
    assert_true(isnan(tally_sums_ratio(&sums, &counts, 2).standard_error));
    struct estimate pooled[3];
    tally_sums_ratios_pooled(&sums, &counts, 0, 3, pooled);
    struct estimate many = pooled[0], two = pooled[1], alone = pooled[2];
    assert_true(alone.value >= 0 && isnan(alone.standard_error));
    assert_close(two.standard_error, sqrt(1.0 / 3 / 2), 0.03);
    assert_true(many.standard_error == tally_sums_ratio(&sums, &counts, 0).standard_error);
    tally_clear(&counts);
    tally_sums_clear(&sums);
}

/* A worker's own sums are read again, however large: of values near the bound of what is added,
 * the squares of a few add up to more than one of them may be. */
static void large_sums_are_read_again(void **state) {
    (void)state;
    struct tally_sums sums, again;
    struct bytes bytes = {0};
    assert_int_equal(tally_sums_create(&sums, 1, NULL), 0);
    assert_int_equal(tally_sums_create(&again, 1, NULL), 0);
    for (size_t r = 0; r < 4; r++)
        tally_sums_add(&sums, 0, r % 2 == 0 ? 0x1.fp29 : -0x1.fp29, 1);
    assert_true(sums.square[0].total > (fixed_point)1 << 120 && sums.square[0].lost == 0);
    tally_sums_put(&bytes, &sums);
    bytes_put_checksum(&bytes);
    struct byte_reader reader = bytes_open(bytes.data, bytes.size);
    tally_sums_get(&reader, &again);
    assert_true(!reader.failed && again.square[0].total == sums.square[0].total);
    for (size_t merged = 0; merged < 200; merged++) /* beyond the range, and counted as lost */
        tally_sums_merge(&again, &sums);
    assert_true(again.square[0].lost > 0 && again.square[0].total > 0);
    bytes_clear(&bytes);
    tally_sums_clear(&sums);
    tally_sums_clear(&again);
}

static void means_and_weights(void **state) {
    (void)state;
    const double x[] = {1, NAN, 2, 6}, weight[] = {1, 5, 1, 2};
    struct estimate mean = estimate_mean(4, x);
    assert_close(mean.value, 3, 1e-15);
    assert_close(mean.standard_error, sqrt(7.0 / 3), 1e-15); /* deviation sqrt(7) */
    struct estimate weighted = estimate_weighted(4, x, weight);
    assert_close(weighted.value, 15.0 / 4, 1e-15);
    /* residuals w (x - 15/4): -11/4, -7/4, 18/4 */
    assert_close(weighted.standard_error, sqrt(1.5 * (121 + 49 + 324)) / 16, 1e-15);
    assert_true(isnan(estimate_mean(0, NULL).value));
    assert_true(isnan(estimate_mean(1, x).standard_error));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_those_of_the_ratio),
        cmocka_unit_test(merging_is_exact),
        cmocka_unit_test(a_million_realisations),
        cmocka_unit_test(certain_and_alone),
        cmocka_unit_test(rare_and_empty),
        cmocka_unit_test(rare_beside_full),
        cmocka_unit_test(ratios_of_few),
        cmocka_unit_test(large_sums_are_read_again),
        cmocka_unit_test(means_and_weights),
    };
    return cmocka_run_group_tests(tests, draw_sample, NULL);
}
