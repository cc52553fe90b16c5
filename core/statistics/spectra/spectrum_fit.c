#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/spectra/spectrum_law.h"
#include "core/statistics/spectra/spectrum_range.h"
#include "core/statistics/uncertainty/spectrum_scores.h"

/* The rise of the deviance at the ends of a 95 % interval, also where only one end is known. An end
 * at 5 %, reported where noise hides the other, would be wrong more often than 1 time in 20. */
static const double RISE = 3.841;
/* By how much the rings at an end scatter more than those inside: half of a ring is empty there,
 * and under a window what its modes hold comes from few. */
static const double EDGE_SCATTER = 2, EDGE_SCATTER_WINDOWED = 1.6;
/* The same of a sharp end under a window, by how far it lies beyond the middle of a ring, in
 * eighths of the distance to the next one (FORMULAS.md, F18.58). */
enum { EIGHTHS = 8 };
static const double EDGE_SCATTER_AT[EIGHTHS] = {1.36, 1.42, 1.53, 1.62, 1.61, 1.59, 1.53, 1.46};
/* Ratio of the variances found over 1500 surfaces of known laws to those estimated without it. */
static const double OVERDISPERSION = 1.1;
static const double SCORE = 1.960; /* of a standard deviation, of two ends */
enum { FEWEST_RINGS = 6, STARTS = 6 };

/* A law and what is known of it. */
struct fitted {
    struct law_problem *problem;
    struct law law;        /* with every parameter that may be seen */
    struct law plain;      /* the same, or without a roll-off where none is seen */
    law_matrix likelihood; /* covariances, widened where the law is wrong */
    law_matrix covariance;
    struct spectrum_scatter scatter; /* beyond that of a Gaussian surface */
    double ratio;                    /* of the deviance to the degrees of freedom */
    double limit;                    /* beyond which that is significantly too large */
    bool wrong;                      /* whether it is */
    double widening;                 /* of variances */
    bool known;                      /* false: too few rings, or none that determines the law */
};

static const double NONE = (double)NAN;

/* Returns by how many rings the errors of a lay, twice as large as they are stated, blur what is
 * sharp at one: twice the root mean square over directions; 0 of circles. */
static double blur_at(const struct lay *lay, double ring) {
    double turn = lay->ratio - 1 / lay->ratio;
    return 2 * ring * hypot(lay->ratio_error, turn * lay->angle_error) * M_SQRT1_2;
}

static void problem_bounds(struct law_problem *problem, const struct spectrum_range *range) {
    double blur = blur_at(&problem->spectrum->lay, (double)range->edge);
    double last = (double)range->last, edge = (double)range->edge;
    double *low = problem->low, *high = problem->high;
    low[LAW_AMPLITUDE] = -INFINITY;
    high[LAW_AMPLITUDE] = INFINITY;
    low[LAW_HURST] = 0;
    high[LAW_HURST] = 1;
    low[LAW_ROLLOFF] = log(LAW_FEWEST_WAVES);
    high[LAW_ROLLOFF] = log(last);
    low[LAW_SHORT] = edge > 0 ? log(fmax(edge - 2 - blur, 1)) : 0;
    high[LAW_SHORT] = edge > 0 ? log(edge + 2.5 + blur) : INFINITY;
    if (edge > 0 && blur > 0)
        law_problem_put_together(problem, edge - 1 - blur, edge + 1 + blur);
    low[LAW_LONG] = log(LAW_FEWEST_WAVES / 2);
    high[LAW_LONG] = log(last / 2);
    low[LAW_BLUR] = log(1e-3 / (last * last));
    high[LAW_BLUR] = log(30 / (last * last));
    low[LAW_NOISE] = log(1e-4 * range->tail_density);
    high[LAW_NOISE] = log(1.1 * range->tail_density);
}

static struct law law_start(const struct law_problem *problem, const struct spectrum_range *range,
                            double rolloff, double longest) {
    const struct map_spectrum *s = problem->spectrum;
    bool blurred = range->to_end == SPECTRUM_END_LOW_PASS;
    bool noisy = range->to_end == SPECTRUM_END_SPACING || range->to_end == SPECTRUM_END_NOISE;
    double noise = range->noise > 0 || !noisy ? range->noise : 0.1 * range->tail_density;
    double last = (double)range->last, edge = (double)range->edge;
    size_t middle = (size_t)problem->reference;
    return (struct law){.p = {log(fmax(s->density[middle], problem->floor)), 0.5, log(rolloff),
                              edge > 0 ? log(edge + (s->windowed ? 0.5 : 0)) : INFINITY,
                              longest > 0 ? log(longest) : problem->low[LAW_LONG],
                              blurred ? log(0.5 / (last * last)) : -INFINITY,
                              noise > 0 ? log(noise) : -INFINITY},
                        .free = {true, true, true, edge > 0, longest > 0, blurred, noisy}};
}

