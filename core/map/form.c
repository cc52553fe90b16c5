#include "core/map/form.h"
#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_bessel.h>
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEVEL = 1e-4, LEAST = 1e-9; /* of p-values; of the RMS height, not rounding */
/* Cells across a map, along a profile; waves a side to which the law is fitted. */
enum {
    CELLS = 64,
    PROFILE_CELLS = 256,
    LAST = 16,
    PROFILE_LAST = 64,
    LEAST_POINTS = 32,
    OBLONG = 16
};

/* --- cells --- */

struct cells {
    struct grid grid;
    double *z, *rest; /* owned, one block: means about a plane, and about a quadratic form */
};

static double mean_of(const struct measured_map *map, size_t i, size_t j, size_t points,
                      size_t rows) {
    const size_t nx = map->grid->nx;
    double total = 0;
    size_t count = 0;
    for (size_t y = j * points; y < j * points + rows; y++)
        for (size_t x = i * points; x < (i + 1) * points; x++)
            if (!isnan(map->z[y * nx + x])) {
                total += map->z[y * nx + x];
                count++;
            }
    return 2 * count >= points * rows ? total / (double)count : (double)NAN;
}

/* Fills means over square cells of so many points. */
static int cells_fill(struct cells *out, const struct measured_map *map, struct error *err) {
    const struct grid *grid = map->grid;
    const bool profile = grid_is_profile(grid);
    const size_t side = profile || grid->nx < grid->ny ? grid->nx : grid->ny;
    const size_t cells = profile ? PROFILE_CELLS : CELLS;
    const size_t points = (side + cells - 1) / cells;
    out->grid.nx = grid->nx / points;
    out->grid.ny = profile ? 1 : grid->ny / points;
    out->grid.lx = grid_dx(grid) * (double)(points * out->grid.nx);
    out->grid.ly = profile ? out->grid.lx : grid_dy(grid) * (double)(points * out->grid.ny);
    const size_t count = grid_points(&out->grid);
    out->z = array_create(count, 2 * sizeof *out->z);
    if (out->z == NULL)
        return error_memory(err, 2 * count * sizeof *out->z, "cells of a map");
    out->rest = out->z + count;
    for (size_t j = 0; j < out->grid.ny; j++)
        for (size_t i = 0; i < out->grid.nx; i++)
            out->z[j * out->grid.nx + i] = mean_of(map, i, j, points, profile ? 1 : points);
    return 0;
}

/* Takes out both trends; false where the heights do not determine them. */
static bool cells_detrend(struct cells *cells) {
    struct trend trend;
    struct error unused;
    if (detrend(&cells->grid, cells->z, DETREND_PLANE, &trend, &unused) != 0)
        return false;
    memcpy(cells->rest, cells->z, grid_points(&cells->grid) * sizeof *cells->z);
    return detrend(&cells->grid, cells->rest, DETREND_QUADRATIC, &trend, &unused) == 0;
}

/* Returns the mean square of what is between both, and that about the plane. */
static double form_square(const struct cells *cells, double *whole) {
    double form = 0, count = 0;
    *whole = 0;
    for (size_t p = 0; p < grid_points(&cells->grid); p++)
        if (!isnan(cells->z[p])) {
            form += pow(cells->z[p] - cells->rest[p], 2);
            *whole += cells->z[p] * cells->z[p];
            count++;
        }
    *whole /= count;
    return form / count;
}

/* --- what a surface has --- */

/* The density is level from a roll-off on, and that of a power before; NaN: there is no roll-off.
 */
struct long_waves {
    double density, wavelength; /* at it */
    double fall, rolloff;
};

static double density_at(const struct long_waves *waves, double k) {
    const double at = isnan(waves->rolloff) ? k : fmax(k, 2 * M_PI / waves->rolloff);
    return waves->density * pow(at * waves->wavelength / (2 * M_PI), -waves->fall);
}

