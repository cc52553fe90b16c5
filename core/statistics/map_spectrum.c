#include "core/statistics/map_spectrum.h"
#include "core/statistics/ring_modes.h"
#include "core/statistics/roughness.h"
#include "core/statistics/windowed_psd.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>

static int arrays_create(struct map_spectrum *s, struct error *err) {
    s->wave_number = array_create(s->bins, sizeof *s->wave_number);
    s->density = array_create(s->bins, sizeof *s->density);
    s->freedom = array_create(s->bins, sizeof *s->freedom);
    s->covariance = array_create(s->bins, sizeof *s->covariance);
    s->share = array_create(s->bins, sizeof *s->share);
    s->distance = array_create(s->bins, sizeof *s->distance);
    return s->wave_number != NULL && s->density != NULL && s->freedom != NULL &&
                   s->covariance != NULL && s->share != NULL && s->distance != NULL
               ? 0
               : error_memory(err, s->bins * sizeof *s->covariance, "rings of a spectrum");
}

static int modes_fill(struct map_spectrum *s, const struct measured_map *map, struct error *err) {
    if (!s->windowed)
        return map_modes_measure(map->grid, map->z, &s->modes, err);
    double *z = array_create(grid_points(map->grid), sizeof *z);
    if (z == NULL)
        return error_memory(err, grid_points(map->grid) * sizeof *z, "a map under a window");
    int status = windowed_heights(map, z, &s->power, err);
    if (status == 0)
        status = map_modes_measure(map->grid, z, &s->modes, err);
    free(z);
    return status;
}

/* Returns the share of the points of a map that are no holes. */
static double heights_share(const struct measured_map *map) {
    size_t points = grid_points(map->grid), there = 0;
    for (size_t point = 0; point < points; point++)
        there += isnan(map->z[point]) ? 0 : 1;
    return (double)there / (double)points;
}

static int check_holes(const struct measured_map *map, double share, struct error *err) {
    return share < 1 && map->boundary == BOUNDARY_PERIODIC
               ? error_set(err, ERROR_INPUT, "a periodic map with holes has no spectrum")
               : 0;
}

int map_spectrum_create(struct map_spectrum **out, const struct measured_map *map,
                        struct error *err) {
    const struct grid *grid = map->grid;
    double share = heights_share(map);
    int status = check_holes(map, share, err);
    if (status != 0)
        return status;
    struct map_spectrum *s = array_create(1, sizeof *s);
    if (s == NULL)
        return error_memory(err, sizeof *s, "a spectrum");
    s->windowed = map->boundary == BOUNDARY_OPEN;
    s->power = 1;
    s->side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    s->bins = radial_bins(grid);
    status = arrays_create(s, err);
    if (status == 0)
        status = modes_fill(s, map, err);
    if (status == 0) {
        psd_of_modes(&s->modes, s->wave_number, s->density);
        for (size_t r = 0; r < s->bins; r++)
            s->density[r] /= s->power;
        status = ring_modes_measure(s, share, err);
    }
    if (status == 0)
        *out = s;
    else
        map_spectrum_destroy(&s);
    return status;
}

void map_spectrum_destroy(struct map_spectrum **spectrum) {
    struct map_spectrum *s = *spectrum;
    if (s == NULL)
        return;
    free(s->modes.power);
    free(s->wave_number);
    free(s->density);
    free(s->freedom);
    free(s->covariance);
    free(s->share);
    free(s->distance);
    free(s);
    *spectrum = NULL;
}

/* Adds the densities of one more piece, the number `count` of them. */
static void piece_add(struct map_spectrum *total, const struct map_spectrum *piece, double count) {
    for (size_t r = 0; r < total->bins; r++)
        total->density[r] += (piece->density[r] - total->density[r]) / count;
}

int profile_spectrum_create(struct map_spectrum **out, const struct measured_map *profile,
                            struct error *err) {
    const struct grid *whole = profile->grid;
    const struct grid grid = {PROFILE_PIECE, 1, grid_dx(whole) * PROFILE_PIECE, 1};
    struct map_spectrum *total = NULL;
    size_t pieces = 0;
    int status = 0;
    for (size_t i = 0; i + PROFILE_PIECE <= whole->nx && status == 0; i += PROFILE_PIECE) {
        const struct measured_map part = {&grid, profile->z + i, BOUNDARY_OPEN};
        struct map_spectrum *piece = NULL;
        if (heights_share(&part) == 0)
            continue;
        status = map_spectrum_create(&piece, &part, err);
        if (status != 0)
            break;
        pieces++;
        if (total != NULL)
            piece_add(total, piece, (double)pieces);
        else {
            total = piece;
            piece = NULL;
        }
        map_spectrum_destroy(&piece);
    }
    if (status == 0 && total == NULL)
        status = error_set(err, ERROR_INPUT, "the profile has no heights, only holes");
    for (size_t r = 0; status == 0 && r < total->rings; r++) {
        total->freedom[r] *= (double)pieces;
        for (size_t d = 0; d < RING_REACH; d++)
            total->covariance[r][d] /= (double)pieces;
    }
    if (status == 0)
        *out = total;
    else
        map_spectrum_destroy(&total);
    return status;
}

