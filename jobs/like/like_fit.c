#include "jobs/like/like_fit.h"
#include "core/map/form.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/stationarity.h"
#include "core/surface/heights.h"
#include "jobs/like/like_estimate.h"
#include "jobs/like/like_grooves.h"
#include "jobs/like/like_hold.h"
#include "jobs/like/like_joint.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME(type, name, value) name,
static const char *const NAMES[HEIGHTS_QUANTILE] = {RUGO_DISTRIBUTIONS(NAME)};

static const double SAME_SPACING = 1e-4; /* relative, of distances along x and along y */

/* A fit to the map. Lengths are in its unit until they are written. */
struct fit {
    const struct like_source *source;
    const char *unit; /* of lengths */
    struct measured_map map;
    struct like_choices choices;
    bool held[LIKE_HELD_COUNT]; /* by the study */
    bool profile;
    double wavelength; /* lambda_s: the shortest wave that the points hold */
    double side;       /* the shorter one of the map */
    char *patch;       /* text of the heights that are held, owned; NULL: none are */
    struct like_estimate estimate;
    size_t count; /* of maps of one surface */
    const struct height_map *maps;
    struct like_joint joint; /* of several */
    double longest;          /* the wave that the study names, over lambda_s; 0: none */
    struct map_form form;    /* that is left */
    double parts_p_value;    /* of parts of the map that are alike; NaN: not known */
    struct like_grooves grooves;
    double *rest; /* the heights without them, which are fitted, owned; NULL: there are none */
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

/* Tests whether parts of a map are alike, as those of random surfaces are; NaN: it is too small. */
static int test_parts(const struct measured_map *map, double *p_value, struct error *err) {
    struct map_chance *chance = NULL;
    struct stationarity stationarity;
    struct cell_differences *differences = array_create(1, sizeof *differences);
    int status = differences != NULL
                     ? map_chance_create(&chance, map, err)
                     : error_memory(err, sizeof *differences, "differences of a map");
    *p_value = (double)NAN;
    if (status == 0 && chance->told) {
        cell_differences_measure(map, &chance->modes, 1, differences);
        stationarity_measure(map, chance->heights, differences, &chance->modes, chance->correlation,
                             &stationarity);
        *p_value = least_p_value(stationarity.p_value, STATIONARY_DIVISIONS);
    }
    map_chance_destroy(&chance);
    free(differences);
    return status;
}

/* Where the map has too few correlation lengths, its differences along x are tested, which have
 * more. */
static int measure_parts(struct fit *fit, struct error *err) {
    const struct grid *grid = fit->map.grid;
    int status = test_parts(&fit->map, &fit->parts_p_value, err);
    if (status != 0 || isfinite(fit->parts_p_value) || grid->nx < 3)
        return status;
    const double lx = grid->lx - grid_dx(grid);
    const struct grid between = {grid->nx - 1, grid->ny, lx, fit->profile ? lx : grid->ly};
    double *z = array_create(grid_points(&between), sizeof *z);
    if (z == NULL)
        return error_memory(err, grid_points(&between) * sizeof *z, "differences of a map");
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < between.nx; i++)
            z[j * between.nx + i] = fit->map.z[j * grid->nx + i + 1] - fit->map.z[j * grid->nx + i];
    const struct measured_map slopes = {&between, z, BOUNDARY_OPEN};
    status = test_parts(&slopes, &fit->parts_p_value, err);
    free(z);
    return status;
}

static int refuse_grooves(const struct map_groove *first, const char *unit, struct error *err) {
    return error_set(
        err, ERROR_INPUT,
        "the map has grooves (every %.4g%s%s, %.3g%s%s deep; p-value %.2g), and surfaces that "
        "are like several maps or have grooves of their own are not made with them: give "
        "\"degroove\": true, which takes them out",
        first->period, *unit != '\0' ? " " : "", unit, first->fit.depth, *unit != '\0' ? " " : "",
        unit, first->p_value);
}

