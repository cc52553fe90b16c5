/* Protects: ranks by a table are those of the keys but for the order within a bin, in any blocks;
 * keys out of range, ties and what is no number end in heights that exist. */
#include "core/random.h"
#include "core/surface/iteration/rank.h"
#include "core/surface/iteration/rank_table.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { N = 40000 };
static double key[N], sorted[N], placed[N], exact[N];

/* Normal keys, of realisation r, and exponential heights. */
static void fill(uint64_t r) {
    random_uniform((struct random_key){3, 0, r}, STREAM_HEIGHTS, 0, N, key);
    for (size_t i = 0; i < N; i++) {
        sorted[i] = -log1p(-((double)i + 0.5) / N);
        key[i] = log((key[i] + 1e-9) / (1 - key[i] + 1e-9));
    }
}

static void place(double low, double high, size_t block) {
    struct rank_table *table = NULL;
    double lowest, highest;
    assert_int_equal(rank_table_create(&table, N, NULL), 0);
    rank_table_start(table, low, high);
    for (size_t i = 0; i < N; i += block)
        rank_table_count(table, N - i < block ? N - i : block, key + i);
    rank_table_finish(table, sorted, &lowest, &highest);
    for (size_t i = 0; i < N; i += block)
        rank_table_order(table, N - i < block ? N - i : block, key + i, placed + i);
    for (size_t i = 0; i < N; i++)
        assert_true(!(key[i] < lowest || key[i] > highest));
    rank_table_destroy(&table);
    assert_null(table);
}

/* 2500 bins over 40 units of the logistic keys: at their middle 160 of 40000 keys share a bin,
 * whose heights spread over less than 0.02; in the tail heights are 1/k apart, k from the end. */
static void heights_are_those_of_the_ranks(void **state) {
    (void)state;
    struct ranker *ranker = NULL;
    assert_int_equal(ranker_create(&ranker, N, NULL), 0);
    for (uint64_t r = 0; r < 3; r++) {
        double square = 0, sum = 0;
        fill(r);
        place(-20, 20, 97);
        assert_int_equal(rank_order(ranker, key, sorted, exact, NULL), 0);
        for (size_t i = 0; i < N; i++) {
            check_close(placed[i], exact[i], exact[i] < 5 ? 0.02 : 1.5);
            square += (placed[i] - exact[i]) * (placed[i] - exact[i]) / N;
            sum += placed[i] / N;
        }
        assert_true(sqrt(square) < 0.01);
        check_close(sum, 1, 2e-3);
    }
    ranker_destroy(&ranker);
}

static void blocks_do_not_matter(void **state) {
    (void)state;
    static double first[N];
    fill(7);
    place(-20, 20, N);
    memcpy(first, placed, sizeof first);
    place(-20, 20, 64);
    assert_memory_equal(first, placed, sizeof first);
}

static void check_heights(void) {
    for (size_t i = 0; i < N; i++)
        assert_true(placed[i] >= sorted[0] - 1e-12 && placed[i] <= sorted[N - 1] + 1e-12);
}

/* Keys beyond the range are as high as its ends; one value for all keys, and an empty range, give
 * heights of the distribution. */
static void odd_keys_have_heights(void **state) {
    (void)state;
    fill(5);
    place(-1, 1, 512);
    check_heights();
    for (size_t i = 0; i < N; i++)
        if (key[i] > 1)
            check_close(placed[i], sorted[N - 1], 1e-6);
    key[5] = NAN;
    key[6] = INFINITY;
    key[7] = -INFINITY;
    place(-20, 20, 512);
    check_heights();
    for (size_t i = 0; i < N; i++)
        key[i] = 2;
    place(2, 2, 512);
    check_heights();
    place(1, 3, 512);
    check_heights();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_are_those_of_the_ranks),
        cmocka_unit_test(blocks_do_not_matter),
        cmocka_unit_test(odd_keys_have_heights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
