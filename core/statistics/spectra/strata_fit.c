#include "core/statistics/spectra/strata_fit.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdlib.h>

/* --- differences of each --- */

enum { LAGS = 6, BINS = 60 };
static const size_t LAG[LAGS] = {1, 2, 3, 4, 6, 8}; /* in points */
static const double BEYOND = 4;                     /* RMS heights of either that the bins reach */

/* Squares of differences of pairs of points, by the mean height of both. */
struct squares {
    double low, step; /* of the bins */
    double pairs[BINS], total[BINS];
};

/* Adds all pairs of points so many columns and rows apart. */
static void pairs_add(struct squares *out, const struct measured_map *map, size_t columns,
                      size_t rows) {
    const size_t nx = map->grid->nx, ny = map->grid->ny;
    for (size_t j = 0; j + rows < ny; j++)
        for (size_t i = 0; i + columns < nx; i++) {
            const double from = map->z[j * nx + i], to = map->z[(j + rows) * nx + i + columns];
            const double bin = ((from + to) / 2 - out->low) / out->step;
            if (!(bin >= 0 && bin < BINS))
                continue;
            out->pairs[(size_t)bin]++;
            out->total[(size_t)bin] += (to - from) * (to - from);
        }
}

/* Two heights in RMS heights about the mean of a Gaussian surface, which it has at two points. */
struct pair {
    double a, b;
};

static double density(double score) {
    return exp(-score * score / 2) / sqrt(2 * M_PI);
}

/* Returns their density, where 1 less their correlation is `apart`. */
static double pair_density(struct pair of, double apart) {
    const double sum = (of.a + of.b) / 2, difference = of.b - of.a, r = 1 - apart;
    return exp(-sum * sum / (1 + r) - difference * difference / (4 * apart)) /
           (2 * M_PI * sqrt(apart * (1 + r)));
}

/* Returns the probability that both are higher, by the integral over the correlation (Plackett
 * 1954). */
static double pair_above(struct pair of, double apart) {
    enum { STEPS = 24 };
    const double most = asin(1 - apart), step = most / STEPS;
    double total = 0;
    for (int n = 0; n < STEPS; n++) {
        const double sine = sin(((double)n + 0.5) * step);
        total +=
            exp(-(of.a * of.a + of.b * of.b - 2 * of.a * of.b * sine) / (2 * (1 - sine * sine)));
    }
    return fmax(gsl_cdf_ugaussian_Q(of.a) * gsl_cdf_ugaussian_Q(of.b) + total * step / (2 * M_PI),
                0);
}

/* Returns the probability that the second is higher, where the first is so. */
static double second_above(double first, double second, double apart) {
    return gsl_cdf_ugaussian_Q((second - (1 - apart) * first) / sqrt(apart * (2 - apart)));
}

/* Returns the density of two heights of the face, the second so much above the first: both are of
 * the valleys, or both of the plateau, or the first of either. */
static double face_density(const struct plateau_law *law, const double apart[STRATA], double mean,
                           double difference) {
    const double first = mean - difference / 2, second = mean + difference / 2;
    const struct pair v = {(first - law->valley_mean) / law->valley_rms,
                           (second - law->valley_mean) / law->valley_rms};
    const struct pair p = {(first - law->plateau_mean) / law->plateau_rms,
                           (second - law->plateau_mean) / law->plateau_rms};
    const double at_v = apart[STRATUM_VALLEYS], at_p = apart[STRATUM_PLATEAU];
    const double mixed =
        density(v.a) * density(p.b) * second_above(v.a, v.b, at_v) * second_above(p.b, p.a, at_p) +
        density(p.a) * density(v.b) * second_above(p.a, p.b, at_p) * second_above(v.b, v.a, at_v);
    return pair_density(v, at_v) * pair_above(p, at_p) / (law->valley_rms * law->valley_rms) +
           pair_density(p, at_p) * pair_above(v, at_v) / (law->plateau_rms * law->plateau_rms) +
           mixed / (law->valley_rms * law->plateau_rms);
}

/* Returns the mean square difference of pairs with this mean height. Steps are short near 0, where
 * the plateau's are. */
static double mean_square(const struct plateau_law *law, const double apart[STRATA], double mean) {
    enum { STEPS = 48 };
    const double valleys = law->valley_rms * sqrt(2 * apart[STRATUM_VALLEYS]);
    const double plateau = law->plateau_rms * sqrt(2 * apart[STRATUM_PLATEAU]);
    const double most = 5 * fmax(valleys, plateau);
    double total = 0, weights = 0;
    for (int n = 0; n < STEPS; n++) {
        const double u = ((double)n + 0.5) / STEPS, difference = most * u * u;
        const double weight = u * face_density(law, apart, mean, difference);
        weights += weight;
        total += weight * difference * difference;
    }
    return weights > 0 ? total / weights : 0;
}

