#include "jobs/like/like_expectation.h"
#include "core/statistics/spectra/spectrum_leakage.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/surface/spectrum.h"
#include "core/surface/spectrum_density.h"
#include <complex.h>
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdlib.h>

/* Rings below LOW_RINGS are expected wave by wave, with the trend that is taken out; waves up to
 * NEAR waves a side of the map count for them. From there on trends take nothing. */
enum { LOW_RINGS = 6, NEAR = LOW_RINGS + 8, DEGREES = 3 };

/* Legendre's polynomials along x and y that a trend consists of. */
struct term {
    int x, y;
};
static const struct term TERMS[] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};

/* Means along one axis of the map, whose points are about its middle. */
struct axis {
    size_t points;
    double step;              /* of the waves of the cell, in radians a point */
    double own;               /* of those of the map */
    long waves;               /* of the cell, -waves to waves */
    long modes;               /* of the map, likewise */
    complex double *wave;     /* owned, as the next: of polynomial p times wave k */
    complex double *windowed; /* of the window times wave k less mode m */
    complex double *trend;    /* of the window times polynomial p less mode m */
};

struct like_expectation {
    const struct map_spectrum *rings; /* borrowed */
    struct grid cell;
    size_t terms;
    struct axis x, y;
    struct spectrum_leakage *leakage; /* of the rings from LOW_RINGS on; NULL: there are none */
};

/* Of mean square 1 over -1 to 1. */
static double legendre(int degree, double x) {
    return degree == 0 ? 1 : degree == 1 ? sqrt(3) * x : sqrt(5) * (3 * x * x - 1) / 2;
}

static double position_of(const struct axis *axis, size_t i) {
    return (double)i + 0.5 - (double)axis->points / 2;
}

static void axis_fill(struct axis *axis) {
    const double n = (double)axis->points;
    for (size_t i = 0; i < axis->points; i++) {
        const double at = position_of(axis, i), window = hann_window(i, axis->points) / n;
        double polynomial[DEGREES];
        for (int p = 0; p < DEGREES; p++)
            polynomial[p] = axis->points == 1 ? (p == 0 ? 1 : 0) : legendre(p, 2 * at / n);
        for (long m = -axis->modes; m <= axis->modes; m++) {
            const complex double mode = cexp(-I * axis->own * (double)m * at) * window;
            for (int p = 0; p < DEGREES; p++)
                axis->trend[(m + axis->modes) * DEGREES + p] += mode * polynomial[p];
        }
        for (long k = -axis->waves; k <= axis->waves; k++) {
            const complex double wave = cexp(I * axis->step * (double)k * at);
            for (int p = 0; p < DEGREES; p++)
                axis->wave[(k + axis->waves) * DEGREES + p] += wave * polynomial[p] / n;
            for (long m = -axis->modes; m <= axis->modes; m++)
                axis->windowed[(k + axis->waves) * (2 * axis->modes + 1) + m + axis->modes] +=
                    wave * window * cexp(-I * axis->own * (double)m * at);
        }
    }
}

/* length and cell: sides of the map and of the cell along the axis; side: the shorter one of the
 * map. */
static int axis_create(struct axis *axis, size_t points, double length, double cell, double side,
                       struct error *err) {
    const bool none = points == 1;
    const double spacing = length / (double)points;
    axis->points = points;
    axis->step = none ? 0 : 2 * M_PI * spacing / cell;
    axis->own = none ? 0 : 2 * M_PI / (double)points;
    axis->waves = none ? 0 : (long)(NEAR * cell / side);
    axis->modes = none ? 0 : (long)(LOW_RINGS * length / side);
    const size_t waves = 2 * (size_t)axis->waves + 1, modes = 2 * (size_t)axis->modes + 1;
    axis->wave = array_create(waves * DEGREES, sizeof *axis->wave);
    axis->windowed = array_create(waves * modes, sizeof *axis->windowed);
    axis->trend = array_create(modes * DEGREES, sizeof *axis->trend);
    if (axis->wave == NULL || axis->windowed == NULL || axis->trend == NULL)
        return error_memory(err, waves * modes * sizeof *axis->windowed, "the waves of a map");
    axis_fill(axis);
    return 0;
}

