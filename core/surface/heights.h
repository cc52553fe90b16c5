/* Height distributions: those of the table below, any monotone quantile function, or numbers. All
 * are centred (mean 0) and scaled to standard deviation 1 here; callers scale. */
#ifndef RUGO_CORE_SURFACE_HEIGHTS_H
#define RUGO_CORE_SURFACE_HEIGHTS_H

#include "core/error.h"
#include "core/rugo_lists.h"
#include "core/surface/height_moments.h"
#include "core/surface/height_table.h"
#include <stdbool.h>

/* A new distribution is an entry of rugo_lists.h, and its row with its functions in heights.c. */
#define HEIGHTS_TYPE(type, name, value) HEIGHTS_##type,
enum heights_type { RUGO_DISTRIBUTIONS(HEIGHTS_TYPE) HEIGHTS_QUANTILE, HEIGHTS_TABLE };
#undef HEIGHTS_TYPE

struct heights {
    enum heights_type type;
    double shape;  /* of distributions that take one: distribution.shape_means */
    double second; /* of distributions with has_second; 0: as the first */
    /* HEIGHTS_QUANTILE: on (0, 1), nowhere falling and not constant, of finite fourth moment
     * (standardised by quadrature); must be safe to call from many threads. context is borrowed. */
    double (*quantile)(double probability, const void *context);
    const void *context;
    const struct height_table *table; /* HEIGHTS_TABLE: borrowed */
};

/* A distribution's properties. Its raw variable has any convenient scale, which standardising
 * removes. Weibull, gamma: scale 1; log-normal: median 1; beta: [0, 1]. */
struct distribution {
    const char *family; /* names its theory curves */
    /* The meaning of the shape, NULL without one, and its range. Over most of it generation meets
     * spectrum and heights. At the most skewed end (Weibull 0.5, log-normal 1) errors of some
     * tenths remain, which surface_report contains. */
    const char *shape_means;
    double shape_low, shape_high; /* of the second shape, too */
    bool has_second;
    /* Of heights of this type, whose shapes alone count. */
    void (*moments)(const struct heights *of, struct height_moments *out);
    double (*quantile)(const struct heights *of, double probability); /* of the raw variable */
    double (*cdf)(const struct heights *of, double raw);
    /* The quantile at the probability of a standard Gaussian score, with all digits in both
     * tails. */
    double (*at_score)(const struct heights *of, double score);
};
/* Returns NULL for HEIGHTS_QUANTILE and HEIGHTS_TABLE, which have no rows. */
const struct distribution *heights_distribution(enum heights_type type);

/* Fails with ERROR_INPUT for a shape out of range, or a quantile function that does not rise or has
 * no finite moments. */
int heights_moments(const struct heights *heights, struct height_moments *out, struct error *err);
/* Finds the shape with which a distribution of the table has this skewness, with the second shape
 * as it is. ERROR_INPUT, with the skewness that it reaches, where none has. */
int heights_shape_of_skewness(const struct heights *of, double skewness, double *shape,
                              struct error *err);
/* Finds the two shapes of a beta distribution of this skewness and kurtosis. ERROR_INPUT where
 * there is none, or a shape is out of range. */
int heights_shapes_of_moments(double skewness, double kurtosis, struct heights *out,
                              struct error *err);
/* Returns the standardised quantile at a probability in (0, 1), given the moments above. */
double heights_quantile(const struct heights *heights, const struct height_moments *moments,
                        double probability);
/* Returns the same at the probability of a standard Gaussian score. That of HEIGHTS_QUANTILE has
 * the digits that probabilities near 1 have. */
double heights_at_score(const struct heights *heights, const struct height_moments *moments,
                        double score);
/* Returns the cumulative probability of a standardised height; NaN for HEIGHTS_QUANTILE. */
double heights_cdf(const struct heights *heights, const struct height_moments *moments, double z);

#endif
