#include "core/statistics/grooves/groove_shape.h"
#include "core/statistics/grooves/groove_sums.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

struct shape_trial {
    double deviance, depth, variance, at;
};

/* Returns what a shape leaves of the lines where it begins t periods before the middle. floor: of
 * the variances. */
static struct shape_trial shape_at(const struct groove_lines *lines, enum groove_shape shape,
                                   bool reversed, double t, double floor) {
    double product = 0, norm = 0, total = 0;
    for (size_t h = 1; h <= lines->count; h++) {
        double complex unit = groove_shape_coefficient(shape, h);
        if (reversed)
            unit = conj(unit);
        const double phase = 2 * M_PI * (double)h * t, v = lines->variance[h - 1] + floor;
        unit *= cos(phase) + sin(phase) * I;
        product += creal(conj(unit) * lines->coefficient[h - 1]) / v;
        norm += complex_square(unit) / v;
        total += complex_square(lines->coefficient[h - 1]) / v;
    }
    const double depth = fmax(product / norm, 0);
    return (struct shape_trial){2 * (total - 2 * depth * product + depth * depth * norm), depth,
                                0.5 / norm, t};
}

/* Finds the phase of a shape. Lines far above their noise make so sharp a minimum, between others,
 * that it is approached from a higher noise. */
static struct shape_trial shape_fit(const struct groove_lines *lines, enum groove_shape shape,
                                    bool reversed) {
    enum { HALVINGS = 20 };
    static const double LOWER[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 0};
    const size_t points = 16 * lines->count + 32;
    struct shape_trial best = {.deviance = INFINITY};
    double strongest = 0;
    for (size_t h = 0; h < lines->count; h++)
        strongest = fmax(strongest, complex_square(lines->coefficient[h]));
    for (size_t i = 0; i < points; i++) {
        const struct shape_trial trial =
            shape_at(lines, shape, reversed, (double)i / (double)points, LOWER[0] * strongest);
        best = trial.deviance < best.deviance ? trial : best;
    }
    for (size_t l = 0; l < sizeof LOWER / sizeof *LOWER; l++) {
        const double floor = LOWER[l] * strongest;
        double reach = 1 / (double)points;
        best = shape_at(lines, shape, reversed, best.at, floor);
        for (int step = 0; step < HALVINGS; step++, reach /= 2)
            for (int sign = -1; sign <= 1; sign += 2) {
                const struct shape_trial trial =
                    shape_at(lines, shape, reversed, best.at + sign * reach / 2, floor);
                best = trial.deviance < best.deviance ? trial : best;
            }
    }
    return best;
}

/* Depth of the series up to the last line that stands out; its error by all lines of it. */
static void series_depth(struct groove_shape_fit *out, const struct groove_lines *lines) {
    double variance = 0;
    const struct groove_extremes e = groove_extremes_find(out->standing, lines->coefficient);
    for (size_t h = 1; h <= out->standing; h++) {
        const double apart = 2 * sin(M_PI * (double)h * (e.high_at - e.low_at));
        variance += 2 * lines->variance[h - 1] * apart * apart;
    }
    out->depth = e.high - e.low;
    out->depth_error = sqrt(variance);
}

/* Makes the depth the mean over all shapes, as probable as the lines make them, with the error that
 * they have about it. */
static void mix(struct groove_shape_fit *out, const struct shape_trial *trial, int best) {
    double total = 0, variance = 0;
    for (int s = 0; s <= GROOVE_HARMONICS; s++)
        total += exp((trial[best].deviance - trial[s].deviance) / 2);
    out->depth = 0;
    for (int s = 0; s <= GROOVE_HARMONICS; s++) {
        const double probability = exp((trial[best].deviance - trial[s].deviance) / 2) / total;
        struct groove_shape_depth *depth = &out->of[s == GROOVE_HARMONICS ? GROOVE_SAW : s];
        if (s == GROOVE_HARMONICS && trial[s].deviance > trial[GROOVE_SAW].deviance)
            depth->probability += probability;
        else
            *depth = (struct groove_shape_depth){depth->probability + probability, trial[s].depth,
                                                 sqrt(trial[s].variance)};
        out->depth += probability * trial[s].depth;
    }
    for (int s = 0; s <= GROOVE_HARMONICS; s++) {
        const double probability = exp((trial[best].deviance - trial[s].deviance) / 2) / total;
        const double apart = trial[s].depth - out->depth;
        variance += probability * (trial[s].variance + apart * apart);
    }
    out->depth_error = sqrt(variance);
}

void groove_shape_find(struct groove_shape_fit *out, const struct groove_lines *lines) {
    static const double STANDS = 7;
    const double freedom = 2 * (double)lines->count - 2;
    struct shape_trial trial[GROOVE_HARMONICS + 1];
    int best = 0;
    *out = (struct groove_shape_fit){.standing = 1};
    for (size_t h = 1; h <= lines->count; h++)
        out->standing = lines->excess[h - 1] > STANDS ? h : out->standing;
    for (int s = 0; s <= GROOVE_HARMONICS; s++) {
        const bool reversed = s == GROOVE_HARMONICS;
        trial[s] = shape_fit(lines, reversed ? GROOVE_SAW : (enum groove_shape)s, reversed);
        /* by one line all are alike, and a sine is taken */
        best = lines->count > 1 && trial[s].deviance < trial[best].deviance ? s : best;
    }
    out->reversed = best == GROOVE_HARMONICS;
    out->shape = out->reversed ? GROOVE_SAW : (enum groove_shape)best;
    out->p_value = freedom > 0 ? gsl_cdf_chisq_Q(trial[best].deviance, freedom) : 1;
    out->at = trial[best].at;
    mix(out, trial, best);
}

void groove_shape_forget(struct groove_shape_fit *fit, const struct groove_lines *lines) {
    fit->shape = GROOVE_HARMONICS;
    fit->reversed = false;
    fit->p_value = (double)NAN;
    series_depth(fit, lines);
}

double complex groove_shape_line(const struct groove_shape_fit *fit, size_t h, double jump) {
    if (fit->shape == GROOVE_HARMONICS)
        return 0;
    const double complex unit = groove_shape_coefficient(fit->shape, h);
    const double phase = 2 * M_PI * (double)h * fit->at, fall = M_PI * (double)h * jump;
    const double share = fall > 0 && fit->shape == GROOVE_SAW ? sin(fall) / fall : 1;
    return share * fit->of[fit->shape].depth * (fit->reversed ? conj(unit) : unit) *
           (cos(phase) + sin(phase) * I);
}

double groove_shape_height(const struct groove_shape_fit *fit, double t, double jump) {
    const struct groove_profile profile = {.shape = fit->shape};
    const double along = fit->at + t, u = (fit->reversed ? -1 : 1) * (along - round(along));
    const double past = 0.5 - fabs(u); /* of the jump of a saw */
    const double height = fit->shape == GROOVE_SAW && past < jump / 2
                              ? copysign((1 - jump) * past / jump, u)
                              : groove_profile_height(&profile, u);
    return fit->of[fit->shape].depth * height;
}

bool groove_shape_endless(const struct groove_shape_fit *fit) {
    return fit->shape != GROOVE_HARMONICS && fit->shape != GROOVE_SINE;
}

struct groove_lines groove_lines_beyond(const struct groove_lines *lines,
                                        const struct groove_shape_fit *fit, double jump) {
    struct groove_lines out = *lines;
    for (size_t h = 1; h <= lines->count && groove_shape_endless(fit); h++)
        out.coefficient[h - 1] -= groove_shape_line(fit, h, jump);
    return out;
}
