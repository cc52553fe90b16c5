#include "jobs/like/like_estimate.h"
#include "core/statistics/heights/height_fit.h"
#include "core/statistics/heights/height_quantiles.h"
#include "core/statistics/spectra/map_spectrum.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/surface/spectrum.h"
#include "jobs/surface/surface_case.h"
#include <math.h>
#include <stdlib.h>

static const double HURST_LEAST = 0.01;
enum { CELL_SIDES = 2 }; /* of a cell, in sides of the map */

static const char *const SQUARES[LIKE_MOMENTS] = {"height", "slope", "curvature"};

/* A fit in progress. */
struct fit {
    const struct measured_map *map;
    const struct like_choices *choices;
    bool profile;
    struct map_spectrum *circles;  /* owned, as the next: of the map */
    struct map_spectrum *ellipses; /* along its lay; NULL where it has none */
    struct like_estimate *out;
};

/* --- the spectrum --- */

/* Finds whether directions differ, from the map alone. */
static int find_lay(struct fit *fit, struct lay *lay, struct error *err) {
    static const double RATIO_MOST = 100;
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    *lay = LAY_NONE;
    if (fit->profile)
        return 0;
    int status = map_directions_find(&directions, fit->map, fit->circles, err);
    if (status == 0)
        status = map_directions_lay(lay, &directions, fit->circles, &by_the_map, err);
    if (status != 0 || !lay_is_plain(lay) || !map_directions_differ(&directions))
        return status;
    /* no one lay is most likely: that of the slopes is next */
    *lay = (struct lay){.ratio = directions.fine.ratio,
                        .angle = remainder(directions.fine.direction + M_PI / 2, M_PI)};
    if (lay->ratio < RATIO_MOST)
        return 0;
    *lay = LAY_NONE;
    if (fit->choices->spectrum == LIKE_SPECTRUM_GIVEN)
        return 0;
    return error_set(
        err, ERROR_INPUT,
        "slopes of the map differ by direction by a factor of %.3g, as those of grooves "
        "that do not end; random surfaces have less than %g: give the spectrum",
        directions.fine.ratio, RATIO_MOST);
}

/* Measures the rings of the map and the law that fits them, over the ellipses of its lay. */
static int measure_rings(struct fit *fit, struct error *err) {
    struct lay lay;
    int status = map_spectrum_create(&fit->circles, fit->map, err);
    if (status == 0)
        status = find_lay(fit, &lay, err);
    if (status == 0)
        status = spectrum_fit_along(fit->circles, &lay, &(struct spectrum_fit_request){0},
                                    &fit->ellipses, &fit->out->law, err);
    if (status == 0 && fit->ellipses != NULL)
        fit->out->lay = fit->ellipses->lay;
    return status;
}

static void choose_cell(struct fit *fit) {
    const struct grid *grid = fit->map->grid;
    double dx = grid_dx(grid);
    struct grid *cell = &fit->out->cell;
    cell->nx = surface_case_side(CELL_SIDES * (double)grid->nx - 0.5); /* has small prime factors */
    cell->ny = fit->profile ? 1 : surface_case_side(CELL_SIDES * (double)grid->ny - 0.5);
    if (fit->choices->exact_cell) {
        cell->nx = CELL_SIDES * grid->nx;
        cell->ny = fit->profile ? 1 : CELL_SIDES * grid->ny;
    }
    cell->lx = dx * (double)cell->nx;
    cell->ly = fit->profile ? cell->lx : dx * (double)cell->ny;
}

/* Refuses a table whose surfaces would not be like the map. */
static int check_left(const struct fit *fit, struct error *err) {
    static const double MOST = 0.05;
    const struct like_left *left = &fit->out->left;
    if (fabs(left->relative) <= MOST || fit->choices->off_stated)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "no smooth spectrum has the map's: the RMS %s of its surfaces would be %+.3g "
                     "%% off; %.2g %% is allowed; prepare the map, give \"spectrum\": \"fit\", or "
                     "\"off\": \"stated\" to take them as they are",
                     SQUARES[left->moment], 100 * left->relative, 100 * MOST);
}

double like_estimate_noise(const struct spectrum_fit *law, const struct grid *grid,
                           double rms_curvature) {
    const double whole = 2 * M_PI / grid_dx(grid); /* of wave numbers, along an axis */
    return spectrum_fit_noise_share(law, grid, rms_curvature) > NOISE_SHARE_MOST
               ? sqrt(law->noise * (law->profile ? whole : whole * whole))
               : 0;
}

