/* Spectral density and autocorrelation of a case. Where the surfaces have the prescribed spectrum
 * exactly, both are known before anything ran; else they are measured on every realisation. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H
#define RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H

#include "jobs/statistics/statistics_tally.h"
#include "schema/result/result.h"

/* These count the entries of the two tallies: 0 where nothing is measured. */
size_t spectra_densities(const struct statistics_case *one_case);
size_t spectra_correlations(const struct statistics_case *one_case);

/* Workspace for measuring, made once a case. */
struct spectra {
    size_t densities, correlations;
    double *abscissa, *measured; /* owned, scratch */
    double *reference; /* owned, densities: prescribed density, its mean where that is 0 */
};
int spectra_create(struct spectra *out, const struct statistics_case *one_case,
                   const struct modes *modes, struct error *err);
void spectra_clear(struct spectra *spectra);
int spectra_measure(struct spectra *spectra, const struct grid *grid, const double *z,
                    struct statistics_tally *tally, struct error *err);

/* Appends the curves "psd" and "acf". */
int spectra_curves(const struct statistics_case *one_case, const struct modes *modes,
                   const struct statistics_tally *tally, struct case_result *result,
                   struct error *err);
/* The same of what is prescribed, whatever surfaces are made of it. */
int spectra_prescribed(const struct statistics_case *one_case, const struct modes *modes,
                       struct case_result *result, struct error *err);

#endif
