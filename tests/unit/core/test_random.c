/* Protects: the words of Philox equal NumPy's, so that surfaces can be compared element by element,
 * and do not depend on how a run is split. */
#include "core/random.h"
#include "tests/support/check.h"

/* numpy.random.Philox(key=[...], counter=[0, stream, realisation, 0]).random_raw() */
static void words_are_those_of_numpy(void **state) {
    (void)state;
    static const uint64_t EXPECTED[6] = {0xd8ec9816d9c758c6, 0x4061741ee7f04f6f,
                                         0xb29a8583b67160fd, 0x9212f4639cd99957,
                                         0x9dc413125e9d313b, 0x8838453d4539a066};
    static const uint64_t LARGEST_KEY[3] = {0x3c2521c58dde5bfb, 0xb7a1ad5dae1306d7,
                                            0x6942eae9fd2feb84};
    uint64_t words[6];
    random_words((struct random_key){20211, 3, 17}, STREAM_HEIGHTS, 0, 6, words);
    assert_memory_equal(words, EXPECTED, sizeof words);
    random_words((struct random_key){UINT64_MAX, 0, 0}, STREAM_PHASES, 0, 3, words);
    assert_memory_equal(words, LARGEST_KEY, sizeof LARGEST_KEY);
}

static void any_split_gives_the_same_words(void **state) {
    (void)state;
    struct random_key key = {1, 2, 3};
    uint64_t whole[40], part[40];
    random_words(key, STREAM_PHASES, 0, 40, whole);
    for (size_t first = 0; first < 9; first++)
        for (size_t n = 0; first + n <= 40; n += 7) {
            random_words(key, STREAM_PHASES, first, n, part);
            assert_memory_equal(part, whole + first, n * sizeof *part);
        }
}

static void uniform_numbers_are_in_range(void **state) {
    (void)state;
    struct random_key key = {4, 5, 6};
    double u[1000], sum = 0;
    uint64_t words[1000];
    random_uniform(key, STREAM_HEIGHTS, 3, 1000, u);
    random_words(key, STREAM_HEIGHTS, 3, 1000, words);
    for (size_t i = 0; i < 1000; i++) {
        assert_true(u[i] >= 0 && u[i] < 1 && u[i] == (double)(words[i] >> 11) * 0x1p-53);
        sum += u[i];
    }
    /* mean 1/2, deviation 1/sqrt(12 n): four standard errors */
    check_close(sum / 1000, 0.5, 4 / sqrt(12.0 * 1000));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_those_of_numpy),
        cmocka_unit_test(any_split_gives_the_same_words),
        cmocka_unit_test(uniform_numbers_are_in_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
