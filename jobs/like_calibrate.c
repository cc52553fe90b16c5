/* A table spectrum that gives back, measured, what was measured (like_spectrum.h). */
#include "core/statistics/open_roughness.h"
#include "core/surface/surface.h"
#include "jobs/like_spectrum.h"
#include <math.h>
#include <stdlib.h>

static const uint64_t SEED = 20; /* any: the same map has the same fit */
enum { ROUNDS_OF_ROWS = 1, ROUNDS_OF_MOMENTS = 2, PIECES_LEAST = 2, PIECES_MOST = 64 };
static const double POINTS = 2097152; /* about so many of all surfaces of a round */
static const double CHANGE_MOST = 4;  /* of a density in a round */

struct calibration {
    struct like_table *table; /* borrowed, as what follows */
    const struct grid *map, *cell;
    enum detrend detrend;
    const double *squares;          /* LIKE_MOMENTS: of the map */
    double *surface, *piece, *mean; /* owned: of the cell, of the map, a value a row */
    double found[LIKE_MOMENTS];     /* mean squares of the pieces */
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

/* Adds the density of a piece to the mean. */
static int add_piece(struct calibration *c, double weight, struct error *err) {
    const struct measured_map map = {c->map, c->piece, BOUNDARY_OPEN};
    struct like_table found = {0};
    struct trend trend;
    for (size_t j = 0; j < c->map->ny; j++)
        for (size_t i = 0; i < c->map->nx; i++)
            c->piece[j * c->map->nx + i] = c->surface[j * c->cell->nx + i];
    int status = detrend(c->map, c->piece, c->detrend, &trend, err);
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
    uint64_t pieces = (uint64_t)fmin(fmax(wanted, PIECES_LEAST), PIECES_MOST);
    for (size_t row = 0; row < c->table->count; row++)
        c->mean[row] = 0;
    for (size_t m = 0; m < LIKE_MOMENTS; m++)
        c->found[m] = 0;
    int status = make(c, &generator, err);
    for (uint64_t r = 0; r < pieces && status == 0; r++) {
        status = generator_run(generator, (struct random_key){SEED, 0, r}, c->surface, NULL, err);
        if (status == 0)
            status = add_piece(c, 1 / (double)pieces, err);
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
                            .piece = array_create(grid_points(map), sizeof(double))};
    int status = 0;
    if (measured == NULL || c.surface == NULL || c.piece == NULL)
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
    free(c.piece);
    return status;
}
