#include "core/statistics/spectra/whole_band.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <stdlib.h>

struct whole_band {
    struct transform *transform;
    struct modes modes, coarser; /* own their powers; coarser has none where it is not wanted */
    double complex *folded;      /* a column of the coarser grid, likewise */
};

static int modes_of_grid(struct modes *out, const struct grid *grid, struct error *err) {
    *out = (struct modes){.grid = *grid, .mode_x = grid->nx / 2, .mode_y = grid->ny / 2};
    size_t count = (out->mode_x + 1) * (2 * out->mode_y + 1);
    out->power = array_create(count, sizeof *out->power);
    return out->power != NULL ? 0 : error_memory(err, count * sizeof *out->power, "a spectrum");
}

int whole_band_create(struct whole_band **out, const struct grid *grid, const struct grid *coarser,
                      struct error *err) {
    struct whole_band *band = array_create(1, sizeof *band);
    if (band == NULL)
        return error_memory(err, sizeof *band, "a band");
    int status = modes_of_grid(&band->modes, grid, err);
    if (status == 0)
        status = transform_create(&band->transform, grid, grid->nx / 2, grid->ny / 2, err);
    if (status == 0 && coarser != NULL) {
        band->folded = array_create(coarser->ny, sizeof *band->folded);
        status = band->folded != NULL
                     ? modes_of_grid(&band->coarser, coarser, err)
                     : error_memory(err, coarser->ny * sizeof *band->folded, "a column of waves");
    }
    if (status != 0) {
        whole_band_destroy(&band);
        return status;
    }
    *out = band;
    return 0;
}

void whole_band_destroy(struct whole_band **band) {
    struct whole_band *gone = *band;
    if (gone == NULL)
        return;
    transform_destroy(&gone->transform);
    free(gone->modes.power);
    free(gone->coarser.power);
    free(gone->folded);
    free(gone);
    *band = NULL;
}

static double waves_of(const struct grid *grid) {
    size_t columns = grid->nx / 2 + 1;
    return (double)columns * (double)(grid->ny + 1);
}

double whole_band_bytes(const struct grid *grid, const struct grid *coarser) {
    double bytes = waves_of(grid) * (sizeof(double complex) + sizeof(double));
    return coarser == NULL ? bytes : bytes + waves_of(coarser) * sizeof(double);
}

/* Replaces a column of ny amplitudes, my = 0, 1, ..., -2, -1, by its squares at rising my. */
WIDE_VECTORS static void squares_fill(const double *column, size_t ny, double *power) {
    size_t half = ny / 2, below = (ny - 1) / 2; /* rows above 0, Nyquist's too, and below */
    double *at = power + half;
    for (size_t row = 0; row <= half; row++)
        at[row] = column[2 * row] * column[2 * row] + column[2 * row + 1] * column[2 * row + 1];
    column += 2 * (ny - below);
    at = power + half - below;
    for (size_t row = 0; row < below; row++)
        at[row] = column[2 * row] * column[2 * row] + column[2 * row + 1] * column[2 * row + 1];
}

/* The values of a transform are pairs of a real and an imaginary part (C11, 6.2.5). */
static void column_squares(const double complex *column, const struct modes *modes, size_t mx) {
    size_t rows = 2 * modes->mode_y + 1;
    squares_fill((const double *)column, modes->grid.ny, modes->power + mx * rows);
}

/* Adds a column's waves to those of half as many rows, which every second point shows. */
static void rows_fold(const double complex *column, size_t ny, double complex *folded) {
    for (size_t row = 0; row < ny; row++)
        folded[row] += column[row];
    for (size_t row = 0; row < ny; row++)
        folded[row] += column[ny + row];
}

/* Does likewise with the mirror image of a column, the waves (-mx, my), of 2 ny rows. */
static void mirrored_fold(const double complex *column, size_t ny, double complex *folded) {
    folded[0] += conj(column[0] + column[ny]);
    for (size_t row = 1; row < ny; row++)
        folded[row] += conj(column[2 * ny - row] + column[ny - row]);
}

/* Wave mx of the coarser grid is also the waves mx + nx/2 and mx - nx/2 of the finer one. */
static void coarser_fill(struct whole_band *band) {
    const struct grid *fine = &band->modes.grid, *grid = &band->coarser.grid;
    const double complex *spectrum = transform_spectrum(band->transform);
    const bool profile = grid_is_profile(fine);
    for (size_t mx = 0; mx <= band->coarser.mode_x; mx++) {
        const double complex *column = spectrum + mx * fine->ny;
        const double complex *other = spectrum + (grid->nx - mx) * fine->ny;
        for (size_t row = 0; row < grid->ny; row++)
            band->folded[row] = 0;
        if (profile)
            band->folded[0] = column[0] + (mx == 0 ? other[0] : conj(other[0]));
        else if (mx == 0) {
            rows_fold(column, grid->ny, band->folded);
            rows_fold(other, grid->ny, band->folded);
        } else {
            rows_fold(column, grid->ny, band->folded);
            mirrored_fold(other, grid->ny, band->folded);
        }
        column_squares(band->folded, &band->coarser, mx);
    }
    band->coarser.power[band->coarser.mode_y] = 0;
}

double whole_band_measure(struct whole_band *band, const double *z) {
    size_t ny = band->modes.grid.ny;
    const double complex *spectrum = transform_spectrum(band->transform);
    transform_forward(band->transform, z);
    for (size_t mx = 0; mx <= band->modes.mode_x; mx++)
        column_squares(spectrum + mx * ny, &band->modes, mx);
    band->modes.power[band->modes.mode_y] = 0;
    if (band->coarser.power != NULL)
        coarser_fill(band);
    return creal(spectrum[0]);
}

const struct modes *whole_band_modes(const struct whole_band *band) {
    return &band->modes;
}

const struct modes *whole_band_coarser(const struct whole_band *band) {
    return band->coarser.power != NULL ? &band->coarser : NULL;
}
