#include "server/show/characterise_heights.h"
#include "core/statistics/angular_spectrum.h"
#include "core/statistics/height_fit.h"
#include "core/statistics/isotropy.h"
#include "core/statistics/scalar_errors.h"
#include "core/statistics/stationarity.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

static const double DEGREE = M_PI / 180;

/* Which error a value has; relative ones are over the value. */
#define ABSOLUTE(group, name, member)                                                              \
    { group, name, name "_error", offsetof(struct scalar_errors, member), false }
#define RELATIVE(group, name, member)                                                              \
    { group, name, name "_error", offsetof(struct scalar_errors, member), true }
#define MOMENTS(group)                                                                             \
    RELATIVE(group, "rms_slope", slope), RELATIVE(group, "rms_curvature", curvature),              \
        RELATIVE(group, "m0", m0), RELATIVE(group, "m2", m2), RELATIVE(group, "m4", m4),           \
        RELATIVE(group, "nayak_alpha", alpha)

static const struct error_row {
    const char *group, *name, *error_name;
    size_t offset;
    bool relative;
} ERRORS[] = {ABSOLUTE("heights", "rms", sq),
              ABSOLUTE("heights", "skewness", ssk),
              ABSOLUTE("heights", "kurtosis", sku),
              MOMENTS("finite_difference"),
              MOMENTS("interpolated"),
              MOMENTS("spectral"),
              ABSOLUTE("areal", "Sa", sa),
              ABSOLUTE("areal", "Sq", sq),
              ABSOLUTE("areal", "Ssk", ssk),
              ABSOLUTE("areal", "Sku", sku),
              RELATIVE("areal", "Sdq", slope),
              RELATIVE("areal", "Sdr", area)};

static void add_errors(struct characterisation *out, const struct map_chance *chance,
                       const struct cell_differences *differences) {
    struct scalar_errors errors;
    scalar_errors_heights(chance->heights, &chance->modes, &errors);
    scalar_errors_differences(differences, chance->heights, &chance->modes, &errors);
    for (size_t n = 0; n < sizeof ERRORS / sizeof *ERRORS; n++) {
        const struct error_row *row = &ERRORS[n];
        double value = characterisation_value(out, row->group, row->name);
        double error = *(const double *)((const char *)&errors + row->offset);
        characterisation_add_error(out, row->group, row->name, row->error_name,
                                   row->relative ? error * value : error);
    }
}

int characterise_hills(struct characterisation *out, const struct measured_map *map,
                       const struct map_chance *chance, const struct summit_list *hills,
                       struct error *err) {
    static const char GROUP[] = "areal";
    double searched[LOW_CELLS_MOST];
    struct summit_errors errors;
    if (!chance->told)
        return 0;
    int status = summit_cells_count(map, &chance->modes, 1, 1, searched, err);
    if (status != 0)
        return status;
    summit_errors_measure(hills, characterisation_value(out, GROUP, "Spd"), map->grid, searched,
                          chance->heights, &chance->modes, &errors);
    characterisation_add_error(out, GROUP, "Spd", "Spd_error", errors.density);
    characterisation_add_error(out, GROUP, "Spc", "Spc_error", errors.curvature_mean);
    return 0;
}

static void add_uncertainty(struct characterisation *out, const struct map_chance *chance) {
    static const char GROUP[] = "uncertainty";
    double none = (double)NAN;
    characterisation_add_text(out, GROUP, "errors", chance->reason);
    characterisation_add(out, GROUP, "lengths_inside", chance->lengths);
    characterisation_add(out, GROUP, "lengths_needed", LENGTHS_INSIDE_LEAST);
    characterisation_add(out, GROUP, "freedom", chance->told ? (double)chance->modes.count : none);
    characterisation_add(out, GROUP, "factor_95",
                         chance->told ? low_modes_factor(chance->modes.count) : none);
}

/* Names of a family's values, by enum heights_type; the shape is NULL without one. */
#define FAMILY(type, name)                                                                         \
    {name, name "_shape", name "_shape_low", name "_shape_high", name "_p_value", name "_distance"},
