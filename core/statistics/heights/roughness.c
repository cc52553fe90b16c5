#include "core/statistics/heights/roughness.h"
#include "core/sum.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>

/* Returns the power of two by which heights about the mean are at most 1 to 2 in size, so that
 * their fourth powers are numbers whatever their unit; as a power of two it rounds nothing. 1 of a
 * flat map. */
static double heights_scale(const struct roughness *of) {
    static const int MOST = 1000; /* larger powers are no numbers */
    const double reach = fmax(of->highest - of->mean, of->mean - of->lowest);
    if (!(reach > 0 && isfinite(reach)))
        return 1;
    const int power = -ilogb(reach);
    return ldexp(1, power < MOST ? power : MOST);
}

/* Fills what the means of powers of scaled heights make. Returns the mean square height. */
static double shape_fill(struct roughness *out, double scale, double second, double third,
                         double fourth) {
    const double rms = sqrt(second);
    out->rms_height = rms / scale;
    out->skewness = third / (second * rms);
    out->kurtosis = fourth / (second * second);
    return second / scale / scale;
}

static void heights_measure(const struct measured_map *map, struct roughness *out) {
    struct average mean = {0};
    out->lowest = INFINITY;
    out->highest = -INFINITY;
    for (size_t point = 0; point < grid_points(map->grid); point++) {
        double z = map->z[point];
        average_add(&mean, z);
        out->lowest = z < out->lowest ? z : out->lowest;
        out->highest = z > out->highest ? z : out->highest;
    }
    out->mean = average_value(&mean);
    if (out->lowest > out->highest) /* no height is known */
        out->lowest = out->highest = NAN;
}

enum { TOGETHER = 64 };
enum { SECOND, THIRD, FOURTH, SLOPE_X, SLOPE_Y, BEND_X, BEND_Y, EITHER, POWERS };
/* Powers of heights about the mean, times scale; squares of forward differences; squares of second
 * ones, and of their sum. */
struct powers {
    double terms[POWERS][TOGETHER]; /* of some points; NaN: not there */
    double total[POWERS], rest[POWERS], count[POWERS];
    double mean, scale, dx, dy;
};

/* Adds the terms of n points in their order, all powers at once, as sum_add does. */
WIDE_VECTORS static void terms_add(size_t n, struct powers *powers) {
    double sum[POWERS], rest[POWERS], count[POWERS];
    for (size_t p = 0; p < POWERS; p++) {
        sum[p] = powers->total[p];
        rest[p] = powers->rest[p];
        count[p] = powers->count[p];
    }
    for (size_t l = 0; l < n; l++)
        for (size_t p = 0; p < POWERS; p++) {
            double term = powers->terms[p][l];
            bool there = term == term;
            double x = there ? term : 0, total = sum[p] + x;
            double larger = (sum[p] - total) + x, smaller = (x - total) + sum[p];
            rest[p] += fabs(sum[p]) >= fabs(x) ? larger : smaller;
            sum[p] = total;
            count[p] += there ? 1 : 0;
        }
    for (size_t p = 0; p < POWERS; p++) {
        powers->total[p] = sum[p];
        powers->rest[p] = rest[p];
        powers->count[p] = count[p];
    }
}

/* Points with their neighbours, and whether those below are there, and those above, too. */
struct around {
    const double *z, *left, *right, *up, *down;
    bool below, both;
};

WIDE_VECTORS static void points_fill(size_t n, struct around at, struct powers *restrict powers) {
    double mean = powers->mean, scale = powers->scale;
    double dx = powers->dx, square = powers->dx * powers->dx;
    for (size_t l = 0; l < n; l++) {
        double z = at.z[l], h = (z - mean) * scale;
        double slope = (at.right[l] - z) / dx, bend = (at.left[l] - 2 * z + at.right[l]) / square;
        powers->terms[SECOND][l] = h * h;
        powers->terms[THIRD][l] = h * h * h;
        powers->terms[FOURTH][l] = h * h * h * h;
        powers->terms[SLOPE_X][l] = slope * slope;
        powers->terms[BEND_X][l] = bend * bend;
    }
}

WIDE_VECTORS static void slopes_fill(size_t n, struct around at, struct powers *restrict powers) {
    double dy = powers->dy;
    for (size_t l = 0; l < n; l++) {
        double slope = (at.down[l] - at.z[l]) / dy;
        powers->terms[SLOPE_Y][l] = slope * slope;
    }
}

