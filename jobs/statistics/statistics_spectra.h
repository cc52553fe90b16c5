/* Spectral density and autocorrelation of a case. Where the surfaces have the prescribed spectrum
 * exactly, both are known in advance; else they are measured on every realisation. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H
#define RUGO_JOBS_STATISTICS_STATISTICS_SPECTRA_H

#include "jobs/statistics/statistics_tally.h"
#include "schema/result/result.h"

struct spectra_sizes spectra_sizes(const struct statistics_case *one_case);

/* The workspace for measuring, made once a case. */
struct spectra {
    struct spectra_sizes sizes;
    double *abscissa, *measured; /* owned, scratch */
    struct grid coarse;          /* of every second point, where changes are measured */
    double *samples, *changed;   /* owned, scratch: its heights, what is measured on it */
    double *reference; /* owned, densities: prescribed density, its mean where that is 0 */
};
/* Fills the densities by which measured ones are divided before they are summed, so that sums are
 * exact: radial_bins prescribed densities, their mean where that is 0. */
void spectra_reference(const struct modes *modes, double *wave_number, double *density);
int spectra_create(struct spectra *out, const struct statistics_case *one_case,
                   const struct modes *modes, struct error *err);
void spectra_clear(struct spectra *spectra);
int spectra_measure(struct spectra *spectra, const struct grid *grid, const double *z,
                    struct statistics_tally *tally, struct error *err);

/* Appends the curves "psd" and "acf". */
int spectra_curves(const struct statistics_case *one_case, const struct modes *modes,
                   const struct statistics_tally *tally, struct case_result *result,
                   struct error *err);
/* Appends the same curves as prescribed, whatever surfaces are made of them. */
int spectra_prescribed(const struct statistics_case *one_case, const struct modes *modes,
                       struct case_result *result, struct error *err);

#endif