enum { STEPS_A_WAVE = 8, WAVES = 8 }; /* of the sum over waves */
/* Of a form, and the highest of the terms beside it. */
enum { FORM_DEGREE = 2, DEGREE = 5, PROFILE_DEGREE = 12, DEGREES = PROFILE_DEGREE + 1 };
/* Degrees of freedom of what the law has; a trial of F18.62 shows that p-values hold with it. */
static const double OF_LAW = 12;
/* Products of Legendre's polynomials along x and y whose degrees add up to `degree`. */
static size_t terms_of(bool profile, int degree) {
    return profile ? 1 : (size_t)degree + 1;
}

/* Fills shares of a wave's mean square that polynomials take along an axis (F18.38). */
static void shares_fill(size_t count, double (*share)[DEGREES]) {
    for (size_t n = 0; n < count; n++)
        for (int p = 0; p < DEGREES; p++) {
            const double bessel = gsl_sf_bessel_jl(p, M_PI * ((double)n + 0.5) / STEPS_A_WAVE);
            share[n][p] = (2 * p + 1) * bessel * bessel;
        }
}

/* Mean squares of the terms of each degree. */
struct squares {
    double of[DEGREES][DEGREES];
};

/* Adds what a wave puts into the terms. */
static void power_add(struct squares *out, bool profile, int most, double power,
                      const double along_x[DEGREES], const double along_y[DEGREES]) {
    for (int degree = FORM_DEGREE; degree <= most; degree++)
        for (size_t t = 0; t < terms_of(profile, degree); t++)
            out->of[degree][t] += power * along_x[(size_t)degree - t] * (profile ? 1 : along_y[t]);
}

static int expect(const struct grid *grid, const struct long_waves *waves, int most,
                  struct squares *out, struct error *err) {
    const bool profile = grid_is_profile(grid);
    const double side = profile ? grid->lx : fmin(grid->lx, grid->ly);
    const double ly = profile ? side : grid->ly;
    const size_t nx = (size_t)(STEPS_A_WAVE * WAVES * grid->lx / side);
    const size_t ny = (size_t)(STEPS_A_WAVE * WAVES * ly / side);
    double(*share)[DEGREES] = array_create(nx + ny, sizeof *share);
    *out = (struct squares){{{0}}};
    if (share == NULL)
        return error_memory(err, (nx + ny) * sizeof *share, "the form of a surface");
    shares_fill(nx, share);
    shares_fill(ny, share + nx);
    const double step_x = 2 * M_PI / grid->lx / STEPS_A_WAVE;
    const double step_y = profile ? 0 : 2 * M_PI / ly / STEPS_A_WAVE;
    const double cell = 2 * step_x * (profile ? 1 : 2 * step_y); /* both signs */
    for (size_t a = 0; a < nx; a++)
        for (size_t b = 0; b < (profile ? 1 : ny); b++) {
            const double k = hypot(((double)a + 0.5) * step_x, ((double)b + 0.5) * step_y);
            power_add(out, profile, most, cell * density_at(waves, k), share[a], share[nx + b]);
        }
    free(share);
    return 0;
}

static double legendre(int degree, double x) {
    return sqrt(2 * degree + 1) * gsl_sf_legendre_Pl(degree, x);
}

/* Returns the mean square of a term in the rest. */
static double term_square(const struct cells *cells, int along_x, int along_y) {
    const struct grid *grid = &cells->grid;
    double sum = 0, count = 0;
    for (size_t j = 0; j < grid->ny; j++) {
        const double y = legendre(along_y, (2 * (double)j + 1) / (double)grid->ny - 1);
        for (size_t i = 0; i < grid->nx; i++)
            if (!isnan(cells->rest[j * grid->nx + i])) {
                sum += cells->rest[j * grid->nx + i] * y *
                       legendre(along_x, (2 * (double)i + 1) / (double)grid->nx - 1);
                count++;
            }
    }
    return sum * sum / (count * count);
}

