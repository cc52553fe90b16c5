#include "jobs/like/like_fit.h"
#include "core/statistics/heights/height_fit.h"
#include "core/statistics/heights/height_quantiles.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/patch.h"
#include "core/statistics/spectra/map_spectrum.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/surface/spectrum.h"
#include "jobs/like/like_spectrum.h"
#include "jobs/surface/surface_case.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Laws that fit a measured surface, as parameters of a study. */

#define NAME(type, name, value) name,
static const char *const NAMES[HEIGHTS_QUANTILE] = {RUGO_DISTRIBUTIONS(NAME)};

/* Finds the distribution that fits the heights best: its name in studies, static, and the shape,
 * NaN without one. */
static int like_law_heights(const struct measured_map *map, const char **name, double *shape,
                            struct error *err) {
    struct map_chance *chance = NULL;
    struct height_fits fits;
    int status = map_chance_create(&chance, map, err);
    if (status != 0)
        return status;
    height_fit_measure(chance->heights, map_chance_modes(chance), &fits);
    map_chance_destroy(&chance);
    *name = NAMES[fits.best];
    *shape = fits.list[fits.best].shape;
    return 0;
}

static const double SAME_SPACING = 1e-4; /* relative, of distances along x and along y */
static const double HURST_LEAST = 0.01;
enum { CELL_SIDES = 2 }; /* of a cell, in sides of the map */

/* A fit to the map. Lengths are in its unit until they are written. */
struct fit {
    const struct like_source *source;
    const char *unit; /* of lengths */
    struct measured_map map;
    enum like_spectrum spectrum;
    enum like_heights heights;
    bool profile;
    double wavelength; /* lambda_s: the shortest wave that the points hold */
    double side;       /* the shorter one of the map */
    struct grid cell;
    struct like_table table;
    double measured[PATCH_QUANTITY_COUNT];
    struct map_spectrum *circles;  /* owned, as the next: of the map */
    struct map_spectrum *ellipses; /* along its lay; NULL where it has none */
    struct spectrum_fit law;
    double rms_slope;   /* of random surfaces on the cell */
    bool without_noise; /* which the map has */
    struct like_left left;
};

/* --- the map --- */

static int check_map(const struct height_map *map, struct error *err) {
    const struct grid *grid = &map->grid;
    double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    if (strcmp(map->xy_unit, map->z_unit) != 0)
        return error_set(err, ERROR_INPUT,
                         "heights are in \"%s\" and lengths along x in \"%s\": slopes have no "
                         "meaning; say \"z_unit\", or \"unit\"",
                         map->z_unit, map->xy_unit);
    if (fabs(dx - dy) > SAME_SPACING * dx)
        return error_set(err, ERROR_INPUT,
                         "points are %g apart along x and %g along y: random surfaces have the "
                         "same distances; give \"resample\"",
                         dx, dy);
    return 0;
}

/* Finds whether directions differ, from the map alone. */
static int find_lay(struct fit *fit, struct lay *lay, struct error *err) {
    static const double RATIO_MOST = 100;
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    *lay = LAY_NONE;
    if (fit->profile)
        return 0;
    int status = map_directions_find(&directions, &fit->map, fit->circles, err);
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
    if (fit->spectrum == LIKE_SPECTRUM_GIVEN)
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
    int status = map_spectrum_create(&fit->circles, &fit->map, err);
    if (status == 0)
        status = find_lay(fit, &lay, err);
    if (status == 0)
        status = spectrum_fit_along(fit->circles, &lay, &(struct spectrum_fit_request){0},
                                    &fit->ellipses, &fit->law, err);
    return status;
}

static void choose_cell(struct fit *fit) {
    const struct grid *grid = fit->map.grid;
    double dx = grid_dx(grid);
    struct grid *cell = &fit->cell;
    cell->nx = surface_case_side(CELL_SIDES * (double)grid->nx - 0.5); /* has small prime factors */
    cell->ny = fit->profile ? 1 : surface_case_side(CELL_SIDES * (double)grid->ny - 0.5);
    cell->lx = dx * (double)cell->nx;
    cell->ly = fit->profile ? cell->lx : dx * (double)cell->ny;
    fit->side = dx * (double)(fit->profile || grid->nx < grid->ny ? grid->nx : grid->ny);
    fit->wavelength = 2 * dx;
}

/* --- parameters, each only where the study has none --- */

static bool has(const cJSON *surface, const char *name) {
    return cJSON_HasObjectItem(surface, name);
}

static bool put_number(cJSON *surface, const char *name, double value) {
    return has(surface, name) || field_put(surface, name, json_number(value));
}