static void axis_clear(struct axis *axis) {
    free(axis->wave);
    free(axis->windowed);
    free(axis->trend);
}

int like_expectation_create(struct like_expectation **out, const struct map_spectrum *rings,
                            enum detrend kind, const struct grid *cell, struct error *err) {
    const struct grid *grid = &rings->modes.grid;
    const bool profile = grid_is_profile(grid);
    struct like_expectation *e = array_create(1, sizeof *e);
    if (e == NULL)
        return error_memory(err, sizeof *e, "expected spectra");
    e->rings = rings;
    e->cell = *cell;
    e->terms = kind == DETREND_QUADRATIC ? 6 : kind == DETREND_PLANE ? 3 : 1;
    int status = axis_create(&e->x, grid->nx, grid->lx, cell->lx, rings->side, err);
    if (status == 0)
        status = axis_create(&e->y, grid->ny, profile ? rings->side : grid->ly,
                             profile ? rings->side : cell->ly, rings->side, err);
    if (status == 0 && rings->rings > LOW_RINGS)
        status = spectrum_leakage_create(&e->leakage, rings, LOW_RINGS, rings->rings - 1, err);
    if (status == 0)
        *out = e;
    else
        like_expectation_destroy(&e);
    return status;
}

void like_expectation_destroy(struct like_expectation **expectation) {
    struct like_expectation *e = *expectation;
    if (e == NULL)
        return;
    axis_clear(&e->x);
    axis_clear(&e->y);
    if (e->leakage != NULL)
        spectrum_leakage_destroy(&e->leakage);
    free(e);
    *expectation = NULL;
}

/* Returns P(kx, ky) at any signs; 0 where the cell has no such mode. */
static double power_of(const struct modes *modes, long kx, long ky) {
    if (kx < 0) {
        kx = -kx;
        ky = -ky;
    }
    return kx > (long)modes->mode_x || labs(ky) > (long)modes->mode_y
               ? 0
               : modes_power(modes, (size_t)kx, ky);
}

/* A mode of the map under the window. */
struct seen {
    long mx, my;
    size_t ring;
};

/* Returns what a wave of the cell puts into a mode, less its trend, of which it has these
 * coefficients. */
static complex double amplitude(const struct like_expectation *e, long kx, long ky, long mx,
                                long my, const complex double *coefficient) {
    const struct axis *x = &e->x, *y = &e->y;
    complex double total = x->windowed[(kx + x->waves) * (2 * x->modes + 1) + mx + x->modes] *
                           y->windowed[(ky + y->waves) * (2 * y->modes + 1) + my + y->modes];
    for (size_t t = 0; t < e->terms; t++)
        total -= coefficient[t] * x->trend[(mx + x->modes) * DEGREES + TERMS[t].x] *
                 y->trend[(my + y->modes) * DEGREES + TERMS[t].y];
    return total;
}

/* Adds what a wave of the cell, of power 1, puts into the modes. */
static void wave_add(const struct like_expectation *e, const struct seen *seen, size_t count,
                     long kx, long ky, double power, double *density) {
    const struct axis *x = &e->x, *y = &e->y;
    complex double coefficient[sizeof TERMS / sizeof *TERMS];
    for (size_t t = 0; t < e->terms; t++)
        coefficient[t] = x->wave[(kx + x->waves) * DEGREES + TERMS[t].x] *
                         y->wave[(ky + y->waves) * DEGREES + TERMS[t].y];
    const complex double mean = amplitude(e, kx, ky, 0, 0, coefficient) /
                                (x->trend[x->modes * DEGREES] * y->trend[y->modes * DEGREES]);
    for (size_t n = 0; n < count; n++) {
        const complex double in_mode = amplitude(e, kx, ky, seen[n].mx, seen[n].my, coefficient) -
                                       mean * x->trend[(seen[n].mx + x->modes) * DEGREES] *
                                           y->trend[(seen[n].my + y->modes) * DEGREES];
        density[seen[n].ring] +=
            power * (creal(in_mode) * creal(in_mode) + cimag(in_mode) * cimag(in_mode));
    }
}

