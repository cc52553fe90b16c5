#include "core/statistics/spectra/spectral_band.h"
#include "core/sum.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

struct spectral_band {
    struct grid grid;
    size_t mode_x, mode_y, rows; /* rows = 2 mode_y + 1, of modes */

    /* Wave numbers, and mean squares of differences between neighbours over the spacing for a power
     * of 1, (2 sin(phase/2)/dx)^2: of column mx, of row my + mode_y. */
    double *wave_x, *wave_y, *slope_x, *slope_y;
    double *odd_y; /* wave_y for odd powers: 0 where the row is also that of -wave_y */

    uint32_t *mode_ring; /* [row*(mode_x + 1) + mx] */
    double *mode_count;  /* of each ring of the grid, modes in the full plane */

    /* The field of the autocorrelation at lags (i, j) dx: columns 0 .. nx/2 of the rows that
     * rings reach, of a square those with j <= i alone. */
    bool square;
    size_t field_rows;
    size_t *row_end;    /* of each row: one behind the last column within a ring */
    uint32_t *lag_ring; /* [j*(nx/2 + 1) + i] */
    double *lag_count;  /* of each ring, lags of the whole field */
    double *even;       /* [mx*(mode_y + 1) + my]: mean power of the modes (+-mx, +-my) */
    /* Two real columns are transformed as one complex one; then a strip of rows. */
    struct transform *columns, *lines;
};

static bool grid_is_square(const struct grid *grid, size_t mode_x, size_t mode_y) {
    return grid->nx == grid->ny && grid->lx == grid->ly && mode_x == mode_y;
}

/* Returns the rows of the field within the rings: r + 1/2 is beyond the last, and on a square no
 * lag with j <= i is above the diagonal. */
static size_t rows_within(const struct grid *grid, bool square) {
    if (grid_is_profile(grid))
        return 1;
    double reach = ((double)acf_lags(grid) - 0.5) * grid_dx(grid) / grid_dy(grid);
    double rows = floor(square ? reach / M_SQRT2 : reach) + 1;
    size_t half = grid->ny / 2 + 1;
    return rows < (double)half ? (size_t)rows : half;
}

/* Returns how many lags of the whole field a computed one stands for. */
static double multiplicity(const struct spectral_band *band, size_t i, size_t j) {
    const struct grid *grid = &band->grid;
    double x = i == 0 || 2 * i == grid->nx ? 1 : 2, y = j == 0 || 2 * j == grid->ny ? 1 : 2;
    return x * y * (band->square && i > j ? 2 : 1);
}

static void lags_fill(struct spectral_band *band) {
    const struct grid *grid = &band->grid;
    size_t lags = acf_lags(grid), width = grid->nx / 2 + 1;
    double aspect = grid_is_profile(grid) ? 0 : grid_dy(grid) / grid_dx(grid);
    for (size_t j = 0; j < band->field_rows; j++) {
        size_t end = band->square ? j : 0;
        for (size_t i = end; i < width; i++) {
            double x = (double)i, y = (double)j * aspect;
            size_t ring = (size_t)(sqrt(x * x + y * y) + 0.5);
            if (ring >= lags)
                break;
            band->lag_ring[j * width + i] = (uint32_t)ring;
            band->lag_count[ring] += multiplicity(band, i, j);
            end = i + 1;
        }
        band->row_end[j] = end;
    }
}

static void modes_fill(struct spectral_band *band) {
    const struct grid *grid = &band->grid;
    bool profile = grid_is_profile(grid);
    long mode_y = (long)band->mode_y;
    double dx = grid_dx(grid), dy = profile ? 1 : grid_dy(grid);
    uint32_t *ring = band->mode_ring;
    for (long my = -mode_y; my <= mode_y; my++) {
        double difference = 2 * sin(M_PI * (double)my / (double)grid->ny) / dy;
        band->wave_y[my + mode_y] = profile ? 0 : 2 * M_PI * (double)my / grid->ly;
        band->odd_y[my + mode_y] = modes_twin(grid, 0, my) ? 0 : band->wave_y[my + mode_y];
        band->slope_y[my + mode_y] = profile ? 0 : difference * difference;
        for (size_t mx = 0; mx <= band->mode_x; mx++)
            *ring++ = (uint32_t)radial_bin(grid, mx, my);
    }
    for (size_t mx = 0; mx <= band->mode_x; mx++) {
        double difference = 2 * sin(M_PI * (double)mx / (double)grid->nx) / dx;
        band->wave_x[mx] = 2 * M_PI * (double)mx / grid->lx;
        band->slope_x[mx] = difference * difference;
    }
    radial_counts(grid, band->mode_count);
}

