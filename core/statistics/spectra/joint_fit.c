#include "core/statistics/spectra/joint_fit.h"
#include "core/statistics/spectra/spectrum_leakage.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <math.h>
#include <stdlib.h>

/* Parameters: logarithms of the amplitude and of the roll-off's wave number, and H. */
enum { AMPLITUDE, HURST, ROLLOFF, PARAMETERS };
static const double RISE = 3.841;         /* of the deviance, at the ends of a 95 % interval */
static const double OVERDISPERSION = 1.1; /* as of one patch (F18.15) */
static const double BEYOND = 2;           /* a roll-off is sought so far outside the bands */
static const double BETWEEN_MOST = 3;     /* deviations of ln C between patches */
enum { STEPS = 400, ENDS = 40, FEWEST_RINGS = 6 };

/* The trusted rings of a patch. */
struct band {
    struct joint_patch *patch;
    struct spectrum_leakage *leakage; /* owned, as the next */
    double *density, *expected;       /* per node, per ring */
    double freedom, inflation;        /* of all rings; of a variance, by what rings share */
    double low_pass;                  /* b of exp(-b k^2); 0: none */
    double deviance, offset;          /* at the law that was evaluated last */
};

struct joint {
    size_t count;
    struct band bands[JOINT_PATCHES_MOST];
    double dimension, reference, low, high; /* wave numbers: of the amplitude, of the roll-off */
    double inflation;                       /* the mean of the bands', by rings */
    double between;                         /* at the law that was evaluated last */
    int held;                               /* a parameter that stays, or PARAMETERS */
    double held_at;
    bool starved; /* a minimisation had no memory */
};

double joint_fit_density(const struct joint_fit *fit, bool profile, double wave_number) {
    const double rolloff = 2 * M_PI / fit->rolloff_wavelength.value;
    const double k = isnan(rolloff) ? wave_number : fmax(wave_number, rolloff);
    return fit->amplitude.value * pow(k * fit->reference_wavelength / (2 * M_PI),
                                      -((profile ? 1 : 2) + 2 * fit->hurst.value));
}

struct lay joint_fit_lay(size_t count, const struct lay *lays) {
    static const double LEAST = 1e-6; /* of standard errors */
    double ratio = 0, ratios = 0, sine = 0, cosine = 0, angles = 0;
    for (size_t n = 0; n < count; n++) {
        if (lay_is_plain(&lays[n]))
            continue;
        const double of_ratio = pow(fmax(lays[n].ratio_error, LEAST), -2);
        const double of_angle = pow(fmax(lays[n].angle_error, LEAST), -2);
        ratio += of_ratio * log(lays[n].ratio);
        ratios += of_ratio;
        sine += of_angle * sin(2 * lays[n].angle); /* a lay has two directions */
        cosine += of_angle * cos(2 * lays[n].angle);
        angles += of_angle;
    }
    if (ratios == 0)
        return LAY_NONE;
    return (struct lay){.ratio = exp(ratio / ratios),
                        .angle = atan2(sine, cosine) / 2,
                        .ratio_error = 1 / sqrt(ratios),
                        .angle_error = 1 / sqrt(angles)};
}

/* --- bands --- */

/* Returns how many times larger the variance of a mean over the rings is than if they were
 * independent. */
static double inflation_of(const struct map_spectrum *s, size_t first, size_t count) {
    double all = 0, own = 0;
    for (size_t r = first; r < first + count; r++)
        for (size_t d = 0; d < RING_REACH && r + d < first + count; d++) {
            const double both = s->covariance[r][d] * s->freedom[r] * s->freedom[r + d];
            all += d == 0 ? both : 2 * both;
            own += d == 0 ? both : 0;
        }
    return own > 0 ? fmax(all / own, 1) : 1;
}

