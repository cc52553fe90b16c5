/* The scalars of one contact realisation, and of a case. Areas are those of the first model on the
 * finest level by matched edges; roughness is that of the own grid, lengths in lambda_s. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SCALARS_H
#define RUGO_JOBS_CONTACT_CONTACT_SCALARS_H

#include "core/statistics/heights/roughness.h"
#include "jobs/contact/tally/contact_tally.h"
#include "jobs/realisations.h"
#include "schema/result/result.h"

enum contact_scalar {
    CONTACT_SCALAR_KAPPA, /* slope of the light-load line */
    CONTACT_SCALAR_POWER_LAW_A,
    CONTACT_SCALAR_POWER_LAW_B,
    CONTACT_SCALAR_ERF_KAPPA,
    CONTACT_SCALAR_AREA_LAST, /* at the last load, as the gap, which is over sqrt(m0) */
    CONTACT_SCALAR_GAP_LAST,
    CONTACT_SCALAR_ITERATIONS, /* of all loads */
    CONTACT_SCALAR_VIOLATION,  /* the largest */
    CONTACT_SCALARS_OF_MODELS, /* own scalars of all models of the program stand between */
    CONTACT_SCALAR_RMS_HEIGHT = CONTACT_SCALARS_OF_MODELS, /* by finite differences, as the slope */
    CONTACT_SCALAR_RMS_SLOPE,
    CONTACT_SCALAR_NAYAK_ALPHA, /* spectral */
    CONTACT_SCALAR_SKEWNESS,
    CONTACT_SCALAR_KURTOSIS,
    CONTACT_SCALAR_GENERATOR_ITERATIONS,
    CONTACT_SCALAR_EPS_H, /* none if Gaussian, as the two below */
    CONTACT_SCALAR_EPS_S,
    CONTACT_SCALAR_EPS_S0,
    CONTACT_SCALAR_COUNT
};
/* Returns the name of a scalar of one realisation: those above, then those of the models; NULL
 * behind the last. */
const char *contact_scalar_name(size_t scalar);

/* Measures the scalars of the realisation whose values the tally holds. nayak_alpha: of its own
 * spectrum. Fails only with ERROR_MEMORY; a fit with too few points has no value. */
int contact_scalars_measure(struct contact_tally *tally, const struct roughness *roughness,
                            double nayak_alpha, const struct surface_report *report, double *out,
                            struct error *err);

/* Appends the scalars over the realisations to the result, with errors by source for those that the
 * tally has at a load. Fits are over the loads at which the mean area is within their range, which
 * are the same for every realisation; their number is a scalar, too. */
int contact_scalars(const struct contact_case *one_case, const struct moments *moments,
                    const struct contact_tally *tally, const struct realisations *realisations,
                    struct case_result *out, struct error *err);

/* Fits over the loads, from the lightest on, at which the mean area is at most area_most. */
struct contact_fit {
    const char *name; /* of the scalar */
    enum contact_measure measure;
    double area_most;
    const char *count, *highest; /* names of its number of loads, and of the highest; NULL: it
                                  * shares those of the fit before */
    const char *residual;        /* name of the RMS of the mean area less the fit, over that of the
                                  * mean area; NULL likewise */
};
enum { CONTACT_FIT_COUNT = MEASURE_FITS };
extern const struct contact_fit CONTACT_FITS[CONTACT_FIT_COUNT];
/* Appends on how many loads a fit was made, the highest of them, and the residual of an area of so
 * many loads from the line with these parameters; b: of the power law. Without loads the number
 * alone; nothing for a fit that shares another's. model: names begin with it; NULL: with nothing.
 */
int contact_scalars_put_range(const struct contact_fit *fit, const char *model,
                              const struct contact_case *one_case, size_t loads, const double *area,
                              double a, double b, struct case_result *out, struct error *err);

/* Returns whether a scalar is a fit over loads, which one, and over how many loads from the
 * lightest on. */
bool contact_scalar_fit(const struct contact_tally *tally, size_t scalar, enum contact_measure *fit,
                        size_t *loads);

#endif