/* Fits from several roll-offs. */
static struct law law_search(struct law_problem *problem, const struct spectrum_range *range,
                             double longest) {
    struct law best = {.deviance = INFINITY};
    double least = fmax(longest, LAW_FEWEST_WAVES), most = 0.8 * (double)range->last;
    for (int start = 0; start < STARTS; start++) {
        double rolloff = least * pow(most / least, (double)start / STARTS);
        struct law law = law_start(problem, range, rolloff, longest);
        law_maximise(problem, &law);
        if (law.deviance < best.deviance)
            best = law;
    }
    /* a sharp end from both sides: the likelihood has bends at rings */
    for (int side = 0; side < 2 && range->edge > 0; side++) {
        struct law law = best;
        law.p[LAW_SHORT] = log((double)range->edge + (side == 0 ? -0.4 : 0.8));
        law_maximise(problem, &law);
        if (law.deviance < best.deviance)
            best = law;
    }
    return best;
}

/* Returns a wave number about which the density begins, where it does so among the rings; 0: it
 * does not seem to. */
static double begin_guess(const struct map_spectrum *s, const struct spectrum_range *range) {
    static const double WEAK = 0.2;
    double highest = 0;
    for (size_t r = range->first; r <= range->last; r++)
        highest = fmax(highest, s->density[r]);
    size_t r = range->first;
    while (r < range->last && s->density[r] < WEAK * highest)
        r++;
    return r > range->first ? (double)r - 0.25 : 0;
}

/* Returns the standard deviation of the deviance of the right law, over its mean. */
static double deviance_scatter(const struct law_problem *problem) {
    const struct map_spectrum *s = problem->spectrum;
    size_t first = problem->leakage->first, count = problem->leakage->count;
    double variance = 0;
    for (size_t r = first; r < first + count; r++)
        for (size_t d = 0; d < RING_REACH && r + d < first + count; d++) {
            double both = s->covariance[r][d];
            if (problem->freedom[r - first] == 0 || problem->freedom[r + d - first] == 0)
                continue;
            variance +=
                (d == 0 ? 2 : 4) * both * both / (s->covariance[r][0] * s->covariance[r + d][0]);
        }
    variance += problem->freedom[count] > 0 ? 2 : 0; /* of rings put together */
    return sqrt(variance) / (double)problem->counted;
}

static double freedom(const struct fitted *fitted) {
    double left = (double)fitted->problem->counted;
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        left -= fitted->law.free[a] ? 1 : 0;
    return left;
}

static void fitted_measure(struct fitted *fitted, const struct spectrum_range *range) {
    static const double BETTER = 12; /* what a lowest wave number must gain to be reported */
    struct law_problem *problem = fitted->problem;
    double guess = begin_guess(problem->spectrum, range);
    problem_bounds(problem, range);
    fitted->law = law_search(problem, range, 0);
    if (guess > 0) {
        struct law begun = law_search(problem, range, guess);
        if (begun.deviance + BETTER < fitted->law.deviance)
            fitted->law = begun;
    }
    fitted->ratio = fitted->law.deviance / freedom(fitted);
    fitted->limit = 1 + 2 * deviance_scatter(problem);
    fitted->wrong = fitted->ratio > fitted->limit;
    fitted->widening = OVERDISPERSION * (fitted->wrong ? fitted->ratio : 1);
    fitted->known = freedom(fitted) > 0 &&
                    law_covariance(problem, &fitted->law, fitted->likelihood, fitted->covariance);
}