static const struct family_names {
    const char *name, *shape, *low, *high, *p_value, *distance;
} FAMILIES[HEIGHTS_QUANTILE] = {HEIGHT_DISTRIBUTIONS(FAMILY)};

static void add_height_fit(struct characterisation *out, const struct map_chance *chance) {
    static const char GROUP[] = "height_fit";
    struct height_fits fits;
    height_fit_measure(chance->heights, map_chance_modes(chance), &fits);
    const struct height_fit *best = &fits.list[fits.best];
    if (isnan(best->distance))
        return;
    characterisation_add_text(out, GROUP, "distribution", FAMILIES[fits.best].name);
    characterisation_add(out, GROUP, "shape", best->shape);
    characterisation_add(out, GROUP, "shape_low", best->shape_low);
    characterisation_add(out, GROUP, "shape_high", best->shape_high);
    characterisation_add(out, GROUP, "p_value", best->p_value);
    characterisation_add(out, GROUP, "distance", best->distance);
    characterisation_add(out, GROUP, "independent", fits.independent);
    for (size_t n = 0; n < HEIGHTS_QUANTILE; n++) {
        const struct height_fit *fit = &fits.list[n];
        if (!isnan(fit->shape)) {
            characterisation_add(out, GROUP, FAMILIES[n].shape, fit->shape);
            characterisation_add(out, GROUP, FAMILIES[n].low, fit->shape_low);
            characterisation_add(out, GROUP, FAMILIES[n].high, fit->shape_high);
        }
        characterisation_add(out, GROUP, FAMILIES[n].p_value, fit->p_value);
        characterisation_add(out, GROUP, FAMILIES[n].distance, fit->distance);
    }
}

/* Measures at a lag in points along x. */
static void isotropy_at(const struct measured_map *map, const struct map_chance *chance, size_t lag,
                        struct isotropy *out) {
    struct cell_differences differences;
    double length = (double)lag * grid_dx(map->grid);
    double excess = chance->told ? low_modes_excess_slopes(&chance->modes, chance->correlation,
                                                           map->grid, length)
                                 : (double)NAN;
    cell_differences_measure(map, &chance->modes, lag, &differences);
    isotropy_measure(&differences, length, &chance->modes, excess, out);
}

/* Returns the longest lag of 1, 2, 4, ... points that is no longer than half of that at which the
 * correlation is 0.2: that of the roughness which most of the height is of. */
static size_t coarse_lag(const struct measured_map *map, const struct map_chance *chance) {
    double side = fmin(map->grid->lx, map->grid->ly), half = side / chance->lengths / 2;
    size_t lag = 1;
    while (chance->told && (double)(2 * lag) * grid_dx(map->grid) <= half)
        lag *= 2;
    return lag;
}

static void add_isotropy(struct characterisation *out, const struct measured_map *map,
                         const struct map_chance *chance, double texture) {
    static const char GROUP[] = "isotropy";
    struct isotropy fine, coarse;
    isotropy_at(map, chance, 1, &fine);
    isotropy_at(map, chance, coarse_lag(map, chance), &coarse);
    const double p_values[] = {fine.p_value, coarse.p_value};
    bool apart = coarse.length > fine.length;
    characterisation_add(out, GROUP, "p_value", least_p_value(p_values, apart ? 2 : 1));
    characterisation_add(out, GROUP, "Std", texture / DEGREE);
    characterisation_add(out, GROUP, "slope_ratio", fine.ratio);
    characterisation_add(out, GROUP, "slope_ratio_error", fine.ratio_error);
    characterisation_add(out, GROUP, "slope_direction", fine.direction / DEGREE);
    characterisation_add(out, GROUP, "slope_direction_error", fine.direction_error / DEGREE);
    characterisation_add(out, GROUP, "slope_p_value", fine.p_value);
    characterisation_add_length(out, GROUP, "coarse_length", coarse.length, 1);
    characterisation_add(out, GROUP, "coarse_ratio", coarse.ratio);
    characterisation_add(out, GROUP, "coarse_ratio_error", coarse.ratio_error);
    characterisation_add(out, GROUP, "coarse_direction", coarse.direction / DEGREE);
    characterisation_add(out, GROUP, "coarse_direction_error", coarse.direction_error / DEGREE);
    characterisation_add(out, GROUP, "coarse_p_value", coarse.p_value);
}

