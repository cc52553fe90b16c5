/* Protects: ranks are those of a stable comparison sort for every input, whatever the distribution
 * of the keys, and no input makes ranking slow out of proportion. */
#include "core/surface/iteration/rank.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <float.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static uint64_t seed;
static uint64_t random_state;

static uint64_t random_word(void) {
    return next_word(&random_state);
}

static double uniform(void) {
    return (double)(random_word() >> 11) * 0x1p-53;
}

/* The oracle: a merge sort of positions that takes the left one of equals. */
static void oracle_sort(const double *key, size_t *position, size_t *spare, size_t n) {
    if (n < 2)
        return;
    size_t half = n / 2;
    oracle_sort(key, position, spare, half);
    oracle_sort(key, position + half, spare, n - half);
    memcpy(spare, position, n * sizeof *spare);
    for (size_t p = 0, a = 0, b = half; p < n; p++) {
        bool left = b == n || (a < half && !(key[spare[b]] < key[spare[a]]));
        position[p] = left ? spare[a++] : spare[b++];
    }
}

typedef double (*key_function)(size_t i, size_t n);

static double gaussian(size_t i, size_t n) {
    (void)i, (void)n;
    return sqrt(-2 * log(1 - uniform())) * cos(2 * M_PI * uniform());
}
static double exponential(size_t i, size_t n) {
    (void)i, (void)n;
    return log(1 - uniform());
}
static double heavy_tail(size_t i, size_t n) {
    (void)i, (void)n;
    return pow(-log(1 - uniform()), 2);
}
static double equal(size_t i, size_t n) {
    (void)i, (void)n;
    return 3.5;
}
static double rising(size_t i, size_t n) {
    (void)n;
    return (double)i;
}
static double falling(size_t i, size_t n) {
    (void)n;
    return -(double)i;
}
static double organ_pipe(size_t i, size_t n) {
    return (double)(i < n / 2 ? i : n - i);
}
static double few_values(size_t i, size_t n) {
    (void)i, (void)n;
    return floor(7 * uniform());
}
static double zeros_of_both_signs(size_t i, size_t n) {
    (void)i, (void)n;
    double u = uniform();
    return u < 0.4 ? -0.0 : u < 0.8 ? 0.0 : u - 0.9;
}
static double one_far_out(size_t i, size_t n) {
    return i == n / 3 ? 1e300 : uniform();
}
static double whole_range(size_t i, size_t n) {
    (void)i, (void)n;
    return (2 * uniform() - 1) * DBL_MAX;
}
static double denormal(size_t i, size_t n) {
    (void)i, (void)n;
    return uniform() * 1e-310;
}
static double huge_and_denormal(size_t i, size_t n) {
    (void)n;
    return i % 2 ? uniform() * 1e-310 : uniform() * 1e300;
}
static double last_digits(size_t i, size_t n) {
    (void)i, (void)n;
    return 1 + (double)(random_word() % 16) * DBL_EPSILON;
}
/* Clusters within clusters: wherever a table is refined, most keys stay in one cell. */
static double nested_clusters(size_t i, size_t n) {
    (void)i, (void)n;
    return exp2(-(double)(random_word() % 1000)) * (1 + uniform() * 0x1p-40);
}
static double two_spikes(size_t i, size_t n) {
    (void)n;
    return (i % 2 ? 1 : -1) + uniform() * 1e-12;
}

static const struct {
    const char *name;
    key_function key;
} CATALOGUE[] = {{"gaussian", gaussian},
                 {"exponential", exponential},
                 {"heavy tail", heavy_tail},
                 {"equal", equal},
                 {"rising", rising},
                 {"falling", falling},
                 {"organ pipe", organ_pipe},
                 {"few values", few_values},
                 {"zeros of both signs", zeros_of_both_signs},
                 {"one far out", one_far_out},
                 {"whole range", whole_range},
                 {"denormal", denormal},
                 {"huge and denormal", huge_and_denormal},
                 {"last digits", last_digits},
                 {"nested clusters", nested_clusters},
                 {"two spikes", two_spikes}};
enum { KINDS = sizeof CATALOGUE / sizeof *CATALOGUE };