/* Takes the grooves out of the heights that are fitted. Of several maps none may have any. */
static int take_grooves(struct fit *fit, const cJSON *surface, struct error *err) {
    const bool refused =
        fit->count > 1 || cJSON_GetObjectItemCaseSensitive(surface, "grooves") != NULL;
    struct map_grooves *found = &fit->grooves.found;
    for (size_t m = 0; m < fit->count; m++) {
        const struct height_map *one = &fit->maps[m];
        const struct measured_map map = {&one->grid, one->z, BOUNDARY_OPEN};
        int status = map_grooves_find(found, &map, err);
        if (status == 0 && found->families > 0 && refused)
            status = refuse_grooves(&found->family[0], one->xy_unit, err);
        if (status != 0 && fit->count > 1)
            error_context(err, "%s", fit->source[m].file);
        if (status != 0)
            return status;
    }
    if (found->families == 0)
        return 0;
    int status = map_grooves_rest(&fit->rest, found, fit->map.grid, fit->map.z, err);
    if (status == 0)
        fit->map.z = fit->rest;
    return status;
}

/* --- parameters, each only where the study has none --- */

static bool has(const cJSON *surface, const char *name) {
    return cJSON_HasObjectItem(surface, name);
}

static bool put_number(cJSON *surface, const char *name, double value) {
    return has(surface, name) || field_put(surface, name, json_number(value));
}

static bool put_lengths(cJSON *surface, const struct fit *fit) {
    double side = fit->side, along_x = fit->estimate.cell.lx / side,
           along_y = fit->estimate.cell.ly / side;
    bool lengths = has(surface, "length_ratio") || has(surface, "length_ratio_y");
    bool put = put_number(surface, "dimension", fit->profile ? 1 : 2) &&
               put_number(surface, "wavelength_ratio", side / fit->wavelength) &&
               put_number(surface, "points_per_wavelength",
                          /* at least two, which a study must have, but for rounding */
                          fmax(2, fit->wavelength / (fit->count > 1 ? grid_dx(&fit->estimate.cell)
                                                                    : grid_dx(fit->map.grid))));
    if (put && !lengths)
        put = put_number(surface, "length_ratio", along_x) &&
              (along_y == along_x || put_number(surface, "length_ratio_y", along_y));
    return put;
}

static bool put_spectrum(cJSON *surface, const struct fit *fit) {
    cJSON *spectrum = cJSON_AddObjectToObject(surface, "spectrum");
    double unit = fit->wavelength;
    double *wave_number = array_create(fit->estimate.table.count, sizeof *wave_number);
    bool put = spectrum != NULL && wave_number != NULL;
    for (size_t row = 0; put && row < fit->estimate.table.count; row++)
        wave_number[row] = fit->estimate.table.wave_number[row] * unit;
    put =
        put && field_put_text(spectrum, "type", "table") &&
        field_put(spectrum, "wave_number", json_numbers(wave_number, fit->estimate.table.count)) &&
        field_put(spectrum, "density",
                  json_numbers(fit->estimate.table.density, fit->estimate.table.count));
    free(wave_number);
    return put;
}

static bool put_scale(cJSON *surface, const struct fit *fit) {
    const struct lay *lay = &fit->estimate.lay;
    if (!lay_is_plain(lay) && !(put_number(surface, "anisotropy", lay->ratio) &&
                                put_number(surface, "lay_angle", lay->angle * 180 / M_PI)))
        return false;
    return has(surface, "rms_height") || put_number(surface, "rms_slope", fit->estimate.rms_slope);
}

static bool put_law(cJSON *surface, struct fit *fit) {
    const struct spectrum *law = &fit->estimate.self_affine;
    fit->wavelength = law->wavelength_short;
    fit->side = law->wavelength_long;
    return put_number(surface, "hurst", law->hurst) &&
           put_number(surface, "rolloff_ratio", law->wavelength_long / law->wavelength_rolloff) &&
           put_scale(surface, fit);
}