static bool put_lengths(cJSON *surface, const struct fit *fit) {
    double side = fit->side, along_x = fit->cell.lx / side, along_y = fit->cell.ly / side;
    bool lengths = has(surface, "length_ratio") || has(surface, "length_ratio_y");
    bool put = put_number(surface, "dimension", fit->profile ? 1 : 2) &&
               put_number(surface, "wavelength_ratio", side / fit->wavelength) &&
               put_number(surface, "points_per_wavelength",
                          /* at least two, which a study must have, but for rounding */
                          fmax(2, fit->wavelength / grid_dx(fit->map.grid)));
    if (put && !lengths)
        put = put_number(surface, "length_ratio", along_x) &&
              (along_y == along_x || put_number(surface, "length_ratio_y", along_y));
    return put;
}

static bool put_spectrum(cJSON *surface, const struct fit *fit) {
    cJSON *spectrum = cJSON_AddObjectToObject(surface, "spectrum");
    double unit = fit->wavelength;
    double *wave_number = array_create(fit->table.count, sizeof *wave_number);
    bool put = spectrum != NULL && wave_number != NULL;
    for (size_t row = 0; put && row < fit->table.count; row++)
        wave_number[row] = fit->table.wave_number[row] * unit;
    put = put && field_put_text(spectrum, "type", "table") &&
          field_put(spectrum, "wave_number", json_numbers(wave_number, fit->table.count)) &&
          field_put(spectrum, "density", json_numbers(fit->table.density, fit->table.count));
    free(wave_number);
    return put;
}

static bool put_scale(cJSON *surface, const struct fit *fit) {
    const struct lay *lay = fit->ellipses != NULL ? &fit->ellipses->lay : NULL;
    if (lay != NULL && !(put_number(surface, "anisotropy", lay->ratio) &&
                         put_number(surface, "lay_angle", lay->angle * 180 / M_PI)))
        return false;
    return has(surface, "rms_height") || put_number(surface, "rms_slope", fit->rms_slope);
}

/* lambda_s is the shortest wave of the law, or the shortest that the points hold if that is
 * longer. */
static int put_law(cJSON *surface, struct fit *fit, struct error *err) {
    struct spectrum law;
    struct moments moments;
    int status = spectrum_fit_law(&fit->law, &law, err);
    if (status != 0)
        return status;
    law.wavelength_short = fmax(law.wavelength_short, 2 * grid_dx(fit->map.grid));
    law.wavelength_long = fmax(law.wavelength_long, law.wavelength_short);
    law.wavelength_rolloff = fmax(law.wavelength_rolloff, law.wavelength_short);
    status = spectrum_moments(&law, &fit->cell, &moments, err);
    if (status != 0)
        return status;
    fit->wavelength = law.wavelength_short;
    fit->side = law.wavelength_long;
    fit->rms_slope = moments.rms_slope;
    bool put = put_number(surface, "hurst", fmax(law.hurst, HURST_LEAST)) &&
               put_number(surface, "rolloff_ratio", law.wavelength_long / law.wavelength_rolloff) &&
               put_scale(surface, fit);
    return put ? 0 : error_memory(err, sizeof law, "a fitted law");
}

/* Returns the heights of the study, which may name their law alone, or new ones; NULL when out of
 * memory. */
static cJSON *heights_of(cJSON *surface) {
    cJSON *own = cJSON_GetObjectItemCaseSensitive(surface, "heights");
    return own != NULL ? own : cJSON_AddObjectToObject(surface, "heights");
}

/* Returns whether a study says which heights it wants, and not only how they are made. */
static bool heights_given(const cJSON *surface) {
    static const char *const SAID[] = {"distribution", "shape",       "skewness",
                                       "samples",      "probability", "quantile"};
    const cJSON *heights = cJSON_GetObjectItemCaseSensitive(surface, "heights");
    bool given = heights != NULL && !cJSON_IsObject(heights); /* to be refused as they are */
    for (size_t n = 0; n < sizeof SAID / sizeof *SAID; n++)
        given = given || cJSON_GetObjectItemCaseSensitive(heights, SAID[n]) != NULL;
    return given;
}

static int put_distribution(cJSON *surface, const struct fit *fit, struct error *err) {
    const char *name;
    double shape;
    int status = like_law_heights(&fit->map, &name, &shape, err);
    if (status != 0)
        return status;
    cJSON *heights = heights_of(surface);
    bool put = heights != NULL && field_put_text(heights, "distribution", name) &&
               (isnan(shape) || field_put(heights, "shape", json_number(shape)));
    return put ? 0 : error_memory(err, sizeof shape, "fitted heights");
}