/* Fits over a range; the caller destroys the problem, which may be NULL. */
static int fitted_create(struct fitted *fitted, const struct map_spectrum *spectrum,
                         const struct spectrum_range *range, struct error *err) {
    static const double DEEP = 1e-3, DEEPEST = 1e-6;
    *fitted = (struct fitted){0};
    if (range->last + 1 < FEWEST_RINGS + range->first)
        return 0;
    double level = range->edge > 0 ? DEEP * spectrum->density[range->edge - 2]
                                   : DEEPEST * spectrum->density[range->last];
    if (!(level > 0))
        return 0;
    const double blur = blur_at(&spectrum->lay, (double)range->edge);
    const size_t last = (size_t)fmin((double)range->last + ceil(blur), (double)spectrum->rings - 1);
    int status = law_problem_create(&fitted->problem, spectrum, range->first, last, level, err);
    if (status == 0)
        fitted_measure(fitted, range);
    return status;
}

/* It is known by few slow waves: Student's factor over that of the normal distribution is in it. */
static int fitted_scatter(struct fitted *fitted, const struct spectrum_fit_request *request,
                          struct error *err) {
    if (!fitted->known || request->map == NULL)
        return 0;
    int status = spectrum_scatter_measure(fitted->problem, &fitted->law, request->map,
                                          request->modes, &fitted->scatter, err);
    const double factor = pow(low_modes_factor(request->modes->count) / SCORE, 2);
    fitted->scatter.density *= factor;
    fitted->scatter.slope *= factor;
    fitted->scatter.both *= factor;
    return status;
}

/* Returns the variance that the scatter adds to what changes so with the logarithm of the amplitude
 * and with H, of which the density falls by twice as much. */
static double scatter_variance(const struct fitted *fitted, double by_amplitude, double by_hurst) {
    const struct spectrum_scatter *s = &fitted->scatter;
    return by_amplitude * by_amplitude * s->density + by_hurst * by_hurst * s->slope / 4 -
           by_amplitude * by_hurst * s->both;
}

/* Takes a sharp end that no law with one fits for a low pass, where a law with that does. */
static int fitted_reconsider(struct fitted *fitted, struct spectrum_range *range,
                             struct error *err) {
    static const double BETTER = 0.5;
    if (!fitted->known || range->edge == 0 || !fitted->wrong)
        return 0;
    struct spectrum_range other = *range;
    struct fitted passed;
    other.edge = 0;
    other.to_end = SPECTRUM_END_LOW_PASS;
    other.last = range->steep;
    int status = fitted_create(&passed, fitted->problem->spectrum, &other, err);
    if (status == 0 && passed.known && passed.ratio < BETTER * fitted->ratio) {
        struct fitted before = *fitted;
        *fitted = passed;
        passed = before;
        *range = other;
    }
    law_problem_destroy(&passed.problem);
    return status;
}

/* Returns the same by the sharp end of a law: noise, of which all modes have as much, fills the
 * rings behind it. */
static double short_end_scatter(const struct law_problem *problem, const double *p) {
    static const double NOISE = 0.0035,
                        POWER = 0.65; /* share of the density at which half is left */
    const double ring = exp(p[LAW_SHORT]), at = EIGHTHS * (ring - floor(ring));
    const size_t before = (size_t)at % EIGHTHS;
    const double part = at - floor(at);
    const double alone =
        (1 - part) * EDGE_SCATTER_AT[before] + part * EDGE_SCATTER_AT[(before + 1) % EIGHTHS];
    const double noise = exp(p[LAW_NOISE]) / law_density(problem, p, p[LAW_SHORT]);
    return 1 + (alone - 1) / (1 + pow(noise / NOISE, POWER));
}

/* Returns by how much more than inside the rings at an end scatter. Where those of a sharp end
 * count as one, by their mean, its degrees of freedom are those of its modes as they are. */
static double edge_scatter(const struct fitted *fitted, enum law_parameter a) {
    const struct law_problem *problem = fitted->problem;
    if ((a != LAW_SHORT && a != LAW_LONG) ||
        (a == LAW_SHORT && problem->freedom[problem->leakage->count] > 0))
        return 1;
    if (!problem->spectrum->windowed)
        return EDGE_SCATTER;
    return a == LAW_SHORT ? short_end_scatter(problem, fitted->law.p) : EDGE_SCATTER_WINDOWED;
}

/* Returns an end of an interval in terms of a parameter; NaN: open. */
static double bound(const struct fitted *fitted, enum law_parameter a, int direction) {
    double ratio = fitted->covariance[a][a] / fitted->likelihood[a][a];
    double more = scatter_variance(fitted, a == LAW_AMPLITUDE ? 1 : 0, a == LAW_HURST ? 1 : 0);
    double error = sqrt(fitted->covariance[a][a] * fitted->widening + more);
    double wider = fmax(ratio, 0.5) * fitted->widening + more / fitted->likelihood[a][a];
    return law_bound(fitted->problem, &fitted->law, a, direction,
                     RISE * wider * edge_scatter(fitted, a), sqrt(RISE) * error);
}