/* Takes the rings of the trusted wavelengths, but those that a sharp end blurs. */
static int band_create(struct band *band, struct joint_patch *patch, struct error *err) {
    const struct map_spectrum *s = patch->spectrum;
    const struct spectrum_fit *fit = patch->fit;
    const size_t blurred = fit->to_end == SPECTRUM_END_CUTOFF ? SPECTRUM_BLURRED : 0;
    size_t first = 1, last = 0;
    *band = (struct band){.patch = patch};
    patch->offset = patch->error = (double)NAN;
    if (!fit->fitted)
        return 0;
    for (size_t r = 1; r < s->rings; r++)
        if (s->freedom[r] > 0 && s->wave_number[r] * fit->trusted_to <= 2 * M_PI)
            last = r;
    while (first < last && s->wave_number[first] * fit->trusted_from < 2 * M_PI * (1 - 1e-9))
        first++;
    if (last < first + FEWEST_RINGS + blurred)
        return 0;
    last -= blurred;
    if (fit->to_end == SPECTRUM_END_LOW_PASS) /* half of the power has passed there */
        band->low_pass = log(2) * pow(fit->trusted_to / (2 * M_PI), 2);
    int status = spectrum_leakage_create(&band->leakage, s, first, last, err);
    if (status != 0)
        return status;
    for (size_t r = first; r <= last; r++)
        band->freedom += s->freedom[r];
    band->inflation = inflation_of(s, first, last + 1 - first);
    band->density = array_create(band->leakage->nodes, sizeof *band->density);
    band->expected = array_create(band->leakage->count, sizeof *band->expected);
    return band->density != NULL && band->expected != NULL
               ? 0
               : error_memory(err, band->leakage->nodes * sizeof(double), "a joint fit");
}

static void joint_clear(struct joint *joint) {
    for (size_t b = 0; b < joint->count; b++) {
        spectrum_leakage_destroy(&joint->bands[b].leakage);
        free(joint->bands[b].density);
        free(joint->bands[b].expected);
    }
}

/* --- the likelihood --- */

static double variance_of(const struct band *band) {
    return 2 * band->inflation / band->freedom;
}

/* Fills the deviance of the rings of a band about the law times a factor of its own. */
static void band_evaluate(const struct joint *joint, struct band *band, const double *p) {
    const struct map_spectrum *s = band->patch->spectrum;
    const double unit = 2 * M_PI / s->side, fall = joint->dimension + 2 * p[HURST];
    const size_t first = band->leakage->first, count = band->leakage->count;
    const double sharp = band->patch->fit->to_end == SPECTRUM_END_CUTOFF
                             ? 2 * M_PI / band->patch->fit->trusted_to
                             : INFINITY;
    double ratios = 0;
    for (size_t a = 0; a < band->leakage->nodes; a++) {
        const double k = unit * band->leakage->node[a];
        const double falling = log(fmax(k, exp(p[ROLLOFF])) / joint->reference);
        band->density[a] =
            k > sharp ? 0 : exp(p[AMPLITUDE] - fall * falling - band->low_pass * k * k);
    }
    spectrum_leakage_apply(band->leakage, band->density, band->expected);
    for (size_t r = 0; r < count; r++) {
        band->expected[r] += band->patch->fit->noise;
        ratios += s->freedom[first + r] * s->density[first + r] / band->expected[r];
    }
    band->offset = log(ratios / band->freedom);
    band->deviance = 0;
    for (size_t r = 0; r < count; r++) {
        const double ratio = s->density[first + r] / band->expected[r] * exp(-band->offset);
        band->deviance += s->freedom[first + r] * (ratio - 1 - log(ratio));
    }
}

/* Returns what the factors of the bands add to the deviance: by restricted likelihood, and as large
 * as that of rings which count as independent. */
static double offsets_deviance(const struct joint *joint, double between) {
    double sum = 0, weights = 0;
    for (size_t b = 0; b < joint->count; b++) {
        const struct band *band = &joint->bands[b];
        const double variance = variance_of(band) + between * between;
        sum += band->offset * band->offset / variance + log(variance);
        weights += 1 / variance;
    }
    return joint->inflation * (sum + log(weights));
}

/* Finds the scatter between patches that is most likely, by trisection. */
static double offsets_least(struct joint *joint) {
    double low = 0, high = BETWEEN_MOST;
    for (int step = 0; step < ENDS; step++) {
        const double one = low + (high - low) / 3, other = high - (high - low) / 3;
        if (offsets_deviance(joint, one) <= offsets_deviance(joint, other))
            high = other;
        else
            low = one;
    }
    joint->between = (low + high) / 2;
    const double least = offsets_deviance(joint, joint->between);
    const double none = offsets_deviance(joint, 0);
    if (none <= least)
        joint->between = 0;
    return fmin(least, none);
}

static double evaluate(struct joint *joint, const double *p) {
    double total = 0;
    for (size_t b = 0; b < joint->count; b++) {
        band_evaluate(joint, &joint->bands[b], p);
        total += joint->bands[b].deviance;
    }
    return total + offsets_least(joint);
}

/* --- the maximum --- */

static double within(double value, double low, double high) {
    return fmin(fmax(value, low), high);
}