static int put_quantiles(cJSON *surface, const struct fit *fit, struct error *err) {
    size_t n = 0, points = grid_points(fit->map.grid);
    for (size_t i = 0; i < points; i++)
        n += isnan(fit->map.z[i]) ? 0 : 1;
    size_t count = height_quantiles_count(n);
    if (count == 0)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu heights is too small for its quantiles; give \"heights\": "
                         "\"gaussian\"",
                         n);
    double *probability = array_create(count, sizeof *probability);
    double *quantile = array_create(count, sizeof *quantile);
    int status = probability != NULL && quantile != NULL
                     ? height_quantiles_measure(&fit->map, n, probability, quantile, err)
                     : error_memory(err, 2 * count * sizeof *quantile, "quantiles");
    cJSON *heights = status == 0 ? heights_of(surface) : NULL;
    for (size_t a = 0; a < count && status == 0; a++)
        quantile[a] /= fit->wavelength;
    if (status == 0 && !(field_put_text(heights, "distribution", "quantiles") &&
                         field_put(heights, "probability", json_numbers(probability, count)) &&
                         field_put(heights, "quantile", json_numbers(quantile, count))))
        status = error_memory(err, 2 * count * sizeof *quantile, "quantiles");
    free(probability);
    free(quantile);
    return status;
}

/* --- measured values --- */

static bool put_measured(cJSON *like, const struct fit *fit) {
    const double *measured = fit->measured;
    cJSON *names = cJSON_AddArrayToObject(like, "quantities");
    cJSON *values = cJSON_AddArrayToObject(like, "measured");
    bool put = names != NULL && values != NULL;
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT && put; a++) {
        double unit = pow(fit->wavelength, patch_power((enum patch_quantity)a, fit->profile));
        if (!isfinite(measured[a]))
            continue;
        put = list_put(names, cJSON_CreateString(PATCH_NAMES[a])) &&
              list_put(values, json_number(measured[a] / unit));
    }
    return put;
}

static const char *const SQUARES[LIKE_MOMENTS] = {"height", "slope", "curvature"};

/* What was done to the map, and to its spectrum, and what is left between it and its surfaces. */
static bool put_prepared(cJSON *like, const struct fit *fit) {
    enum { SIZE = 4000, NAMED = 1 }; /* per cent */
    const double left = 100 * fit->left.relative;
    char *text = array_create(SIZE, 1);
    if (text == NULL)
        return false;
    int used = snprintf(text, SIZE, "%s", fit->source->prepared);
    if (fit->without_noise && used >= 0 && used < SIZE)
        used += snprintf(text + used, (size_t)(SIZE - used),
                         "%snoise: taken out of the spectrum, with the waves in it",
                         used > 0 ? "; " : "");
    if (fabs(left) > NAMED && used >= 0 && used < SIZE)
        snprintf(text + used, (size_t)(SIZE - used), "%sRMS %s of the surfaces: %+.3g %% off",
                 used > 0 ? "; " : "", SQUARES[fit->left.moment], left);
    bool put = field_put_text(like, "prepared", text);
    free(text);
    return put;
}

static bool put_marks(cJSON *like, const struct fit *fit) {
    const struct like_source *source = fit->source;
    const struct grid *grid = fit->map.grid;
    const double points[] = {(double)grid->nx, (double)grid->ny};
    const double trusted[] = {fit->law.trusted_from / fit->wavelength,
                              fit->law.trusted_to / fit->wavelength};
    return field_put_text(like, "file", source->file) &&
           field_put_text(like, "sha256", source->sha256) &&
           field_put_count(like, "bytes", source->bytes) &&
           field_put_text(like, "format", source->format) && put_prepared(like, fit) &&
           field_put_text(like, "unit", fit->unit) &&
           field_put(like, "wavelength", json_number(fit->wavelength)) &&
           field_put(like, "spacing", json_number(grid_dx(grid) / fit->wavelength)) &&
           field_put(like, "points", json_numbers(points, fit->profile ? 1 : 2)) &&
           (!isfinite(trusted[0] * trusted[1]) ||
            field_put(like, "trusted", json_numbers(trusted, 2))) &&
           field_put_text(like, "detrend", choice_name(LIKE_DETRENDS, (int)source->detrend)) &&
           field_put_text(like, "spectrum", choice_name(LIKE_SPECTRA, (int)fit->spectrum)) &&
           field_put_text(like, "heights", choice_name(LIKE_HEIGHTS, (int)fit->heights));
}

static int put_like(cJSON *surface, const struct fit *fit, struct error *err) {
    cJSON_DeleteItemFromObjectCaseSensitive(surface, "like");
    cJSON *like = cJSON_AddObjectToObject(surface, "like");
    if (like != NULL && put_marks(like, fit) && put_measured(like, fit))
        return 0;
    return error_memory(err, sizeof *fit, "a fitted surface");
}

/* --- together --- */

