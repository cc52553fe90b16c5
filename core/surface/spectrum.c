#include "core/surface/spectrum.h"
#include "core/sum.h"
#include "core/surface/counter_face.h"
#include "core/surface/plateau_face.h"
#include "core/surface/spectrum_density.h"
#include "core/surface/transform.h"
#include "core/surface/translation/translation.h"
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>

static const double TWO_PI = 6.283185307179586;

enum { STEPS = 200 }; /* midpoints of the integrals over log k */

/* Returns the radial density at k > 0 in any scale (F2.1, F2.2). */
static double radial_density(const struct spectrum *spectrum, int dimension, double k) {
    double exponent = dimension;
    if (spectrum->type == SPECTRUM_SELF_AFFINE)
        return pow(fmax(1, k * spectrum->wavelength_rolloff / TWO_PI),
                   -(2 * spectrum->hurst + exponent));
    if (spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        return pow(1 + k * k * spectrum->correlation_x * spectrum->correlation_y,
                   -(1 + exponent) / 2);
    return 1;
}

/* The means of cos^2 and cos^4 over directions give m2 and m4 of plane sections from the radial
 * moments of a surface. */
double spectrum_expected_summits(const struct spectrum *spectrum, const struct grid *grid,
                                 double long_waves, double short_waves, double *alpha) {
    int dimension = grid_is_profile(grid) ? 1 : 2;
    double section2 = dimension == 2 ? 1.0 / 2 : 1, section4 = dimension == 2 ? 3.0 / 8 : 1;
    double low = TWO_PI * long_waves / grid->lx, high = TWO_PI * short_waves / grid->lx;
    double step = log(fmax(high / low, 1 + 1e-6)) / STEPS, m0 = 0, m2 = 0, m4 = 0;
    for (int a = 0; a < STEPS; a++) {
        double k = low * exp((a + 0.5) * step);
        double power = radial_density(spectrum, dimension, k) * pow(k, dimension);
        m0 += power;
        m2 += power * k * k * section2;
        m4 += power * k * k * k * k * section4;
    }
    *alpha = m0 * m4 / (m2 * m2);
    if (dimension == 1)
        return grid->lx * sqrt(m4 / m2) / TWO_PI;
    return grid->lx * grid->ly * m4 / m2 / (3 * sqrt(3) * TWO_PI);
}

/* The rounding error of a transform is below this share of R(0); smaller powers, of either sign,
 * become 0. */
static const double ROUNDING = 1e-17;

static double shorter_way(size_t i, size_t points) {
    return (double)(2 * i <= points ? i : points - i);
}

double exponential_correlation(const struct spectrum *spectrum, const struct grid *grid, size_t i,
                               size_t j) {
    double x = shorter_way(i, grid->nx) * grid_dx(grid) / spectrum->correlation_x;
    if (grid_is_profile(grid))
        return exp(-x);
    return exp(-hypot(x, shorter_way(j, grid->ny) * grid_dy(grid) / spectrum->correlation_y));
}

static void powers_take(struct modes *modes, const double complex *mode) {
    const struct grid *grid = &modes->grid;
    size_t rows = 2 * modes->mode_y + 1;
    struct sum positive = {0, 0}, negative = {0, 0};
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (size_t row = 0; row < grid->ny; row++, mode++) {
            size_t at = row <= modes->mode_y ? row + modes->mode_y : row + modes->mode_y - grid->ny;
            double power = creal(*mode), weight = modes_weight(grid, mx);
            if ((mx == 0 && row == 0) || fabs(power) <= ROUNDING)
                continue;
            sum_add(power > 0 ? &positive : &negative, weight * fabs(power));
            if (power < 0)
                continue;
            modes->power[mx * rows + at] = power;
            modes->count += modes_weight(grid, mx);
        }
    double all = sum_value(&positive) + sum_value(&negative);
    modes->clipped = all > 0 ? sum_value(&negative) / all : 0;
}

/* Of the surface, or of the Gaussian field that it is translated from. */
static double field_correlation(const struct spectrum *spectrum, const struct grid *grid, size_t i,
                                size_t j) {
    double asked = exponential_correlation(spectrum, grid, i, j);
    if (spectrum->translation == NULL)
        return asked;
    return hermite_gaussian_correlation(
        height_function_powers(translation_function(spectrum->translation)), asked);
}

int exponential_fill(struct modes *modes, const struct spectrum *spectrum, struct error *err) {
    const struct grid *grid = &modes->grid;
    struct transform *transform = NULL;
    double *field = fftw_alloc_real(grid_points(grid));
    if (field == NULL)
        return error_memory(err, grid_points(grid) * sizeof *field, "an autocorrelation");
    int status = transform_create(&transform, grid, modes->mode_x, modes->mode_y, err);
    if (status == 0) {
        for (size_t j = 0; j < grid->ny; j++)
            for (size_t i = 0; i < grid->nx; i++)
                field[j * grid->nx + i] = field_correlation(spectrum, grid, i, j);
        transform_forward(transform, field);
        powers_take(modes, transform_spectrum(transform));
    }
    transform_destroy(&transform);
    fftw_free(field);
    return status;
}

static int refuse(struct error *err, const char *what, double value, const char *allowed) {
    return error_set(err, ERROR_INPUT, "%s = %g; allowed: %s", what, value, allowed);
}

static bool is_length(double value) {
    return value > 0 && isfinite(value);
}

static int self_affine_check(const struct spectrum *s, struct error *err) {
    if (!(s->hurst >= 0 && s->hurst <= 1))
        return refuse(err, "hurst", s->hurst, "0 to 1");
    if (!(s->anisotropy >= 0 && isfinite(s->anisotropy)))
        return refuse(err, "anisotropy", s->anisotropy, "above 0, finite; 0 is as 1");
    if (!isfinite(s->lay_angle))
        return refuse(err, "angle of the lay", s->lay_angle, "finite, in radians");
    if (!is_length(s->wavelength_long))
        return refuse(err, "longest wavelength", s->wavelength_long, "above 0, finite");
    if (!is_length(s->wavelength_short) ||
        s->wavelength_short > s->wavelength_long * (1 + BAND_EDGE))
        return refuse(err, "shortest wavelength", s->wavelength_short,
                      "above 0, up to the longest wavelength");
    if (!(s->wavelength_rolloff >= s->wavelength_short * (1 - BAND_EDGE) &&
          s->wavelength_rolloff <= s->wavelength_long * (1 + BAND_EDGE)))
        return refuse(err, "roll-off wavelength", s->wavelength_rolloff,
                      "from the shortest to the longest wavelength");
    return 0;
}

static int table_check(const struct spectrum *s, struct error *err) {
    if (s->table_count < 2)
        return error_set(err, ERROR_INPUT, "a spectrum table of %zu rows; allowed: at least 2",
                         s->table_count);
    for (size_t row = 0; row < s->table_count; row++) {
        double before = row != 0 ? s->table_wave_number[row - 1] : 0;
        if (!(s->table_wave_number[row] > before && isfinite(s->table_wave_number[row])))
            return error_set(err, ERROR_INPUT,
                             "wave number %zu of the spectrum table = %g; allowed: rising, above 0",
                             row, s->table_wave_number[row]);
        if (!(s->table_density[row] >= 0 && isfinite(s->table_density[row])))
            return error_set(err, ERROR_INPUT,
                             "density %zu of the spectrum table = %g; allowed: 0 or more, finite",
                             row, s->table_density[row]);
    }
    return 0;
}

static int spectrum_check(const struct spectrum *s, const struct grid *grid, struct error *err) {
    if (s->scale != SCALE_NONE && !is_length(s->scale_value))
        return refuse(err, s->scale == SCALE_RMS_SLOPE ? "RMS slope" : "RMS height", s->scale_value,
                      "above 0, finite");
    switch (s->type) {
    case SPECTRUM_SELF_AFFINE:
        return self_affine_check(s, err);
    case SPECTRUM_EXPONENTIAL_ACF:
        if (!is_length(s->correlation_x))
            return refuse(err, "correlation length x", s->correlation_x, "above 0, finite");
        if (!grid_is_profile(grid) && !is_length(s->correlation_y))
            return refuse(err, "correlation length y", s->correlation_y, "above 0, finite");
        return 0;
    case SPECTRUM_TABLE:
        return table_check(s, err);
    }
    return error_set(err, ERROR_INPUT, "spectrum type %d is unknown", (int)s->type);
}

static double density(const struct spectrum *s, bool profile, double kx, double ky) {
    double along = kx, across = ky;
    if (s->lay_angle != 0) {
        along = kx * cos(s->lay_angle) + ky * sin(s->lay_angle);
        across = ky * cos(s->lay_angle) - kx * sin(s->lay_angle);
    }
    double x = s->anisotropy > 0 ? along * s->anisotropy : along;
    double k = profile ? fabs(kx) : hypot(x, across);
    double asked = spectrum_density(s, profile, k);
    return s->translation != NULL ? asked * translation_factor(s->translation, k) : asked;
}

/* Returns how many times as long the waves along a side are at least as the shortest of all, where
 * this side has an angle to the lay. */
static double shortest_along(const struct spectrum *s, double angle) {
    double ratio = s->anisotropy > 0 ? s->anisotropy : 1;
    return angle == 0 ? ratio : 1 / hypot(cos(angle) / ratio, sin(angle));
}

/* Returns the highest wave number of the band along a side of `length`; infinite for a spectrum
 * without a band. anisotropy: of the longest wave of the band's edge along this side. */
static double band_edge(const struct spectrum *s, double length, double anisotropy) {
    if (s->type == SPECTRUM_SELF_AFFINE)
        return floor(length / (s->wavelength_short * anisotropy) * (1 + BAND_EDGE));
    if (s->type == SPECTRUM_TABLE)
        return floor(s->table_wave_number[s->table_count - 1] * length / (2 * M_PI * anisotropy) *
                     (1 + BAND_EDGE));
    return INFINITY;
}

static double band_edge_x(const struct spectrum *s, bool profile, double lx) {
    return band_edge(s, lx, profile ? 1 : shortest_along(s, s->lay_angle));
}

static double band_edge_y(const struct spectrum *s, bool profile, double ly) {
    if (profile)
        return 0;
    return band_edge(s, ly, s->lay_angle != 0 ? shortest_along(s, M_PI / 2 - s->lay_angle) : 1);
}

/* Finds the highest wave number along a side of `length` with `points`: the band's edge, or Nyquist
 * for a spectrum without one. */
static int resolved_edge(double edge, double length, size_t points, size_t *mode,
                         struct error *err) {
    size_t nyquist = points / 2;
    if (isinf(edge))
        edge = (double)nyquist;
    if (edge > (double)nyquist)
        return error_set(
            err, ERROR_INPUT,
            "%zu points on a side of %g do not resolve the shortest of its %.0f waves; "
            "allowed: at least 2 points a wave",
            points, length, edge);
    *mode = (size_t)edge;
    return 0;
}

/* Returns the density of the wave with mx waves along x and my along y. */
static double wave_density(const struct spectrum *s, const struct grid *grid, size_t mx, long my) {
    const bool profile = grid_is_profile(grid);
    double kx = 2 * M_PI * (double)mx / grid->lx;
    double ky = profile ? 0 : 2 * M_PI * (double)my / grid->ly;
    return density(s, profile, kx, ky);
}

bool spectrum_has_mode(const struct spectrum *spectrum, const struct grid *grid) {
    if (spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        return true;
    const bool profile = grid_is_profile(grid);
    const double edge_x = band_edge_x(spectrum, profile, grid->lx);
    const double edge_y = band_edge_y(spectrum, profile, grid->ly);
    for (size_t mx = 0; (double)mx <= edge_x; mx++)
        for (long my = -(long)edge_y; (double)my <= edge_y; my++)
            if (wave_density(spectrum, grid, mx, my) > 0)
                return true;
    return false;
}

/* Returns the density of a mode. One with as many waves as half of the points is also its mirror
 * image, of which an oblique lay makes another. */
static double mode_density(const struct grid *grid, const struct spectrum *s, size_t mx, long my) {
    double own = wave_density(s, grid, mx, my);
    return modes_twin(grid, mx, my) && s->lay_angle != 0
               ? (own + wave_density(s, grid, mx, -my)) / 2
               : own;
}

static void modes_fill(struct modes *modes, const struct spectrum *s) {
    const struct grid *grid = &modes->grid;
    long mode_y = (long)modes->mode_y;
    double *power = modes->power;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -mode_y; my <= mode_y; my++, power++) {
            bool twin = my < 0 && 2 * (size_t)-my == grid->ny;
            if ((mx == 0 && my == 0) || twin)
                continue;
            *power = mode_density(grid, s, mx, my);
            if (*power > 0)
                modes->count += modes_weight(grid, mx);
        }
}

/* Returns the square of the factor that gives heights of these moments their prescribed scale. */
static double scale_square(const struct spectrum *s, const struct moments *moments) {
    double factor = 1 / moments->m00;
    if (s->scale == SCALE_RMS_HEIGHT)
        factor = s->scale_value / moments->rms_height * (s->scale_value / moments->rms_height);
    if (s->scale == SCALE_RMS_SLOPE)
        factor = s->scale_value / moments->rms_slope * (s->scale_value / moments->rms_slope);
    return factor;
}

static void powers_multiply(struct modes *modes, double factor) {
    size_t count = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    for (size_t i = 0; i < count; i++)
        modes->power[i] *= factor;
}

static int modes_scale(struct modes *modes, const struct spectrum *s, struct error *err) {
    struct moments moments;
    modes_gaussian_moments(modes, &moments);
    if (modes->count == 0 || !(moments.m00 > 0 && isfinite(moments.m00)))
        return error_set(err, ERROR_INPUT, "the spectrum has no mode on a cell of %g by %g",
                         modes->grid.lx, modes->grid.ly);
    modes->translation = s->translation;
    if (s->translation == NULL) {
        powers_multiply(modes, scale_square(s, &moments));
        return 0;
    }
    powers_multiply(modes, 1 / moments.m00);
    modes->height = 1;
    modes_moments(modes, &moments);
    modes->height = sqrt(scale_square(s, &moments));
    return 0;
}

/* Makes the modes of the first face. */
static int face_modes_create(struct modes **out, const struct spectrum *spectrum,
                             const struct grid *grid, struct error *err) {
    int status = grid_check(grid, err);
    if (status == 0)
        status = spectrum_check(spectrum, grid, err);
    if (status != 0)
        return status;
    struct modes *modes = array_create(1, sizeof *modes);
    if (modes == NULL)
        return error_memory(err, sizeof *modes, "a discrete spectrum");
    modes->grid = *grid;
    const bool profile = grid_is_profile(grid);
    status = resolved_edge(band_edge_x(spectrum, profile, grid->lx), grid->lx, grid->nx,
                           &modes->mode_x, err);
    if (status == 0)
        status = resolved_edge(band_edge_y(spectrum, profile, grid->ly), grid->ly, grid->ny,
                               &modes->mode_y, err);
    if (status == 0) {
        size_t count = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
        modes->power = array_create(count, sizeof *modes->power);
        if (modes->power == NULL)
            status = error_memory(err, count * sizeof *modes->power, "a discrete spectrum");
    }
    if (status == 0 && spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        status = exponential_fill(modes, spectrum, err);
    else if (status == 0)
        modes_fill(modes, spectrum);
    if (status == 0)
        status = modes_scale(modes, spectrum, err);
    if (status != 0) {
        modes_destroy(&modes);
        return status;
    }
    *out = modes;
    return 0;
}

static void powers_add(struct modes *sum, const struct modes *face, double weight) {
    long mode_y = (long)face->mode_y;
    size_t rows = 2 * sum->mode_y + 1;
    for (size_t mx = 0; mx <= face->mode_x; mx++)
        for (long my = -mode_y; my <= mode_y; my++)
            sum->power[mx * rows + (size_t)(my + (long)sum->mode_y)] +=
                weight * modes_power(face, mx, my);
}

static double power_of(const struct modes *modes) {
    struct moments moments;
    modes_moments(modes, &moments);
    return moments.m00;
}

/* Makes the modes of a weighted sum of two faces on the same grid. */
static int modes_add(struct modes **out, const struct modes *one, double weight,
                     const struct modes *other, double other_weight, struct error *err) {
    struct modes *sum = array_create(1, sizeof *sum);
    if (sum == NULL)
        return error_memory(err, sizeof *sum, "a discrete spectrum");
    *sum = (struct modes){.grid = one->grid};
    sum->mode_x = one->mode_x > other->mode_x ? one->mode_x : other->mode_x;
    sum->mode_y = one->mode_y > other->mode_y ? one->mode_y : other->mode_y;
    size_t rows = 2 * sum->mode_y + 1, count = (sum->mode_x + 1) * rows;
    sum->power = array_create(count, sizeof *sum->power);
    if (sum->power == NULL) {
        modes_destroy(&sum);
        return error_memory(err, count * sizeof(double), "a discrete spectrum");
    }
    powers_add(sum, one, weight);
    powers_add(sum, other, other_weight);
    for (size_t a = 0; a < count; a++)
        if (sum->power[a] > 0)
            sum->count += modes_weight(&sum->grid, a / rows);
    double power = weight * power_of(one), more = other_weight * power_of(other);
    sum->clipped = (one->clipped * power + other->clipped * more) / (power + more);
    *out = sum;
    return 0;
}

struct spectrum plateau_spectrum(const struct spectrum *valleys, double rms_height) {
    struct spectrum spectrum = valleys->plateau->spectrum;
    spectrum.scale = SCALE_RMS_HEIGHT;
    spectrum.scale_value = valleys->plateau->rms_ratio * rms_height;
    return spectrum;
}

/* Makes the modes of a stratified face. */
static int stratified_modes_create(struct modes **out, const struct spectrum *spectrum,
                                   const struct grid *grid, struct error *err) {
    struct modes *valleys = NULL, *plateau = NULL;
    if (spectrum->translation != NULL || spectrum->counter != NULL ||
        spectrum->plateau->spectrum.translation != NULL ||
        spectrum->plateau->spectrum.counter != NULL || spectrum->plateau->spectrum.plateau != NULL)
        return error_set(err, ERROR_INPUT,
                         "a stratified face with a translated surface, or a third one; allowed: "
                         "two that are not translated");
    int status = face_modes_create(&valleys, spectrum, grid, err);
    if (status != 0)
        return status;
    const double rms = sqrt(power_of(valleys));
    const struct spectrum second = plateau_spectrum(spectrum, rms);
    const struct stratified_heights heights =
        stratified_heights_of(rms, second.scale_value, spectrum->plateau->offset * rms);
    status = face_modes_create(&plateau, &second, grid, err);
    if (status == 0)
        status =
            modes_add(out, valleys, heights.valley_share, plateau, 1 - heights.valley_share, err);
    if (status == 0) {
        (*out)->stratified = true;
        (*out)->height = heights.deviation;
    }
    modes_destroy(&valleys);
    modes_destroy(&plateau);
    return status;
}

int modes_create(struct modes **out, const struct spectrum *spectrum, const struct grid *grid,
                 struct error *err) {
    if (spectrum->plateau != NULL)
        return stratified_modes_create(out, spectrum, grid, err);
    if (spectrum->counter == NULL)
        return face_modes_create(out, spectrum, grid, err);
    const struct spectrum *counter = &spectrum->counter->spectrum;
    struct modes *one = NULL, *other = NULL;
    if (spectrum->translation != NULL || counter->translation != NULL || counter->counter != NULL ||
        counter->plateau != NULL)
        return error_set(err, ERROR_INPUT,
                         "two faces with a translated one, or a third one; allowed: two that are "
                         "not translated");
    int status = face_modes_create(&one, spectrum, grid, err);
    if (status == 0)
        status = face_modes_create(&other, counter, grid, err);
    if (status == 0)
        status = modes_add(out, one, 1, other, 1, err);
    modes_destroy(&one);
    modes_destroy(&other);
    return status;
}

void modes_destroy(struct modes **modes) {
    if (*modes == NULL)
        return;
    free((*modes)->power);
    free(*modes);
    *modes = NULL;
}

/* The moments weight the power by kx^p ky^q; powers stand in the order of their fields. */
static const unsigned char POWERS[][2] = {{0, 0}, {2, 0}, {0, 2}, {1, 1}, {2, 2},
                                          {4, 0}, {0, 4}, {3, 1}, {1, 3}};
enum { MOMENTS = sizeof POWERS / sizeof *POWERS };

void modes_gaussian_moments(const struct modes *modes, struct moments *out) {
    const struct grid *grid = &modes->grid;
    struct sum sums[MOMENTS] = {{0}};
    long mode_y = (long)modes->mode_y;
    bool profile = grid_is_profile(grid);
    const double *power = modes->power;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -mode_y; my <= mode_y; my++, power++) {
            if (*power == 0)
                continue;
            double weighted = *power * modes_weight(grid, mx);
            double kx = 2 * M_PI * (double)mx / grid->lx;
            double ky = profile ? 0 : 2 * M_PI * (double)my / grid->ly;
            bool twin = modes_twin(grid, mx, my);
            double x[5] = {1, kx, kx * kx, kx * kx * kx, kx * kx * kx * kx};
            double y[5] = {1, ky, ky * ky, ky * ky * ky, ky * ky * ky * ky};
            for (size_t s = 0; s < MOMENTS; s++)
                if (!twin || POWERS[s][0] % 2 == 0)
                    sum_add(&sums[s], weighted * x[POWERS[s][0]] * y[POWERS[s][1]]);
        }
    double m[MOMENTS];
    for (size_t s = 0; s < MOMENTS; s++)
        m[s] = sum_value(&sums[s]);
    *out = (struct moments){.m00 = m[0],
                            .m20 = m[1],
                            .m02 = m[2],
                            .m11 = m[3],
                            .m22 = m[4],
                            .m40 = m[5],
                            .m04 = m[6],
                            .m31 = m[7],
                            .m13 = m[8]};
    moments_derive(out, profile);
}

void modes_moments(const struct modes *modes, struct moments *out) {
    modes_gaussian_moments(modes, out);
    if (modes->translation != NULL)
        *out = translation_moments(modes->translation, out, modes->height);
    if (modes->stratified) {
        out->m00 = modes->height * modes->height;
        moments_derive(out, grid_is_profile(&modes->grid));
    }
}

int spectrum_moments(const struct spectrum *spectrum, const struct grid *grid, struct moments *out,
                     struct error *err) {
    struct modes *modes = NULL;
    int status = modes_create(&modes, spectrum, grid, err);
    if (status == 0)
        modes_moments(modes, out);
    modes_destroy(&modes);
    return status;
}
