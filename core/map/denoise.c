#include "core/map/denoise.h"
#include "core/error.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>

/* The law of a map, and the lay that its ellipses have. */
struct lay_law {
    struct spectrum_fit fit; /* of waves across the lay */
    struct lay lay;
};

/* Finds the lay of a surface whose directions differ. */
static int find_lay(struct lay *lay, const struct measured_map *map,
                    const struct map_spectrum *circles, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    *lay = LAY_NONE;
    if (grid_is_profile(map->grid))
        return 0;
    int status = map_directions_find(&directions, map, circles, err);
    return status == 0 ? map_directions_lay(lay, &directions, circles, &by_the_map, err) : status;
}

static int fit_law(struct lay_law *law, const struct measured_map *map, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_spectrum *circles = NULL, *ellipses = NULL;
    int status = map_spectrum_create(&circles, map, err);
    if (status == 0)
        status = find_lay(&law->lay, map, circles, err);
    if (status == 0)
        status = spectrum_fit_along(circles, &law->lay, &by_the_map, &ellipses, &law->fit, err);
    map_spectrum_destroy(&ellipses);
    map_spectrum_destroy(&circles);
    if (status == 0)
        law->fit.lay_ratio.value = 1; /* densities are those of waves across */
    return status;
}

/* Returns what a wave number across the lay is multiplied by. Longer waves than the law's have
 * little noise, as its longest. */
static double gain(const struct spectrum_fit *fit, double wave_number) {
    static const double GUARD = 1e-9;
    const double longest = fmin(fit->longest, fit->trusted_from) * (1 - GUARD);
    if (wave_number * fit->shortest > 2 * M_PI * (1 + GUARD))
        return 0;
    const double law = spectrum_fit_density(fit, fmax(wave_number, 2 * M_PI / longest));
    return sqrt(law / (law + fit->noise));
}

/* Fills one value a wave of the half spectrum, of a cell of that length to the points' own. */
static void symbol_fill(const struct lay_law *law, const struct grid *cell, double *symbol) {
    const struct lay_frame frame = lay_frame_of(&law->lay);
    const double x = 2 * M_PI / cell->lx, y = 2 * M_PI / cell->ly;
    for (size_t mx = 0; mx <= cell->nx / 2; mx++)
        for (size_t row = 0; row < cell->ny; row++) {
            const double my = row <= cell->ny / 2 ? (double)row : (double)row - (double)cell->ny;
            *symbol++ =
                gain(&law->fit, grid_is_profile(cell) ? (double)mx * x
                                                      : lay_length(&frame, (double)mx * x, my * y));
        }
}

/* The cell that repeats: of an open map with its mirror images. */
static struct grid repeated_cell(const struct grid *grid, bool open) {
    struct grid cell = *grid;
    if (!open)
        return cell;
    cell.nx *= 2;
    cell.lx *= 2;
    if (!grid_is_profile(grid)) {
        cell.ny *= 2;
        cell.ly *= 2;
    }
    return cell;
}

static size_t mirrored(size_t i, size_t n) {
    return i < n ? i : 2 * n - 1 - i;
}

static int filter(const struct lay_law *law, const struct grid *grid, double *z, bool open,
                  struct error *err) {
    const struct grid cell = repeated_cell(grid, open);
    const size_t points = grid_points(&cell), modes = (cell.nx / 2 + 1) * cell.ny;
    struct transform *transform = NULL;
    double *field = array_create(points + modes, sizeof *field), *symbol = NULL;
    if (field == NULL)
        return error_memory(err, (points + modes) * sizeof *field, "a map without noise");
    symbol = field + points;
    int status = transform_create(&transform, &cell, cell.nx / 2, cell.ny / 2, err);
    if (status == 0) {
        for (size_t j = 0; j < cell.ny; j++)
            for (size_t i = 0; i < cell.nx; i++)
                field[j * cell.nx + i] =
                    z[mirrored(j, grid->ny) * grid->nx + mirrored(i, grid->nx)];
        symbol_fill(law, &cell, symbol);
        transform_filter(transform, symbol, 1, field, field);
        for (size_t j = 0; j < grid->ny; j++)
            for (size_t i = 0; i < grid->nx; i++)
                z[j * grid->nx + i] = field[j * cell.nx + i];
    }
    transform_destroy(&transform);
    free(field);
    return status;
}

int map_denoise(const struct grid *grid, double *z, enum boundary boundary,
                struct denoise_result *out, struct error *err) {
    const struct measured_map map = {grid, z, boundary};
    const double whole = 2 * M_PI / grid_dx(grid);
    struct lay_law law = {.fit.fitted = false};
    struct roughness roughness;
    *out = (struct denoise_result){.found = false};
    int status = fit_law(&law, &map, err);
    const struct spectrum_fit *fit = &law.fit;
    if (status != 0 || !fit->fitted)
        return status;
    map_roughness_measure(&map, &roughness);
    out->slope_before = out->slope_after = roughness.rms_slope;
    if (!(spectrum_fit_noise_share(fit, grid, roughness.rms_curvature) > NOISE_SHARE_MOST))
        return 0;
    out->found = true;
    out->noise = sqrt(fit->noise * (grid_is_profile(grid) ? whole : whole * whole));
    out->shortest = fit->shortest;
    status = filter(&law, grid, z, boundary == BOUNDARY_OPEN, err);
    if (status == 0)
        map_roughness_measure(&map, &roughness);
    out->slope_after = roughness.rms_slope;
    return status;
}