WIDE_VECTORS static void bends_fill(size_t n, struct around at, struct powers *restrict powers) {
    double square_x = powers->dx * powers->dx, square_y = powers->dy * powers->dy;
    for (size_t l = 0; l < n; l++) {
        double z = at.z[l], bend_x = (at.left[l] - 2 * z + at.right[l]) / square_x;
        double bend = (at.up[l] - 2 * z + at.down[l]) / square_y;
        powers->terms[BEND_Y][l] = bend * bend;
        powers->terms[EITHER][l] = (bend_x + bend) * (bend_x + bend);
    }
}

static void part_add(size_t n, struct around at, struct powers *powers) {
    points_fill(n, at, powers);
    if (at.below)
        slopes_fill(n, at, powers);
    if (at.both)
        bends_fill(n, at, powers);
    for (size_t l = 0; l < n && !at.below; l++)
        powers->terms[SLOPE_Y][l] = (double)NAN;
    for (size_t l = 0; l < n && !at.both; l++)
        powers->terms[BEND_Y][l] = powers->terms[EITHER][l] = (double)NAN;
    terms_add(n, powers);
}

/* Returns row j from its second point on. */
static struct around row_around(const struct measured_map *map, size_t j) {
    const size_t nx = map->grid->nx, ny = map->grid->ny;
    const bool open = map->boundary == BOUNDARY_OPEN, profile = grid_is_profile(map->grid);
    const double *row = map->z + j * nx + 1;
    const double *up = map->z + (j > 0 ? j - 1 : ny - 1) * nx + 1;
    const double *down = map->z + (j + 1 < ny ? j + 1 : 0) * nx + 1;
    bool above = !profile && (!open || j > 0), below = !profile && (!open || j + 1 < ny);
    return (struct around){row, row - 1, row + 1, up, down, below, above && below};
}

/* Adds row j. Its first and its last point have one beside them that is at the other end, or none.
 */
static void open_row_add(const struct measured_map *map, size_t j, struct powers *powers) {
    static const double NONE = (double)NAN;
    const size_t nx = map->grid->nx, last = nx - 2;
    const bool open = map->boundary == BOUNDARY_OPEN;
    const struct around row = row_around(map, j);
    struct around at;
    at = (struct around){
        row.z - 1, open ? &NONE : row.z + last, row.right - 1, row.up - 1, row.down - 1, row.below,
        row.both};
    part_add(1, at, powers);
    for (size_t i = 0; i < last; i += TOGETHER) {
        at = (struct around){row.z + i,    row.left + i, row.right + i, row.up + i,
                             row.down + i, row.below,    row.both};
        part_add(last - i < TOGETHER ? last - i : TOGETHER, at, powers);
    }
    at = (struct around){row.z + last,  row.left + last, open ? &NONE : row.z - 1,
                         row.up + last, row.down + last, row.below,
                         row.both};
    part_add(1, at, powers);
}

void open_roughness_measure(const struct measured_map *map, struct roughness *out) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid);
    double dx = grid_dx(grid), means[POWERS];
    heights_measure(map, out);
    struct powers powers = {.mean = out->mean,
                            .scale = heights_scale(out),
                            .dx = dx,
                            .dy = profile ? dx : grid_dy(grid)};
    for (size_t j = 0; j < grid->ny; j++)
        open_row_add(map, j, &powers);
    for (size_t p = 0; p < POWERS; p++)
        means[p] = powers.count[p] > 0 ? (powers.total[p] + powers.rest[p]) / powers.count[p]
                                       : (double)NAN;
    double variance = shape_fill(out, powers.scale, means[SECOND], means[THIRD], means[FOURTH]);
    out->m2 = profile ? means[SLOPE_X] : (means[SLOPE_X] + means[SLOPE_Y]) / 2;
    out->m4 = profile ? means[BEND_X] : (means[BEND_X] + means[BEND_Y]) / 2;
    out->rms_slope = profile ? sqrt(means[SLOPE_X]) : sqrt(2 * out->m2);
    out->rms_curvature = profile ? sqrt(means[BEND_X]) : sqrt(means[EITHER]) / 2;
    out->nayak_alpha = variance / out->m2 * (out->m4 / out->m2);
}

void map_roughness_measure(const struct measured_map *map, struct roughness *out) {
    if (map->boundary == BOUNDARY_OPEN)
        open_roughness_measure(map, out);
    else
        roughness_measure(map->grid, map->z, out);
}

/* Sums over points in LANES interleaved parts: short chains of rounding, and vectors for the
 * compiler. */
enum { LANES = 8 };
struct row_sums {
    double second[LANES], third[LANES], fourth[LANES]; /* powers of the scaled height */
    double slope_x[LANES], slope_y[LANES];             /* squares of forward differences */
    double bend_x[LANES], bend_y[LANES], bend[LANES];  /* squares of second ones, of their sum */
};

