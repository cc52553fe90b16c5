/* A table spectrum of random surfaces on which the measured values are found again
 * (like_spectrum.h). */
#include "jobs/like/like_expectation.h"
#include "jobs/like/like_spectrum.h"
#include <math.h>
#include <stdlib.h>

/* A smooth change of a table spectrum that gives it moments: its logarithm is a constant, a part of
 * the waves that make the height, and a part of those that make the curvature. */

enum { STEPS = 30, PARTS = 16 }; /* of Newton's method; of an interval between rows */
static const double BEND_MOST = 1.4, ENOUGH = 1e-10; /* of the logarithm */

struct bend {
    double height, curvature; /* wave numbers about which the parts end and begin */
    double c[LIKE_MOMENTS];
};

static void parts_at(const struct bend *bend, double k, double parts[LIKE_MOMENTS]) {
    const double low = k / bend->height, high = k / bend->curvature;
    parts[0] = 1;
    parts[1] = 1 / (1 + low * low);
    parts[2] = high * high / (1 + high * high);
}

static double bend_at(const struct bend *bend, double k) {
    double parts[LIKE_MOMENTS], sum = 0;
    parts_at(bend, k, parts);
    for (size_t q = 0; q < LIKE_MOMENTS; q++)
        sum += bend->c[q] * parts[q];
    return sum;
}