/* Returns a wavelength by its wave number's interval, whose ends are in the reverse order. */
static struct interval wavelength(const struct fitted *fitted, enum law_parameter a, bool within) {
    double side = fitted->problem->spectrum->side;
    struct interval interval = {side / exp(fitted->law.p[a]), NONE, NONE};
    double lowest = within ? bound(fitted, a, -1) : NONE, highest = bound(fitted, a, 1);
    if (isnan(lowest) || isnan(highest))
        interval.value = NONE;
    interval.low = side / exp(highest);
    interval.high = side / exp(lowest);
    return interval;
}

/* An open end stays open. */
static void include(struct interval *interval) {
    if (interval->low > interval->value)
        interval->low = interval->value;
    if (interval->high < interval->value)
        interval->high = interval->value;
}

/* The roll-off; where none is seen the plain law goes without. */
static void fill_rolloff(struct fitted *fitted, struct spectrum_fit *out) {
    out->rolloff_wavelength = wavelength(fitted, LAW_ROLLOFF, true);
    fitted->plain = fitted->law;
    if (isnan(out->rolloff_wavelength.value) && isnan(out->rolloff_wavelength.high)) {
        fitted->plain.free[LAW_ROLLOFF] = false;
        fitted->plain.p[LAW_ROLLOFF] = fitted->problem->low[LAW_ROLLOFF];
        law_maximise(fitted->problem, &fitted->plain);
    }
}

static void fill_ends(const struct fitted *fitted, const struct spectrum_range *range,
                      struct spectrum_fit *out) {
    const struct grid *grid = &fitted->problem->spectrum->modes.grid;
    double longer = grid_longest_side(grid);
    out->short_wavelength = (struct interval){NONE, NONE, out->trusted_to};
    if (range->edge > 0)
        out->short_wavelength = wavelength(fitted, LAW_SHORT, true);
    struct fitted begun = *fitted;
    bool begins = fitted->law.free[LAW_LONG];
    if (!begins) { /* how far it could be moved */
        begun.likelihood[LAW_LONG][LAW_LONG] = begun.covariance[LAW_LONG][LAW_LONG] = 1;
        begun.widening = fitted->widening;
    }
    out->long_wavelength = wavelength(&begun, LAW_LONG, begins);
    out->longest = begins ? out->long_wavelength.value : longer;
    out->shortest = range->edge > 0 ? out->short_wavelength.value : out->trusted_to;
    if (isnan(out->longest))
        out->longest = longer;
    if (isnan(out->shortest))
        out->shortest = out->trusted_to;
}

/* Returns the integral of k^power over low to high. */
static double power_integral(double power, double low, double high) {
    if (!(high > low))
        return 0;
    return fabs(power + 1) < 1e-9 ? log(high / low)
                                  : (pow(high, power + 1) - pow(low, power + 1)) / (power + 1);
}

/* Orders of the moments of a law: mean squares of |k|^0, |k| and |k|^2 times the height. */
enum { MOMENTS = 3 };

/* Returns what an order is over that of the same density over circles: by the area of ellipses, and
 * along the lay by k over k'. Of profiles 1. */
static double lay_share(const struct lay *lay, int order) {
    const double square = 1 / (lay->ratio * lay->ratio);
    const double along = order == 0   ? 1
                         : order == 1 ? (1 + square) / 2
                                      : 3 * (1 + square * square) / 8 + square / 4;
    return along / lay->ratio;
}

/* Returns how the logarithm of an order changes with that of the ratio, for ellipses of one area.
 */
static double lay_slope(const struct lay *lay, int order) {
    static const double STEP = 1e-4;
    struct lay wider = *lay;
    wider.ratio *= 1 + STEP;
    return (log(lay_share(&wider, order) / lay_share(lay, order)) + (order + 1) * log1p(STEP)) /
           log1p(STEP);
}

/* Returns the logarithm of a moment of a law, its wave numbers being in waves per side, from lowest
 * to highest, or the law's own ends. */
