/* Nayak parameter of self-affine spectra, and the bandwidth that gives a wanted one. */
#include "core/surface/alpha_rings.h"
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdio.h>

/* Returns (zeta^e - 1)/e, and log(zeta) at e = 0. */
static double power_integral(double zeta, double e) {
    double x = e * log(zeta);
    return e == 0 ? log(zeta) : expm1(x) / e;
}

double spectrum_alpha_continuous(int dimension, double hurst, double ratio_long,
                                 double ratio_rolloff) {
    bool domain = (dimension == 1 || dimension == 2) && hurst >= 0 && hurst <= 1 &&
                  ratio_rolloff >= 1 && ratio_long >= ratio_rolloff && isfinite(ratio_long);
    if (!domain)
        return NAN;
    double xi = 1 / ratio_rolloff, zeta = ratio_long / ratio_rolloff;
    double m[3];
    for (int order = 0; order < 3; order++) {
        double plateau = dimension == 2 ? 2 * order + 2 : 2 * order + 1;
        m[order] =
            -expm1(plateau * log(xi)) / plateau + power_integral(zeta, 2 * order - 2 * hurst);
    }
    /* One ring or line of waves is the limit of a vanishing band. */
    if (!(m[1] > 0))
        return dimension == 2 ? 1.5 : 1;
    return (dimension == 2 ? 1.5 : 1) * (m[0] / m[1]) * (m[2] / m[1]);
}

enum { BISECTIONS = 200 };
static const double RATIO_MOST = 1e9;

int spectrum_ratio_continuous(int dimension, double hurst, double ratio_rolloff, double alpha,
                              double *ratio, struct error *err) {
    double low = ratio_rolloff, high = RATIO_MOST;
    double least = spectrum_alpha_continuous(dimension, hurst, low, ratio_rolloff);
    double most = spectrum_alpha_continuous(dimension, hurst, high, ratio_rolloff);
    if (!(alpha >= least && alpha <= most))
        return error_set(
            err, ERROR_NUMERIC,
            "no wavelength ratio gives alpha = %g at hurst = %g; allowed: %.6g to %.6g", alpha,
            hurst, least, most);
    for (int step = 0; step < BISECTIONS && high > low; step++) {
        double middle = sqrt(low * high);
        if (spectrum_alpha_continuous(dimension, hurst, middle, ratio_rolloff) < alpha)
            low = middle;
        else
            high = middle;
    }
    *ratio = sqrt(low * high);
    return 0;
}

static int ratio_refused(int dimension, double hurst, double ratio_rolloff, double length,
                         double most, struct error *err) {
    if (length >= 1 && length < most && ratio_rolloff >= 1 && hurst >= 0 && hurst <= 1 &&
        (dimension == 1 || dimension == 2))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "dimension %d, hurst %g, roll-off ratio %g, length ratio %g: allowed: 1 or 2, "
                     "0 to 1, 1 or more, 1 to %g",
                     dimension, hurst, ratio_rolloff, length, most);
}

/* About the most that the shortest wave of all gives. */
static double most_of(const struct ring_search *search, double ratio_rolloff) {
    double ratio = fmax(search->largest / search->sums.lowest, ratio_rolloff);
    return spectrum_alpha_continuous(2, search->sums.hurst, ratio, ratio_rolloff);
}

/* sides: of the cell, as the message tells them. */
static int ratio_of(struct ring_search *search, double ratio_rolloff, const char *sides,
                    double *ratio, double *reached, struct error *err) {
    static const double DISCRETE_MOST = 4; /* times the continuous value: small cells have more */
    double most = search->sums.dimension == 2 ? most_of(search, ratio_rolloff) : INFINITY;
    bool found = false;
    if (search->alpha > DISCRETE_MOST * most)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: up to about %.2g",
                         search->alpha, search->sums.hurst, sides, most);
    int status = ring_search_run(search, &found, err);
    if (status != 0)
        return status;
    if (!found && search->left_behind)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: %.6g to about %.2g",
                         search->alpha, search->sums.hurst, sides, search->least_alpha, most);
    if (!found)
        return error_set(err, ERROR_NUMERIC,
                         "no wavelength ratio gives alpha = %g at hurst = %g and a cell of %s long "
                         "waves; allowed: %.6g to %.6g",
                         search->alpha, search->sums.hurst, sides, search->least_alpha,
                         search->most_alpha);
    *ratio = sqrt(search->best_square) / search->sums.lowest;
    *reached = search->best_alpha;
    return 0;
}

int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err) {
    char sides[32];
    struct ring_search search = {
        .sums = {dimension, hurst, length_ratio, length_ratio * ratio_rolloff, 0, 0, 0},
        .alpha = alpha,
        .times = 1,
        .largest = RINGS_MOST,
    };
    int status = ratio_refused(dimension, hurst, ratio_rolloff, length_ratio, RINGS_MOST, err);
    if (status != 0)
        return status;
    snprintf(sides, sizeof sides, "%g", length_ratio);
    return ratio_of(&search, ratio_rolloff, sides, ratio, reached, err);
}

int spectrum_ratio_rectangle(double hurst, double ratio_rolloff, double length_x, double length_y,
                             double alpha, double *ratio, double *reached, struct error *err) {
    double longer = fmax(length_x, length_y), shorter = fmin(length_x, length_y);
    char sides[64];
    struct ring_search search = {
        .sums = {2, hurst, longer, longer * ratio_rolloff, 0, 0, 0},
        .alpha = alpha,
        .times = longer / shorter,
        .largest = LATTICE_MOST,
    };
    int status = ratio_refused(2, hurst, ratio_rolloff, longer, LATTICE_MOST, err);
    if (status == 0)
        status = ratio_refused(2, hurst, ratio_rolloff, shorter, LATTICE_MOST, err);
    if (status != 0)
        return status;
    snprintf(sides, sizeof sides, "%g by %g", length_x, length_y);
    return ratio_of(&search, ratio_rolloff, sides, ratio, reached, err);
}
