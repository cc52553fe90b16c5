#include "jobs/like/like_joint.h"
#include "core/statistics/heights/height_quantiles.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/surface/spectrum.h"
#include "jobs/surface/surface_case.h"
#include <math.h>
#include <stdlib.h>

static const double HURST_LEAST = 0.01;
enum { CELL_WAVES = 4 }; /* sides of the cell in longest waves: twice the side of the widest map */

/* A fit in progress; the spectra are owned. */
struct fit {
    size_t count;
    const struct measured_map *maps;
    struct map_spectrum *circles[JOINT_PATCHES_MOST], *ellipses[JOINT_PATCHES_MOST];
    struct spectrum_fit fits[JOINT_PATCHES_MOST]; /* of each map alone */
    struct joint_patch patches[JOINT_PATCHES_MOST];
    struct joint_fit law;
    struct lay lay;
    bool profile;
};

static void fit_clear(struct fit *fit) {
    for (size_t m = 0; m < fit->count; m++) {
        map_spectrum_destroy(&fit->ellipses[m]);
        map_spectrum_destroy(&fit->circles[m]);
    }
}

/* --- the law --- */

static int find_lay(const struct fit *fit, size_t m, struct lay *lay, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    *lay = LAY_NONE;
    if (fit->profile)
        return 0;
    int status = map_directions_find(&directions, &fit->maps[m], fit->circles[m], err);
    return status == 0 ? map_directions_lay(lay, &directions, fit->circles[m], &by_the_map, err)
                       : status;
}

static int fit_maps(struct fit *fit, const struct spectrum_fit_request *trusted,
                    struct error *err) {
    struct lay lays[JOINT_PATCHES_MOST];
    int status = 0;
    for (size_t m = 0; m < fit->count && status == 0; m++) {
        status = map_spectrum_create(&fit->circles[m], &fit->maps[m], err);
        if (status == 0)
            status = find_lay(fit, m, &lays[m], err);
    }
    if (status != 0)
        return status;
    fit->lay = joint_fit_lay(fit->count, lays);
    for (size_t m = 0; m < fit->count && status == 0; m++) {
        const struct spectrum_fit_request by_the_map = {0};
        status = spectrum_fit_along(fit->circles[m], &fit->lay,
                                    trusted != NULL ? &trusted[m] : &by_the_map, &fit->ellipses[m],
                                    &fit->fits[m], err);
        fit->patches[m] = (struct joint_patch){
            .spectrum = fit->ellipses[m] != NULL ? fit->ellipses[m] : fit->circles[m],
            .fit = &fit->fits[m]};
    }
    return status == 0 ? joint_fit_measure(fit->count, fit->patches, &fit->law, err) : status;
}

/* Returns the number of the map that has the shortest trusted waves. */
static size_t finest_of(const struct fit *fit) {
    size_t finest = 0;
    for (size_t m = 1; m < fit->count; m++)
        if (fit->fits[m].fitted &&
            (!fit->fits[finest].fitted || fit->fits[m].trusted_to < fit->fits[finest].trusted_to))
            finest = m;
    return finest;
}

/* Returns the mean square height of the law between wave numbers: of waves down to the roll-off its
 * density is even, and falls from there on. Of surfaces the integral of 2 pi k C over the ratio of
 * the lay, of profiles of 2 C. */
static double mean_square(const struct fit *fit, double low, double rolloff, double high) {
    const double d = fit->profile ? 1 : 2, hurst = fmax(fit->law.hurst.value, HURST_LEAST);
    const double plateau = joint_fit_density(&fit->law, fit->profile, rolloff);
    const double even = (pow(rolloff, d) - pow(low, d)) / d;
    const double falling = pow(rolloff, d) * (1 - pow(high / rolloff, -2 * hurst)) / (2 * hurst);
    return (fit->profile ? 2 : 2 * M_PI / fit->lay.ratio) * plateau * (even + falling);
}

/* Fills the law, the cell and the slope of surfaces on it. */
static int law_fill(const struct fit *fit, double longest, struct like_estimate *out,
                    struct error *err) {
    const struct spectrum_fit *finest = &fit->fits[finest_of(fit)];
    const double dx = grid_dx(fit->maps[finest_of(fit)].grid);
    struct spectrum *law = &out->self_affine;
    struct moments moments;
    const double shortest = fmax(finest->shortest, 2 * dx);
    const double from = fmax(longest > 0 ? longest : fit->law.longest, shortest);
    const double rolloff = isnan(fit->law.rolloff_wavelength.value)
                               ? from
                               : fmin(fmax(fit->law.rolloff_wavelength.value, shortest), from);
    const double square =
        mean_square(fit, 2 * M_PI / from, 2 * M_PI / rolloff, 2 * M_PI / shortest);
    *law = (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = fmax(fit->law.hurst.value, HURST_LEAST),
                             .wavelength_long = from,
                             .wavelength_rolloff = rolloff,
                             .wavelength_short = shortest,
                             .anisotropy = fit->lay.ratio,
                             .lay_angle = fit->lay.angle,
                             .scale = SCALE_RMS_HEIGHT,
                             .scale_value = sqrt(square)};
    const size_t side = surface_case_side(CELL_WAVES * from / dx - 0.5);
    if ((double)side * (fit->profile ? 1 : (double)side) > SURFACE_POINTS_MOST)
        return error_set(err, ERROR_INPUT,
                         "waves of %g to %g need a cell of %zu points a side; give "
                         "\"wavelength_ratio\", the longest wave over the shortest",
                         from, shortest, side);
    out->cell = (struct grid){side, fit->profile ? 1 : side, dx * (double)side, dx * (double)side};
    out->lay = fit->lay;
    out->law = *finest;
    out->law.trusted_from = fit->law.longest;
    int status = spectrum_moments(law, &out->cell, &moments, err);
    out->rms_slope = status == 0 ? moments.rms_slope : 0;
    return status;
}