static bool arrays_create(struct spectral_band *band) {
    const struct grid *grid = &band->grid;
    size_t columns = band->mode_x + 1, width = grid->nx / 2 + 1;
    band->wave_x = array_create(columns, sizeof(double));
    band->wave_y = array_create(band->rows, sizeof(double));
    band->odd_y = array_create(band->rows, sizeof(double));
    band->slope_x = array_create(columns, sizeof(double));
    band->slope_y = array_create(band->rows, sizeof(double));
    band->mode_ring = array_create(columns * band->rows, sizeof(uint32_t));
    band->mode_count = array_create(radial_bins(grid), sizeof(double));
    band->row_end = array_create(band->field_rows, sizeof(size_t));
    band->lag_ring = array_create(band->field_rows * width, sizeof(uint32_t));
    band->lag_count = array_create(acf_lags(grid), sizeof(double));
    band->even = array_create(columns * (band->mode_y + 1), sizeof(double));
    return band->wave_x != NULL && band->wave_y != NULL && band->odd_y != NULL &&
           band->slope_x != NULL && band->slope_y != NULL && band->mode_ring != NULL &&
           band->mode_count != NULL && band->row_end != NULL && band->lag_ring != NULL &&
           band->lag_count != NULL && band->even != NULL;
}

double spectral_band_bytes(const struct grid *grid, size_t mode_x, size_t mode_y) {
    size_t width = grid->nx / 2 + 1;
    double columns = (double)(mode_x + 1), rows = (double)(2 * mode_y + 1);
    double field = (double)rows_within(grid, grid_is_square(grid, mode_x, mode_y));
    double lines = (double)TRANSFORM_ROWS * (double)grid->nx;
    return sizeof(double) *
               (2 * columns + 3 * rows + columns * rows / 2 + (double)radial_bins(grid)) +
           sizeof(uint32_t) * (columns * rows + field * (double)width) +
           sizeof(double) * (field + (double)acf_lags(grid)) +
           sizeof(double complex) * (columns / 2 + 1) * (double)grid->ny +
           sizeof(double) * 6 * lines; /* of both transforms */
}

int spectral_band_create(struct spectral_band **out, const struct grid *grid, size_t mode_x,
                         size_t mode_y, struct error *err) {
    struct spectral_band *band = array_create(1, sizeof *band);
    if (band == NULL)
        return error_memory(err, sizeof *band, "a band");
    band->grid = *grid;
    band->mode_x = mode_x;
    band->mode_y = mode_y;
    band->rows = 2 * mode_y + 1;
    band->square = grid_is_square(grid, mode_x, mode_y);
    band->field_rows = rows_within(grid, band->square);
    struct grid strip = *grid;
    strip.ny = grid->ny < TRANSFORM_ROWS ? grid->ny : TRANSFORM_ROWS;
    int status = arrays_create(band)
                     ? transform_create(&band->columns, grid, mode_x / 2, mode_y, err)
                     : error_memory(err, (size_t)spectral_band_bytes(grid, mode_x, mode_y),
                                    "tables of a band");
    if (status == 0)
        status = transform_create(&band->lines, &strip, mode_x, 0, err);
    if (status != 0) {
        spectral_band_destroy(&band);
        return status;
    }
    modes_fill(band);
    lags_fill(band);
    *out = band;
    return 0;
}

void spectral_band_destroy(struct spectral_band **band) {
    struct spectral_band *gone = *band;
    if (gone == NULL)
        return;
    transform_destroy(&gone->columns);
    transform_destroy(&gone->lines);
    free(gone->wave_x);
    free(gone->wave_y);
    free(gone->odd_y);
    free(gone->slope_x);
    free(gone->slope_y);
    free(gone->mode_ring);
    free(gone->mode_count);
    free(gone->row_end);
    free(gone->lag_ring);
    free(gone->lag_count);
    free(gone->even);
    free(gone);
    *band = NULL;
}

/* --- moments --- */

/* Sums over a column of modes, by what powers are weighted with, in interleaved parts. */
enum { SUM_POWER, SUM_K, SUM_K2, SUM_K3, SUM_K4, SUM_SLOPE, SUM_BEND, SUMS };
enum { LANES = 4 };
struct column_lanes {
    double of[SUMS][LANES];
};

static inline void mode_add(struct column_lanes *lanes, size_t l, double power, double k,
                            double odd, double slope) {
    lanes->of[SUM_POWER][l] += power;
    lanes->of[SUM_K][l] += power * odd;
    lanes->of[SUM_K2][l] += power * k * k;
    lanes->of[SUM_K3][l] += power * odd * k * k;
    lanes->of[SUM_K4][l] += power * k * k * k * k;
    lanes->of[SUM_SLOPE][l] += power * slope;
    lanes->of[SUM_BEND][l] += power * slope * slope;
}

