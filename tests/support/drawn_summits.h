/* Summits drawn from the Gaussian law of heights and second derivatives, each pressed by Hertz's
 * solution: theories of asperities from their premises. Heights may be a function of the drawn
 * field. */
#ifndef RUGO_TESTS_SUPPORT_DRAWN_SUMMITS_H
#define RUGO_TESTS_SUPPORT_DRAWN_SUMMITS_H

#include "core/random.h"
#include "core/theory/translated_heights.h"
#include "tests/support/check.h"
#include <gsl/gsl_sf_ellint.h>
#include <stdlib.h>

/* Hertz by Johnson (1985, 4.25 to 4.32): a summit of curvatures 1 and kappa, at which the contact
 * is an ellipse of this eccentricity, compressed by 1. A table over shapes is linear in between. */
enum { ELLIPSES = 2000 };
struct ellipse {
    double kappa, area, load; /* load over E* */
};

static inline void ellipses_tabulate(struct ellipse ellipses[ELLIPSES]) {
    for (int n = 0; n < ELLIPSES; n++) {
        double thin = exp(-6.0 * (n + 0.02) / ELLIPSES), e = sqrt(1 - thin * thin); /* b/a */
        double first = gsl_sf_ellint_Kcomp(e, GSL_PREC_DOUBLE);
        double second = gsl_sf_ellint_Ecomp(e, GSL_PREC_DOUBLE);
        double axis = sqrt(2 * (first - second) / (e * e * first));
        double kappa = (second / (thin * thin) - first) / (first - second);
        ellipses[n] =
            (struct ellipse){kappa, M_PI * axis * axis * thin, 2.0 / 3 * M_PI * axis / first};
    }
}

static inline struct ellipse ellipse_at(const struct ellipse *ellipses, double kappa) {
    int low = 0, high = ELLIPSES - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        *(ellipses[middle].kappa <= kappa ? &low : &high) = middle;
    }
    const struct ellipse *a = &ellipses[low], *b = &ellipses[high];
    double part = fmin((kappa - a->kappa) / (b->kappa - a->kappa), 1);
    return (struct ellipse){kappa, a->area + part * (b->area - a->area),
                            a->load + part * (b->load - a->load)};
}

struct area_estimate {
    double sum, squares;
};
static inline void estimate_add(struct area_estimate *estimate, double x) {
    estimate->sum += x;
    estimate->squares += x * x;
}
/* 4 standard errors are exceeded once in 16 000. */
static inline void estimate_check(const struct area_estimate *estimate, double n, double expected) {
    double mean = estimate->sum / n;
    double error = sqrt((estimate->squares / n - mean * mean) / n);
    check_close(mean, expected, 4 * error);
    assert_true(error < 0.015 * expected); /* else the check says little */
}

/* Checks the fraction and the load at a separation, in deviations of the surface, by n points
 * without slope of a field g of m0 = m2 = 1, m4 = alpha. Each maximum counts with |det|/(2 pi m2).
 * heights: those of the surface; NULL: g itself. m2: of the surface, of unit deviation. Philox keys
 * 7, number. */
static inline void drawn_summits_check(uint64_t n, uint64_t number, double alpha,
                                       const struct translated_heights *heights, double m2,
                                       double separation, double fraction, double load) {
    struct ellipse *ellipses = malloc(ELLIPSES * sizeof *ellipses);
    struct area_estimate areas = {0, 0}, loads = {0, 0};
    assert_non_null(ellipses);
    ellipses_tabulate(ellipses);
    for (uint64_t draw = 0; draw < n; draw++) {
        double u[4], g[4]; /* Box & Muller */
        random_uniform((struct random_key){7, number, 0}, STREAM_HEIGHTS, 4 * draw, 4, u);
        for (int i = 0; i < 4; i++) {
            double angle = 2 * M_PI * u[i | 1];
            g[i] = sqrt(-2 * log1p(-u[i & ~1])) * (i & 1 ? sin(angle) : cos(angle));
        }
        double mean = sqrt(2 * alpha / 3) * g[0]; /* -(g_xx + g_yy)/2 */
        double apart = sqrt(alpha / 3) * hypot(g[1], g[2]);
        double score = 1.5 / alpha * mean + sqrt(1 - 1.5 / alpha) * g[3];
        struct height_slope z = heights != NULL ? translated_heights_at(heights, score)
                                                : (struct height_slope){score, 1};
        double over = z.height - separation, patch = 0, force = 0;
        if (mean > apart && over > 0) {
            struct ellipse at = ellipse_at(ellipses, (mean + apart) / (mean - apart));
            double weight = (mean * mean - apart * apart) / (2 * M_PI);
            double length = over / ((mean - apart) * z.slope);
            patch = weight * at.area * length;
            force = weight * at.load * over * sqrt(length) / sqrt(2 * m2);
        }
        estimate_add(&areas, patch);
        estimate_add(&loads, force);
    }
    free(ellipses);
    estimate_check(&areas, (double)n, fraction);
    estimate_check(&loads, (double)n, load);
}

#endif