/* Where the study gives the spectrum, the cell has twice the sides of the first map. */
static void cell_of_first(const struct grid *grid, struct grid *cell) {
    const double dx = grid_dx(grid);
    cell->nx = surface_case_side(2 * (double)grid->nx - 0.5);
    cell->ny = grid_is_profile(grid) ? 1 : surface_case_side(2 * (double)grid->ny - 0.5);
    cell->lx = dx * (double)cell->nx;
    cell->ly = grid_is_profile(grid) ? cell->lx : dx * (double)cell->ny;
}

/* --- the heights --- */

/* Adds every so manieth height of a map, about its mean and over its RMS height. */
static size_t heights_add(const struct measured_map *map, size_t every, double *out) {
    struct roughness roughness;
    size_t count = 0, seen = 0;
    map_roughness_measure(map, &roughness);
    for (size_t p = 0; p < grid_points(map->grid); p++)
        if (!isnan(map->z[p]) && seen++ % every == 0)
            out[count++] = (map->z[p] - roughness.mean) / roughness.rms_height;
    return count;
}

/* Quantiles of the heights of all maps, each over its RMS height, so many of an area. */
static int heights_fit(const struct fit *fit, struct like_estimate *out, struct error *err) {
    size_t most = 0, n = 0;
    double coarsest = 0;
    for (size_t m = 0; m < fit->count; m++) {
        const struct grid *grid = fit->maps[m].grid;
        most += grid_points(grid);
        coarsest = fmax(coarsest, grid_dx(grid));
    }
    double *heights = array_create(most, sizeof *heights);
    if (heights == NULL)
        return error_memory(err, most * sizeof *heights, "heights of maps");
    for (size_t m = 0; m < fit->count; m++) {
        const double step = coarsest / grid_dx(fit->maps[m].grid);
        n += heights_add(&fit->maps[m], (size_t)fmax(1, rint(fit->profile ? step : step * step)),
                         heights + n);
    }
    const struct grid all = {n, 1, (double)n, (double)n};
    const struct measured_map map = {&all, heights, BOUNDARY_OPEN};
    const size_t count = height_quantiles_count(n);
    int status = count > 0 ? 0
                           : error_set(err, ERROR_INPUT,
                                       "maps of %zu heights as far apart as the coarsest has them "
                                       "are too small for quantiles; give \"heights\": "
                                       "\"gaussian\"",
                                       n);
    out->probability = array_create(count + 1, sizeof *out->probability);
    out->quantile = array_create(count + 1, sizeof *out->quantile);
    if (status == 0 && (out->probability == NULL || out->quantile == NULL))
        status = error_memory(err, 2 * count * sizeof *out->quantile, "quantiles");
    out->quantile_count = status == 0 ? count : 0;
    if (status == 0)
        status = height_quantiles_measure(&map, n, out->probability, out->quantile, err);
    for (size_t a = 0; a < out->quantile_count; a++)
        out->quantile[a] *= out->self_affine.scale_value;
    free(heights);
    return status;
}

/* --- together --- */

int like_joint_measure(struct like_estimate *out, struct like_joint *joint, size_t count,
                       const struct measured_map *maps, const struct spectrum_fit_request *trusted,
                       double longest, const struct like_choices *choices, struct error *err) {
    struct fit fit = {.count = count, .maps = maps, .profile = grid_is_profile(maps[0].grid)};
    *out = (struct like_estimate){.lay = LAY_NONE, .shape = (double)NAN};
    *joint = (struct like_joint){.count = count};
    int status = patch_measure(&maps[0], out->measured, err);
    if (status == 0)
        status = fit_maps(&fit, trusted, err);
    if (status == 0 && choices->spectrum == LIKE_SPECTRUM_FIT)
        status = law_fill(&fit, longest, out, err);
    else if (status == 0)
        cell_of_first(maps[0].grid, &out->cell);
    if (status == 0 && choices->heights == LIKE_HEIGHTS_QUANTILES)
        status = heights_fit(&fit, out, err);
    if (status == 0 && choices->spectrum == LIKE_SPECTRUM_FIT)
        out->noise =
            like_estimate_noise(&fit.fits[0], maps[0].grid, out->measured[PATCH_RMS_CURVATURE]);
    joint->between = fit.law.between;
    for (size_t m = 0; m < count && status == 0; m++)
        joint->trusted[m] = (struct spectrum_fit_request){
            .longest = fit.fits[m].trusted_from,
            .shortest = fit.fits[m].to_end == SPECTRUM_END_CUTOFF ? 0 : fit.fits[m].trusted_to};
    fit_clear(&fit);
    return status;
}
