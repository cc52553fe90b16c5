#include "core/surface/spectrum_density.h"
#include <math.h>

/* Returns the unscaled self-affine density (F2.1) at the frequency q = |k|/(2 pi). */
static double self_affine_density(const struct spectrum *s, bool profile, double q) {
    if (q * s->wavelength_long < 1 - BAND_EDGE || q * s->wavelength_short > 1 + BAND_EDGE)
        return 0;
    double relative = q * s->wavelength_rolloff;
    if (relative <= 1)
        return 1;
    return pow(relative, profile ? -1 - 2 * s->hurst : -2 * (s->hurst + 1));
}

/* Interpolates between logarithms, or linearly where an end of the interval is zero. */
static double table_density(const struct spectrum *s, double k) {
    const double *x = s->table_wave_number, *y = s->table_density;
    size_t low = 0, high = s->table_count - 1;
    if (k < x[0] * (1 - BAND_EDGE) || k > x[high] * (1 + BAND_EDGE))
        return 0;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (x[middle] <= k)
            low = middle;
        else
            high = middle;
    }
    double t = fmin(fmax(log(k / x[low]) / log(x[high] / x[low]), 0), 1);
    if (y[low] == 0 || y[high] == 0)
        return y[low] + t * (y[high] - y[low]);
    return y[low] * pow(y[high] / y[low], t);
}

double spectrum_density(const struct spectrum *s, bool profile, double k) {
    switch (s->type) {
    case SPECTRUM_SELF_AFFINE:
        return self_affine_density(s, profile, k / (2 * M_PI));
    case SPECTRUM_EXPONENTIAL_ACF:
        return 0; /* exponential_fill */
    case SPECTRUM_TABLE:
        return table_density(s, k);
    }
    return 0;
}

bool spectrum_band(const struct spectrum *s, double *low, double *high) {
    if (s->type == SPECTRUM_SELF_AFFINE) {
        *low = 2 * M_PI / s->wavelength_long;
        *high = 2 * M_PI / s->wavelength_short;
        return true;
    }
    if (s->type == SPECTRUM_TABLE) {
        *low = s->table_wave_number[0];
        *high = s->table_wave_number[s->table_count - 1];
        return true;
    }
    return false;
}