WIDE_VECTORS static void column_sum(const struct spectral_band *band, const double *power,
                                    struct column_lanes *out) {
    const double *k = band->wave_y, *odd = band->odd_y, *slope = band->slope_y;
    const size_t rows = band->rows;
    struct column_lanes lanes = {.of = {{0}}};
    size_t row = 0;
    for (; row + LANES <= rows; row += LANES)
        for (size_t l = 0; l < LANES; l++)
            mode_add(&lanes, l, power[row + l], k[row + l], odd[row + l], slope[row + l]);
    for (; row < rows; row++)
        mode_add(&lanes, 0, power[row], k[row], odd[row], slope[row]);
    *out = lanes;
}

/* Sums over columns: the nine moments, then means of squares of differences and their products. */
struct band_totals {
    struct sum m00, m20, m02, m11, m22, m40, m04, m31, m13;
    struct sum slope_x, slope_y, bend_x, bend_y, both;
};

static void totals_add(struct band_totals *totals, const struct column_lanes *lanes, double weight,
                       double k, double odd, double slope) {
    double of[SUMS];
    for (size_t s = 0; s < SUMS; s++)
        of[s] =
            weight * ((lanes->of[s][0] + lanes->of[s][2]) + (lanes->of[s][1] + lanes->of[s][3]));
    sum_add(&totals->m00, of[SUM_POWER]);
    sum_add(&totals->m20, k * k * of[SUM_POWER]);
    sum_add(&totals->m40, k * k * k * k * of[SUM_POWER]);
    sum_add(&totals->m02, of[SUM_K2]);
    sum_add(&totals->m04, of[SUM_K4]);
    sum_add(&totals->m22, k * k * of[SUM_K2]);
    sum_add(&totals->m11, odd * of[SUM_K]);
    sum_add(&totals->m31, odd * k * k * of[SUM_K]);
    sum_add(&totals->m13, odd * of[SUM_K3]);
    sum_add(&totals->slope_x, slope * of[SUM_POWER]);
    sum_add(&totals->bend_x, slope * slope * of[SUM_POWER]);
    sum_add(&totals->slope_y, of[SUM_SLOPE]);
    sum_add(&totals->bend_y, of[SUM_BEND]);
    sum_add(&totals->both, slope * of[SUM_SLOPE]);
}

static void moments_take(const struct band_totals *totals, bool profile, struct moments *out) {
    *out = (struct moments){.m00 = sum_value(&totals->m00),
                            .m20 = sum_value(&totals->m20),
                            .m02 = sum_value(&totals->m02),
                            .m11 = sum_value(&totals->m11),
                            .m22 = sum_value(&totals->m22),
                            .m40 = sum_value(&totals->m40),
                            .m04 = sum_value(&totals->m04),
                            .m31 = sum_value(&totals->m31),
                            .m13 = sum_value(&totals->m13)};
    moments_derive(out, profile);
}

static void differences_take(const struct band_totals *totals, bool profile,
                             struct roughness *out) {
    double variance = sum_value(&totals->m00);
    double slope_x = sum_value(&totals->slope_x), slope_y = sum_value(&totals->slope_y);
    double bend_x = sum_value(&totals->bend_x), bend_y = sum_value(&totals->bend_y);
    *out = (struct roughness){.rms_height = sqrt(variance),
                              .rms_slope = sqrt(slope_x + slope_y),
                              .skewness = NAN,
                              .kurtosis = NAN,
                              .m2 = profile ? slope_x : (slope_x + slope_y) / 2,
                              .m4 = profile ? bend_x : (bend_x + bend_y) / 2,
                              .lowest = NAN,
                              .highest = NAN};
    out->rms_curvature =
        profile ? sqrt(bend_x) : sqrt(bend_x + 2 * sum_value(&totals->both) + bend_y) / 2;
    out->nayak_alpha = variance / out->m2 * (out->m4 / out->m2);
}

void spectral_band_moments(const struct spectral_band *band, const struct modes *modes,
                           struct moments *moments, struct roughness *roughness) {
    bool profile = grid_is_profile(&band->grid);
    struct band_totals totals = {.m00 = {0}};
    for (size_t mx = 0; mx <= band->mode_x; mx++) {
        struct column_lanes lanes;
        const double k = band->wave_x[mx], odd = modes_twin(&band->grid, mx, 0) ? 0 : k;
        column_sum(band, modes->power + mx * band->rows, &lanes);
        totals_add(&totals, &lanes, modes_weight(&band->grid, mx), k, odd, band->slope_x[mx]);
    }
    moments_take(&totals, profile, moments);
    differences_take(&totals, profile, roughness);
}

/* --- means over rings --- */