static void add_spreads(struct characterisation *out, const char *group, double areas,
                        const struct spread *spread, double p_value) {
    static const char *const NAMES[STATIONARY_PARAMETERS][3] = {
        {"mean_spread", "mean_expected", "mean_p_value"},
        {"rms_spread", "rms_expected", "rms_p_value"},
        {"skewness_spread", "skewness_expected", "skewness_p_value"},
        {"slope_spread", "slope_expected", "slope_p_value"}};
    characterisation_add(out, group, "areas", areas);
    characterisation_add(out, group, "p_value", p_value);
    for (int q = 0; q < STATIONARY_PARAMETERS; q++) {
        characterisation_add(out, group, NAMES[q][0], spread[q].found);
        characterisation_add(out, group, NAMES[q][1], spread[q].expected);
        characterisation_add(out, group, NAMES[q][2], spread[q].p_value);
    }
}

static void add_stationarity(struct characterisation *out, const struct measured_map *map,
                             const struct map_chance *chance,
                             const struct cell_differences *differences) {
    static const char *const GROUPS[STATIONARY_DIVISIONS] = {"stationarity_coarse",
                                                             "stationarity_fine"};
    static const double AREAS[STATIONARY_DIVISIONS] = {4, 16};
    struct stationarity s = {.p_value = {(double)NAN, (double)NAN}};
    if (chance->told)
        stationarity_measure(map, chance->heights, differences, &chance->modes, chance->correlation,
                             &s);
    characterisation_add(out, "stationarity", "p_value",
                         least_p_value(s.p_value, STATIONARY_DIVISIONS));
    for (size_t d = 0; d < STATIONARY_DIVISIONS && chance->told; d++)
        add_spreads(out, GROUPS[d], AREAS[d], s.spread[d], s.p_value[d]);
}

static int add_directions(struct characterisation *out, const struct measured_map *map,
                          const struct map_chance *chance, struct error *err) {
    static const char GROUP[] = "angular_spectrum";
    static const char *const NAMES[ANGULAR_KINDS][2] = {{"height", "height_error"},
                                                        {"slope", "slope_error"}};
    struct map_spectrum *spectrum = NULL;
    struct angular_spectrum angular;
    int status = map_spectrum_create(&spectrum, map, err);
    if (status != 0)
        return status;
    angular_spectrum_measure(spectrum, &angular);
    map_spectrum_destroy(&spectrum);
    add_isotropy(out, map, chance, angular_spectrum_peak(&angular));
    double *angle = characterisation_column(out, GROUP, "angle", ANGULAR_SECTORS);
    for (size_t n = 0; n < ANGULAR_SECTORS && angle != NULL; n++)
        angle[n] = angular.angle[n] / DEGREE;
    for (int kind = 0; kind < ANGULAR_KINDS; kind++) {
        double *power = characterisation_column(out, GROUP, NAMES[kind][0], ANGULAR_SECTORS);
        double *error = characterisation_column(out, GROUP, NAMES[kind][1], ANGULAR_SECTORS);
        if (angle == NULL || power == NULL || error == NULL)
            return error_memory(err, ANGULAR_SECTORS * sizeof *angle, "an angular spectrum");
        memcpy(power, angular.power[kind], ANGULAR_SECTORS * sizeof *power);
        memcpy(error, angular.error[kind], ANGULAR_SECTORS * sizeof *error);
    }
    return 0;
}

int characterise_chance(struct characterisation *out, const struct measured_map *map,
                        const struct map_chance *chance, struct error *err) {
    struct cell_differences differences;
    cell_differences_measure(map, &chance->modes, 1, &differences);
    if (chance->told)
        add_errors(out, chance, &differences);
    add_uncertainty(out, chance);
    add_height_fit(out, chance);
    int status = grid_is_profile(map->grid) ? 0 : add_directions(out, map, chance, err);
    if (status == 0)
        add_stationarity(out, map, chance, &differences);
    return status;
}
