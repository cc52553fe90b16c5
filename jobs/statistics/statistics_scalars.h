/* The scalars of one realisation, and of a case. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_SCALARS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_SCALARS_H

#include "core/statistics/heights/roughness.h"
#include "core/statistics/patch.h"
#include "jobs/kind.h"
#include "jobs/realisations.h"
#include "jobs/statistics/statistics_tally.h"
#include "jobs/statistics/statistics_theory.h"
#include "schema/result/result.h"

/* Scalars that are measured again on some realisations, of a surface of the other law of heights
 * ("law_..."); NaN on all others (statistics_law.h). ENTRY(scalar, name). */
#define LAW_SCALARS(ENTRY)                                                                         \
    ENTRY(SKEWNESS, "skewness")                                                                    \
    ENTRY(KURTOSIS, "kurtosis")                                                                    \
    ENTRY(LOWEST, "lowest")                                                                        \
    ENTRY(HIGHEST, "highest")                                                                      \
    ENTRY(SUMMITS, "summits")                                                                      \
    ENTRY(SUMMIT_HEIGHT_MEAN, "summit_height_mean")                                                \
    ENTRY(SUMMIT_HEIGHT_VARIANCE, "summit_height_variance")                                        \
    ENTRY(SUMMIT_HEIGHT_SKEWNESS, "summit_height_skewness")                                        \
    ENTRY(SUMMIT_HEIGHT_KURTOSIS, "summit_height_kurtosis")                                        \
    ENTRY(SUMMIT_CURVATURE_MEAN, "summit_curvature_mean")                                          \
    ENTRY(PITS, "pits")                                                                            \
    ENTRY(PIT_HEIGHT_MEAN, "pit_height_mean")                                                      \
    ENTRY(PIT_HEIGHT_VARIANCE, "pit_height_variance")                                              \
    ENTRY(PIT_HEIGHT_SKEWNESS, "pit_height_skewness")                                              \
    ENTRY(PIT_HEIGHT_KURTOSIS, "pit_height_kurtosis")                                              \
    ENTRY(PIT_CURVATURE_MEAN, "pit_curvature_mean")
#define LAW_NUMBER(scalar, name) LAW_##scalar,
enum { LAW_SCALARS(LAW_NUMBER) LAW_COUNT };
#define LAW_SCALAR(scalar, name) SCALAR_LAW_##scalar,

/* Lengths are in lambda_s. m0 to nayak_alpha are spectral; the names of finite-difference values
 * say so. */
enum statistics_scalar {
    SCALAR_RMS_HEIGHT, /* the three by finite differences (2.35) */
    SCALAR_RMS_SLOPE,
    SCALAR_RMS_CURVATURE,
    SCALAR_SKEWNESS,
    SCALAR_KURTOSIS,
    SCALAR_LOWEST, /* z*, as all summit heights below */
    SCALAR_HIGHEST,
    SCALAR_M0,
    SCALAR_M2,
    SCALAR_M4,
    SCALAR_NAYAK_ALPHA,
    SCALAR_M2_DIFFERENCE,
    SCALAR_M4_DIFFERENCE,
    SCALAR_NAYAK_ALPHA_DIFFERENCE,
    SCALAR_SUMMITS,                 /* in the cell; if Gaussian, half of summits and pits */
    SCALAR_SUMMIT_DENSITY,          /* per lambda_s^2, profiles per lambda_s */
    SCALAR_SUMMIT_DENSITY_PER_AREA, /* per lambda_l^2, profiles per lambda_l */
    SCALAR_SUMMIT_HEIGHT_MEAN,
    SCALAR_SUMMIT_HEIGHT_VARIANCE,
    SCALAR_SUMMIT_HEIGHT_SKEWNESS,
    SCALAR_SUMMIT_HEIGHT_KURTOSIS,
    SCALAR_SUMMIT_CURVATURE_MEAN, /* kappa_m/sqrt(m4) */
    SCALAR_PITS,                  /* as the eight above, of the summits of -z; none if Gaussian */
    SCALAR_PIT_DENSITY,
    SCALAR_PIT_DENSITY_PER_AREA,
    SCALAR_PIT_HEIGHT_MEAN,
    SCALAR_PIT_HEIGHT_VARIANCE,
    SCALAR_PIT_HEIGHT_SKEWNESS,
    SCALAR_PIT_HEIGHT_KURTOSIS,
    SCALAR_PIT_CURVATURE_MEAN,
    SCALAR_GENERATOR_ITERATIONS,
    SCALAR_GENERATOR_CONVERGED, /* 1 below tolerance, 0 stalled or at the limit; none if Gaussian */
    SCALAR_EPS_H,
    SCALAR_EPS_S,
    SCALAR_EPS_S0,
    SCALAR_EPS_S_AMPLITUDE,
    SCALAR_EPS_S0_AMPLITUDE,
    SCALAR_OWN, /* number of those of the surface itself */
    SCALAR_BEFORE_LAW = SCALAR_OWN - 1,
    LAW_SCALARS(LAW_SCALAR) SCALAR_PATCH,
    SCALAR_COUNT = SCALAR_PATCH + PATCH_QUANTITY_COUNT /* of a sub-map as large as a measured map */
};
enum { SCALAR_LAW = SCALAR_OWN };
/* Offset from the scalars of summits to those of pits, which have the same order. */
enum { SIDE_SCALARS = SCALAR_PITS - SCALAR_SUMMITS };
const char *statistics_scalar_name(size_t at); /* NULL behind the last */
/* The own scalar that corresponds to each of LAW_SCALARS. */
extern const unsigned char LAW_OWN[LAW_COUNT];

/* Measurements of one realisation. */
struct realisation_measures {
    const struct roughness *roughness;
    const struct moments *moments;     /* of this realisation's spectrum */
    const struct summit_list *summits; /* of each side (statistics_tally.h) */
    const struct surface_report *report;
};
/* Fills all scalars of the surface itself, and the others with NaN. moments: of the prescribed
 * spectrum, which sets the scale. */
void statistics_scalars_measure(const struct statistics_case *one_case,
                                const struct moments *moments,
                                const struct realisation_measures *measures,
                                double out[SCALAR_COUNT]);

/* Computes the finite-difference values of every surface with exactly this spectrum; the others are
 * NaN. */
void statistics_constants(const struct modes *modes, const struct moments *moments,
                          struct roughness *out);

/* Fills in what is known of heights and slopes of the sum of a random part, which has these
 * moments, and the grooves of the case; other spectral moments and those by differences are NaN,
 * and what else is in out stays. */
void statistics_scalars_with_grooves(const struct statistics_case *one_case,
                                     const struct moments *moments, double out[SCALAR_COUNT]);

/* Appends the scalars over the realisations to the result. Constants, which all surfaces of an
 * exact spectrum share, have the value of the spectrum and a standard error of 0, which no other
 * scalar has. */
int statistics_scalars(const struct statistics_case *one_case, const struct surface_basis *basis,
                       const struct summit_theories *theories,
                       const struct realisations *realisations, struct case_result *out,
                       struct error *err);

/* Fills the values of a scalar and their weights, as job_kind asks for them. */
int statistics_scalar_values(const struct realisations *realisations, size_t scalar, double *values,
                             double *weights, struct error *err);

#endif
