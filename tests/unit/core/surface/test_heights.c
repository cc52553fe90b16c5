/* Protects: the moments, bounds, quantiles and densities of the height distributions, to the
 * reference's tables and without loss of digits at the ends of the range of shapes. */
#include "core/random.h"
#include "core/surface/heights.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct height_moments moments_of(enum heights_type type, double shape) {
    struct heights heights = {.type = type, .shape = shape};
    struct height_moments moments;
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    return moments;
}

/* The densities of the raw variables (F4.1), which the program itself does not need. */
static double raw_density(enum heights_type type, double shape, double raw) {
    double a = shape;
    switch (type) {
    case HEIGHTS_GAUSSIAN:
        return exp(-raw * raw / 2) / sqrt(2 * M_PI);
    case HEIGHTS_WEIBULL_MIN:
        return raw < 0 ? 0 : shape * pow(raw, shape - 1) * exp(-pow(raw, shape));
    case HEIGHTS_WEIBULL_MAX:
        return raw_density(HEIGHTS_WEIBULL_MIN, shape, -raw);
    case HEIGHTS_LOGNORMAL:
        return raw > 0 ? raw_density(HEIGHTS_GAUSSIAN, 0, log(raw) / shape) / (shape * raw) : 0;
    case HEIGHTS_GAMMA:
        return raw > 0 ? exp((a - 1) * log(raw) - raw - lgamma(a)) : 0;
    case HEIGHTS_BETA: /* of equal shapes */
        return raw > 0 && raw < 1
                   ? exp((a - 1) * log(raw * (1 - raw)) - 2 * lgamma(a) + lgamma(2 * a))
                   : 0;
    default:
        fail_msg("no density of distribution %d", (int)type);
        return NAN;
    }
}

/* Of the standardised heights. */
static double density(const struct heights *heights, const struct height_moments *moments,
                      double z) {
    return moments->deviation *
           raw_density(heights->type, heights->shape, moments->mean + moments->deviation * z);
}

/* Table 3.3 and the bounds of F4.3, to their printed digits. */
static void moments_are_those_of_the_table(void **state) {
    (void)state;
    static const double TABLE[][4] = {{1, 2, 9, 1},
                                      {1.2, 1.5211, 6.2357, 1.1949},
                                      {1.5, 1.0720, 4.3904, 1.4728},
                                      {2, 0.6311, 3.2451, 1.9131},
                                      {3.602, 0.0001, 2.7168, 3.2428}};
    for (size_t row = 0; row < sizeof TABLE / sizeof *TABLE; row++) {
        struct height_moments low = moments_of(HEIGHTS_WEIBULL_MIN, TABLE[row][0]);
        struct height_moments high = moments_of(HEIGHTS_WEIBULL_MAX, TABLE[row][0]);
        check_close(low.skewness, TABLE[row][1], 0.5e-4);
        check_close(low.kurtosis, TABLE[row][2], 0.5e-4);
        check_close(-low.lowest, TABLE[row][3], 0.5e-4);
        assert_true(isinf(low.highest));
        check_close(high.skewness, -low.skewness, 0);
        check_close(high.kurtosis, low.kurtosis, 0);
        check_close(high.highest, -low.lowest, 0);
        check_close(high.mean, -low.mean, 0);
        assert_true(isinf(high.lowest) && high.lowest < 0);
    }
}

/* At C = 20 four digits of the central moments cancel when they are formed from raw ones; the
 * values are from 50-digit arithmetic. 1e-11: what remains of the cancellation in lgamma's
 * arguments. */
static void extreme_shapes_keep_their_digits(void **state) {
    (void)state;
    struct height_moments half = moments_of(HEIGHTS_WEIBULL_MIN, 0.5);
    check_relative(half.mean, 2.0, 1e-14);
    check_relative(half.deviation, 4.4721359549995793928, 1e-13);
    check_relative(half.skewness, 6.6187612133993780616, 1e-13);
    check_relative(half.kurtosis, 87.72, 1e-13);
    struct height_moments twenty = moments_of(HEIGHTS_WEIBULL_MIN, 20);
    check_relative(twenty.mean, 0.973504265562775643202, 1e-13);
    check_relative(twenty.deviation, 0.060334192610442550955, 1e-11);
    check_relative(twenty.skewness, -0.86796509517451089683, 1e-11);
    check_relative(twenty.kurtosis, 4.267200759255400820984, 1e-11);
}

