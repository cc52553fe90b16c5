/* Protects: variance, skewness and kurtosis over the summits of many realisations are those of all
 * their heights together, and their error is that which leaving out realisations one by one
 * (jackknife) shows. */
#include "jobs/estimate.h"
#include "jobs/statistics/summit_heights.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>

enum { REALISATIONS = 60, MOST = 40, MOMENTS = 3 };

struct sample {
    size_t count[REALISATIONS]; /* of heights; 0 and 1 among them */
    double heights[REALISATIONS][MOST];
};

static double uniform(uint64_t *seed) {
    return ldexp((double)(next_word(seed) >> 11), -53);
}

/* Heights are skewed, and those of one realisation go together. */
static void draw(struct sample *sample) {
    uint64_t seed = seed_or(11);
    for (size_t r = 0; r < REALISATIONS; r++) {
        double common = 0.3 * uniform(&seed);
        sample->count[r] = r < 2 ? r : 2 + next_word(&seed) % (MOST - 2);
        for (size_t a = 0; a < sample->count[r]; a++)
            sample->heights[r][a] = 1 + common - log(1 - uniform(&seed));
    }
}

/* Moments of all heights of realisations first to last but one, from their definition. */
struct moments_found {
    double number, mean, of[MOMENTS];
};
static struct moments_found brute_force(const struct sample *sample, size_t first, size_t last,
                                        size_t without) {
    struct moments_found out = {0};
    double powers[5] = {0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t r = first; r < last; r++)
            for (size_t a = 0; a < sample->count[r] && r != without; a++)
                for (int p = 0; p < 5; p++)
                    powers[p] += pow(sample->heights[r][a] - out.mean, p);
        out.number = powers[0];
        if (pass == 0)
            out.mean = powers[1] / powers[0];
        for (int p = 0; p < 5 && pass == 0; p++)
            powers[p] = 0;
    }
    out.of[HEIGHT_VARIANCE] = powers[2] / powers[0];
    out.of[HEIGHT_SKEWNESS] = powers[3] / powers[0] / pow(out.of[HEIGHT_VARIANCE], 1.5);
    out.of[HEIGHT_KURTOSIS] = powers[4] / powers[0] / pow(out.of[HEIGHT_VARIANCE], 2);
    return out;
}

static double jackknife(const struct sample *sample, enum height_moment moment) {
    double values[REALISATIONS], mean = 0, squares = 0;
    for (size_t r = 0; r < REALISATIONS; r++) {
        values[r] = brute_force(sample, 0, REALISATIONS, r).of[moment];
        mean += values[r] / REALISATIONS;
    }
    for (size_t r = 0; r < REALISATIONS; r++)
        squares += (values[r] - mean) * (values[r] - mean);
    return sqrt(squares * (REALISATIONS - 1) / REALISATIONS);
}

static void moments_of_all_summits(void **state) {
    (void)state;
    static struct sample sample;
    static double columns[2 + MOMENTS][REALISATIONS], values[REALISATIONS];
    draw(&sample);
    for (size_t r = 0; r < REALISATIONS; r++) {
        struct moments_found own = brute_force(&sample, r, r + 1, REALISATIONS);
        columns[0][r] = own.number;
        columns[1][r] = own.mean;
        for (size_t m = 0; m < MOMENTS; m++)
            columns[2 + m][r] = own.of[m];
    }
    assert_true(isnan(columns[3][1]) && isnan(columns[1][0]));
    const struct height_columns of = {.n = REALISATIONS,
                                      .number = columns[0],
                                      .mean = columns[1],
                                      .variance = columns[2],
                                      .skewness = columns[3],
                                      .kurtosis = columns[4]};
    const struct moments_found all = brute_force(&sample, 0, REALISATIONS, REALISATIONS);
    for (enum height_moment m = HEIGHT_VARIANCE; m <= HEIGHT_KURTOSIS; m++) {
        height_moment_values(&of, m, values);
        struct estimate found = estimate_weighted(REALISATIONS, values, columns[0]);
        check_relative(found.value, all.of[m], 1e-12);
        /* Linear parts leave out terms of one over the number of realisations. */
        check_relative(found.standard_error, jackknife(&sample, m), 0.1);
    }
}

/* Sums over groups about any common height give the same as realisations do. */
static void parts_add_up(void **state) {
    (void)state;
    static struct sample sample;
    struct height_powers groups[4] = {{0}}, all = {0};
    draw(&sample);
    const struct moments_found expected = brute_force(&sample, 0, REALISATIONS, REALISATIONS);
    for (size_t r = 0; r < REALISATIONS; r++)
        for (size_t a = 0; a < sample.count[r]; a++) {
            double d = sample.heights[r][a] - expected.mean;
            struct height_powers *to[] = {&groups[r % 4], &all};
            for (size_t n = 0; n < 2; n++) {
                to[n]->number++;
                to[n]->first += d;
                to[n]->second += d * d;
                to[n]->third += d * d * d;
                to[n]->fourth += d * d * d * d;
            }
        }
    for (enum height_moment m = HEIGHT_VARIANCE; m <= HEIGHT_KURTOSIS; m++) {
        double sum = 0;
        for (size_t g = 0; g < 4; g++)
            sum += height_moment_part(m, &all, &groups[g]);
        check_relative(sum / all.number, expected.of[m], 1e-12);
    }
}

static void equal_heights_have_no_shape(void **state) {
    (void)state;
    static const double number[] = {1, 1}, mean[] = {2, 2}, none[] = {0, 0}, nan[] = {NAN, NAN};
    const struct height_columns of = {2, number, mean, none, nan, nan};
    double values[2];
    height_moment_values(&of, HEIGHT_VARIANCE, values);
    assert_true(values[0] == 0 && values[1] == 0);
    height_moment_values(&of, HEIGHT_SKEWNESS, values);
    assert_true(isnan(values[0]) && isnan(values[1]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moments_of_all_summits),
        cmocka_unit_test(parts_add_up),
        cmocka_unit_test(equal_heights_have_no_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
