/* A table spectrum of random surfaces on which the measured values are found again
 * (like_spectrum.h). */
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "jobs/like/like_spectrum.h"
#include <math.h>
#include <stdlib.h>

/* A smooth change of a table spectrum that gives it moments (like_spectrum.h). */

enum { STEPS = 30, PARTS = 16 }; /* of Newton's method; of an interval between rows */
static const double BEND_MOST = 1.4, ENOUGH = 1e-10; /* of the logarithm */

/* Maps the wave numbers between the ends of the table to -1 to 1, by their logarithms. */
static double log_position(const struct like_table *table, double low, double wave_number) {
    double high = table->wave_number[table->count - 1];
    return 2 * log(wave_number / low) / log(high / low) - 1;
}

static double bend_at(const double c[LIKE_MOMENTS], double x) {
    return c[0] + x * (c[1] + x * c[2]);
}

/* Computes sums[m][q]: of the moment of order 2 m, times x^q. */
static void sum_moments(const struct like_table *table, double low, bool profile,
                        const double c[LIKE_MOMENTS], double sums[LIKE_MOMENTS][LIKE_MOMENTS]) {
    for (size_t m = 0; m < LIKE_MOMENTS; m++)
        for (size_t q = 0; q < LIKE_MOMENTS; q++)
            sums[m][q] = 0;
    for (size_t row = 0; row + 1 < table->count; row++) {
        double from = fmax(table->wave_number[row], low), to = table->wave_number[row + 1];
        double ratio = table->density[row + 1] / table->density[row];
        double whole = log(to / table->wave_number[row]);
        if (!(to > from) || !(ratio > 0) || !isfinite(ratio))
            continue;
        double step = log(to / from) / PARTS;
        for (size_t part = 0; part < PARTS; part++) {
            double k = from * exp(((double)part + 0.5) * step), x = log_position(table, low, k);
            double density = table->density[row] *
                             pow(ratio, log(k / table->wave_number[row]) / whole) *
                             exp(bend_at(c, x));
            double weight = density * step * (profile ? k : k * k);
            for (size_t m = 0; m < LIKE_MOMENTS; m++, weight *= k * k)
                for (size_t q = 0; q < LIKE_MOMENTS; q++)
                    sums[m][q] += weight * pow(x, (double)q);
        }
    }
}

/* Solves by Cramer's rule; false where the moments do not determine the change. */
static bool solve(const double a[LIKE_MOMENTS][LIKE_MOMENTS], const double b[LIKE_MOMENTS],
                  double x[LIKE_MOMENTS]) {
    double whole = 0;
    for (int column = -1; column < LIKE_MOMENTS; column++) {
        double d[LIKE_MOMENTS][LIKE_MOMENTS];
        for (int m = 0; m < LIKE_MOMENTS; m++)
            for (int q = 0; q < LIKE_MOMENTS; q++)
                d[m][q] = q == column ? b[m] : a[m][q];
        double value = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                       d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                       d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
        if (column < 0)
            whole = value;
        else
            x[column] = value / whole;
    }
    return fabs(whole) > 1e-12;
}

/* Finds the change by Newton's method on the logarithms of the moments. */
static bool find_bend(const struct like_table *table, double low, bool profile,
                      const double factors[LIKE_MOMENTS], double c[LIKE_MOMENTS]) {
    double before[LIKE_MOMENTS][LIKE_MOMENTS], now[LIKE_MOMENTS][LIKE_MOMENTS];
    sum_moments(table, low, profile, c, before);
    for (int step = 0; step < STEPS; step++) {
        double lacking[LIKE_MOMENTS], change[LIKE_MOMENTS], most = 0;
        sum_moments(table, low, profile, c, now);
        for (int m = 0; m < LIKE_MOMENTS; m++) {
            lacking[m] = log(factors[m] * before[m][0] / now[m][0]);
            most = fmax(most, fabs(lacking[m]));
            for (int q = LIKE_MOMENTS; q-- > 0;)
                now[m][q] /= now[m][0];
        }
        if (most < ENOUGH)
            return true;
        if (!isfinite(most) || !solve((const double(*)[LIKE_MOMENTS])now, lacking, change))
            return false;
        for (int q = 0; q < LIKE_MOMENTS; q++)
            c[q] += change[q];
    }
    return false;
}

void like_table_bend(struct like_table *table, const struct grid *cell,
                     const double factors[LIKE_MOMENTS]) {
    bool profile = grid_is_profile(cell);
    double c[LIKE_MOMENTS] = {0}, side = profile ? cell->lx : fmax(cell->lx, cell->ly);
    double low = fmax(2 * M_PI / side, table->wave_number[0]);
    bool found = find_bend(table, low, profile, factors, c);
    for (size_t row = 0; found && row < table->count; row++)
        found = fabs(bend_at(c, fmax(log_position(table, low, table->wave_number[row]), -1))) <
                BEND_MOST;
    for (size_t row = 0; found && row < table->count; row++)
        table->density[row] *=
            exp(bend_at(c, fmax(log_position(table, low, table->wave_number[row]), -1)));
}