/* Ranks n keys of a kind and compares with the oracle, element by element. */
static void compare(const char *name, key_function make, size_t n) {
    struct ranker *ranker = NULL;
    struct error err = {0};
    double *key = malloc(n * sizeof *key);
    double *sorted = malloc(n * sizeof *sorted);
    double *placed = malloc(n * sizeof *placed);
    size_t *position = malloc(2 * n * sizeof *position);
    assert_true(key && sorted && placed && position);
    for (size_t i = 0; i < n; i++) {
        key[i] = make(i, n);
        sorted[i] = (double)i; /* the sorted height is then the rank itself */
        position[i] = i;
    }
    oracle_sort(key, position, position + n, n);
    assert_int_equal(ranker_create(&ranker, n, &err), 0);
    for (int again = 0; again < 2; again++) { /* a used workspace ranks like a new one */
        assert_int_equal(rank_order(ranker, key, sorted, placed, &err), 0);
        for (size_t p = 0; p < n; p++)
            if (placed[position[p]] != (double)p)
                fail_msg("%s, n = %zu, seed %llu: key %zu has rank %g, not %zu", name, n,
                         (unsigned long long)seed, position[p], placed[position[p]], p);
    }
    memcpy(sorted, key, n * sizeof *sorted);
    assert_int_equal(rank_sort(ranker, sorted, &err), 0);
    for (size_t p = 0; p < n; p++)
        if (sorted[p] != key[position[p]] || signbit(sorted[p]) != signbit(key[position[p]]))
            fail_msg("%s, n = %zu, seed %llu: sorted[%zu] = %g, not %g", name, n,
                     (unsigned long long)seed, p, sorted[p], key[position[p]]);
    ranker_destroy(&ranker);
    assert_null(ranker);
    free(key);
    free(sorted);
    free(placed);
    free(position);
}

static void ranks_equal_a_stable_sort(void **state) {
    (void)state;
    static const size_t SIZES[] = {1, 2, 3, 5, 127, 128, 129, 1000, 4096, 4097, 40009, 200003};
    for (size_t kind = 0; kind < KINDS; kind++)
        for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++)
            compare(CATALOGUE[kind].name, CATALOGUE[kind].key, SIZES[s]);
}

static void random_sizes_and_mixtures(void **state) {
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        size_t kind = random_word() % KINDS;
        compare(CATALOGUE[kind].name, CATALOGUE[kind].key, 1 + random_word() % 3000);
    }
}

static void values_not_finite_are_refused(void **state) {
    (void)state;
    enum { N = 1001 };
    static const double FAULTS[] = {NAN, INFINITY, -INFINITY};
    double key[N], sorted[N], placed[N];
    struct ranker *ranker = NULL;
    struct error err = {0};
    assert_int_equal(ranker_create(&ranker, N, &err), 0);
    for (size_t at = 0; at < N; at += 250)
        for (size_t f = 0; f < 3; f++) {
            for (size_t i = 0; i < N; i++)
                key[i] = sorted[i] = (double)i;
            key[at] = FAULTS[f];
            assert_int_equal(rank_order(ranker, key, sorted, placed, &err), ERROR_NUMERIC);
            assert_non_null(strstr(err.text, "not finite"));
            assert_int_equal(rank_sort(ranker, key, &err), ERROR_NUMERIC);
        }
    ranker_destroy(&ranker);
}

static void impossible_counts_are_refused(void **state) {
    (void)state;
    struct ranker *ranker = NULL;
    struct error err = {0};
    assert_int_equal(ranker_create(&ranker, 0, &err), ERROR_INPUT);
    assert_null(ranker);
    assert_int_equal(ranker_create(&ranker, SIZE_MAX, &err), ERROR_INPUT);
    assert_null(ranker);
    ranker_destroy(&ranker);
}

/* A million keys of each kind, against n log n with a generous constant: 100 times what a good
 * distribution takes would still be under the limit, a quadratic step would take minutes. */
static void no_kind_is_quadratic(void **state) {
    (void)state;
    size_t n = 1000003;
    double *key = malloc(n * sizeof *key);
    double *sorted = malloc(n * sizeof *sorted);
    double *placed = malloc(n * sizeof *placed);
    struct ranker *ranker = NULL;
    struct error err = {0};
    assert_true(key && sorted && placed);
    assert_int_equal(ranker_create(&ranker, n, &err), 0);
    for (size_t i = 0; i < n; i++)
        sorted[i] = (double)i;
    for (size_t kind = 0; kind < KINDS; kind++) {
        for (size_t i = 0; i < n; i++)
            key[i] = CATALOGUE[kind].key(i, n);
        clock_t start = clock();
        assert_int_equal(rank_order(ranker, key, sorted, placed, &err), 0);
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        if (!(seconds < 5))
            fail_msg("%s: %.1f s of CPU for a million keys", CATALOGUE[kind].name, seconds);
    }
    ranker_destroy(&ranker);
    free(key);
    free(sorted);
    free(placed);
}

int main(void) {
    seed = seed_of_now();
    random_state = seed;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranks_equal_a_stable_sort),
        cmocka_unit_test(random_sizes_and_mixtures),
        cmocka_unit_test(values_not_finite_are_refused),
        cmocka_unit_test(impossible_counts_are_refused),
        cmocka_unit_test(no_kind_is_quadratic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
