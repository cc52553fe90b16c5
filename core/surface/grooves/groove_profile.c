#include "core/surface/grooves/groove_profile.h"
#include <math.h>

const char *const GROOVE_SHAPE_NAMES[GROOVE_SHAPES] = {"sine", "arcs", "triangle", "saw",
                                                       "harmonics"};

double complex groove_shape_coefficient(enum groove_shape shape, size_t h) {
    const double order = (double)h, sign = h % 2 == 0 ? 1 : -1;
    switch (shape) {
    case GROOVE_SINE:
        return h == 1 ? 0.25 : 0;
    case GROOVE_ARCS:
        return 2 * sign / (M_PI * M_PI * order * order);
    case GROOVE_TRIANGLE:
        return h % 2 == 0 ? 0 : -2 / (M_PI * M_PI * order * order);
    case GROOVE_SAW:
        return sign / (2 * M_PI * order) * I;
    case GROOVE_HARMONICS:
    case GROOVE_SHAPES:
        break;
    }
    return 0;
}

/* Returns sum_h 2 Re(coefficient[h] exp(2 pi i h t)). */
static double series_at(size_t count, const double complex *coefficient, double t) {
    const double phase = 2 * M_PI * t;
    const double complex turn = cos(phase) + sin(phase) * I;
    double complex sum = 0;
    for (size_t h = count; h-- > 0;)
        sum = (sum + coefficient[h]) * turn;
    return 2 * creal(sum);
}

/* Goes on from the best of many points to the extreme beside it, by thirds. */
static double climb(size_t count, const double complex *coefficient, double sign, double from,
                    double reach) {
    enum { STEPS = 60 };
    double low = from - reach, high = from + reach;
    for (int step = 0; step < STEPS; step++) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (sign * series_at(count, coefficient, a) < sign * series_at(count, coefficient, b))
            low = a;
        else
            high = b;
    }
    return (low + high) / 2;
}

struct groove_extremes groove_extremes_find(size_t count, const double complex *coefficient) {
    enum { POINTS_A_HARMONIC = 24 };
    const size_t points = POINTS_A_HARMONIC * (count > 0 ? count : 1);
    struct groove_extremes out = {.low = INFINITY, .high = -INFINITY};
    for (size_t i = 0; i < points; i++) {
        const double t = (double)i / (double)points, height = series_at(count, coefficient, t);
        if (height < out.low)
            out = (struct groove_extremes){height, out.high, t, out.high_at};
        if (height > out.high)
            out = (struct groove_extremes){out.low, height, out.low_at, t};
    }
    out.low_at = climb(count, coefficient, -1, out.low_at, 1. / (double)points);
    out.high_at = climb(count, coefficient, 1, out.high_at, 1. / (double)points);
    out.low = series_at(count, coefficient, out.low_at);
    out.high = series_at(count, coefficient, out.high_at);
    return out;
}

int groove_profile_of_harmonics(struct groove_profile *out, size_t count, const double *amplitude,
                                const double *phase, struct error *err) {
    *out = (struct groove_profile){.shape = GROOVE_HARMONICS, .count = count};
    if (count == 0 || count > GROOVE_HARMONICS_MOST)
        return error_set(err, ERROR_INPUT, "%zu harmonics; allowed: 1 to %d", count,
                         GROOVE_HARMONICS_MOST);
    for (size_t h = 0; h < count; h++)
        out->coefficient[h] = amplitude[h] / 2 * (cos(phase[h]) + sin(phase[h]) * I);
    const struct groove_extremes extremes = groove_extremes_find(count, out->coefficient);
    const double depth = extremes.high - extremes.low;
    if (!(depth > 0 && isfinite(depth)))
        return error_set(err, ERROR_INPUT, "the harmonics make no groove, all of them are 0");
    for (size_t h = 0; h < count; h++)
        out->coefficient[h] /= depth;
    return 0;
}

double groove_profile_height(const struct groove_profile *profile, double t) {
    const double u = t - round(t);
    switch (profile->shape) {
    case GROOVE_SINE:
        return cos(2 * M_PI * u) / 2;
    case GROOVE_ARCS:
        return 4 * u * u - 1. / 3;
    case GROOVE_TRIANGLE:
        return 2 * fabs(u) - 0.5;
    case GROOVE_SAW:
        return u;
    case GROOVE_HARMONICS:
    case GROOVE_SHAPES:
        break;
    }
    return series_at(profile->count, profile->coefficient, u);
}

static struct groove_moments moments_of_series(const struct groove_profile *profile) {
    /* even points are exact for powers of the series up to the fourth */
    const size_t points = 4 * profile->count + 1;
    struct groove_moments out = {0};
    for (size_t i = 0; i < points; i++) {
        const double z = groove_profile_height(profile, (double)i / (double)points);
        out.second += z * z / (double)points;
        out.third += z * z * z / (double)points;
        out.fourth += z * z * z * z / (double)points;
    }
    for (size_t h = 0; h < profile->count; h++) {
        const double order = 2 * M_PI * (double)(h + 1), size = cabs(profile->coefficient[h]);
        out.slope += 2 * order * order * size * size;
    }
    return out;
}

struct groove_moments groove_profile_moments(const struct groove_profile *profile) {
    switch (profile->shape) {
    case GROOVE_SINE:
        return (struct groove_moments){1. / 8, 0, 3. / 128, M_PI * M_PI / 2};
    case GROOVE_ARCS:
        return (struct groove_moments){4. / 45, 16. / 945, 16. / 945, 16. / 3};
    case GROOVE_TRIANGLE:
        return (struct groove_moments){1. / 12, 0, 1. / 80, 4};
    case GROOVE_SAW:
        return (struct groove_moments){1. / 12, 0, 1. / 80, INFINITY};
    case GROOVE_HARMONICS:
    case GROOVE_SHAPES:
        break;
    }
    return moments_of_series(profile);
}