static double log_moment(const struct law_problem *problem, const double *p, int order,
                         double lowest, double highest) {
    bool profile = problem->dimension == 1;
    double fall = problem->dimension + 2 * p[LAW_HURST], begin = exp(p[LAW_ROLLOFF]);
    double low = lowest > 0 ? lowest : exp(p[LAW_LONG]);
    double high = highest > 0 ? highest : exp(p[LAW_SHORT]);
    double scale = (profile ? 1 : lay_share(&problem->spectrum->lay, order)) *
                   pow(2 * M_PI / problem->spectrum->side, problem->dimension + 2 * order);
    double weight = (profile ? 0 : 1) + 2 * order, knee = fmin(fmax(begin, low), high);
    double flat = power_integral(weight, low, knee) * pow(begin / problem->reference, -fall);
    double falling = power_integral(weight - fall, knee, high) * pow(problem->reference, fall);
    return p[LAW_AMPLITUDE] + log((profile ? 2 : 2 * M_PI) * scale * (flat + falling));
}

/* The interval of what has this logarithm and its standard error; with one far above 1 it is not
 * known. */
static struct interval about(double logarithm, double error) {
    static const double TOLD = 1;
    return (struct interval){exp(logarithm), error < TOLD ? exp(logarithm - SCORE * error) : NONE,
                             error < TOLD ? exp(logarithm + SCORE * error) : NONE};
}

/* The logarithm of a product of powers of the moments. */
static double log_product(const struct fitted *fitted, const struct spectrum_fit *fit,
                          const struct law *law, const double powers[MOMENTS]) {
    double side = fitted->problem->spectrum->side, total = 0;
    double low = law->free[LAW_LONG] ? 0 : side / fit->longest;
    double high = law->free[LAW_SHORT] ? 0 : side / fit->shortest;
    for (int order = 0; order < MOMENTS; order++)
        if (powers[order] != 0)
            total += powers[order] * log_moment(fitted->problem, law->p, order, low, high);
    return total;
}

/* A factor times a product of powers of the moments, with its error by those of the law and of its
 * lay. */
static struct interval product(const struct fitted *fitted, const struct spectrum_fit *fit,
                               double factor, const double powers[MOMENTS]) {
    static const double STEP = 1e-5;
    const struct law *law = &fitted->plain;
    const struct lay *lay = &fitted->problem->spectrum->lay;
    double slope[LAW_PARAMETERS], variance = 0, by_lay = 0;
    double value = log_product(fitted, fit, law, powers);
    for (size_t a = 0; a < LAW_PARAMETERS; a++) {
        struct law moved = *law;
        moved.p[a] += STEP;
        slope[a] = law->free[a] ? (log_product(fitted, fit, &moved, powers) - value) / STEP : 0;
    }
    for (size_t a = 0; a < LAW_PARAMETERS; a++)
        for (size_t b = 0; b < LAW_PARAMETERS; b++)
            variance += slope[a] * fitted->covariance[a][b] * slope[b];
    variance *= fitted->widening;
    variance += scatter_variance(fitted, slope[LAW_AMPLITUDE], slope[LAW_HURST]);
    for (int order = 1; order < MOMENTS && !lay_is_plain(lay); order++)
        by_lay += powers[order] * lay_slope(lay, order) * lay->ratio_error;
    struct interval interval = about(log(factor) + value, sqrt(variance + by_lay * by_lay));
    if (isnan(fit->rolloff_wavelength.value) && fit->rolloff_wavelength.low < fit->longest) {
        /* a roll-off may lie beyond the longest waves that are seen */
        struct law bent = *law;
        bent.p[LAW_ROLLOFF] = log(fitted->problem->spectrum->side / fit->rolloff_wavelength.low);
        interval.low *= fmin(exp(log_product(fitted, fit, &bent, powers) - value), 1);
    }
    return interval;
}

static void fill_moments(const struct fitted *fitted, struct spectrum_fit *out) {
    static const double HEIGHT[] = {0.5, 0, 0}, SLOPE[] = {0, 0.5, 0}, CURVATURE[] = {0, 0, 0.5},
                        ALPHA[] = {1, -2, 1}, DENSITY[] = {0, -1, 1}, PEAKS[] = {0, -0.5, 0.5};
    const bool profile = out->profile;
    out->rms_height = product(fitted, out, 1, HEIGHT);
    out->rms_slope = product(fitted, out, 1, SLOPE);
    out->rms_curvature = product(fitted, out, profile ? 1 : 0.5, CURVATURE);
    if (!lay_is_plain(&fitted->problem->spectrum->lay))
        return;
    out->nayak_alpha = product(fitted, out, profile ? 1 : 1.5, ALPHA);
    out->summit_density = profile ? product(fitted, out, 1 / (2 * M_PI), PEAKS)
                                  : product(fitted, out, 0.75 / (6 * M_PI * sqrt(3)), DENSITY);
}

