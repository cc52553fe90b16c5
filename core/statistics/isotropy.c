#include "core/statistics/isotropy.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

/* Variances and covariance of the means of two fields. */
struct covariance {
    double aa, ab, bb;
};

static double total(const double *sums, size_t cells) {
    double all = 0;
    for (size_t cell = 0; cell < cells; cell++)
        all += sums[cell];
    return all;
}

/* Of along/gradient and across/gradient, by what each cell changes in them. */
static struct covariance covariance_measure(const struct cell_differences *d,
                                            const struct low_modes *modes, double gradient,
                                            double along, double across) {
    size_t cells = modes->cells_x * modes->cells_y;
    double a[LOW_CELLS_MOST], b[LOW_CELLS_MOST];
    struct covariance out = {0};
    for (size_t cell = 0; cell < cells; cell++) {
        a[cell] = (d->along[cell] - along * d->gradient[cell]) / gradient;
        b[cell] = (d->across[cell] - across * d->gradient[cell]) / gradient;
    }
    for (size_t m = 0; m < modes->count; m++) {
        double of_a = low_mode_amplitude(modes, m, a), of_b = low_mode_amplitude(modes, m, b);
        out.aa += of_a * of_a / (double)modes->count;
        out.ab += of_a * of_b / (double)modes->count;
        out.bb += of_b * of_b / (double)modes->count;
    }
    return out;
}

void isotropy_measure(const struct cell_differences *d, double length,
                      const struct low_modes *modes, double excess, struct isotropy *out) {
    size_t cells = modes->cells_x * modes->cells_y;
    double none = (double)NAN, gradient = total(d->gradient, cells);
    double along = total(d->along, cells) / gradient, across = total(d->across, cells) / gradient;
    double size = hypot(along, across);
    *out = (struct isotropy){.length = length,
                             .anisotropy = size,
                             .ratio = sqrt((1 + size) / (1 - size)),
                             .direction = atan2(across, along) / 2,
                             .anisotropy_error = none,
                             .ratio_error = none,
                             .direction_error = none,
                             .p_value = none};
    if (!(gradient > 0))
        out->anisotropy = out->ratio = out->direction = none;
    if (isnan(excess) || !(gradient > 0))
        return;
    struct covariance c = covariance_measure(d, modes, gradient, along, across);
    c.aa *= excess;
    c.ab *= excess;
    c.bb *= excess;
    double determinant = c.aa * c.bb - c.ab * c.ab, n = (double)modes->count;
    double x = along / size, y = across / size;
    out->anisotropy_error = sqrt(x * x * c.aa + 2 * x * y * c.ab + y * y * c.bb);
    out->ratio_error = out->ratio * out->anisotropy_error / (1 - size * size);
    out->direction_error = sqrt(y * y * c.aa - 2 * x * y * c.ab + x * x * c.bb) / (2 * size);
    double hotelling = (along * along * c.bb - 2 * along * across * c.ab + across * across * c.aa) /
                       determinant; /* of two numbers, by a covariance of n degrees of freedom */
    out->p_value = gsl_cdf_fdist_Q(hotelling * (n - 1) / (2 * n), 2, n - 1);
}

double least_p_value(const double *p_values, size_t n) {
    double least = 1;
    for (size_t a = 0; a < n; a++) {
        if (isnan(p_values[a]))
            return p_values[a];
        least = fmin(least, p_values[a]);
    }
    return -expm1((double)n * log1p(-least));
}
