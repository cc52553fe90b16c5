/* Spectral density and autocorrelation of a case. Where the surfaces have the prescribed spectrum
 * exactly, both are known in advance. Else they are measured on every realisation: of its spectrum
 * where that is known (random amplitudes), or of its heights. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H
#define RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H

#include "core/statistics/spectra/spectral_band.h"
#include "core/statistics/spectra/whole_band.h"
#include "jobs/statistics/statistics_tally.h"
#include "schema/result/result.h"

struct spectra_sizes spectra_sizes(const struct statistics_case *one_case);

/* The workspace for measuring, made once a case. */
struct spectra {
    struct spectra_sizes sizes;
    struct spectral_band *band;   /* owned, as all below; NULL unless spectra are measured */
    struct whole_band *whole;     /* NULL where the spectrum of a realisation is known */
    struct spectral_band *coarse; /* of every second point; NULL unless changes are measured */
    double *measured, *changed;   /* scratch */
    double *reference;            /* densities: prescribed density, its mean where that is 0 */
};
int spectra_create(struct spectra *out, const struct statistics_case *one_case,
                   const struct modes *modes, struct error *err);
void spectra_clear(struct spectra *spectra);
/* Returns the spectrum of a realisation, without its mean, which it fills. It is measured where it
 * is not known, and valid until the next one. */
const struct modes *spectra_modes(struct spectra *spectra, const struct realisation *realisation,
                                  double *mean);
/* Adds density and correlation of the spectrum that spectra_modes has returned last. */
void spectra_measure(struct spectra *spectra, const struct modes *modes,
                     struct statistics_tally *tally);
/* Returns the peak bytes of the workspace and of what is measured with it. */
double spectra_bytes(const struct statistics_case *one_case);

/* Appends the curves "psd" and "acf". */
int spectra_curves(const struct statistics_case *one_case, const struct modes *modes,
                   const struct statistics_tally *tally, struct case_result *result,
                   struct error *err);
/* Appends the same curves as prescribed, whatever surfaces are made of them. */
int spectra_prescribed(const struct statistics_case *one_case, const struct modes *modes,
                       struct case_result *result, struct error *err);

#endif