/* Returns a number between two for any one; and that one. */
static double between(double low, double high, double term) {
    return low + (high - low) / (1 + exp(-term));
}

static double term_of(double low, double high, double value) {
    return log((value - low) / (high - value));
}

/* Goes downhill to the least squares of n residuals over p terms. ERROR_MEMORY. */
static int descend(gsl_multifit_nlinear_fdf *of, size_t n, double *terms, size_t p,
                   struct error *err) {
    enum { STEPS = 60 };
    static const double TOLERANCE = 1e-6;
    const gsl_multifit_nlinear_parameters usual = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *work =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &usual, n, p);
    if (work == NULL)
        return error_memory(err, 8 * n * p * sizeof *terms, "the fit of a stratified map");
    const gsl_vector_view start = gsl_vector_view_array(terms, p);
    int end = 0;
    of->n = n;
    of->p = p;
    (void)gsl_multifit_nlinear_init(&start.vector, of, work);
    /* where it ends early, it is as near as it comes */
    (void)gsl_multifit_nlinear_driver(STEPS, TOLERANCE, TOLERANCE, TOLERANCE, NULL, NULL, &end,
                                      work);
    for (size_t a = 0; a < p; a++)
        terms[a] = gsl_vector_get(work->x, a);
    gsl_multifit_nlinear_free(work);
    return 0;
}

/* What is fitted at one lag: 1 less the correlations of both. */
struct lag_fit {
    const struct squares *squares;
    const struct plateau_law *law;
};
static const double APART_LEAST = 1e-5, APART_MOST = 1.2;

/* Fills the ratios of measured squares to those of the law, less 1, over their errors. */
static int lag_residuals(const gsl_vector *terms, void *context, gsl_vector *out) {
    static const double LEAST = 20; /* pairs */
    const struct lag_fit *fit = context;
    const struct squares *squares = fit->squares;
    const double apart[STRATA] = {between(APART_LEAST, APART_MOST, gsl_vector_get(terms, 0)),
                                  between(APART_LEAST, APART_MOST, gsl_vector_get(terms, 1))};
    for (size_t b = 0; b < BINS; b++) {
        const double height = squares->low + ((double)b + 0.5) * squares->step;
        const double pairs = squares->pairs[b];
        const double expected = pairs > LEAST ? mean_square(fit->law, apart, height) : 0;
        gsl_vector_set(out, b,
                       expected > 0 ? sqrt(pairs) * (squares->total[b] / pairs / expected - 1) : 0);
    }
    return GSL_SUCCESS;
}

/* Fills 1 less the correlations with which the squares are nearest to those measured; they begin
 * as they are. */
static int squares_fit(const struct squares *squares, const struct plateau_law *law,
                       double apart[STRATA], struct error *err) {
    struct lag_fit fit = {squares, law};
    gsl_multifit_nlinear_fdf of = {.f = lag_residuals, .params = &fit};
    double terms[STRATA];
    for (int s = 0; s < STRATA; s++)
        terms[s] = term_of(APART_LEAST, APART_MOST, fmin(apart[s], 0.9 * APART_MOST));
    int status = descend(&of, BINS, terms, STRATA, err);
    for (int s = 0; s < STRATA; s++)
        apart[s] = between(APART_LEAST, APART_MOST, terms[s]);
    return status;
}

/* Fills 1 less the correlation of each at the lags: mean square differences over twice the mean
 * square height. */
static int measure(double out[STRATA][LAGS], const struct measured_map *map,
                   const struct plateau_law *law, struct error *err) {
    const double low = law->valley_mean - BEYOND * law->valley_rms;
    const double high = law->plateau_mean + BEYOND * law->plateau_rms;
    struct squares *squares = array_create(1, sizeof *squares);
    double apart[STRATA] = {0.05, 0.05};
    int status =
        squares != NULL ? 0 : error_memory(err, sizeof *squares, "slopes of a stratified map");
    for (size_t lag = 0; lag < LAGS && status == 0; lag++) {
        *squares = (struct squares){.low = low, .step = (high - low) / BINS};
        pairs_add(squares, map, LAG[lag], 0);
        if (!grid_is_profile(map->grid))
            pairs_add(squares, map, 0, LAG[lag]);
        status = squares_fit(squares, law, apart, err);
        for (int s = 0; s < STRATA; s++)
            out[s][lag] = apart[s];
    }
    free(squares);
    return status;
}

/* --- the spectra --- */

/* Returns the mean square difference at a lag, over twice the mean square height, of waves between
 * these wave numbers: 1 - J0(k lag) of surfaces, in the mean over all directions, 1 - cos(k lag)
 * of profiles. */