static int fit_table(struct fit *fit, struct error *err) {
    struct like_estimate *out = fit->out;
    double squares[LIKE_MOMENTS] = {pow(out->measured[PATCH_RMS_HEIGHT], 2),
                                    pow(out->measured[PATCH_RMS_SLOPE], 2),
                                    pow(out->measured[PATCH_RMS_CURVATURE], 2)};
    const struct map_spectrum *rings = fit->ellipses != NULL ? fit->ellipses : fit->circles;
    const struct like_noise noise = {out->noise > 0 ? out->law.noise : 0,
                                     2 * M_PI / out->law.trusted_to};
    int status = like_table_measure(&out->table, rings, &noise, err);
    if (status == 0)
        status = like_table_calibrate(&out->table, rings, fit->choices->detrend, &out->cell, &noise,
                                      squares, &out->left, err);
    if (status == 0)
        status = check_left(fit, err);
    return status == 0
               ? like_table_slope(&out->table, &out->cell, sqrt(squares[1]), &out->rms_slope, err)
               : status;
}

/* The shortest wave is that of the law, or the shortest that the points hold if that is longer. */
static int fit_law(struct fit *fit, struct error *err) {
    struct spectrum *law = &fit->out->self_affine;
    struct moments moments;
    int status = spectrum_fit_law(&fit->out->law, law, err);
    if (status != 0)
        return status;
    law->wavelength_short = fmax(law->wavelength_short, 2 * grid_dx(fit->map->grid));
    law->wavelength_long = fmax(law->wavelength_long, law->wavelength_short);
    law->wavelength_rolloff = fmax(law->wavelength_rolloff, law->wavelength_short);
    status = spectrum_moments(law, &fit->out->cell, &moments, err);
    law->hurst = fmax(law->hurst, HURST_LEAST);
    fit->out->rms_slope = status == 0 ? moments.rms_slope : 0;
    return status;
}

/* --- the heights --- */

/* Finds the distribution that fits the heights best. */
static int fit_distribution(struct fit *fit, struct error *err) {
    struct map_chance *chance = NULL;
    struct height_fits fits;
    int status = map_chance_create(&chance, fit->map, err);
    if (status != 0)
        return status;
    height_fit_measure(chance->heights, map_chance_modes(chance), &fits);
    map_chance_destroy(&chance);
    fit->out->distribution = (enum heights_type)fits.best;
    fit->out->shape = fits.list[fits.best].shape;
    return 0;
}

static int fit_quantiles(struct fit *fit, struct error *err) {
    struct like_estimate *out = fit->out;
    size_t n = 0, points = grid_points(fit->map->grid);
    for (size_t i = 0; i < points; i++)
        n += isnan(fit->map->z[i]) ? 0 : 1;
    size_t count = height_quantiles_count(n);
    if (count == 0)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu heights is too small for its quantiles; give \"heights\": "
                         "\"gaussian\"",
                         n);
    out->probability = array_create(count, sizeof *out->probability);
    out->quantile = array_create(count, sizeof *out->quantile);
    if (out->probability == NULL || out->quantile == NULL)
        return error_memory(err, 2 * count * sizeof *out->quantile, "quantiles");
    out->quantile_count = count;
    return height_quantiles_measure(fit->map, n, out->probability, out->quantile, err);
}

/* --- together --- */

int like_estimate_measure(struct like_estimate *out, const struct measured_map *map,
                          const struct like_choices *choices, struct error *err) {
    struct fit fit = {
        .map = map, .choices = choices, .profile = grid_is_profile(map->grid), .out = out};
    *out = (struct like_estimate){.lay = LAY_NONE, .shape = (double)NAN};
    choose_cell(&fit);
    int status = patch_measure(map, out->measured, err);
    if (status == 0 && !(out->measured[PATCH_RMS_SLOPE] > 0))
        status = error_set(err, ERROR_INPUT, "the map is flat");
    if (status == 0)
        status = measure_rings(&fit, err);
    if (status == 0 && choices->spectrum != LIKE_SPECTRUM_GIVEN)
        out->noise = like_estimate_noise(&out->law, map->grid, out->measured[PATCH_RMS_CURVATURE]);
    if (status == 0 && choices->spectrum == LIKE_SPECTRUM_TABLE)
        status = fit_table(&fit, err);
    if (status == 0 && choices->spectrum == LIKE_SPECTRUM_FIT)
        status = fit_law(&fit, err);
    if (status == 0 && choices->heights == LIKE_HEIGHTS_QUANTILES)
        status = fit_quantiles(&fit, err);
    if (status == 0 && choices->heights == LIKE_HEIGHTS_FIT)
        status = fit_distribution(&fit, err);
    map_spectrum_destroy(&fit.ellipses);
    map_spectrum_destroy(&fit.circles);
    return status;
}

void like_estimate_clear(struct like_estimate *estimate) {
    like_table_clear(&estimate->table);
    free(estimate->probability);
    free(estimate->quantile);
    *estimate = (struct like_estimate){0};
}