static bool put_table(cJSON *surface, struct fit *fit) {
    fit->wavelength = 2 * M_PI / fit->estimate.table.highest;
    return put_spectrum(surface, fit) && put_scale(surface, fit);
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
    given = given || has(surface, "plateau");                 /* which makes them */
    for (size_t n = 0; n < sizeof SAID / sizeof *SAID; n++)
        given = given || cJSON_GetObjectItemCaseSensitive(heights, SAID[n]) != NULL;
    return given;
}

static bool put_distribution(cJSON *surface, const struct fit *fit) {
    const struct like_estimate *estimate = &fit->estimate;
    cJSON *heights = heights_of(surface);
    return heights != NULL &&
           field_put_text(heights, "distribution", NAMES[estimate->distribution]) &&
           (isnan(estimate->shape) || field_put(heights, "shape", json_number(estimate->shape)));
}

static bool put_quantiles(cJSON *surface, const struct fit *fit) {
    const struct like_estimate *estimate = &fit->estimate;
    const size_t count = estimate->quantile_count;
    cJSON *heights = heights_of(surface);
    double *quantile = array_create(count, sizeof *quantile);
    for (size_t a = 0; a < count && quantile != NULL; a++)
        quantile[a] = estimate->quantile[a] / fit->wavelength;
    bool put = heights != NULL && quantile != NULL &&
               field_put_text(heights, "distribution", "quantiles") &&
               field_put(heights, "probability", json_numbers(estimate->probability, count)) &&
               field_put(heights, "quantile", json_numbers(quantile, count));
    free(quantile);
    return put;
}

/* --- measured values --- */

