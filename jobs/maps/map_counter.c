#include "jobs/maps/map_counter.h"
#include "core/surface/modes.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SPACING = 1e-6; /* relative difference of spacings that are equal */
static const double DEVIATIONS = 3; /* of a correlation beyond which faces are not independent */
static const double SAME_HEIGHTS = 0.99; /* correlation of maps of one face */

bool map_correlation_stands_out(const struct map_correlation *correlation) {
    double value = fabs(correlation->value);
    return value > DEVIATIONS * correlation->deviation || value > SAME_HEIGHTS;
}

static bool are_equal(double a, double b) {
    return fabs(a - b) <= SPACING * fmax(fabs(a), fabs(b));
}

static int check(const struct height_map *map, const struct height_map *counter, bool periodic,
                 struct error *err) {
    const struct grid *one = &map->grid, *other = &counter->grid;
    bool profile = grid_is_profile(one);
    if (profile != grid_is_profile(other))
        return error_set(err, ERROR_INPUT, "a profile and a surface cannot be pressed together");
    if (strcmp(map->xy_unit, counter->xy_unit) != 0 || strcmp(map->z_unit, counter->z_unit) != 0)
        return error_set(err, ERROR_INPUT,
                         "units of length of both maps differ: x in \"%s\" and \"%s\", z in \"%s\" "
                         "and \"%s\"; --unit and --z-unit name those of files without",
                         map->xy_unit, counter->xy_unit, map->z_unit, counter->z_unit);
    if (!are_equal(grid_dx(one), grid_dx(other)) ||
        (!profile && !are_equal(grid_dy(one), grid_dy(other))))
        return error_set(err, ERROR_INPUT,
                         "points of both maps are %g by %g and %g by %g apart; --resample SPACING "
                         "makes them equal",
                         grid_dx(one), profile ? 0 : grid_dy(one), grid_dx(other),
                         profile ? 0 : grid_dy(other));
    if (periodic && (one->nx != other->nx || one->ny != other->ny))
        return error_set(err, ERROR_INPUT,
                         "periodic maps of %zu by %zu and %zu by %zu points have no common cell; "
                         "--crop or --boundary open",
                         one->nx, one->ny, other->nx, other->ny);
    return 0;
}

/* Keeps the first nx by ny points. The memory stays as large as it was. */
static void crop(struct height_map *map, size_t nx, size_t ny) {
    struct grid *grid = &map->grid;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    if (nx == grid->nx && ny == grid->ny)
        return;
    for (size_t j = 1; j < ny; j++)
        memmove(map->z + j * nx, map->z + j * grid->nx, nx * sizeof *map->z);
    *grid = (struct grid){nx, ny, dx * (double)nx, ny > 1 ? dy * (double)ny : grid->ly};
}

static void turn_over(struct height_map *map) {
    size_t nx = map->grid.nx;
    for (size_t j = 0; j < map->grid.ny; j++)
        for (size_t i = 0; i < nx / 2; i++) {
            double *row = map->z + j * nx, z = row[i];
            row[i] = row[nx - 1 - i];
            row[nx - 1 - i] = z;
        }
}

/* Sums over the waves of two maps of one grid, but the mean. */
static void correlate(struct transform *one, struct transform *other, const struct grid *grid,
                      struct map_correlation *out) {
    const double complex *a = transform_spectrum(one), *b = transform_spectrum(other);
    double cross = 0, powers = 0, own = 0, others = 0;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++, a++, b++) {
            double weight = mx + row == 0 ? 0 : modes_weight(grid, mx);
            double power = creal(*a * conj(*a)), other_power = creal(*b * conj(*b));
            cross += weight * creal(*a * conj(*b));
            own += weight * power;
            others += weight * other_power;
            powers += weight * power * other_power;
        }
    bool rough = own > 0 && others > 0;
    out->value = rough ? cross / sqrt(own * others) : 0;
    out->deviation = rough ? sqrt(powers / (own * others)) : 0;
}

static int correlation_measure(const struct height_map *map, const struct height_map *counter,
                               struct map_correlation *out, struct error *err) {
    const struct grid *grid = &map->grid;
    struct transform *one = NULL, *other = NULL;
    int status = transform_create(&one, grid, grid->nx / 2, grid->ny / 2, err);
    if (status == 0)
        status = transform_create(&other, grid, grid->nx / 2, grid->ny / 2, err);
    if (status == 0) {
        transform_forward(one, map->z);
        transform_forward(other, counter->z);
        correlate(one, other, grid, out);
    }
    transform_destroy(&one);
    transform_destroy(&other);
    return status;
}

int map_counter_add(struct height_map *map, struct height_map *counter, bool periodic,
                    struct map_counter *out, struct error *err) {
    const struct grid *one = &map->grid, *other = &counter->grid;
    int status = check(map, counter, periodic, err);
    if (status != 0)
        return status;
    *out = (struct map_counter){.nx = one->nx < other->nx ? one->nx : other->nx,
                                .ny = one->ny < other->ny ? one->ny : other->ny};
    out->cropped = one->nx != other->nx || one->ny != other->ny;
    crop(counter, out->nx, out->ny);
    crop(map, out->nx, out->ny);
    status = correlation_measure(map, counter, &out->as_held, err);
    turn_over(counter);
    if (status == 0)
        status = correlation_measure(map, counter, &out->facing, err);
    for (size_t i = 0; i < out->nx * out->ny && status == 0; i++)
        map->z[i] += counter->z[i];
    return status;
}
