/* The self-affine law (FORMULAS.md, F2.1) that fits the spectral density of a map, with 95 %
 * intervals, over the wavelengths at which the map can be trusted: F18.13 to F18.15. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_FIT_H
#define RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_FIT_H

#include "core/statistics/spectra/spectrum_range.h"

/* A value with its 95 % interval. */

/* NaN for a value that was not seen, and for an end of its 95 % interval that is open; what lies
 * beyond an end is left out at 2.5 %, also of an end that is alone. */
struct interval {
    double value, low, high;
};

struct spectrum_fit {
    double trusted_from, trusted_to; /* wavelengths, the longest and the shortest of the fit */
    enum spectrum_end from_end, to_end;
    double noise; /* density of the flat tail that was taken out; 0: none was seen */

    /* Not seen, an interval has value NaN and one end: the roll-off is longer than `low`, or
     * shorter than `high`; the shortest wave is shorter than `high`, the longest longer than `low`.
     */
    struct interval hurst;
    struct interval rolloff_wavelength, short_wavelength, long_wavelength;
    double reference_wavelength; /* within the trusted ones */
    struct interval amplitude;   /* density there, of the law as it falls from the roll-off on */
    /* Of the law from `longest`, which is long_wavelength or else the longer side of the map, to
     * `shortest`, which is short_wavelength or else trusted_to. */
    struct interval rms_height, rms_slope, rms_curvature;
    double longest, shortest;
    /* Of Gaussian surfaces of this law (F6.7), of profiles of the peaks (F7.2); NaN with a lay. */
    struct interval nayak_alpha, summit_density;
    /* Of a lay, whose spectrum is over ellipses: wavelengths and densities above are those of waves
     * across it. The ratio is 1 where there is none, and the angle NaN, both without ends. */
    struct interval lay_ratio, lay_angle; /* angle in radians, counter-clockwise from x */
    bool profile;

    double deviance; /* per degree of freedom: about 1 where the law holds; larger ones have widened
                        the intervals already */
    double deviance_limit; /* 2 of its standard deviations above 1: the law does not hold beyond */
    double freedom;        /* rings less parameters */
    bool fitted;           /* false: too few waves; all but the trusted range is NaN then */
};
/* ERROR_INPUT for a range without wave numbers of the map; ERROR_MEMORY. */
int spectrum_fit_measure(const struct map_spectrum *spectrum,
                         const struct spectrum_fit_request *request, struct spectrum_fit *out,
                         struct error *err);

/* Fits over the ellipses of a lay; over the circles where the lay is plain. *ellipses: NULL at
 * first, their spectrum where there is one, the caller's to destroy in any case. Errors as above.
 */
int spectrum_fit_along(const struct map_spectrum *circles, const struct lay *lay,
                       const struct spectrum_fit_request *request, struct map_spectrum **ellipses,
                       struct spectrum_fit *out, struct error *err);

/* Returns the density of the law at a wave number, with a lay its mean over all directions; 0
 * beyond its ends. */
double spectrum_fit_density(const struct spectrum_fit *fit, double wave_number);
/* Returns which share of the mean square curvature of a map (F18.2) its noise has, taken as white
 * up to the shortest waves of the points: 0 where none was seen. rms_curvature: of the map. */
double spectrum_fit_noise_share(const struct spectrum_fit *fit, const struct grid *grid,
                                double rms_curvature);
/* Above this share noise governs what short waves are measured by. */
#define NOISE_SHARE_MOST 0.05
/* Fills the spectrum of a study that makes surfaces by the law: what was not seen is as long, or as
 * short, as that of the RMS height above. ERROR_INPUT where nothing was fitted. */
int spectrum_fit_law(const struct spectrum_fit *fit, struct spectrum *out, struct error *err);

#endif
