#include "jobs/like/like_spectrum.h"
#include "core/theory/sampled_field.h"
#include <math.h>
#include <stdlib.h>

enum { PARTS_OF_OCTAVE = 4, FEWEST_RINGS = 4 };
static const double ROUNDING = 1e-9; /* relative, of wave numbers */
static const double LONGER = 64;     /* the table has waves of cells so many times as long */

void like_table_clear(struct like_table *table) {
    free(table->wave_number);
    free(table->density);
    *table = (struct like_table){0};
}

static void add_row(struct like_table *table, double wave_number, double density) {
    table->wave_number[table->count] = wave_number;
    table->density[table->count++] = density;
}

/* Exponent of the density of a rough surface over the wave number: H is about 0.75. */
static double fall_of(bool profile) {
    return profile ? 2.5 : 3.5;
}

/* Adds a row with the mean of rings first..last - 1, weighted by their numbers of waves. The
 * exponent is taken out, so that the row is at the middle of their logarithms. */
static void add_rings(struct like_table *table, size_t first, size_t last,
                      const double *wave_number, const double *density, bool profile) {
    double fall = fall_of(profile);
    double middle = sqrt(wave_number[first] * wave_number[last - 1]), sum = 0, weight = 0;
    for (size_t r = first; r < last; r++) {
        double waves = profile ? 1 : (double)r;
        sum += waves * density[r] * pow(wave_number[r] / middle, fall);
        weight += waves;
    }
    add_row(table, middle, sum / weight);
}

/* Returns the wave number below which all but a small part of the fourth moment lies. Beyond it a
 * spectrum with a cut-off has only leakage of the window. */
static double highest_of(const double *wave_number, const double *density, size_t bins, double most,
                         bool profile) {
    static const double BEYOND = 1e-4;
    double total = 0, above = 0;
    size_t last = bins - 1;
    while (last > 1 && wave_number[last] > most * (1 + ROUNDING))
        last--;
    for (size_t r = 1; r <= last; r++)
        total += (profile ? 1 : (double)r) * density[r] * pow(wave_number[r], 4);
    for (size_t r = last; r > 2; r--) {
        above += (profile ? 1 : (double)r) * density[r] * pow(wave_number[r], 4);
        if (above > BEYOND * total)
            return r == last ? most : wave_number[r];
    }
    return most;
}

/* first: the first ring. */
static void smooth(struct like_table *out, const double *wave_number, const double *density,
                   size_t first, size_t bins, double most, bool profile) {
    double octave = pow(2, 1.0 / PARTS_OF_OCTAVE);
    add_row(out, wave_number[first] / LONGER, density[first]);
    while (first < bins && wave_number[first] <= most * (1 + ROUNDING)) {
        size_t last = first + 1;
        while (last < bins && wave_number[last] <= wave_number[first] * octave &&
               wave_number[last] <= most * (1 + ROUNDING))
            last++;
        add_rings(out, first, last, wave_number, density, profile);
        first = last;
    }
    double last = out->wave_number[out->count - 1];
    if (last < most * (1 - ROUNDING))
        add_row(out, most, out->density[out->count - 1] * pow(most / last, -fall_of(profile)));
}

/* Returns the first ring behind those without waves, which small ellipses may be. */
static size_t first_of(const struct map_spectrum *rings) {
    size_t first = 1;
    for (size_t r = 1; r < rings->rings; r++)
        first = rings->freedom[r] > 0 ? first : r + 1;
    return first;
}

static int rows_fill(struct like_table *out, const struct map_spectrum *rings,
                     const double *density, size_t bins, double most, struct error *err) {
    const struct grid *grid = &rings->modes.grid;
    const bool profile = grid_is_profile(grid);
    const size_t first = first_of(rings);
    *out = (struct like_table){.lay = rings->lay,
                               .wave_number = array_create(bins + 2, sizeof *out->wave_number),
                               .density = array_create(bins + 2, sizeof *out->density)};
    if (out->wave_number == NULL || out->density == NULL) {
        like_table_clear(out);
        return error_memory(err, 2 * bins * sizeof *density, "a table spectrum");
    }
    if (first + FEWEST_RINGS > bins) {
        like_table_clear(out);
        return error_set(err, ERROR_INPUT, "the map is too small for a spectrum");
    }
    if (most == 0)
        most = highest_of(rings->wave_number, density, bins, M_PI / grid_dx(grid), profile);
    smooth(out, rings->wave_number, density, first, bins, most, profile);
    out->highest = out->wave_number[out->count - 1];
    return 0;
}

int like_table_measure(struct like_table *out, const struct map_spectrum *rings,
                       const struct like_noise *noise, struct error *err) {
    static const double LEAST = 0.05; /* of what was measured: what is left has an error, too */
    if (noise->density == 0)
        return rows_fill(out, rings, rings->density, rings->rings, 0, err);
    double *rest = array_create(rings->rings, sizeof *rest);
    if (rest == NULL)
        return error_memory(err, rings->rings * sizeof *rest, "a spectral density");
    for (size_t r = 0; r < rings->rings; r++)
        rest[r] = fmax(rings->density[r] - noise->density, LEAST * rings->density[r]);
    int status = rows_fill(out, rings, rest, rings->rings, noise->wave_number, err);
    free(rest);
    return status;
}

int like_table_rows(const struct like_table *table, const struct map_spectrum *rings,
                    const double *density, double *rows, struct error *err) {
    struct like_table found;
    int status = rows_fill(&found, rings, density, rings->rings, table->highest, err);
    if (status != 0)
        return status;
    for (size_t row = 0; row < table->count; row++)
        rows[row] = row < found.count ? found.density[row] : (double)NAN;
    like_table_clear(&found);
    return 0;
}

void like_table_spectrum(const struct like_table *table, struct spectrum *out) {
    *out = (struct spectrum){.type = SPECTRUM_TABLE,
                             .anisotropy = table->lay.ratio,
                             .lay_angle = table->lay.angle,
                             .table_count = table->count,
                             .table_wave_number = table->wave_number,
                             .table_density = table->density};
}

int like_table_slope(const struct like_table *table, const struct grid *cell, double measured,
                     double *rms_slope, struct error *err) {
    struct spectrum spectrum;
    struct modes *modes = NULL;
    struct moments moments;
    struct sampled_moments sampled;
    like_table_spectrum(table, &spectrum);
    int status = modes_create(&modes, &spectrum, cell, err);
    if (status != 0)
        return status;
    modes_moments(modes, &moments);
    sampled_moments(modes, &sampled);
    *rms_slope = moments.rms_slope * measured / sampled.rms_slope;
    modes_destroy(&modes);
    return 0;
}