static void quantiles_invert_the_distribution(void **state) {
    (void)state;
    static const double PROBABILITIES[] = {1e-12, 1e-3, 0.2, 0.5, 0.9, 1 - 1e-9};
    static const double PARTS[] = {0, 0.2, 0.5, 1}; /* of the range of the shape */
    for (enum heights_type type = 0; type < HEIGHTS_QUANTILE; type++)
        for (size_t s = 0; s < 4; s++)
            for (size_t k = 0; k < sizeof PROBABILITIES / sizeof *PROBABILITIES; k++) {
                const struct distribution *row = heights_distribution(type);
                double shape = row->shape_low + PARTS[s] * (row->shape_high - row->shape_low);
                struct heights heights = {.type = type, .shape = shape};
                struct height_moments moments = moments_of(type, shape);
                double p = PROBABILITIES[k];
                double z = heights_quantile(&heights, &moments, p);
                /* z has lost digits near a bound: an error of 4e-16 there moves p by the density */
                double inside =
                    fmin(fmax(z, moments.lowest * (1 - 4e-16)), moments.highest * (1 - 4e-16));
                double lost = 4e-16 * density(&heights, &moments, inside) * fmax(1, fabs(z)) * 40;
                check_close(heights_cdf(&heights, &moments, z), p, 1e-11 * p + fmin(lost, 1e-6));
            }
}

/* Of all that have one: five-point differences. */
static void densities_are_slopes(void **state) {
    (void)state;
    for (enum heights_type type = 0; type < HEIGHTS_QUANTILE; type++) {
        const struct distribution *row = heights_distribution(type);
        struct heights heights = {.type = type,
                                  .shape = (row->shape_low + 0.1 * row->shape_high) / 1.1};
        struct height_moments moments = moments_of(type, heights.shape);
        for (double z = -0.4; z < 3; z += 0.3) {
            double step = 1e-3, slope = 0;
            static const double WEIGHTS[] = {1, -8, 0, 8, -1};
            for (int k = -2; k <= 2; k++)
                slope += WEIGHTS[k + 2] * heights_cdf(&heights, &moments, z + k * step);
            check_close(slope / (12 * step), density(&heights, &moments, z), 1e-8);
        }
    }
}

/* The density is the slope of the distribution, and integrates to 1 with mean 0 and variance 1. */
static void densities_are_standardised(void **state) {
    (void)state;
    struct heights heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 1.5};
    struct height_moments moments = moments_of(heights.type, heights.shape);
    double sum = 0, mean = 0, square = 0, step = 1e-4;
    for (size_t i = 0; i < 165000; i++) {
        double z = moments.highest - step * ((double)i + 0.5);
        double weight = step * density(&heights, &moments, z);
        sum += weight;
        mean += weight * z;
        square += weight * z * z;
        double low = heights_cdf(&heights, &moments, z - step / 2);
        double high = heights_cdf(&heights, &moments, z + step / 2);
        if (z < moments.highest - 0.01) /* midpoint rule: f'' step^2 / 24, large at the bound */
            check_close(high - low, weight, 1e-6 * step);
    }
    check_close(sum, 1, 1e-6); /* the square-root start at the bound: step^1.5 */
    check_close(mean, 0, 1e-5);
    check_close(square, 1, 1e-5);
    check_close(density(&heights, &moments, moments.highest + 0.1), 0, 0);
    check_close(heights_cdf(&heights, &moments, moments.highest + 0.1), 1, 0);
}

/* A million draws: mean, variance, skewness and kurtosis within 4 standard errors, these from the
 * blocks' spread (heavy tails make formulas for them useless). */
static void draws_have_the_moments(void **state) {
    (void)state;
    enum { BLOCKS = 100, DRAWS = 10000 };
    static const double SHAPES[] = {1, 1.2, 1.5, 2, 3.602};
    double *u = malloc(DRAWS * sizeof *u);
    assert_non_null(u);
    for (size_t s = 0; s < 5; s++) {
        struct heights heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = SHAPES[s]};
        struct height_moments moments = moments_of(heights.type, heights.shape);
        const double expected[4] = {0, 1, moments.skewness, moments.kurtosis};
        double sum[4] = {0}, square[4] = {0};
        for (size_t block = 0; block < BLOCKS; block++) {
            random_uniform((struct random_key){7, s, block}, STREAM_HEIGHTS, 0, DRAWS, u);
            double power[4] = {0};
            for (size_t i = 0; i < DRAWS; i++) {
                double z = heights_quantile(&heights, &moments, fmax(u[i], 0x1p-54));
                for (size_t k = 0; k < 4; k++)
                    power[k] += pow(z, (double)k + 1) / DRAWS;
            }
            for (size_t k = 0; k < 4; k++) {
                sum[k] += power[k];
                square[k] += power[k] * power[k];
            }
        }
        for (size_t k = 0; k < 4; k++) {
            double mean = sum[k] / BLOCKS;
            double error = sqrt((square[k] / BLOCKS - mean * mean) / (BLOCKS - 1));
            check_close(mean, expected[k], 4 * error);
        }
    }
    free(u);
}