/* Fills the modes of the rings below LOW_RINGS, one of each pair; returns how many. */
static size_t seen_list(const struct like_expectation *e, struct seen *seen, double *counts) {
    const struct map_spectrum *s = e->rings;
    const struct grid *grid = &s->modes.grid;
    const bool profile = grid_is_profile(grid);
    size_t count = 0;
    for (long mx = 0; mx <= e->x.modes; mx++)
        for (long my = mx > 0 ? -e->y.modes : 1; my <= e->y.modes; my++) {
            size_t r = (size_t)(lay_length(&s->frame, (double)mx * (s->side / grid->lx),
                                           profile ? 0 : (double)my * (s->side / grid->ly)) +
                                0.5);
            if (r >= LOW_RINGS || r >= s->rings)
                continue;
            seen[count++] = (struct seen){mx, my, r};
            counts[r]++;
        }
    return count;
}

static int low_rings(const struct like_expectation *e, const struct modes *modes, double *density,
                     struct error *err) {
    const struct grid *grid = &e->rings->modes.grid;
    const bool profile = grid_is_profile(grid);
    double counts[LOW_RINGS] = {0};
    size_t most = (2 * (size_t)e->x.modes + 1) * (2 * (size_t)e->y.modes + 1);
    struct seen *seen = array_create(most, sizeof *seen);
    if (seen == NULL)
        return error_memory(err, most * sizeof *seen, "the waves of a map");
    size_t count = seen_list(e, seen, counts);
    for (long kx = -e->x.waves; kx <= e->x.waves; kx++)
        for (long ky = -e->y.waves; ky <= e->y.waves; ky++) {
            double power = power_of(modes, kx, ky);
            if (power > 0)
                wave_add(e, seen, count, kx, ky, power, density);
        }
    double cell = profile ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    for (size_t r = 1; r < LOW_RINGS && r < e->rings->rings; r++)
        density[r] *= counts[r] > 0 ? cell / (counts[r] * e->rings->power) : 0;
    free(seen);
    return 0;
}

/* Returns the factor from the density as prescribed to that of the cell. */
static double scale_of(const struct like_expectation *e, const struct modes *modes,
                       const struct spectrum *across) {
    const struct grid *cell = &e->cell;
    const bool profile = grid_is_profile(cell);
    double area = profile ? 2 * M_PI / cell->lx : 4 * M_PI * M_PI / (cell->lx * cell->ly);
    double most = 0, scale = 0;
    for (size_t mx = 1; mx <= modes->mode_x; mx++) { /* along x, where it is greatest */
        double power = modes_power(modes, mx, 0);
        double k = lay_length(&e->rings->frame, 2 * M_PI * (double)mx / cell->lx, 0);
        double prescribed = spectrum_density(across, profile, k);
        if (power > most && prescribed > 0) {
            most = power;
            scale = power / area / prescribed;
        }
    }
    return scale;
}

static int high_rings(const struct like_expectation *e, const struct modes *modes,
                      const struct spectrum *spectrum, double *density, struct error *err) {
    const struct spectrum_leakage *l = e->leakage;
    struct spectrum across = *spectrum;
    across.anisotropy = 0;
    across.lay_angle = 0;
    double scale = scale_of(e, modes, &across);
    double *node = l != NULL ? array_create(l->nodes, sizeof *node) : NULL;
    if (l == NULL)
        return 0;
    if (node == NULL)
        return error_memory(err, l->nodes * sizeof *node, "a spectrum");
    for (size_t n = 0; n < l->nodes; n++)
        node[n] = scale * spectrum_density(&across, grid_is_profile(&e->cell),
                                           2 * M_PI * l->node[n] / e->rings->side);
    spectrum_leakage_apply(l, node, density + l->first);
    free(node);
    return 0;
}

