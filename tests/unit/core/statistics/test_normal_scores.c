/* Protects: normal scores keep the order of the heights, holes and the deviation, and are the field
 * of heights that were made of one; heights that do not differ are refused. */
#include "core/statistics/heights/normal_scores.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <math.h>
#include <string.h>

enum { SIDE = 24, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, 1, 1};

static double deviation_of(const double *z) {
    double mean = 0, square = 0, count = 0;
    for (size_t n = 0; n < POINTS; n++)
        if (!isnan(z[n])) {
            mean += z[n];
            count++;
        }
    for (size_t n = 0; n < POINTS; n++)
        if (!isnan(z[n]))
            square += pow(z[n] - mean / count, 2);
    return sqrt(square / count);
}

static void scores_are_those_of_the_field(void **state) {
    (void)state;
    uint64_t seed = seed_or(21);
    double field[POINTS], z[POINTS], scores[POINTS], direct[POINTS];
    noise_fill(&seed, POINTS, field);
    for (size_t n = 0; n < POINTS; n++)
        z[n] = exp(2 * field[n]); /* rises, and is far from Gaussian */
    z[17] = field[17] = NAN;
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    const struct measured_map own = {&GRID, field, BOUNDARY_OPEN};
    assert_int_equal(normal_scores_fill(&map, scores, NULL), 0);
    assert_int_equal(normal_scores_fill(&own, direct, NULL), 0);
    const double ratio = deviation_of(z) / deviation_of(field);
    assert_true(isnan(scores[17]));
    for (size_t n = 0; n < POINTS; n++)
        if (n != 17) {
            check_relative(scores[n], ratio * direct[n], 1e-12);
            assert_true((scores[n] > scores[0]) == (z[n] > z[0]));
        }
    check_relative(deviation_of(scores), deviation_of(z), 1e-9);
}

static void equal_heights_are_refused(void **state) {
    (void)state;
    double z[POINTS] = {0}, scores[POINTS];
    struct error err = {0};
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    assert_int_equal(normal_scores_fill(&map, scores, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "576 heights that do not differ"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scores_are_those_of_the_field),
        cmocka_unit_test(equal_heights_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