void spectral_band_density(const struct spectral_band *band, const struct modes *modes,
                           double *density) {
    const struct grid *grid = &band->grid;
    size_t bins = radial_bins(grid);
    double cell =
        grid_is_profile(grid) ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    const uint32_t *ring = band->mode_ring;
    for (size_t r = 0; r < bins; r++)
        density[r] = 0;
    for (size_t row = 0; row < band->rows; row++)
        for (size_t mx = 0; mx <= band->mode_x; mx++)
            density[*ring++] += modes_weight(grid, mx) * modes->power[mx * band->rows + row];
    for (size_t r = 0; r < bins; r++)
        density[r] = band->mode_count[r] > 0 ? density[r] / band->mode_count[r] * cell : 0;
}

static void even_fill(struct spectral_band *band, const struct modes *modes) {
    size_t mode_y = band->mode_y;
    for (size_t mx = 0; mx <= band->mode_x; mx++) {
        const double *at = modes->power + mx * band->rows + mode_y;
        double *even = band->even + mx * (mode_y + 1);
        for (size_t my = 0; my <= mode_y; my++) {
            bool single = my == 0 || 2 * my == band->grid.ny; /* stored once, at +my */
            even[my] = single ? at[my] : (at[my] + at[-(ptrdiff_t)my]) / 2;
        }
    }
    if (!band->square)
        return;
    for (size_t mx = 0; mx <= band->mode_x; mx++)
        for (size_t my = 0; my < mx; my++) {
            double *one = band->even + mx * (mode_y + 1) + my;
            double *other = band->even + my * (mode_y + 1) + mx;
            *one = *other = (*one + *other) / 2;
        }
}

/* Puts columns 2p and 2p + 1 into the real and the imaginary part of column p. */
static void columns_fill(struct spectral_band *band) {
    size_t ny = band->grid.ny, height = band->mode_y + 1;
    double complex *column = transform_spectrum(band->columns);
    for (size_t p = 0; p <= band->mode_x / 2; p++, column += ny) {
        const double *real = band->even + 2 * p * height;
        const double *imaginary = 2 * p < band->mode_x ? real + height : NULL;
        for (size_t row = height; row + height <= ny; row++)
            column[row] = 0;
        for (size_t my = 0; my < height; my++) {
            double complex pair = real[my] + (imaginary != NULL ? imaginary[my] : 0) * I;
            column[my] = pair;
            if (my > 0)
                column[ny - my] = pair;
        }
    }
}

/* Returns rows j .. j + rows - 1 of the field, at most TRANSFORM_ROWS of them, to be changed. */
static double *strip_of(struct spectral_band *band, size_t j, size_t rows) {
    size_t ny = band->grid.ny, height = ny < TRANSFORM_ROWS ? ny : TRANSFORM_ROWS;
    const double complex *pair = transform_spectrum(band->columns) + j;
    double complex *line = transform_spectrum(band->lines);
    for (size_t mx = 0; mx <= band->mode_x; mx++) {
        for (size_t row = 0; row < rows; row++)
            line[mx * height + row] = mx % 2 == 0 ? creal(pair[row]) : cimag(pair[row]);
        pair += mx % 2 == 0 ? 0 : ny;
    }
    return transform_inverse_strip(band->lines, 0, rows);
}

/* Adds row j of the field to the sums of its rings. */
static void row_add(const struct spectral_band *band, size_t j, double *restrict line,
                    double *restrict sums) {
    const struct grid *grid = &band->grid;
    size_t first = band->square ? j : 0, end = band->row_end[j];
    const uint32_t *ring = band->lag_ring + j * (grid->nx / 2 + 1);
    double most = (band->square ? 4 : 2) * (j == 0 || 2 * j == grid->ny ? 1 : 2);
    line[0] /= 2;
    if (grid->nx % 2 == 0)
        line[grid->nx / 2] /= 2;
    if (band->square)
        line[j] /= 2;
    for (size_t i = first; i < end; i++)
        sums[ring[i]] += most * line[i];
}

void spectral_band_correlation(struct spectral_band *band, const struct modes *modes,
                               double *correlation) {
    size_t lags = acf_lags(&band->grid), nx = band->grid.nx;
    double origin = 0;
    even_fill(band, modes);
    columns_fill(band);
    transform_inverse_columns(band->columns);
    for (size_t r = 0; r < lags; r++)
        correlation[r] = 0;
    for (size_t j = 0; j < band->field_rows; j += TRANSFORM_ROWS) {
        size_t left = band->field_rows - j, rows = left < TRANSFORM_ROWS ? left : TRANSFORM_ROWS;
        double *strip = strip_of(band, j, rows);
        origin = j == 0 ? strip[0] : origin;
        for (size_t row = 0; row < rows; row++)
            row_add(band, j + row, strip + row * nx, correlation);
    }
    for (size_t r = 0; r < lags; r++)
        correlation[r] = correlation[r] / band->lag_count[r] / origin;
}