int like_expectation_rings(const struct like_expectation *e, const struct spectrum *spectrum,
                           double *density, struct error *err) {
    struct modes *modes = NULL;
    int status = modes_create(&modes, spectrum, &e->cell, err);
    if (status != 0)
        return status;
    for (size_t r = 0; r < e->rings->rings; r++)
        density[r] = 0;
    status = low_rings(e, modes, density, err);
    if (status == 0)
        status = high_rings(e, modes, spectrum, density, err);
    modes_destroy(&modes);
    return status;
}

/* Returns the share of a wave's mean square that polynomials of one degree along an axis take; the
 * length is in radians. */
static double share_of(int degree, double length) {
    double bessel = gsl_sf_bessel_jl(degree, length / 2);
    return (2 * degree + 1) * bessel * bessel;
}

/* What a wave of the cell has of a sub-map's sums, by axis. */
struct shares {
    double share[DEGREES]; /* that polynomials take of its mean square */
    double slope;          /* mean square of its differences, over the spacing */
};

static struct shares shares_of(double length, double spacing, double k) {
    struct shares out = {.slope = pow(2 * sin(k * spacing / 2) / spacing, 2)};
    for (int p = 0; p < DEGREES; p++)
        out.share[p] = share_of(p, k * length);
    return out;
}

static void waves_add(const struct like_expectation *e, const struct modes *modes,
                      const struct shares *along, const struct shares *across,
                      struct like_waves waves[LIKE_WAVES]) {
    const struct grid *cell = &e->cell;
    const bool profile = grid_is_profile(cell);
    const double longest = 2 * M_PI / (profile ? cell->lx : fmax(cell->lx, cell->ly));
    const size_t rows = 2 * modes->mode_y + 1;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (size_t row = 0; row < rows; row++) {
            const double ky = profile ? 0 : ((double)row - (double)modes->mode_y) / cell->ly;
            double k = 2 * M_PI * lay_length(&e->rings->frame, (double)mx / cell->lx, ky);
            double power = modes_weight(cell, mx) * modes->power[mx * rows + row], share = 0;
            if (!(power > 0))
                continue;
            double at = fmax(log2(k / longest), 0) * LIKE_WAVES_AN_OCTAVE;
            size_t n = at < LIKE_WAVES - 1 ? (size_t)at : LIKE_WAVES - 1;
            for (size_t t = 0; t < e->terms; t++)
                share += along[mx].share[TERMS[t].x] * across[row].share[TERMS[t].y];
            double slope = along[mx].slope + (profile ? 0 : across[row].slope);
            waves[n].wave_number = longest * exp2(((double)n + 0.5) / LIKE_WAVES_AN_OCTAVE);
            waves[n].squares[0] += power * (1 - share);
            waves[n].squares[1] += power * slope;
            waves[n].squares[2] += power * slope * slope / (profile ? 1 : 4);
        }
}

int like_expectation_waves(const struct like_expectation *e, const struct spectrum *spectrum,
                           struct like_waves waves[LIKE_WAVES], struct error *err) {
    const struct grid *grid = &e->rings->modes.grid, *cell = &e->cell;
    struct modes *modes = NULL;
    int status = modes_create(&modes, spectrum, cell, err);
    if (status != 0)
        return status;
    const size_t rows = 2 * modes->mode_y + 1;
    struct shares *along = array_create(modes->mode_x + 1, sizeof *along);
    struct shares *across = array_create(rows, sizeof *across);
    for (size_t n = 0; n < LIKE_WAVES; n++)
        waves[n] = (struct like_waves){0};
    if (along == NULL || across == NULL)
        status = error_memory(err, rows * sizeof *across, "a spectrum");
    else {
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            along[mx] = shares_of(grid->lx, grid_dx(grid), 2 * M_PI * (double)mx / cell->lx);
        for (size_t row = 0; row < rows; row++)
            across[row] =
                shares_of(grid->ly, grid_dx(grid),
                          2 * M_PI * fabs((double)row - (double)modes->mode_y) / cell->ly);
        waves_add(e, modes, along, across, waves);
    }
    free(along);
    free(across);
    modes_destroy(&modes);
    return status;
}
