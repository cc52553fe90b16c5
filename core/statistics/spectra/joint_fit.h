/* One self-affine law (FORMULAS.md, F2.1) for several patches of one surface, each in the band of
 * wavelengths in which it can be trusted: FORMULAS.md, F18.48. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_JOINT_FIT_H
#define RUGO_CORE_STATISTICS_SPECTRA_JOINT_FIT_H

#include "core/statistics/spectra/spectrum_fit.h"

enum { JOINT_PATCHES_MOST = 16 };

struct joint_patch {
    const struct map_spectrum *spectrum; /* over circles, or over the ellipses of the one lay of
                                            all; borrowed, as the next */
    const struct spectrum_fit *fit;      /* of the patch alone: its trusted band, noise and ends */
    /* Filled by joint_fit_measure: the logarithm of its density over that of the law, less the
     * scatter that it shares with the others, and the standard error that its waves give that;
     * NaN: it has no ring in its band, and does not count. */
    double offset, error;
};

struct joint_fit {
    size_t patches;           /* that count */
    double longest, shortest; /* wavelengths that are trusted in one at least */
    double reference_wavelength;
    struct interval hurst, rolloff_wavelength, amplitude; /* as in struct spectrum_fit */
    /* Standard deviation of ln C between patches, beyond what their waves explain, and the p-value
     * of patches that have none. */
    double between, p_value;
    double deviance, deviance_limit, freedom; /* as in struct spectrum_fit */
};
/* Returns the one lay of several patches: the mean of those that have one, LAY_NONE among them left
 * out, by their standard errors (F18.51); LAY_NONE where none has. */
struct lay joint_fit_lay(size_t count, const struct lay *lays);
/* All patches are surfaces, or all profiles. ERROR_INPUT where fewer than two have trusted waves;
 * ERROR_NUMERIC where no law has a finite deviance; ERROR_MEMORY. */
int joint_fit_measure(size_t count, struct joint_patch *patches, struct joint_fit *out,
                      struct error *err);
/* Returns the density of the law at a wave number, without ends. */
double joint_fit_density(const struct joint_fit *fit, bool profile, double wave_number);

#endif