static double lanes_total(const double *lanes) {
    return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
           ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/* How heights are taken for their powers: (z - mean) scale. */
struct standard {
    double mean, scale;
};

/* Adds one point to lane l: z[i] with its neighbours; up == middle == down for a profile. */
static inline void point_add(struct row_sums *sums, size_t l, double left, double z, double right,
                             double up, double down, struct standard by) {
    double h = (z - by.mean) * by.scale, h2 = h * h;
    double slope_x = right - z, slope_y = down - z;
    double bend_x = left - 2 * z + right, bend_y = up - 2 * z + down;
    sums->second[l] += h2;
    sums->third[l] += h2 * h;
    sums->fourth[l] += h2 * h2;
    sums->slope_x[l] += slope_x * slope_x;
    sums->slope_y[l] += slope_y * slope_y;
    sums->bend_x[l] += bend_x * bend_x;
    sums->bend_y[l] += bend_y * bend_y;
    sums->bend[l] += bend_x * bend_y;
}

WIDE_VECTORS static void row_add(const double *up, const double *row, const double *down, size_t nx,
                                 struct standard by, struct row_sums *sums) {
    point_add(sums, 0, row[nx - 1], row[0], row[1], up[0], down[0], by);
    size_t i = 1;
    for (; i + LANES < nx; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            point_add(sums, l, row[i + l - 1], row[i + l], row[i + l + 1], up[i + l], down[i + l],
                      by);
    for (; i < nx; i++)
        point_add(sums, 0, row[i - 1], row[i], row[i + 1 < nx ? i + 1 : 0], up[i], down[i], by);
}

static double map_mean(const struct grid *grid, const double *z, double *lowest, double *highest) {
    struct sum total = {0, 0}; /* of rows */
    *lowest = *highest = z[0];
    for (size_t j = 0; j < grid->ny; j++) {
        const double *row = z + j * grid->nx;
        double sum = 0;
        for (size_t i = 0; i < grid->nx; i++) {
            sum += row[i];
            *lowest = row[i] < *lowest ? row[i] : *lowest;
            *highest = row[i] > *highest ? row[i] : *highest;
        }
        sum_add(&total, sum);
    }
    return sum_value(&total) / (double)grid_points(grid);
}

enum { SUMS = sizeof(struct row_sums) / sizeof(double[LANES]) };

/* Computes means over the map, in the order of struct row_sums. */
static void map_means(const struct grid *grid, const double *z, struct standard by, double *means) {
    struct sum totals[SUMS] = {{0}};
    size_t nx = grid->nx, ny = grid->ny;
    for (size_t j = 0; j < ny; j++) {
        const double *up = z + (j != 0 ? j - 1 : ny - 1) * nx,
                     *down = z + (j + 1 < ny ? j + 1 : 0) * nx;
        union {
            struct row_sums named;
            double lanes[SUMS][LANES];
        } sums = {.lanes = {{0}}};
        row_add(up, z + j * nx, down, nx, by, &sums.named);
        for (size_t s = 0; s < SUMS; s++)
            sum_add(&totals[s], lanes_total(sums.lanes[s]));
    }
    for (size_t s = 0; s < SUMS; s++)
        means[s] = sum_value(&totals[s]) / (double)grid_points(grid);
}

void roughness_measure(const struct grid *grid, const double *z, struct roughness *out) {
    double means[SUMS];
    out->mean = map_mean(grid, z, &out->lowest, &out->highest);
    const struct standard by = {out->mean, heights_scale(out)};
    map_means(grid, z, by, means);
    bool profile = grid_is_profile(grid);
    double dx = grid_dx(grid), dy = profile ? dx : grid_dy(grid);
    double slope_x = means[3] / (dx * dx), slope_y = means[4] / (dy * dy);
    double bend_x = means[5] / (dx * dx * dx * dx), bend_y = means[6] / (dy * dy * dy * dy);
    double both = means[7] / (dx * dx * dy * dy);
    double variance = shape_fill(out, by.scale, means[0], means[1], means[2]);
    out->rms_slope = sqrt(slope_x + slope_y);
    out->rms_curvature = profile ? sqrt(bend_x) : sqrt(bend_x + 2 * both + bend_y) / 2;
    out->m2 = profile ? slope_x : (slope_x + slope_y) / 2;
    out->m4 = profile ? bend_x : (bend_x + bend_y) / 2;
    out->nayak_alpha = variance / out->m2 * (out->m4 / out->m2);
}

int map_modes_measure(const struct grid *grid, const double *z, struct modes *modes,
                      struct error *err) {
    struct transform *transform = NULL;
    *modes = (struct modes){.grid = *grid, .mode_x = grid->nx / 2, .mode_y = grid->ny / 2};
    size_t rows = 2 * modes->mode_y + 1;
    modes->power = array_create((modes->mode_x + 1) * rows, sizeof *modes->power);
    if (modes->power == NULL)
        return error_memory(err, (modes->mode_x + 1) * rows * sizeof *modes->power, "a spectrum");
    int status = transform_create(&transform, grid, modes->mode_x, modes->mode_y, err);
    if (status != 0) {
        free(modes->power);
        modes->power = NULL;
        return status;
    }
    transform_forward(transform, z);
    const double complex *mode = transform_spectrum(transform);
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (size_t row = 0; row < grid->ny; row++, mode++) {
            size_t at = row <= modes->mode_y ? row + modes->mode_y : row + modes->mode_y - grid->ny;
            double amplitude2 = creal(*mode) * creal(*mode) + cimag(*mode) * cimag(*mode);
            modes->power[mx * rows + at] = mx == 0 && row == 0 ? 0 : amplitude2;
        }
    transform_destroy(&transform);
    return 0;
}

int roughness_spectral(const struct grid *grid, const double *z, struct moments *out,
                       struct error *err) {
    struct modes modes;
    int status = map_modes_measure(grid, z, &modes, err);
    if (status != 0)
        return status;
    modes_moments(&modes, out);
    free(modes.power);
    return 0;
}

static double shorter_side(const struct grid *grid) {
    return grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
}

size_t radial_bin(const struct grid *grid, size_t mx, long my) {
    double side = shorter_side(grid);
    return ring_of((double)mx * (side / grid->lx),
                   grid_is_profile(grid) ? 0 : (double)my * (side / grid->ly));
}

size_t radial_bins(const struct grid *grid) {
    return radial_bin(grid, grid->nx / 2, (long)(grid->ny / 2)) + 1;
}

void radial_counts(const struct grid *grid, double *count) {
    size_t bins = radial_bins(grid);
    for (size_t r = 0; r < bins; r++)
        count[r] = 0;
    for (size_t my = 0; my <= grid->ny / 2; my++)
        for (size_t mx = 0; mx <= grid->nx / 2; mx++) {
            unsigned signs = my > 0 && 2 * my != grid->ny ? 2 : 1;
            count[radial_bin(grid, mx, (long)my)] += signs * modes_weight(grid, mx);
        }
}

/* band: means are over the waves of a ring that have any power, else over all of the ring. */
static void ring_density(const struct modes *modes, bool band, double *wave_number,
                         double *density) {
    const struct grid *grid = &modes->grid;
    size_t bins = radial_bins(grid);
    bool profile = grid_is_profile(grid);
    double cell = profile ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    long mode_y = (long)modes->mode_y;
    for (size_t r = 0; r < bins; r++) {
        wave_number[r] = 0; /* first the number of modes, then the wave number */
        density[r] = 0;
    }
    if (!band)
        radial_counts(grid, wave_number);
    for (long my = -mode_y; my <= mode_y; my++)
        for (size_t mx = 0; mx <= modes->mode_x; mx++) {
            double power = modes_power(modes, mx, my);
            if (power == 0 || (my < 0 && 2 * (size_t)-my == grid->ny))
                continue;
            size_t r = radial_bin(grid, mx, my);
            double weight = modes_weight(grid, mx);
            wave_number[r] += band ? weight : 0;
            density[r] += weight * power;
        }
    for (size_t r = 0; r < bins; r++) {
        density[r] = wave_number[r] > 0 ? density[r] / wave_number[r] * cell : 0;
        wave_number[r] = 2 * M_PI * (double)r / shorter_side(grid);
    }
}

void psd_of_modes(const struct modes *modes, double *wave_number, double *density) {
    ring_density(modes, false, wave_number, density);
}

void psd_of_band(const struct modes *modes, double *wave_number, double *density) {
    ring_density(modes, true, wave_number, density);
}

int psd_measure(const struct grid *grid, const double *z, double *wave_number, double *density,
                struct error *err) {
    struct modes modes;
    int status = map_modes_measure(grid, z, &modes, err);
    if (status != 0)
        return status;
    psd_of_modes(&modes, wave_number, density);
    free(modes.power);
    return 0;
}

size_t acf_lags(const struct grid *grid) {
    static const double EDGE = 1e-9; /* a lag this near to half a side is that */
    if (grid_is_profile(grid) || grid->lx <= grid->ly)
        return grid->nx / 2 + 1;
    return (size_t)(grid->ly / grid_dx(grid) * (1 + EDGE) / 2) + 1;
}

/* Mean of a field even about the origin over rings of width dx about it, over its value there. */
static void ring_means(const struct grid *grid, const double *field, double *counts, double *lag,
                       double *mean) {
    size_t lags = acf_lags(grid);
    double dx = grid_dx(grid), dy = grid_is_profile(grid) ? 0 : grid_dy(grid);
    for (size_t r = 0; r < lags; r++)
        counts[r] = mean[r] = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            double x = (double)(i <= grid->nx / 2 ? i : grid->nx - i);
            double y = (double)(j <= grid->ny / 2 ? j : grid->ny - j) * (dy / dx);
            size_t r = (size_t)(sqrt(x * x + y * y) + 0.5);
            if (r >= lags)
                continue;
            counts[r]++;
            mean[r] += field[j * grid->nx + i];
        }
    double origin = field[0];
    for (size_t r = 0; r < lags; r++) {
        lag[r] = (double)r * dx;
        mean[r] = mean[r] / counts[r] / origin;
    }
}

int ring_average(const struct grid *grid, const double *field, double *lag, double *mean,
                 struct error *err) {
    size_t lags = acf_lags(grid);
    double *counts = array_create(lags, sizeof *counts);
    if (counts == NULL)
        return error_memory(err, lags * sizeof *counts, "rings of lags");
    ring_means(grid, field, counts, lag, mean);
    free(counts);
    return 0;
}

/* correlation: of the field on all points. */
static int changes_fill(const struct grid *grid, const double *field, const double *correlation,
                        double *change, struct error *err) {
    size_t lags = (acf_lags(grid) + 1) / 2; /* as many as the coarser grid has */
    struct grid coarse = *grid;
    for (size_t r = 0; r < lags; r++)
        change[r] = NAN;
    bool strip = grid->ny == 2 && grid->nx > 2; /* half of which would be a profile */
    if (strip || grid->nx % 2 != 0 || (!grid_is_profile(grid) && grid->ny % 2 != 0))
        return 0;
    coarse.nx = grid->nx / 2;
    coarse.ny = grid_is_profile(grid) ? 1 : grid->ny / 2;
    double *samples = array_create(grid_points(&coarse) + lags, sizeof *samples);
    if (samples == NULL)
        return error_memory(err, grid_points(&coarse) * sizeof *samples, "a coarser field");
    for (size_t j = 0; j < coarse.ny; j++)
        for (size_t i = 0; i < coarse.nx; i++)
            samples[j * coarse.nx + i] = field[2 * j * grid->nx + 2 * i];
    double *lag = samples + grid_points(&coarse);
    int status = ring_average(&coarse, samples, lag, change, err);
    for (size_t r = 0; r < lags && status == 0; r++)
        change[r] = correlation[2 * r] - change[r];
    free(samples);
    return status;
}

int acf_of_modes_changes(const struct modes *modes, double *lag, double *correlation,
                         double *change, struct error *err) {
    const struct grid *grid = &modes->grid;
    struct transform *transform = NULL;
    double *field = array_create(grid_points(grid), sizeof *field);
    int status = field != NULL
                     ? 0
                     : error_memory(err, grid_points(grid) * sizeof *field, "an autocorrelation");
    if (status == 0)
        status = transform_create(&transform, grid, modes->mode_x, modes->mode_y, err);
    if (status == 0) {
        double complex *mode = transform_spectrum(transform);
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            for (size_t row = 0; row < grid->ny; row++, mode++) {
                long my = row <= grid->ny / 2 ? (long)row : (long)row - (long)grid->ny;
                *mode = labs(my) <= (long)modes->mode_y ? modes_power(modes, mx, my) : 0;
            }
        transform_inverse(transform, field);
        status = ring_average(grid, field, lag, correlation, err);
    }
    if (status == 0 && change != NULL)
        status = changes_fill(grid, field, correlation, change, err);
    transform_destroy(&transform);
    free(field);
    return status;
}

int acf_of_modes(const struct modes *modes, double *lag, double *correlation, struct error *err) {
    return acf_of_modes_changes(modes, lag, correlation, NULL, err);
}

int acf_measure(const struct grid *grid, const double *z, double *lag, double *correlation,
                struct error *err) {
    struct modes modes;
    int status = map_modes_measure(grid, z, &modes, err);
    if (status != 0)
        return status;
    status = acf_of_modes(&modes, lag, correlation, err);
    free(modes.power);
    return status;
}
