#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

struct sector {
    double power, expected, squares; /* squares of what is expected */
};

/* The half turn begins half a sector before -pi/2, so that both axes are in the middle of one. */
static size_t sector_of(double x, double y) {
    double turn = atan2(y, x) / M_PI + 0.5 + 0.5 / ANGULAR_SECTORS;
    return (size_t)(turn * ANGULAR_SECTORS) % ANGULAR_SECTORS;
}

/* cell: what densities are of a mode's power. */
static void mode_add(const struct map_spectrum *s, size_t mx, long my, double cell,
                     struct sector sectors[ANGULAR_KINDS][ANGULAR_SECTORS]) {
    const struct grid *grid = &s->modes.grid;
    double x = (double)mx * (s->side / grid->lx), y = (double)my * (s->side / grid->ly);
    size_t ring = ring_of(x, y);
    if (ring < 1 || ring >= s->rings)
        return;
    double power = modes_power(&s->modes, mx, my) * cell / s->power, expected = s->density[ring];
    for (int kind = 0; kind < ANGULAR_KINDS; kind++) {
        struct sector *sector = &sectors[kind][sector_of(x, y)];
        double weight = kind == ANGULAR_SLOPES ? x * x + y * y : 1;
        sector->power += weight * power;
        sector->expected += weight * expected;
        sector->squares += weight * expected * weight * expected;
    }
}

void angular_spectrum_measure(const struct map_spectrum *s, struct angular_spectrum *out) {
    const struct grid *grid = &s->modes.grid;
    struct sector sectors[ANGULAR_KINDS][ANGULAR_SECTORS] = {0};
    long most_y = (long)(grid->ny - 1) / 2;
    double cell = grid->lx * grid->ly / (4 * M_PI * M_PI);
    for (size_t mx = 0; 2 * mx < grid->nx; mx++)
        for (long my = mx > 0 ? -most_y : 1; my <= most_y; my++)
            mode_add(s, mx, my, cell, sectors);
    double alike = s->windowed ? WINDOWED_ALIKE * WINDOWED_ALIKE : 1;
    for (size_t n = 0; n < ANGULAR_SECTORS; n++) {
        out->angle[n] = M_PI * ((double)n / ANGULAR_SECTORS - 0.5);
        for (int kind = 0; kind < ANGULAR_KINDS; kind++) {
            const struct sector *sector = &sectors[kind][n];
            double power = sector->expected > 0 ? sector->power / sector->expected : (double)NAN;
            out->power[kind][n] = power;
            out->error[kind][n] = power * sqrt(alike * sector->squares) / sector->expected;
        }
    }
}

double angular_spectrum_peak(const struct angular_spectrum *spectrum) {
    double angle = (double)NAN, most = -INFINITY;
    for (size_t n = 0; n < ANGULAR_SECTORS; n++)
        if (spectrum->power[ANGULAR_HEIGHTS][n] > most) {
            most = spectrum->power[ANGULAR_HEIGHTS][n];
            angle = spectrum->angle[n];
        }
    return angle;
}

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
    double waves = 0;
    for (size_t m = 0; m < modes->count; m++) {
        const double weight = low_mode_weight(modes, m, d->squares);
        if (!(weight > LOW_MODE_WEIGHT_LEAST))
            continue;
        double of_a = low_mode_amplitude(modes, m, a), of_b = low_mode_amplitude(modes, m, b);
        out.aa += of_a * of_a / weight;
        out.ab += of_a * of_b / weight;
        out.bb += of_b * of_b / weight;
        waves++;
    }
    return (struct covariance){out.aa / waves, out.ab / waves, out.bb / waves};
}

static const double LEVEL = 0.05;

/* A length has no sign, so that it is above 0 without any anisotropy. Where that is not excluded,
 * the intervals of 95 %, so many errors to either side, hold it, and all directions. */
static void errors_widen(struct isotropy *out, double factor) {
    out->anisotropy_error = fmax(out->anisotropy_error, out->anisotropy / factor);
    out->ratio_error = fmax(out->ratio_error, (out->ratio - 1) / factor);
    out->direction_error = fmax(out->direction_error, M_PI / 2 / factor);
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
    if (out->p_value >= LEVEL)
        errors_widen(out, low_modes_factor(modes->count));
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