/* The p-value of the form beside a mean square that is known with so many degrees of freedom. */
static void judge_beside(struct map_form *out, const struct squares *squares, bool profile,
                         double form, double factor, double known) {
    double sum = 0, sum_of_squares = 0;
    for (size_t t = 0; t < terms_of(profile, FORM_DEGREE); t++) {
        sum += squares->of[FORM_DEGREE][t];
        sum_of_squares += squares->of[FORM_DEGREE][t] * squares->of[FORM_DEGREE][t];
    }
    const double p_value =
        gsl_cdf_fdist_Q(form / (factor * sum), sum * sum / sum_of_squares, known);
    if (!(p_value >= out->p_value)) {
        out->p_value = p_value;
        out->expected = sqrt(factor * sum);
    }
}

/* Returns the mean square of the terms of higher degrees over that of the law; *terms: of how many.
 */
static double measure_terms(const struct cells *cells, const struct squares *squares, int most,
                            double *terms) {
    const bool profile = grid_is_profile(&cells->grid);
    double ratio = 0;
    *terms = 0;
    for (int degree = FORM_DEGREE + 1; degree <= most; degree++)
        for (size_t t = 0; t < terms_of(profile, degree); t++) {
            ratio += term_square(cells, degree - (int)t, (int)t) / squares->of[degree][t];
            *terms += 1;
        }
    return ratio / *terms;
}

static int fit(const struct cells *cells, struct long_waves *out, struct error *err) {
    const struct measured_map rest = {&cells->grid, cells->rest, BOUNDARY_OPEN};
    const bool profile = grid_is_profile(&cells->grid);
    struct map_spectrum *rings = NULL;
    struct spectrum_fit law = {.fitted = false};
    int status = map_spectrum_create(&rings, &rest, err);
    if (status == 0) {
        const struct spectrum_fit_request request = {.shortest = rings->side /
                                                                 (profile ? PROFILE_LAST : LAST)};
        status = spectrum_fit_measure(rings, &request, &law, err);
    }
    map_spectrum_destroy(&rings);
    *out = (struct long_waves){1, 1, profile ? 3 : 4, (double)NAN};
    if (status == 0 && law.fitted)
        *out = (struct long_waves){
            law.amplitude.value, law.reference_wavelength, (profile ? 1 : 2) + 2 * law.hurst.value,
            isnan(law.rolloff_wavelength.value) ? (double)NAN : law.rolloff_wavelength.high};
    return status;
}

static int judge(struct map_form *out, const struct cells *cells, double form, struct error *err) {
    const bool profile = grid_is_profile(&cells->grid);
    const int most = profile ? PROFILE_DEGREE : DEGREE;
    struct long_waves waves;
    struct squares squares;
    double terms;
    int status = fit(cells, &waves, err);
    if (status == 0)
        status = expect(&cells->grid, &waves, most, &squares, err);
    if (status != 0)
        return status;
    out->height = sqrt(form);
    judge_beside(out, &squares, profile, form, 1, OF_LAW);
    const double factor = measure_terms(cells, &squares, most, &terms);
    judge_beside(out, &squares, profile, form, factor, terms);
    out->p_value = fmin(2 * out->p_value, 1); /* the less of two */
    return 0;
}

int map_form_find(struct map_form *out, const struct measured_map *map, struct error *err) {
    const struct grid *grid = map->grid;
    const double none = (double)NAN;
    struct cells cells = {0};
    double whole;
    *out = (struct map_form){none, none, none, none};
    const size_t ny = grid_is_profile(grid) ? grid->nx : grid->ny;
    const size_t least = grid->nx < ny ? grid->nx : ny, most = grid->nx < ny ? ny : grid->nx;
    if (map->boundary != BOUNDARY_OPEN || least < LEAST_POINTS || most > OBLONG * least)
        return 0;
    int status = cells_fill(&cells, map, err);
    if (status == 0 && cells_detrend(&cells)) {
        const double form = form_square(&cells, &whole);
        if (form > LEAST * LEAST * whole && whole > form)
            status = judge(out, &cells, form, err);
        out->share = form / whole;
    }
    free(cells.z);
    return status;
}

bool map_form_found(const struct map_form *form) {
    return form->p_value < LEVEL;
}