/* Returns the value below which chi squared is with a probability, by Wilson and Hilferty's
 * approximation, within 1e-5, of many degrees of freedom, where the library's does not always end.
 */
static double chi_squared(double probability, double freedom) {
    static const double MANY = 200;
    double exact = freedom <= MANY ? gsl_cdf_chisq_Pinv(probability, freedom) : (double)NAN;
    double part = 2 / (9 * freedom), score = gsl_cdf_ugaussian_Pinv(probability);
    return isfinite(exact) ? exact : freedom * pow(1 - part + score * sqrt(part), 3);
}

/* The ends of what a value has as its mean, where it is distributed as chi squared. */
static void band(double value, double freedom, double *low, double *high) {
    bool known = freedom > 0 && value >= 0;
    *low = known ? value * freedom / chi_squared(0.975, freedom) : (double)NAN;
    *high = known ? value * freedom / chi_squared(0.025, freedom) : (double)NAN;
}

void map_spectrum_band(const struct map_spectrum *s, size_t ring, double *low, double *high) {
    bool inside = ring > 0 && ring < s->rings;
    band(s->density[ring], inside ? s->freedom[ring] : 0, low, high);
}

size_t line_psd_count(const struct map_spectrum *s, int axis) {
    const struct grid *grid = &s->modes.grid;
    size_t n = axis == 0 ? grid->nx : grid->ny;
    return (n - 1) / 2;
}

/* |Z|^2 at any signs of mx and my; 0 outside. */
static double power_at(const struct modes *modes, long mx, long my) {
    if (labs(mx) > (long)modes->mode_x)
        return 0;
    my = mx < 0 ? -my : my;
    if (2 * my == -(long)modes->grid.ny)
        my = -my;
    return labs(my) > (long)modes->mode_y ? 0 : modes_power(modes, (size_t)labs(mx), my);
}

/* Adds up the powers of the modes of one wave number along the axis. *variance: what its relative
 * variance is by these powers: of two modes of correlation c, the mean product is 1 + c^2 times
 * that of their means. */
static double line_power(const struct map_spectrum *s, int axis, long m, double *variance) {
    const struct grid *grid = &s->modes.grid;
    long n = axis == 0 ? (long)grid->ny : (long)grid->nx, reach = s->windowed && n > 1 ? 2 : 0;
    double total = 0, square = 0;
    for (long a = -((n - 1) / 2); a <= n / 2; a++) {
        double at[3] = {0};
        for (long d = 0; d <= reach; d++)
            at[d] = axis == 0 ? power_at(&s->modes, m, a + d) : power_at(&s->modes, a + d, m);
        total += at[0];
        for (long d = 0; d <= reach; d++) {
            double correlation = window_correlation(d);
            square += (d == 0 ? 1 : 2) * at[0] * at[d] * correlation / (1 + correlation);
        }
    }
    *variance = total > 0 ? square / (total * total) : (double)NAN;
    return total / s->power;
}

/* Returns the relative variance about wave number m: its mean over those nearby, or chance in it
 * would go with chance in the density. */
static double variance_about(const double *variance, size_t m, size_t count) {
    enum { NEARBY = 4 };
    struct average mean = {0};
    for (size_t a = m > NEARBY ? m - NEARBY : 1; a <= m + NEARBY && a <= count; a++)
        average_add(&mean, variance[a - 1]);
    return average_value(&mean);
}

void line_psd_measure(const struct map_spectrum *s, int axis, double *wave_number, double *density,
                      double *low, double *high) {
    /* found over 600 pieces, of surfaces whose density changes within the reach of the window */
    static const double WINDOWED = 1.12;
    const struct grid *grid = &s->modes.grid;
    double length = axis == 0 ? grid->lx : grid->ly, excess = s->windowed ? WINDOWED : 1;
    size_t count = line_psd_count(s, axis);
    for (size_t m = 1; m <= count; m++) {
        wave_number[m - 1] = 2 * M_PI * (double)m / length;
        density[m - 1] = line_power(s, axis, (long)m, &high[m - 1]) * length / (2 * M_PI);
    }
    for (size_t m = 1; m <= count; m++)
        low[m - 1] = 2 / (variance_about(high, m, count) * excess);
    for (size_t m = 1; m <= count; m++)
        band(density[m - 1], low[m - 1], &low[m - 1], &high[m - 1]);
}