/* Takes the parameters from the minimiser's, which has none of what is held. */
static void parameters_of(const struct joint *joint, const gsl_vector *x, double p[PARAMETERS]) {
    size_t next = 0;
    for (int a = 0; a < PARAMETERS; a++)
        p[a] = a == joint->held ? joint->held_at : gsl_vector_get(x, next++);
    p[HURST] = within(p[HURST], 0, 1);
    p[ROLLOFF] = within(p[ROLLOFF], log(joint->low), log(joint->high));
}

static double objective(const gsl_vector *x, void *context) {
    struct joint *joint = context;
    double p[PARAMETERS], outside = 0;
    parameters_of(joint, x, p);
    size_t next = 0;
    for (int a = 0; a < PARAMETERS; a++)
        if (a != joint->held)
            outside += pow(gsl_vector_get(x, next++) - p[a], 2);
    return evaluate(joint, p) + outside;
}

/* Minimises from p (Nelder & Mead 1965). Returns the least deviance, NaN without memory. */
static double minimise(struct joint *joint, double p[PARAMETERS]) {
    static const double STEP[PARAMETERS] = {0.5, 0.1, 0.4}, ENOUGH = 1e-5;
    const size_t n = joint->held < PARAMETERS ? PARAMETERS - 1 : PARAMETERS;
    gsl_multimin_function function = {objective, n, joint};
    gsl_vector *x = gsl_vector_alloc(n), *step = gsl_vector_alloc(n);
    gsl_multimin_fminimizer *simplex =
        gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, n);
    double least = (double)NAN;
    joint->starved = joint->starved || x == NULL || step == NULL || simplex == NULL;
    if (x != NULL && step != NULL && simplex != NULL) {
        size_t next = 0;
        for (int a = 0; a < PARAMETERS; a++)
            if (a != joint->held) {
                gsl_vector_set(x, next, p[a]);
                gsl_vector_set(step, next++, STEP[a]);
            }
        int status = gsl_multimin_fminimizer_set(simplex, &function, x, step);
        for (int i = 0; i < STEPS && status == GSL_SUCCESS; i++) {
            status = gsl_multimin_fminimizer_iterate(simplex);
            if (gsl_multimin_fminimizer_size(simplex) < ENOUGH)
                break;
        }
        parameters_of(joint, gsl_multimin_fminimizer_x(simplex), p);
        least = evaluate(joint, p);
    }
    gsl_vector_free(x);
    gsl_vector_free(step);
    gsl_multimin_fminimizer_free(simplex);
    return least;
}

/* Minimises from several roll-offs. */
static double search(struct joint *joint, double p[PARAMETERS]) {
    enum { STARTS = 4 };
    double least = INFINITY;
    for (int start = 0; start < STARTS; start++) {
        const double part = (start + 0.5) / STARTS;
        double trial[PARAMETERS] = {p[AMPLITUDE], 0.6,
                                    log(joint->low) + part * log(joint->high / joint->low)};
        double deviance = minimise(joint, trial);
        if (!(deviance < least))
            continue;
        least = deviance;
        for (int a = 0; a < PARAMETERS; a++)
            p[a] = trial[a];
    }
    return least;
}

/* --- intervals --- */

static double least_at(struct joint *joint, const double best[PARAMETERS], int a, double value) {
    double p[PARAMETERS] = {best[0], best[1], best[2]};
    joint->held = a;
    joint->held_at = value;
    double least = minimise(joint, p);
    joint->held = PARAMETERS;
    return least;
}

/* Returns where the deviance has risen by so much between the best value and a limit; NaN: open. */
static double end_of(struct joint *joint, const double best[PARAMETERS], int a, double limit,
                     double least, double rise) {
    enum { HALVINGS = 12 };
    double inside = best[a], outside = limit;
    if (!(least_at(joint, best, a, limit) > least + rise))
        return (double)NAN;
    for (int step = 0; step < HALVINGS; step++) {
        const double middle = (inside + outside) / 2;
        if (least_at(joint, best, a, middle) > least + rise)
            outside = middle;
        else
            inside = middle;
    }
    return (inside + outside) / 2;
}