/* Refuses a table whose surfaces would not be like the map. */
static int check_left(const struct fit *fit, struct error *err) {
    static const double MOST = 0.05;
    const struct like_left *left = &fit->left;
    if (fabs(left->relative) <= MOST || fit->source->off_stated)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "no smooth spectrum has the map's: the RMS %s of its surfaces would be %+.3g "
                     "%% off; %.2g %% is allowed; prepare the map, give \"spectrum\": \"fit\", or "
                     "\"off\": \"stated\" to take them as they are",
                     SQUARES[left->moment], 100 * left->relative, 100 * MOST);
}

/* Noise counts where it governs the curvature of the map. */
static struct like_noise noise_of(const struct fit *fit) {
    const double share =
        spectrum_fit_noise_share(&fit->law, fit->map.grid, fit->measured[PATCH_RMS_CURVATURE]);
    return (struct like_noise){share > NOISE_SHARE_MOST ? fit->law.noise : 0,
                               2 * M_PI / fit->law.trusted_to};
}

static int fit_table(cJSON *surface, struct fit *fit, struct error *err) {
    double squares[LIKE_MOMENTS] = {pow(fit->measured[PATCH_RMS_HEIGHT], 2),
                                    pow(fit->measured[PATCH_RMS_SLOPE], 2),
                                    pow(fit->measured[PATCH_RMS_CURVATURE], 2)};
    const struct map_spectrum *rings = fit->ellipses != NULL ? fit->ellipses : fit->circles;
    const struct like_noise noise = noise_of(fit);
    int status = like_table_measure(&fit->table, rings, &noise, err);
    if (status == 0)
        status = like_table_calibrate(&fit->table, rings, fit->source->detrend, &fit->cell, &noise,
                                      squares, &fit->left, err);
    fit->without_noise = noise.density > 0;
    if (status == 0)
        status = check_left(fit, err);
    if (status != 0)
        return status;
    fit->wavelength = 2 * M_PI / fit->table.highest;
    status = like_table_slope(&fit->table, &fit->cell, sqrt(squares[1]), &fit->rms_slope, err);
    if (status == 0 && !(put_spectrum(surface, fit) && put_scale(surface, fit)))
        status = error_memory(err, fit->table.count * sizeof(double), "a table spectrum");
    return status;
}

static int fit_spectrum(cJSON *surface, struct fit *fit, struct error *err) {
    int status = measure_rings(fit, err);
    if (status == 0 && fit->spectrum == LIKE_SPECTRUM_TABLE)
        status = fit_table(surface, fit, err);
    if (status == 0 && fit->spectrum == LIKE_SPECTRUM_FIT)
        status = put_law(surface, fit, err);
    if (status == 0 && !put_lengths(surface, fit))
        status = error_memory(err, sizeof *fit, "a fitted surface");
    return status;
}

/* Chooses what is fitted: not what the study gives of the spectrum and of the heights. If the study
 * has a shortest wave, its points are those of that wave. */
static void choose(struct fit *fit, const cJSON *surface) {
    bool own_spectrum = has(surface, "spectrum") || has(surface, "hurst") ||
                        (has(surface, "nayak_alpha") && has(surface, "wavelength_ratio"));
    double points = field_number(surface, "points_per_wavelength");
    fit->spectrum = own_spectrum ? LIKE_SPECTRUM_GIVEN : fit->source->spectrum;
    fit->heights = heights_given(surface) ? LIKE_HEIGHTS_GIVEN : fit->source->heights;
    choose_cell(fit);
    if (own_spectrum && points > 0)
        fit->wavelength = points * grid_dx(fit->map.grid);
}

int like_fit(cJSON *surface, const struct height_map *map, const struct like_source *source,
             struct error *err) {
    struct fit fit = {.source = source,
                      .unit = map->xy_unit,
                      .map = {&map->grid, map->z, BOUNDARY_OPEN},
                      .profile = grid_is_profile(&map->grid)};
    int status = check_map(map, err);
    if (status != 0)
        return status;
    choose(&fit, surface);
    status = patch_measure(&fit.map, fit.measured, err);
    if (status == 0 && !(fit.measured[PATCH_RMS_SLOPE] > 0))
        status = error_set(err, ERROR_INPUT, "the map is flat");
    if (status == 0)
        status = fit_spectrum(surface, &fit, err);
    if (status == 0 && fit.heights == LIKE_HEIGHTS_QUANTILES)
        status = put_quantiles(surface, &fit, err);
    if (status == 0 && fit.heights == LIKE_HEIGHTS_FIT)
        status = put_distribution(surface, &fit, err);
    if (status == 0 && !has(surface, "amplitudes") &&
        !field_put_text(surface, "amplitudes", "random"))
        status = error_memory(err, sizeof fit, "a fitted surface");
    if (status == 0)
        status = put_like(surface, &fit, err);
    like_table_clear(&fit.table);
    map_spectrum_destroy(&fit.ellipses);
    map_spectrum_destroy(&fit.circles);
    return status;
}