static const uint64_t SEED = 20; /* any: the same map has the same fit */
enum { ROUNDS_OF_ROWS = 1, ROUNDS_OF_MOMENTS = 2, SUB_MAPS_LEAST = 2, SUB_MAPS_MOST = 64 };
static const double POINTS = 2097152; /* of all surfaces of a round, about */
static const double CHANGE_MOST = 4;  /* of a density in a round */

struct calibration {
    struct like_table *table; /* borrowed, as the next fields */
    const struct grid *map, *cell;
    enum detrend detrend;
    const double *squares;                /* LIKE_MOMENTS: of the map */
    double *surface, *map_heights, *mean; /* owned: of the cell, of the map, a value for each row */
    double found[LIKE_MOMENTS];           /* mean squares of the sub-maps */
};

static int make(struct calibration *c, struct generator **generator, struct error *err) {
    struct spectrum spectrum = {.type = SPECTRUM_TABLE,
                                .anisotropy = c->table->anisotropy,
                                .table_count = c->table->count,
                                .table_wave_number = c->table->wave_number,
                                .table_density = c->table->density,
                                .scale = SCALE_RMS_SLOPE};
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = AMPLITUDES_RANDOM;
    int status =
        like_table_slope(c->table, c->cell, sqrt(c->squares[1]), &spectrum.scale_value, err);
    return status == 0 ? generator_create(generator, &spectrum, c->cell, &options, err) : status;
}

/* Adds the density of a sub-map to the mean. */
static int add_sub_map(struct calibration *c, double weight, struct error *err) {
    const struct measured_map map = {c->map, c->map_heights, BOUNDARY_OPEN};
    struct like_table found = {0};
    struct trend trend;
    for (size_t j = 0; j < c->map->ny; j++)
        for (size_t i = 0; i < c->map->nx; i++)
            c->map_heights[j * c->map->nx + i] = c->surface[j * c->cell->nx + i];
    int status = detrend(c->map, c->map_heights, c->detrend, &trend, err);
    struct roughness roughness;
    open_roughness_measure(&map, &roughness);
    c->found[0] += weight * roughness.rms_height * roughness.rms_height;
    c->found[1] += weight * roughness.rms_slope * roughness.rms_slope;
    c->found[2] += weight * roughness.rms_curvature * roughness.rms_curvature;
    if (status == 0)
        status = like_table_measure(&found, &map, c->table->anisotropy, c->table->highest, err);
    for (size_t row = 0; status == 0 && row < found.count; row++)
        c->mean[row] += weight * found.density[row];
    like_table_clear(&found);
    return status;
}

static int measure_round(struct calibration *c, struct error *err) {
    struct generator *generator = NULL;
    double wanted = floor(POINTS / (double)grid_points(c->cell));
    uint64_t sub_maps = (uint64_t)fmin(fmax(wanted, SUB_MAPS_LEAST), SUB_MAPS_MOST);
    for (size_t row = 0; row < c->table->count; row++)
        c->mean[row] = 0;
    for (size_t m = 0; m < LIKE_MOMENTS; m++)
        c->found[m] = 0;
    int status = make(c, &generator, err);
    for (uint64_t r = 0; r < sub_maps && status == 0; r++) {
        status = generator_run(generator, (struct random_key){SEED, 0, r}, c->surface, NULL, err);
        if (status == 0)
            status = add_sub_map(c, 1 / (double)sub_maps, err);
    }
    generator_destroy(&generator);
    return status;
}

static int calibrate_rows(struct calibration *c, const double *measured, struct error *err) {
    int status = measure_round(c, err);
    for (size_t row = 0; row < c->table->count && status == 0; row++) {
        double change = measured[row] / c->mean[row];
        if (isfinite(change))
            c->table->density[row] *= fmin(fmax(change, 1 / CHANGE_MOST), CHANGE_MOST);
    }
    return status;
}

static int calibrate_moments(struct calibration *c, struct error *err) {
    double wanted[LIKE_MOMENTS];
    int status = measure_round(c, err);
    for (size_t m = 0; m < LIKE_MOMENTS && status == 0; m++)
        wanted[m] = c->squares[m] / c->found[m];
    if (status == 0)
        like_table_bend(c->table, c->cell, wanted);
    return status;
}

int like_table_calibrate(struct like_table *table, const struct grid *map, enum detrend kind,
                         const struct grid *cell, const double squares[LIKE_MOMENTS],
                         struct error *err) {
    double *measured = array_create(2 * table->count, sizeof *measured);
    struct calibration c = {.table = table,
                            .map = map,
                            .cell = cell,
                            .detrend = kind,
                            .squares = squares,
                            .surface = array_create(grid_points(cell), sizeof(double)),
                            .map_heights = array_create(grid_points(map), sizeof(double))};
    int status = 0;
    if (measured == NULL || c.surface == NULL || c.map_heights == NULL)
        status = error_memory(err, grid_points(cell) * sizeof(double), "a surface to compare with");
    else
        c.mean = measured + table->count;
    for (size_t row = 0; row < table->count && status == 0; row++)
        measured[row] = table->density[row];
    for (int round = 0; round < ROUNDS_OF_ROWS && status == 0; round++)
        status = calibrate_rows(&c, measured, err);
    for (int round = 0; round < ROUNDS_OF_MOMENTS && status == 0; round++)
        status = calibrate_moments(&c, err);
    free(measured);
    free(c.surface);
    free(c.map_heights);
    return status;
}