static void fill_intervals(struct joint *joint, const double best[PARAMETERS], double least,
                           double rise, struct joint_fit *out) {
    static const double FAR = 5; /* of ln C */
    double low = end_of(joint, best, HURST, 0, least, rise);
    double high = end_of(joint, best, HURST, 1, least, rise);
    out->hurst = (struct interval){best[HURST], isnan(low) ? 0 : low, isnan(high) ? 1 : high};
    low = end_of(joint, best, AMPLITUDE, best[AMPLITUDE] - FAR, least, rise);
    high = end_of(joint, best, AMPLITUDE, best[AMPLITUDE] + FAR, least, rise);
    out->amplitude = (struct interval){exp(best[AMPLITUDE]), exp(low), exp(high)};
    low = end_of(joint, best, ROLLOFF, log(joint->low), least, rise);
    high = end_of(joint, best, ROLLOFF, log(joint->high), least, rise);
    out->rolloff_wavelength =
        (struct interval){isnan(low) || isnan(high) ? (double)NAN : 2 * M_PI / exp(best[ROLLOFF]),
                          2 * M_PI / exp(high), 2 * M_PI / exp(low)};
}

/* Fills the scatter between patches: their factors about their common mean, which is 0. */
static void fill_patches(struct joint *joint, struct joint_fit *out) {
    double square = 0, freedom = 1 - PARAMETERS - (double)joint->count;
    out->between = joint->between;
    for (size_t b = 0; b < joint->count; b++) {
        struct band *band = &joint->bands[b];
        band->patch->offset = band->offset;
        band->patch->error = sqrt(variance_of(band));
        square += band->offset * band->offset / variance_of(band);
        freedom += (double)band->leakage->count;
        out->deviance += band->deviance;
    }
    out->freedom = freedom;
    out->deviance /= freedom;
    out->p_value = gsl_cdf_chisq_Q(square, (double)joint->count - 1);
}

static int measure(struct joint *joint, struct joint_fit *out, struct error *err) {
    double best[PARAMETERS] = {0};
    const struct band *first = &joint->bands[0];
    best[AMPLITUDE] = log(first->patch->spectrum->density[first->leakage->first]);
    double least = search(joint, best);
    if (joint->starved)
        return error_memory(err, sizeof *joint, "a joint fit");
    if (!isfinite(least))
        return error_set(err, ERROR_NUMERIC,
                         "a joint fit of %zu maps: the deviance of their spectra from a law is %g "
                         "wherever it was tried; allowed: finite",
                         joint->count, least);
    least = evaluate(joint, best);
    fill_patches(joint, out);
    out->deviance_limit = 1 + 2 * sqrt(2 * joint->inflation / out->freedom);
    const double wrong = out->deviance > out->deviance_limit ? out->deviance : 1;
    fill_intervals(joint, best, least, RISE * OVERDISPERSION * joint->inflation * wrong, out);
    return 0;
}

/* Finds the band of all together. */
static void joint_fill(struct joint *joint, struct joint_fit *out) {
    double rings = 0;
    out->shortest = INFINITY;
    for (size_t b = 0; b < joint->count; b++) {
        const struct spectrum_fit *fit = joint->bands[b].patch->fit;
        out->longest = fmax(out->longest, fit->trusted_from);
        out->shortest = fmin(out->shortest, fit->trusted_to);
        const double count = (double)joint->bands[b].leakage->count;
        joint->inflation += joint->bands[b].inflation * count;
        rings += count;
    }
    joint->inflation /= rings;
    joint->dimension = grid_is_profile(&joint->bands[0].patch->spectrum->modes.grid) ? 1 : 2;
    joint->low = 2 * M_PI / (BEYOND * out->longest);
    joint->high = 2 * M_PI / out->shortest;
    joint->reference = 2 * M_PI / sqrt(out->longest * out->shortest);
    joint->held = PARAMETERS;
    out->reference_wavelength = 2 * M_PI / joint->reference;
}

int joint_fit_measure(size_t count, struct joint_patch *patches, struct joint_fit *out,
                      struct error *err) {
    struct joint joint = {0};
    int status = 0;
    *out = (struct joint_fit){0};
    for (size_t n = 0; n < count && status == 0; n++) {
        struct band *band = &joint.bands[joint.count];
        status = band_create(band, &patches[n], err);
        joint.count += band->leakage != NULL ? 1 : 0;
    }
    out->patches = joint.count;
    if (status == 0 && joint.count < 2)
        status = error_set(err, ERROR_INPUT,
                           "%zu of %zu maps have waves that can be trusted; a joint fit needs two",
                           joint.count, count);
    if (status == 0) {
        joint_fill(&joint, out);
        status = measure(&joint, out, err);
    }
    joint_clear(&joint);
    return status;
}