/* Computes sums[m][q]: of mean square m, times part q. */
static void sum_moments(const struct like_waves waves[LIKE_WAVES], const struct bend *bend,
                        double sums[LIKE_MOMENTS][LIKE_MOMENTS]) {
    for (size_t m = 0; m < LIKE_MOMENTS; m++)
        for (size_t q = 0; q < LIKE_MOMENTS; q++)
            sums[m][q] = 0;
    for (size_t n = 0; n < LIKE_WAVES; n++) {
        double parts[LIKE_MOMENTS];
        if (waves[n].wave_number == 0)
            continue;
        const double change = exp(bend_at(bend, waves[n].wave_number));
        parts_at(bend, waves[n].wave_number, parts);
        for (size_t m = 0; m < LIKE_MOMENTS; m++)
            for (size_t q = 0; q < LIKE_MOMENTS; q++)
                sums[m][q] += waves[n].squares[m] * change * parts[q];
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

/* Returns the root mean square wave number of what makes up a mean square. */
static double wave_of(const struct like_waves waves[LIKE_WAVES], int moment) {
    double sum = 0, square = 0;
    for (size_t n = 0; n < LIKE_WAVES; n++) {
        sum += waves[n].squares[moment];
        square += waves[n].squares[moment] * waves[n].wave_number * waves[n].wave_number;
    }
    return sqrt(square / sum);
}

/* Finds by Newton's method, on the logarithms, the change that gives the mean squares. */
static bool find_bend(const struct like_waves waves[LIKE_WAVES], const double squares[LIKE_MOMENTS],
                      struct bend *bend) {
    double now[LIKE_MOMENTS][LIKE_MOMENTS];
    *bend = (struct bend){.height = wave_of(waves, 0), .curvature = wave_of(waves, 1)};
    for (int step = 0; step < STEPS; step++) {
        double lacking[LIKE_MOMENTS], change[LIKE_MOMENTS], most = 0;
        sum_moments(waves, bend, now);
        for (int m = 0; m < LIKE_MOMENTS; m++) {
            lacking[m] = log(squares[m] / now[m][0]);
            most = fmax(most, fabs(lacking[m]));
            for (int q = LIKE_MOMENTS; q-- > 0;)
                now[m][q] /= now[m][0];
        }
        if (most < ENOUGH)
            return true;
        if (!isfinite(most) || !solve((const double(*)[LIKE_MOMENTS])now, lacking, change))
            return false;
        for (int q = 0; q < LIKE_MOMENTS; q++)
            bend->c[q] += fmin(fmax(change[q], -1), 1);
    }
    return false;
}

/* Changes the density so that sub-maps have these mean squares. Does nothing where that takes more
 * than a factor of four somewhere. */
static void table_bend(struct like_table *table, const struct like_waves waves[LIKE_WAVES],
                       const double squares[LIKE_MOMENTS]) {
    struct bend bend;
    bool found = find_bend(waves, squares, &bend);
    for (size_t row = 0; found && row < table->count; row++)
        found = fabs(bend_at(&bend, table->wave_number[row])) < BEND_MOST;
    for (size_t row = 0; found && row < table->count; row++)
        table->density[row] *= exp(bend_at(&bend, table->wave_number[row]));
}

enum { ROUNDS_OF_ROWS = 4, ROUNDS_OF_MOMENTS = 3 };
static const double CHANGE_MOST = 4; /* of a density in a round */

struct calibration {
    struct like_table *table; /* borrowed, as the next fields */
    const struct map_spectrum *rings;
    const struct grid *cell;
    double *squares; /* LIKE_MOMENTS: of the map */
    struct like_expectation *expectation;
    double *density, *wanted, *expected; /* of rings; of rows */
    struct like_waves *waves;
};

/* The table's spectrum in the scale in which forward differences are those of the map. */
static int spectrum_of(const struct calibration *c, struct spectrum *out, struct error *err) {
    like_table_spectrum(c->table, out);
    out->scale = SCALE_RMS_SLOPE;
    return like_table_slope(c->table, c->cell, sqrt(c->squares[1]), &out->scale_value, err);
}

static int calibrate_rows(struct calibration *c, struct error *err) {
    struct spectrum spectrum;
    int status = spectrum_of(c, &spectrum, err);
    if (status == 0)
        status = like_expectation_rings(c->expectation, &spectrum, c->density, err);
    if (status == 0)
        status = like_table_rows(c->table, c->rings, c->density, c->expected, err);
    for (size_t row = 0; row < c->table->count && status == 0; row++) {
        double change = c->wanted[row] / c->expected[row];
        if (isfinite(change))
            c->table->density[row] *= fmin(fmax(change, 1 / CHANGE_MOST), CHANGE_MOST);
    }
    return status;
}

static int calibrate_moments(struct calibration *c, struct error *err) {
    struct spectrum spectrum;
    int status = spectrum_of(c, &spectrum, err);
    if (status == 0)
        status = like_expectation_waves(c->expectation, &spectrum, c->waves, err);
    if (status == 0)
        table_bend(c->table, c->waves, c->squares);
    return status;
}

/* Fills the largest difference that is left. */
static int measure_left(const struct calibration *c, struct like_left *left, struct error *err) {
    struct spectrum spectrum;
    int status = spectrum_of(c, &spectrum, err);
    if (status == 0)
        status = like_expectation_waves(c->expectation, &spectrum, c->waves, err);
    *left = (struct like_left){0};
    for (int m = 0; m < LIKE_MOMENTS && status == 0; m++) {
        double sum = 0;
        for (size_t n = 0; n < LIKE_WAVES; n++)
            sum += c->waves[n].squares[m];
        double relative = sqrt(sum / c->squares[m]) - 1;
        if (!(fabs(relative) <= fabs(left->relative)))
            *left = (struct like_left){relative, m};
    }
    return status;
}

/* Returns the density of the map over that of the surfaces, by the waves that make the slope. */
static int measure_scale(const struct calibration *c, const struct spectrum *spectrum,
                         double *scale, struct error *err) {
    const int power = grid_is_profile(c->cell) ? 3 : 4; /* rows are even in logarithms */
    double map = 0, surfaces = 0;
    int status = like_expectation_rings(c->expectation, spectrum, c->density, err);
    if (status == 0)
        status = like_table_rows(c->table, c->rings, c->density, c->expected, err);
    for (size_t row = 0; status == 0 && row < c->table->count; row++) {
        const double weight = pow(c->table->wave_number[row] / c->table->highest, power);
        if (!isfinite(c->expected[row]))
            continue;
        map += weight * c->wanted[row];
        surfaces += weight * c->expected[row];
    }
    *scale = map / surfaces;
    return status;
}

static const double NOISE_MOST = 0.5; /* of a mean square */

/* Takes the noise out of the mean squares. It adds to them what independent heights have. Where
 * that is most of them, what is left is known less than what surfaces of the rings have, over the
 * part of the map that their window shows. */
static int squares_without(struct calibration *c, const struct like_noise *noise,
                           struct error *err) {
    const struct grid *grid = &c->rings->modes.grid;
    const double whole = 2 * M_PI / grid_dx(grid); /* of wave numbers, along an axis */
    const double power = noise->density * (grid_is_profile(grid) ? whole : whole * whole);
    const double square = grid_dx(grid) * grid_dx(grid);
    const double own[LIKE_MOMENTS] = {power, (grid_is_profile(grid) ? 2 : 4) * power / square,
                                      (grid_is_profile(grid) ? 6 : 5) * power / (square * square)};
    struct spectrum spectrum;
    double scale;
    int status = spectrum_of(c, &spectrum, err);
    if (status == 0)
        status = measure_scale(c, &spectrum, &scale, err);
    if (status == 0)
        status = like_expectation_waves(c->expectation, &spectrum, c->waves, err);
    if (status == 0 && !(c->squares[0] > power))
        return error_set(err, ERROR_INPUT,
                         "the map has no more than noise: RMS height %g, noise %g",
                         sqrt(c->squares[0]), sqrt(power));
    for (int m = 0; status == 0 && m < LIKE_MOMENTS; m++) {
        if (m == 0 || own[m] < NOISE_MOST * c->squares[m]) {
            c->squares[m] -= own[m];
            continue;
        }
        c->squares[m] = 0;
        for (size_t n = 0; n < LIKE_WAVES; n++)
            c->squares[m] += scale * c->waves[n].squares[m];
    }
    return status;
}

static int calibrate(struct calibration *c, const struct like_noise *noise, struct like_left *left,
                     struct error *err) {
    int status = 0;
    for (int round = 0; round < ROUNDS_OF_ROWS && status == 0; round++)
        status = calibrate_rows(c, err);
    if (status == 0 && noise->density > 0)
        status = squares_without(c, noise, err);
    for (int round = 0; round < ROUNDS_OF_MOMENTS && status == 0; round++)
        status = calibrate_moments(c, err);
    return status == 0 ? measure_left(c, left, err) : status;
}

int like_table_calibrate(struct like_table *table, const struct map_spectrum *rings,
                         enum detrend kind, const struct grid *cell, const struct like_noise *noise,
                         double squares[LIKE_MOMENTS], struct like_left *left, struct error *err) {
    double *wanted = array_create(2 * table->count, sizeof *wanted);
    struct calibration c = {.table = table,
                            .rings = rings,
                            .cell = cell,
                            .squares = squares,
                            .wanted = wanted,
                            .density = array_create(rings->rings, sizeof(double)),
                            .waves = array_create(LIKE_WAVES, sizeof(struct like_waves))};
    int status = wanted != NULL && c.density != NULL && c.waves != NULL
                     ? like_expectation_create(&c.expectation, rings, kind, cell, err)
                     : error_memory(err, 2 * table->count * sizeof *wanted, "a table spectrum");
    if (status == 0) {
        c.expected = wanted + table->count;
        for (size_t row = 0; row < table->count; row++)
            wanted[row] = table->density[row];
        status = calibrate(&c, noise, left, err);
    }
    like_expectation_destroy(&c.expectation);
    free(wanted);
    free(c.density);
    free(c.waves);
    return status;
}
