#include "schema/result/total.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *unknown_source_name(size_t source) {
    return source == UNKNOWN_STATISTICAL ? "statistical" : ERROR_SOURCE_ROWS[source].name;
}

double total_deviations(double sampled) {
    static const double NORMAL = 1.96, BELOW = 0.975;
    return sampled > 0 ? gsl_cdf_tdist_Pinv(BELOW, fmax(1, sampled - 1)) : NORMAL;
}

double total_freedom(size_t count, const double *variances, const double *realisations) {
    double variance = 0, square = 0;
    for (size_t a = 0; a < count; a++) {
        variance += variances[a];
        if (variances[a] != 0)
            square += variances[a] * variances[a] / (realisations[a] - 1);
    }
    return variance * variance / square;
}

struct total total_of(double value, double standard_error, double sampled,
                      const struct scalar_error errors[ERROR_SOURCES]) {
    struct total total = {.low = NAN, .high = NAN};
    double most = 0, least = 0;
    bool any = !isnan(standard_error);
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct scalar_error *error = &errors[s];
        bool known = error->applies && error->known && !isnan(error->value);
        bool bounded = known && !isnan(error->bound);
        total.unknown[s] = error->applies && !bounded;
        most += known ? error->value + (bounded ? error->bound : 0) : 0;
        least += known ? error->value - (bounded ? error->bound : 0) : 0;
        any = any || known;
    }
    total.unknown[UNKNOWN_STATISTICAL] = sampled == 1 && isnan(standard_error);
    if (isnan(value) || !any)
        return total;
    double statistical = standard_error > 0 ? total_deviations(sampled) * standard_error : 0;
    total.low = value - (statistical + fmax(0, most));
    total.high = value + (statistical + fmax(0, -least));
    return total;
}

double scalar_sampled(const struct scalar *scalar) {
    return scalar->effective > 0 ? scalar->effective : (double)scalar->sampled;
}

struct total scalar_total(const struct scalar *scalar) {
    return total_of(scalar->value, scalar->standard_error, scalar_sampled(scalar), scalar->errors);
}

double total_half_width(double value, const struct total *total) {
    return isnan(total->low) ? (double)NAN : fmax(value - total->low, total->high - value);
}

bool total_is_partial(const struct total *total) {
    bool partial = false;
    for (size_t s = 0; s < UNKNOWN_SOURCES; s++)
        partial = partial || total->unknown[s];
    return partial;
}

void total_unknown_names(const struct total *total, char names[TOTAL_NAMES_SIZE]) {
    size_t length = 0;
    names[0] = '\0';
    for (size_t s = 0; s < UNKNOWN_SOURCES && length < TOTAL_NAMES_SIZE; s++)
        if (total->unknown[s])
            length += (size_t)snprintf(names + length, TOTAL_NAMES_SIZE - length, "%s%s",
                                       length > 0 ? " " : "", unknown_source_name(s));
}

static double at_or_nan(const double *numbers, size_t at) {
    return numbers != NULL ? numbers[at] : (double)NAN;
}

struct scalar_error curve_error_at(const struct curve *curve, enum error_source source, size_t at) {
    const struct curve_error *error = &curve->errors[source];
    double value = at_or_nan(error->value, at);
    return (struct scalar_error){.applies = error->applies,
                                 .known = !isnan(value),
                                 .value = value,
                                 .bound = at_or_nan(error->bound, at),
                                 .standard_error = at_or_nan(error->standard_error, at)};
}

double curve_sampled_at(const struct curve *curve, size_t at) {
    double effective = at_or_nan(curve->effective, at);
    double without = curve_is_partial(curve) ? at_or_nan(curve->valueless, at) : 0;
    if (effective > 0)
        return effective;
    return (double)curve->sampled - (isnan(without) ? 0 : without);
}

struct total curve_total(const struct curve *curve, size_t at) {
    struct scalar_error errors[ERROR_SOURCES];
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        errors[s] = curve_error_at(curve, s, at);
    return total_of(curve->y[at], curve->standard_error[at], curve_sampled_at(curve, at), errors);
}

void curve_unknown(const struct curve *curve, bool unknown[UNKNOWN_SOURCES]) {
    memset(unknown, 0, UNKNOWN_SOURCES * sizeof *unknown);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        unknown[s] = curve->errors[s].applies && curve->errors[s].value == NULL;
    for (size_t at = 0; at < curve_value_count(curve); at++) {
        const struct total total = curve_total(curve, at);
        for (size_t s = 0; s < UNKNOWN_SOURCES && !isnan(curve->y[at]); s++)
            unknown[s] = unknown[s] || total.unknown[s];
    }
}