/* Widens an interval of a positive value by what an error of its logarithm adds. */
static void widen(struct interval *interval, double error) {
    if (error == 0)
        return;
    interval->low =
        interval->value * exp(-hypot(log(interval->value / interval->low), SCORE * error));
    interval->high =
        interval->value * exp(hypot(log(interval->high / interval->value), SCORE * error));
}

/* Fills the lay, and widens by its error what was fitted over its ellipses: of the same area these
 * are as many times longer across as the root of the ratio is less. */
static void fill_lay(const struct lay *lay, struct spectrum_fit *out) {
    if (lay_is_plain(lay))
        return;
    const double half = lay->ratio_error / 2;
    out->lay_ratio = (struct interval){lay->ratio, lay->ratio * exp(-SCORE * lay->ratio_error),
                                       lay->ratio * exp(SCORE * lay->ratio_error)};
    out->lay_angle = (struct interval){lay->angle, lay->angle - SCORE * lay->angle_error,
                                       lay->angle + SCORE * lay->angle_error};
    widen(&out->rolloff_wavelength, half);
    widen(&out->short_wavelength, half);
    widen(&out->long_wavelength, half);
    widen(&out->amplitude, (2 + 2 * out->hurst.value) * half);
}

/* Trusts waves up to a sharp end, or as long as half of their power has passed. */
static void fill_trusted(const struct fitted *fitted, struct spectrum_fit *out) {
    double side = fitted->problem->spectrum->side;
    if (out->to_end == SPECTRUM_END_CUTOFF)
        out->trusted_to = side / exp(fitted->law.p[LAW_SHORT]);
    else if (out->to_end == SPECTRUM_END_LOW_PASS)
        out->trusted_to = fmax(out->trusted_to, side / sqrt(log(2) / exp(fitted->law.p[LAW_BLUR])));
}

static void fill(struct fitted *fitted, const struct spectrum_range *range,
                 struct spectrum_fit *out) {
    struct law_problem *problem = fitted->problem;
    out->fitted = true;
    out->freedom = freedom(fitted);
    out->deviance = fitted->ratio;
    out->deviance_limit = fitted->limit;
    out->noise = range->noise > 0 ? exp(fitted->law.p[LAW_NOISE]) : 0;
    fill_trusted(fitted, out);
    fill_rolloff(fitted, out);
    fill_ends(fitted, range, out);
    const double *p = fitted->plain.p;
    double lowest = bound(fitted, LAW_HURST, -1);
    double highest = bound(fitted, LAW_HURST, 1);
    out->hurst =
        (struct interval){p[LAW_HURST], isnan(lowest) ? 0 : lowest, isnan(highest) ? 1 : highest};
    include(&out->hurst);
    out->reference_wavelength = problem->spectrum->side / problem->reference;
    out->amplitude = (struct interval){exp(p[LAW_AMPLITUDE]), exp(bound(fitted, LAW_AMPLITUDE, -1)),
                                       exp(bound(fitted, LAW_AMPLITUDE, 1))};
    include(&out->amplitude);
    fill_moments(fitted, out);
    fill_lay(&problem->spectrum->lay, out);
}