static bool put_measured(cJSON *like, const struct fit *fit) {
    const double *measured = fit->estimate.measured;
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

static const double PARTS_LEVEL = 0.01;
static const char *const SQUARES[LIKE_MOMENTS] = {"height", "slope", "curvature"};

enum { FORM_TEXT = 200 };
static void write_form(const struct fit *fit, char text[FORM_TEXT]) {
    snprintf(
        text, FORM_TEXT,
        "a bow is left in the map (RMS %.3g%s%.10s; p-value %.2g), and its surfaces have none: "
        "\"detrend\": \"quadratic\" takes it out",
        fit->form.height, *fit->unit != '\0' ? " " : "", fit->unit, fit->form.p_value);
}

/* What was done to the map, and to its spectrum, and what is left between it and its surfaces. */
static bool put_prepared(cJSON *like, const struct fit *fit) {
    enum { SIZE = 4000, NAMED = 1 }; /* per cent */
    const double left = 100 * fit->estimate.left.relative;
    char *text = array_create(SIZE, 1);
    if (text == NULL)
        return false;
    int used = snprintf(text, SIZE, "%s", fit->source->prepared);
    if (fit->estimate.noise > 0 && used >= 0 && used < SIZE)
        used += snprintf(text + used, (size_t)(SIZE - used),
                         "%snoise: taken out of the spectrum, with the waves in it",
                         used > 0 ? "; " : "");
    if (fit->rest != NULL && used >= 0 && used < SIZE)
        used += snprintf(text + used, (size_t)(SIZE - used), "%s%s", used > 0 ? "; " : "",
                         fit->grooves.words);
    if (fabs(left) > NAMED && used >= 0 && used < SIZE)
        used +=
            snprintf(text + used, (size_t)(SIZE - used), "%sRMS %s of the surfaces: %+.3g %% off",
                     used > 0 ? "; " : "", SQUARES[fit->estimate.left.moment], left);
    if (fit->parts_p_value < PARTS_LEVEL && used >= 0 && used < SIZE)
        used +=
            snprintf(text + used, (size_t)(SIZE - used),
                     "%sparts of the map differ (p-value %.2g), and those of its surfaces do not",
                     used > 0 ? "; " : "", fit->parts_p_value);
    if (map_form_found(&fit->form) && used >= 0 && used < SIZE) {
        char words[FORM_TEXT];
        write_form(fit, words);
        snprintf(text + used, (size_t)(SIZE - used), "%s%s", used > 0 ? "; " : "", words);
    }
    bool put = field_put_text(like, "prepared", text);
    free(text);
    return put;
}

/* Writes what the map leaves open; nothing where the study gives spectrum and heights. */
static bool put_uncertainty(cJSON *like, const struct fit *fit) {
    const struct like_choices *choices = &fit->choices;
    bool open = choices->spectrum != LIKE_SPECTRUM_GIVEN ||
                choices->heights == LIKE_HEIGHTS_QUANTILES || choices->heights == LIKE_HEIGHTS_FIT;
    open = open && !fit->source->hold; /* it is in the draws */
    enum like_uncertainty uncertainty = open ? fit->source->uncertainty : LIKE_UNCERTAINTY_NONE;
    bool put =
        field_put_text(like, "uncertainty", choice_name(LIKE_UNCERTAINTIES, (int)uncertainty));
    cJSON *held = NULL;
    for (int h = 0; h < LIKE_HELD_COUNT && put; h++)
        if (fit->held[h] && uncertainty != LIKE_UNCERTAINTY_NONE) {
            held = held != NULL ? held : cJSON_AddArrayToObject(like, "held");
            put = held != NULL && list_put(held, cJSON_CreateString(choice_name(LIKE_HELD, h)));
        }
    return put;
}

static bool put_marks(cJSON *like, const struct fit *fit) {
    const struct like_source *source = fit->source;
    const struct grid *grid = fit->map.grid;
    const double points[] = {(double)grid->nx, (double)grid->ny};
    const double trusted[] = {fit->estimate.law.trusted_from / fit->wavelength,
                              fit->estimate.law.trusted_to / fit->wavelength};
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
           field_put_text(like, "spectrum",
                          choice_name(LIKE_SPECTRA, (int)fit->choices.spectrum)) &&
           field_put_text(like, "heights", choice_name(LIKE_HEIGHTS, (int)fit->choices.heights)) &&
           put_uncertainty(like, fit) &&
           (!(fit->estimate.noise > 0) || fit->source->hold ||
            field_put(like, "noise", json_number(fit->estimate.noise / fit->wavelength))) &&
           (fit->rest == NULL ||
            field_put(like, "groove_depth_error", json_number(fit->grooves.depth_error))) &&
           (fit->patch == NULL || (cJSON_AddTrueToObject(like, "hold") != NULL &&
                                   field_put_text(like, "patch", fit->patch)));
}

/* Writes what the further maps are, and their files. */
static bool put_maps(cJSON *like, const struct fit *fit) {
    double numbers[JOINT_PATCHES_MOST * LIKE_MAP_NUMBERS];
    char *text = array_create(LIKE_OTHERS_TEXT, 1);
    size_t used = 0;
    if (text == NULL)
        return false;
    for (size_t m = 0; m < fit->count; m++) {
        const struct grid *grid = &fit->maps[m].grid;
        const struct like_source *source = &fit->source[m];
        const double of[LIKE_MAP_NUMBERS] = {(double)grid->nx, (double)grid->ny,
                                             grid_dx(grid) / fit->wavelength,
                                             fit->joint.trusted[m].longest / fit->wavelength,
                                             fit->joint.trusted[m].shortest / fit->wavelength};
        for (size_t a = 0; a < LIKE_MAP_NUMBERS; a++)
            numbers[m * LIKE_MAP_NUMBERS + a] = isfinite(of[a]) ? of[a] : 0;
        if (m > 0 && used < LIKE_OTHERS_TEXT)
            used += (size_t)snprintf(text + used, LIKE_OTHERS_TEXT - used,
                                     "%s%s, SHA-256 %s, %zu bytes, %s, prepared by %s",
                                     m > 1 ? "; " : "", source->file, source->sha256, source->bytes,
                                     source->format, source->prepared);
    }
    const bool put =
        field_put(like, "maps", json_numbers(numbers, fit->count * LIKE_MAP_NUMBERS)) &&
        field_put(like, "between", json_number(fit->joint.between)) &&
        field_put_text(like, "others", text);
    free(text);
    return put;
}

static int put_like(cJSON *surface, const struct fit *fit, struct error *err) {
    cJSON_DeleteItemFromObjectCaseSensitive(surface, "like");
    cJSON *like = cJSON_AddObjectToObject(surface, "like");
    if (like != NULL && put_marks(like, fit) && (fit->count == 1 || put_maps(like, fit)) &&
        put_measured(like, fit))
        return 0;
    return error_memory(err, sizeof *fit, "a fitted surface");
}

/* --- together --- */

/* Chooses what is fitted: not what the study gives of the spectrum and of the heights. If the study
 * has a shortest wave, its points are those of that wave. */
static void choose(struct fit *fit, const cJSON *surface) {
    const struct grid *grid = fit->map.grid;
    bool own_spectrum = has(surface, "spectrum") || has(surface, "hurst") ||
                        (has(surface, "nayak_alpha") && has(surface, "wavelength_ratio"));
    double points = field_number(surface, "points_per_wavelength");
    fit->choices = (struct like_choices){
        .spectrum = own_spectrum ? LIKE_SPECTRUM_GIVEN : fit->source->spectrum,
        .heights = heights_given(surface) ? LIKE_HEIGHTS_GIVEN : fit->source->heights,
        .detrend = fit->source->detrend,
        .off_stated = fit->source->off_stated};
    if (fit->source->hold && fit->choices.heights != LIKE_HEIGHTS_GIVEN)
        fit->choices.heights = LIKE_HEIGHTS_GAUSSIAN; /* they are those of the patch */
    if (fit->source->hold)
        fit->choices.exact_cell = true;
    fit->held[LIKE_HELD_SCALE] = has(surface, "rms_slope") || has(surface, "rms_height");
    fit->held[LIKE_HELD_LAY] = has(surface, "anisotropy") || has(surface, "lay_angle");
    fit->held[LIKE_HELD_ROLLOFF] = has(surface, "rolloff_ratio");
    fit->side = grid_dx(grid) * (double)(fit->profile || grid->nx < grid->ny ? grid->nx : grid->ny);
    fit->wavelength = (own_spectrum && points > 0 ? points : 2) * grid_dx(grid);
}

static bool put_all(cJSON *surface, struct fit *fit) {
    const struct like_choices *choices = &fit->choices;
    bool put = true;
    if (choices->spectrum == LIKE_SPECTRUM_TABLE)
        put = put_table(surface, fit);
    else if (choices->spectrum == LIKE_SPECTRUM_FIT)
        put = put_law(surface, fit);
    put = put && put_lengths(surface, fit);
    if (put && choices->heights == LIKE_HEIGHTS_QUANTILES)
        put = put_quantiles(surface, fit);
    if (put && choices->heights == LIKE_HEIGHTS_FIT)
        put = put_distribution(surface, fit);
    return put && (has(surface, "amplitudes") || field_put_text(surface, "amplitudes", "random"));
}

/* Checks what several maps of one surface have in common, and what they exclude. */
static int check_together(const struct fit *fit, struct error *err) {
    const struct height_map *maps = fit->maps;
    int status = 0;
    for (size_t m = 1; m < fit->count && status == 0; m++) {
        status = check_map(&maps[m], err);
        if (status == 0 && (grid_is_profile(&maps[m].grid) != fit->profile ||
                            strcmp(maps[m].xy_unit, maps[0].xy_unit) != 0 ||
                            fit->source[m].detrend != fit->source[0].detrend))
            status = error_set(err, ERROR_INPUT,
                               "maps of one surface are all profiles or none, with lengths in one "
                               "unit, here \"%s\" and \"%s\", and without one trend",
                               maps[0].xy_unit, maps[m].xy_unit);
        if (status != 0)
            error_context(err, "%s", fit->source[m].file);
    }
    if (status == 0 && fit->source->hold)
        return error_set(err, ERROR_INPUT, "\"hold\": surfaces hold one map; name one file");
    if (status == 0 && fit->choices.heights == LIKE_HEIGHTS_FIT)
        return error_set(err, ERROR_INPUT,
                         "\"heights\": \"fit\" is of one map; of several allowed: quantiles, "
                         "gaussian");
    return status;
}

static int estimate_together(struct fit *fit, struct error *err) {
    struct measured_map measured[JOINT_PATCHES_MOST];
    for (size_t m = 0; m < fit->count; m++)
        measured[m] = (struct measured_map){&fit->maps[m].grid, fit->maps[m].z, BOUNDARY_OPEN};
    if (fit->choices.spectrum == LIKE_SPECTRUM_TABLE)
        fit->choices.spectrum = LIKE_SPECTRUM_FIT;
    int status = check_together(fit, err);
    if (status == 0)
        status = like_joint_measure(&fit->estimate, &fit->joint, fit->count, measured, NULL, 0,
                                    &fit->choices, err);
    const double shortest = fit->estimate.self_affine.wavelength_short;
    if (status != 0 || !(fit->longest > 0) || !(shortest > 0))
        return status;
    like_estimate_clear(&fit->estimate);
    return like_joint_measure(&fit->estimate, &fit->joint, fit->count, measured, NULL,
                              fit->longest * shortest, &fit->choices, err);
}

/* Gives the study the grooves. What is compared with sub-maps of its surfaces, which have them, is
 * the map with them. */
static int make_grooves(struct fit *fit, cJSON *surface, const struct height_map *map,
                        struct error *err) {
    const struct measured_map whole = {&map->grid, map->z, BOUNDARY_OPEN};
    int status = like_grooves_put(
        surface, &fit->grooves,
        &(struct like_grooves_of){&map->grid, fit->wavelength, fit->unit, fit->source->hold}, err);
    return status == 0 ? patch_measure(&whole, fit->estimate.measured, err) : status;
}

int like_fit_together(cJSON *surface, size_t count, const struct height_map *maps,
                      const struct like_source *sources, struct error *err) {
    const struct height_map *map = &maps[0];
    struct fit fit = {.source = sources,
                      .unit = map->xy_unit,
                      .map = {&map->grid, map->z, BOUNDARY_OPEN},
                      .profile = grid_is_profile(&map->grid),
                      .count = count,
                      .maps = maps,
                      .longest = field_number(surface, "wavelength_ratio")};
    int status = check_map(map, err);
    if (status == 0)
        status = take_grooves(&fit, surface, err);
    if (status == 0)
        status = measure_parts(&fit, err);
    if (status == 0)
        status = map_form_find(&fit.form, &fit.map, err);
    if (status != 0) {
        free(fit.rest);
        return status;
    }
    choose(&fit, surface);
    status = count > 1 ? estimate_together(&fit, err)
                       : like_estimate_measure(&fit.estimate, &fit.map, &fit.choices, err);
    if (status == ERROR_INPUT && map_form_found(&fit.form)) {
        char words[FORM_TEXT];
        write_form(&fit, words);
        error_context(err, "%s", words);
    }
    if (status == 0 && !put_all(surface, &fit))
        status = error_memory(err, sizeof fit, "a fitted surface");
    if (status == 0 && fit.rest != NULL)
        status = make_grooves(&fit, surface, map, err);
    if (status == 0 && sources->hold)
        status = like_hold_text(&fit.patch, map, fit.wavelength, err);
    if (status == 0)
        status = put_like(surface, &fit, err);
    free(fit.patch);
    free(fit.rest);
    like_estimate_clear(&fit.estimate);
    return status;
}

int like_fit(cJSON *surface, const struct height_map *map, const struct like_source *source,
             struct error *err) {
    return like_fit_together(surface, 1, map, source, err);
}