static double exponential_quantile(double p, const void *context) {
    return *(const double *)context - 3 * log1p(-p);
}
static double falling_quantile(double p, const void *context) {
    (void)context;
    return -p;
}
static double constant_quantile(double p, const void *context) {
    (void)p, (void)context;
    return 2;
}
static double cauchy_quantile(double p, const void *context) {
    (void)context;
    return tan(M_PI * (p - 0.5));
}
static double step_quantile(double p, const void *context) {
    (void)context;
    return p < 0.25 ? -1 : 1;
}

static void quantile_functions_are_standardised(void **state) {
    (void)state;
    double shift = -7;
    struct heights heights = {
        .type = HEIGHTS_QUANTILE, .quantile = exponential_quantile, .context = &shift};
    struct height_moments moments;
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    check_close(moments.mean, -4, 1e-11); /* quadrature's stated 12 digits */
    check_close(moments.deviation, 3, 1e-11);
    check_close(moments.skewness, 2, 1e-9);
    check_close(moments.kurtosis, 9, 1e-8);
    check_close(heights_quantile(&heights, &moments, 0.5), M_LN2 - 1, 1e-11);
    assert_true(isnan(heights_cdf(&heights, &moments, 0)));
    heights.quantile = step_quantile; /* jumps: the stated three digits */
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    check_close(moments.mean, 0.5, 2e-3);
    check_close(moments.deviation, sqrt(0.75), 2e-3);
}

/* The moments of a log-normal variable by their closed forms (Johnson, Kotz & Balakrishnan 1994,
 * 14.8), and those that any quantile function gets by quadrature. */
static double lognormal_half(double probability, const void *context) {
    const struct height_moments *unit = context; /* of a standard Gaussian */
    struct heights gaussian = {.type = HEIGHTS_GAUSSIAN};
    return exp(0.5 * heights_quantile(&gaussian, unit, probability));
}

static void lognormal_moments_are_the_closed_forms(void **state) {
    (void)state;
    static const double SHAPES[] = {0.01, 0.1, 0.5, 1};
    for (size_t s = 0; s < 4; s++) {
        struct height_moments moments = moments_of(HEIGHTS_LOGNORMAL, SHAPES[s]);
        double square = SHAPES[s] * SHAPES[s];
        check_relative(moments.skewness, (exp(square) + 2) * sqrt(exp(square) - 1), 1e-11);
        check_relative(moments.kurtosis,
                       exp(4 * square) + 2 * exp(3 * square) + 3 * exp(2 * square) - 3, 1e-14);
        check_relative(moments.lowest, -1 / sqrt(exp(square) - 1), 1e-11);
        assert_true(isinf(moments.highest));
    }
    struct height_moments unit = moments_of(HEIGHTS_GAUSSIAN, 0), measured;
    struct height_moments half = moments_of(HEIGHTS_LOGNORMAL, 0.5);
    struct heights heights = {
        .type = HEIGHTS_QUANTILE, .quantile = lognormal_half, .context = &unit};
    assert_int_equal(heights_moments(&heights, &measured, NULL), 0);
    check_relative(half.mean, measured.mean, 1e-9);
    check_relative(half.deviation, measured.deviation, 1e-9);
    check_relative(half.skewness, measured.skewness, 1e-6); /* tails beyond the last node */
    check_relative(half.kurtosis, measured.kurtosis, 1e-4);
}