static double structure(double hurst, double low, double high, double lag, bool profile) {
    enum { STEPS = 200 };
    const double step = log(high / low) / STEPS;
    double total = 0, squares = 0;
    for (int n = 0; n < STEPS; n++) {
        const double k = low * exp(((double)n + 0.5) * step), power = pow(k, -2 * hurst);
        squares += power;
        total += power * (1 - (profile ? cos(k * lag) : gsl_sf_bessel_J0(k * lag)));
    }
    return total / squares;
}

/* The laws: Hurst exponents, logarithms of the ratios of longest to shortest wave, and that of the
 * highest wave number, of both. */
enum { HURST, RATIO = HURST + STRATA, HIGHEST = RATIO + STRATA, TERMS };
struct law_fit {
    bool profile;
    double dx, apart[STRATA][LAGS];
    double points; /* of the shortest wave; 0: they are fitted, as the last term */
};
static const double HURST_LEAST = 0.02, HURST_MOST = 1, RATIO_LEAST = 1.05, RATIO_MOST = 1000,
                    POINTS_LEAST = 2, POINTS_MOST = 32; /* a shortest wave */

static double highest_of(const struct law_fit *fit, double term) {
    return 2 * M_PI / fit->dx / exp(between(log(POINTS_LEAST), log(POINTS_MOST), term));
}

static double ratio_of(double term) {
    return exp(between(log(RATIO_LEAST), log(RATIO_MOST), term));
}

static double hurst_of(double term) {
    return between(HURST_LEAST, HURST_MOST, term);
}

/* Longer lags have fewer waves in the map. */
static int law_residuals(const gsl_vector *terms, void *context, gsl_vector *out) {
    const struct law_fit *fit = context;
    const double high = fit->points > 0 ? 2 * M_PI / (fit->points * fit->dx)
                                        : highest_of(fit, gsl_vector_get(terms, HIGHEST));
    for (size_t s = 0; s < STRATA; s++)
        for (size_t lag = 0; lag < LAGS; lag++) {
            const double ratio = ratio_of(gsl_vector_get(terms, RATIO + s));
            const double hurst = hurst_of(gsl_vector_get(terms, HURST + s));
            const double at =
                structure(hurst, high / ratio, high, (double)LAG[lag] * fit->dx, fit->profile);
            gsl_vector_set(out, s * LAGS + lag, log(fit->apart[s][lag] / at) / (double)LAG[lag]);
        }
    return GSL_SUCCESS;
}

/* --- together --- */

int strata_fit(struct strata_law *out, const struct measured_map *map,
               const struct plateau_law *heights, struct error *err) {
    struct law_fit fit = {.profile = grid_is_profile(map->grid), .dx = grid_dx(map->grid)};
    const double rms[STRATA] = {heights->valley_rms, heights->plateau_rms};
    gsl_multifit_nlinear_fdf of = {.f = law_residuals, .params = &fit};
    struct average mean = {0};
    for (size_t p = 0; p < grid_points(map->grid); p++)
        if (!isnan(map->z[p]))
            average_add(&mean, map->z[p]);
    struct plateau_law law = *heights; /* about 0, as the heights of the map are */
    law.plateau_mean += average_value(&mean);
    law.valley_mean += average_value(&mean);
    if (map->grid->nx < 4 * LAG[LAGS - 1])
        return error_set(err, ERROR_INPUT, "a stratified map of %zu columns; allowed: at least %zu",
                         map->grid->nx, 4 * LAG[LAGS - 1]);
    double terms[TERMS] = {0}; /* in the middle of all */
    terms[HIGHEST] = term_of(log(POINTS_LEAST), log(POINTS_MOST), log(4));
    int status = measure(fit.apart, map, &law, err);
    if (status == 0)
        status = descend(&of, (size_t)STRATA * LAGS, terms, TERMS, err);
    if (status != 0)
        return status;
    fit.points = fmax(rint(2 * M_PI / highest_of(&fit, terms[HIGHEST]) / fit.dx), POINTS_LEAST);
    status = descend(&of, (size_t)STRATA * LAGS, terms, HIGHEST, err);
    if (status != 0)
        return status;
    *out = (struct strata_law){.wavelength_short = fit.points * fit.dx,
                               .rms_ratio = rms[STRATUM_PLATEAU] / rms[STRATUM_VALLEYS],
                               .offset = (heights->plateau_mean - heights->valley_mean) /
                                         rms[STRATUM_VALLEYS]};
    for (int s = 0; s < STRATA; s++) {
        out->hurst[s] = hurst_of(terms[HURST + s]);
        out->wavelength_long[s] = out->wavelength_short * ratio_of(terms[RATIO + s]);
        out->rms_slope[s] = rms[s] * sqrt((fit.profile ? 2 : 4) * fit.apart[s][0]) / fit.dx;
    }
    return 0;
}
