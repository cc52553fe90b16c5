#include "jobs/statistics/summit_heights.h"
#include "core/sum.h"
#include "jobs/estimate.h"

/* Less the moment itself this is the derivative of the moment with respect to the share of the
 * summits of a height: its influence function (Hampel 1974), with a mean of 0 over all summits. */
double height_moment_part(enum height_moment moment, const struct height_powers *all,
                          const struct height_powers *some) {
    double variance = all->second / all->number, deviation = sqrt(variance);
    double skewness = all->third / all->number / (variance * deviation);
    double kurtosis = all->fourth / all->number / (variance * variance);
    double stretch = some->second / variance - some->number, shift = some->first / deviation;
    if (moment == HEIGHT_SKEWNESS)
        return some->third / (variance * deviation) - 3 * shift - 1.5 * skewness * stretch;
    if (moment == HEIGHT_KURTOSIS)
        return some->fourth / (variance * variance) - 4 * skewness * shift - 2 * kurtosis * stretch;
    return some->second;
}

/* Returns means over the summits of realisation r about a common mean. Equal heights have no
 * skewness, but a third moment of 0. */
static struct height_powers powers_of(const struct height_columns *of, size_t r, double common) {
    double d = of->mean[r] - common, second = of->variance[r], third = 0, fourth = 0;
    if (second > 0) {
        third = of->skewness[r] * second * sqrt(second);
        fourth = of->kurtosis[r] * second * second;
    }
    return (struct height_powers){.number = 1,
                                  .first = d,
                                  .second = second + d * d,
                                  .third = third + d * (3 * second + d * d),
                                  .fourth = fourth + d * (4 * third + d * (6 * second + d * d))};
}

static struct height_powers powers_of_all(const struct height_columns *of, double common) {
    struct sum number = {0}, second = {0}, third = {0}, fourth = {0};
    for (size_t r = 0; r < of->n; r++) {
        if (!(of->number[r] > 0))
            continue;
        struct height_powers mean = powers_of(of, r, common);
        sum_add(&number, of->number[r]);
        sum_add(&second, of->number[r] * mean.second);
        sum_add(&third, of->number[r] * mean.third);
        sum_add(&fourth, of->number[r] * mean.fourth);
    }
    return (struct height_powers){.number = sum_value(&number),
                                  .second = sum_value(&second),
                                  .third = sum_value(&third),
                                  .fourth = sum_value(&fourth)};
}

void height_moment_values(const struct height_columns *of, enum height_moment moment,
                          double *values) {
    double common = estimate_weighted(of->n, of->mean, of->number).value;
    const struct height_powers all = powers_of_all(of, common);
    for (size_t r = 0; r < of->n; r++) {
        const struct height_powers mean = powers_of(of, r, common);
        values[r] = of->number[r] > 0 ? height_moment_part(moment, &all, &mean) : (double)NAN;
    }
}