static int rising(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Kolmogorov and Smirnov's distance of 20000 draws from the distribution: beyond 1.95/sqrt(n) with
 * probability 1e-3; the draws are always the same. */
static void draws_follow_the_distribution(void **state) {
    (void)state;
    enum { DRAWS = 20000 };
    static double u[DRAWS];
    for (enum heights_type type = 0; type < HEIGHTS_QUANTILE; type++) {
        const struct distribution *row = heights_distribution(type);
        struct heights heights = {.type = type,
                                  .shape = (row->shape_low + 0.4 * row->shape_high) / 1.4};
        struct height_moments moments = moments_of(type, heights.shape);
        random_uniform((struct random_key){11, (uint64_t)type, 0}, STREAM_HEIGHTS, 0, DRAWS, u);
        for (size_t i = 0; i < DRAWS; i++)
            u[i] = heights_quantile(&heights, &moments, fmax(u[i], 0x1p-54));
        qsort(u, DRAWS, sizeof *u, rising);
        double distance = 0;
        for (size_t i = 0; i < DRAWS; i++) {
            double p = heights_cdf(&heights, &moments, u[i]);
            distance = fmax(distance, fabs(p - ((double)i + 0.5) / DRAWS) + 0.5 / DRAWS);
        }
        check_close(distance, 0, 1.95 / sqrt(DRAWS));
    }
}

static void nonsense_is_refused(void **state) {
    (void)state;
    static const double SHAPES[] = {0.4999, 20.001, -1, 0, NAN, INFINITY};
    struct height_moments moments;
    struct error err;
    for (size_t s = 0; s < sizeof SHAPES / sizeof *SHAPES; s++) {
        struct heights heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = SHAPES[s]};
        assert_int_equal(heights_moments(&heights, &moments, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "[0.5, 20]"));
    }
    struct heights wide = {.type = HEIGHTS_LOGNORMAL, .shape = 1.001};
    assert_int_equal(heights_moments(&wide, &moments, &err), ERROR_INPUT);
    assert_string_equal(err.text, "standard deviation of the logarithm: 1.001 is not in [0.01, 1]");
    struct heights heights = {.type = HEIGHTS_QUANTILE};
    assert_int_equal(heights_moments(&heights, &moments, &err), ERROR_INPUT);
    heights.quantile = falling_quantile;
    assert_int_equal(heights_moments(&heights, &moments, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "rising"));
    heights.quantile = constant_quantile;
    assert_int_equal(heights_moments(&heights, &moments, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "constant"));
    heights.quantile = cauchy_quantile;
    assert_int_equal(heights_moments(&heights, &moments, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "moment"));
}

/* Over the whole range of shapes, both signs; and what no shape has is refused with the range. */
static void shapes_of_a_skewness(void **state) {
    (void)state;
    static const enum heights_type TYPES[] = {HEIGHTS_WEIBULL_MIN, HEIGHTS_WEIBULL_MAX,
                                              HEIGHTS_LOGNORMAL, HEIGHTS_GAMMA};
    struct error err = {0};
    double shape = 0;
    for (size_t t = 0; t < sizeof TYPES / sizeof *TYPES; t++) {
        const struct distribution *row = heights_distribution(TYPES[t]);
        const struct heights of = {.type = TYPES[t]};
        for (int n = 0; n <= 20; n++) {
            double asked = row->shape_low + (row->shape_high - row->shape_low) * n / 20;
            double skewness = moments_of(TYPES[t], asked).skewness;
            assert_int_equal(heights_shape_of_skewness(&of, skewness, &shape, NULL), 0);
            check_relative(shape, asked, 1e-9);
        }
    }
    assert_int_equal(
        heights_shape_of_skewness(&(struct heights){.type = HEIGHTS_WEIBULL_MIN}, -1, &shape, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "no shape has the skewness -1; allowed: -0.8"));
    assert_int_equal(
        heights_shape_of_skewness(&(struct heights){.type = HEIGHTS_LOGNORMAL}, -0.1, &shape, &err),
        ERROR_INPUT);
    assert_int_equal(
        heights_shape_of_skewness(&(struct heights){.type = HEIGHTS_GAUSSIAN}, 0, &shape, &err),
        ERROR_INPUT);
}

/* Closed forms (Johnson, Kotz & Balakrishnan 1994, 1995), and the moments of the quantile function
 * by quadrature, whose tails end at its last node. */
static double by_row(double probability, const void *context) {
    const struct heights *heights = context;
    return heights_distribution(heights->type)->quantile(heights, probability);
}

static void gamma_and_beta_have_their_moments(void **state) {
    (void)state;
    static const struct heights OWN[] = {{.type = HEIGHTS_GAMMA, .shape = 0.25},
                                         {.type = HEIGHTS_GAMMA, .shape = 4},
                                         {.type = HEIGHTS_GAMMA, .shape = 1000},
                                         {.type = HEIGHTS_BETA, .shape = 0.5},
                                         {.type = HEIGHTS_BETA, .shape = 2, .second = 5},
                                         {.type = HEIGHTS_BETA, .shape = 100, .second = 0.5}};
    for (size_t n = 0; n < sizeof OWN / sizeof *OWN; n++) {
        struct heights measured = {
            .type = HEIGHTS_QUANTILE, .quantile = by_row, .context = &OWN[n]};
        struct height_moments exact, found;
        assert_int_equal(heights_moments(&OWN[n], &exact, NULL), 0);
        assert_int_equal(heights_moments(&measured, &found, NULL), 0);
        check_relative(found.mean, exact.mean, 1e-9);
        check_relative(found.deviation, exact.deviation, 1e-8);
        check_close(found.skewness, exact.skewness, 1e-5);
        check_relative(found.kurtosis, exact.kurtosis, 1e-4);
        check_relative(exact.lowest * exact.deviation, -exact.mean, 1e-13);
        if (OWN[n].type == HEIGHTS_BETA)
            check_relative(exact.highest * exact.deviation, 1 - exact.mean, 1e-13);
    }
    check_relative(moments_of(HEIGHTS_GAMMA, 4).skewness, 1, 1e-15); /* 2/sqrt(4) */
    check_relative(moments_of(HEIGHTS_GAMMA, 4).kurtosis, 4.5, 1e-15);
    check_relative(moments_of(HEIGHTS_BETA, 1).kurtosis, 1.8, 1e-14); /* even heights */
}