int spectrum_fit_measure(const struct map_spectrum *spectrum,
                         const struct spectrum_fit_request *request, struct spectrum_fit *out,
                         struct error *err) {
    static const struct interval UNKNOWN = {(double)NAN, (double)NAN, (double)NAN};
    struct spectrum_range range;
    struct fitted fitted;
    int status = spectrum_range_find(spectrum, request, &range, err);
    if (status != 0)
        return status;
    status = fitted_create(&fitted, spectrum, &range, err);
    if (status == 0)
        status = fitted_reconsider(&fitted, &range, err);
    if (status == 0)
        status = fitted_scatter(&fitted, request, err);
    *out = (struct spectrum_fit){.trusted_from = spectrum->side / (double)range.first,
                                 .trusted_to = spectrum->side / (double)range.last,
                                 .from_end = range.from_end,
                                 .to_end = range.to_end,
                                 .noise = range.noise,
                                 .hurst = UNKNOWN,
                                 .rolloff_wavelength = UNKNOWN,
                                 .short_wavelength = UNKNOWN,
                                 .long_wavelength = UNKNOWN,
                                 .reference_wavelength = NONE,
                                 .amplitude = UNKNOWN,
                                 .rms_height = UNKNOWN,
                                 .rms_slope = UNKNOWN,
                                 .rms_curvature = UNKNOWN,
                                 .nayak_alpha = UNKNOWN,
                                 .summit_density = UNKNOWN,
                                 .longest = NONE,
                                 .shortest = NONE,
                                 .lay_ratio = {1, NONE, NONE},
                                 .lay_angle = UNKNOWN,
                                 .profile = grid_is_profile(&spectrum->modes.grid),
                                 .deviance = NONE,
                                 .deviance_limit = NONE};
    if (status == 0 && fitted.known)
        fill(&fitted, &range, out);
    law_problem_destroy(&fitted.problem);
    return status;
}

int spectrum_fit_along(const struct map_spectrum *circles, const struct lay *lay,
                       const struct spectrum_fit_request *request, struct map_spectrum **ellipses,
                       struct spectrum_fit *out, struct error *err) {
    int status = lay_is_plain(lay) ? 0 : map_spectrum_create_along(ellipses, circles, lay, err);
    return status == 0
               ? spectrum_fit_measure(*ellipses != NULL ? *ellipses : circles, request, out, err)
               : status;
}

static double density_across(const struct spectrum_fit *fit, double wave_number) {
    static const double GUARD = 1e-9;
    double length = 2 * M_PI / fmax(wave_number, 1e-300);
    if (!fit->fitted || length > fit->longest * (1 + GUARD) || length < fit->shortest * (1 - GUARD))
        return 0;
    double rolloff =
        isnan(fit->rolloff_wavelength.value) ? fit->longest : fit->rolloff_wavelength.value;
    return fit->amplitude.value * pow(fmin(length, rolloff) / fit->reference_wavelength,
                                      (fit->profile ? 1 : 2) + 2 * fit->hurst.value);
}

double spectrum_fit_density(const struct spectrum_fit *fit, double wave_number) {
    enum { DIRECTIONS = 180 }; /* of a quarter turn from the lay */
    const double ratio = fit->lay_ratio.value;
    double total = 0;
    if (ratio == 1)
        return density_across(fit, wave_number);
    for (int d = 0; d < DIRECTIONS; d++) {
        double angle = M_PI / 2 * (d + 0.5) / DIRECTIONS;
        total += density_across(fit, wave_number * hypot(ratio * cos(angle), sin(angle)));
    }
    return total / DIRECTIONS;
}

double spectrum_fit_noise_share(const struct spectrum_fit *fit, const struct grid *grid,
                                double rms_curvature) {
    const double dx = grid_dx(grid), whole = 2 * M_PI / dx; /* of wave numbers, along an axis */
    const double power = fit->noise * (fit->profile ? whole : whole * whole);
    /* of (l - 2 z + r)/dx^2, and of half the sum of both of a surface, for independent heights */
    const double bend = (fit->profile ? 6 : 5) * power / (dx * dx * dx * dx);
    return fit->noise > 0 ? fmin(bend / (rms_curvature * rms_curvature), 1) : 0;
}

int spectrum_fit_law(const struct spectrum_fit *fit, struct spectrum *out, struct error *err) {
    if (!fit->fitted)
        return error_set(err, ERROR_INPUT,
                         "no law fits the spectrum of the map: it has too few "
                         "wavelengths that can be trusted");
    double rolloff =
        isnan(fit->rolloff_wavelength.value) ? fit->longest : fit->rolloff_wavelength.value;
    *out = (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = fit->hurst.value,
                             .wavelength_long = fit->longest,
                             .wavelength_rolloff = fmin(fmax(rolloff, fit->shortest), fit->longest),
                             .wavelength_short = fit->shortest,
                             .anisotropy = fit->lay_ratio.value,
                             .lay_angle = fit->lay_ratio.value > 1 ? fit->lay_angle.value : 0,
                             .scale = SCALE_RMS_HEIGHT,
                             .scale_value = fit->rms_height.value};
    return 0;
}
