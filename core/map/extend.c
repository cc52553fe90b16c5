#include "core/map/extend.h"
#include "core/error.h"
#include "core/map/map_law.h"
#include "core/map/membrane.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A map is held to within this share of its RMS height where no noise is seen. */
static const double NOISE_LEAST = 1e-3;

/* Fills the powers of the waves of the cell. */
static int powers_create(double **out, const struct grid *cell, const struct map_law *law,
                         struct error *err) {
    const size_t modes = (cell->nx / 2 + 1) * cell->ny;
    const double x = 2 * M_PI / cell->lx, y = grid_is_profile(cell) ? 1 : 2 * M_PI / cell->ly;
    double *power = array_create(modes, sizeof *power);
    if (power == NULL)
        return error_memory(err, modes * sizeof *power, "the law of a map");
    map_law_fill(law, cell, map_law_whole_density, power);
    for (size_t m = 0; m < modes; m++)
        power[m] *= x * y;
    *out = power;
    return 0;
}

/* Replaces the heights of the map, whose mean is given, by those of a draw on the cell. */
static int draw(struct height_map *map, const struct conditional_law *law, double mean,
                uint64_t seed, struct extend_result *out, struct error *err) {
    const struct grid *grid = &map->grid, *cell = law->cell;
    const size_t points = grid_points(grid);
    double *z = array_create(grid_points(cell), sizeof *z), *held = array_create(points, sizeof *z);
    int status = z != NULL && held != NULL
                     ? 0
                     : error_memory(err, grid_points(cell) * sizeof *z, "a map of twice the sides");
    if (status == 0) {
        for (size_t p = 0; p < points; p++)
            held[p] = map->z[p] - mean;
        status = conditional_draw(law, &(struct conditional_patch){grid->nx, grid->ny, held},
                                  (struct random_key){seed, 0, 0}, z, &out->draw, err);
    }
    free(held);
    if (status != 0) {
        free(z);
        return status;
    }
    for (size_t p = 0; p < grid_points(cell); p++)
        z[p] += mean;
    free(map->z);
    map->z = z;
    map->grid = *cell;
    return 0;
}

/* Fits the law to the map with its holes filled: what a spectrum leaves at the rims of holes looks
 * like noise. */
static int fit(struct map_law *out, const struct height_map *map, struct error *err) {
    const size_t points = grid_points(&map->grid);
    double *filled = array_create(points, sizeof *filled);
    if (filled == NULL)
        return error_memory(err, points * sizeof *filled, "the law of a map");
    memcpy(filled, map->z, points * sizeof *filled);
    const struct measured_map whole = {&map->grid, filled, BOUNDARY_OPEN};
    struct roughness roughness;
    int status = membrane_fill(&map->grid, filled, BOUNDARY_OPEN, err);
    if (status == 0)
        status = map_law_fit(out, &whole, err);
    if (status == 0 && !out->fit.fitted) {
        map_law_clear(out);
        status = error_set(err, ERROR_INPUT,
                           "no law fits the spectrum of the map: it has too few wavelengths that "
                           "can be trusted");
    }
    if (status == 0) {
        map_roughness_measure(&whole, &roughness);
        /* what governs nothing is held as part of the surface */
        if (!(spectrum_fit_noise_share(&out->fit, &map->grid, roughness.rms_curvature) >
              NOISE_SHARE_MOST))
            out->fit.noise = 0;
    }
    free(filled);
    return status;
}

int map_extend(struct height_map *map, uint64_t seed, struct extend_result *out,
               struct error *err) {
    const struct grid *grid = &map->grid;
    const bool profile = grid_is_profile(grid);
    const struct grid cell = {2 * grid->nx, profile ? 1 : 2 * grid->ny, 2 * grid->lx,
                              profile ? grid->ly : 2 * grid->ly};
    const struct measured_map measured = {grid, map->z, BOUNDARY_OPEN};
    const double whole = 4 * M_PI * M_PI / (grid_dx(grid) * grid_dy(grid));
    struct map_law law;
    struct roughness roughness;
    double *power = NULL;
    *out = (struct extend_result){.noise = 0};
    if (grid_points(&cell) > (size_t)1 << 31)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu by %zu points has one of twice its sides of more than the "
                         "2^31 points that a map may have",
                         grid->nx, grid->ny);
    map_roughness_measure(&measured, &roughness);
    if (!(roughness.rms_height > 0))
        return error_set(err, ERROR_INPUT, "the map has no heights that differ");
    int status = fit(&law, map, err);
    if (status != 0)
        return status;
    status = powers_create(&power, &cell, &law, err);
    map_law_clear(&law);
    if (status != 0)

        if (status != 0)
            return status;
    const double seen = sqrt(law.fit.noise * (profile ? 2 * M_PI / grid_dx(grid) : whole));
    const double least = NOISE_LEAST * roughness.rms_height;
    out->noise_seen = seen > least;
    out->noise = fmax(seen, least);
    out->law_holds = law.fit.deviance <= law.fit.deviance_limit;
    out->skewness = roughness.skewness;
    out->kurtosis = roughness.kurtosis;
    status = draw(map, &(struct conditional_law){&cell, power, out->noise * out->noise},
                  roughness.mean, seed, out, err);
    free(power);
    return status;
}