/* A skewness and a kurtosis give both shapes of beta; what lies beyond its reach is refused. */
static void beta_has_a_skewness_and_a_kurtosis(void **state) {
    (void)state;
    static const double SHAPES[][2] = {{0.5, 0.5}, {2, 5}, {5, 2}, {90, 3}, {1, 1}};
    struct error err = {0};
    struct heights found = {.type = HEIGHTS_BETA};
    for (size_t n = 0; n < sizeof SHAPES / sizeof *SHAPES; n++) {
        struct heights asked = {
            .type = HEIGHTS_BETA, .shape = SHAPES[n][0] * 1.001, .second = SHAPES[n][1] * 1.001};
        struct height_moments moments;
        double shape;
        assert_int_equal(heights_moments(&asked, &moments, NULL), 0);
        assert_int_equal(
            heights_shapes_of_moments(moments.skewness, moments.kurtosis, &found, &err), 0);
        check_relative(found.shape, asked.shape, 1e-9);
        check_relative(found.second, asked.second, 1e-9);
        assert_int_equal(heights_shape_of_skewness(&asked, moments.skewness, &shape, &err), 0);
        check_relative(shape, asked.shape, 1e-9); /* with the second shape as it is */
    }
    assert_int_equal(heights_shapes_of_moments(1, 4.5, &found, &err), ERROR_INPUT); /* gamma's */
    assert_non_null(strstr(err.text, "allowed: (2, 4.5)"));
    assert_int_equal(heights_shapes_of_moments(0, 2.99, &found, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "shapes"));
    double shape;
    assert_int_equal(
        heights_shape_of_skewness(&(struct heights){.type = HEIGHTS_BETA}, 0.5, &shape, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "second shape"));
    struct height_moments moments;
    const struct heights wide = {.type = HEIGHTS_BETA, .shape = 1, .second = 101};
    assert_int_equal(heights_moments(&wide, &moments, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "second shape of a beta distribution: 101"));
}

/* Values at Gaussian scores keep their digits in both tails, where probabilities have none left. */
static void scores_reach_far(void **state) {
    (void)state;
    static const double SHAPES[] = {0.25, 1, 30, 1000};
    for (size_t n = 0; n < 4; n++) {
        struct heights heights = {.type = HEIGHTS_GAMMA, .shape = SHAPES[n]};
        struct height_moments moments = moments_of(HEIGHTS_GAMMA, SHAPES[n]);
        double last = heights_at_score(&heights, &moments, -38);
        for (double score = -30; score <= 30; score += 2) {
            double z = heights_at_score(&heights, &moments, score);
            assert_true(isfinite(z) && z >= last);
            last = z;
        }
        if (SHAPES[n] == 1) /* exponential: the logarithm of the share above */
            check_relative(last * moments.deviation + moments.mean, -log(erfc(30 / sqrt(2)) / 2),
                           1e-12);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moments_are_those_of_the_table),
        cmocka_unit_test(shapes_of_a_skewness),
        cmocka_unit_test(gamma_and_beta_have_their_moments),
        cmocka_unit_test(beta_has_a_skewness_and_a_kurtosis),
        cmocka_unit_test(scores_reach_far),
        cmocka_unit_test(extreme_shapes_keep_their_digits),
        cmocka_unit_test(quantiles_invert_the_distribution),
        cmocka_unit_test(densities_are_slopes),
        cmocka_unit_test(densities_are_standardised),
        cmocka_unit_test(draws_have_the_moments),
        cmocka_unit_test(quantile_functions_are_standardised),
        cmocka_unit_test(lognormal_moments_are_the_closed_forms),
        cmocka_unit_test(draws_follow_the_distribution),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
