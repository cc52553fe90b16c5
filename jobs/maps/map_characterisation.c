#include "jobs/maps/map_characterisation.h"
#include "core/statistics/heights/height_quantiles.h"
#include "jobs/maps/map_remedies.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int curve_create(struct map_curve *out, size_t count, const char *what, struct error *err) {
    double *room = array_create(count > 0 ? count : 1, 2 * sizeof *room);
    if (room == NULL)
        return error_memory(err, 2 * count * sizeof *room, what);
    *out = (struct map_curve){count, room, room + count};
    return 0;
}

/* Fills a curve that is not measured with NaN. */
static void curve_leave_out(struct map_curve *curve) {
    for (size_t n = 0; n < curve->count; n++)
        curve->x[n] = curve->y[n] = (double)NAN;
}

void map_characterisation_clear(struct map_characterisation *characterisation) {
    map_spectra_clear(&characterisation->spectra);
    free(characterisation->correlation.x);
    free(characterisation->quantiles.x);
    characterisation->correlation = characterisation->quantiles = (struct map_curve){.count = 0};
}

/* --- heights --- */

static int measure_quantiles(struct map_curve *out, const struct measured_map *map, size_t heights,
                             enum map_extent extent, struct error *err) {
    size_t count = height_quantiles_count(heights);
    if (count == 0)
        return 0;
    int status = curve_create(out, count, "quantiles of the heights", err);
    if (status != 0 || extent == MAP_WHOLE)
        return status == 0 ? height_quantiles_measure(map, heights, out->x, out->y, err) : status;
    curve_leave_out(out);
    return 0;
}

static void count_heights(struct map_histogram *out, const struct measured_map *map) {
    size_t points = grid_points(map->grid), count = 0;
    double low = INFINITY, high = -INFINITY;
    for (size_t n = 0; n < points; n++) {
        low = map->z[n] < low ? map->z[n] : low;
        high = map->z[n] > high ? map->z[n] : high;
        count += isnan(map->z[n]) ? 0 : 1;
    }
    double wanted = fmin(HISTOGRAM_BINS_MOST, fmax(12, 2 * cbrt((double)count)));
    *out = (struct map_histogram){
        .count = low < high ? (size_t)wanted : 0, .low = low, .width = 1, .total = (double)count};
    if (out->count == 0)
        return;
    out->width = (high - low) / (double)out->count;
    const double last = (double)out->count - 1;
    for (size_t n = 0; n < points; n++) {
        double bin = (map->z[n] - low) / out->width;
        if (!isnan(bin))
            out->counts[(size_t)(bin < last ? bin : last)] += 1;
    }
}

bool map_height_law_find(struct map_height_law *out,
                         const struct map_characterisation *characterisation) {
    const struct height_fits *fits = &characterisation->height_fits;
    const struct height_fit *best = &fits->list[fits->best];
    struct error unused;
    if (isnan(best->distance) || fits->best == HEIGHTS_GAUSSIAN)
        return false;
    *out = (struct map_height_law){
        .heights = {.type = (enum heights_type)fits->best, .shape = best->shape}};
    return heights_moments(&out->heights, &out->moments, &unused) == 0;
}

double map_height_law_density(const struct map_height_law *law, double x, double mean,
                              double deviation) {
    static const double STEP = 1e-3; /* of the standard deviation */
    double t = (x - mean) / deviation;
    return (heights_cdf(&law->heights, &law->moments, t + STEP) -
            heights_cdf(&law->heights, &law->moments, t - STEP)) /
           (2 * STEP * deviation);
}

/* --- surfaces --- */

static int measure_hill_errors(struct map_characterisation *out, const struct measured_map *map,
                               const struct map_chance *chance, const struct summit_list *hills,
                               struct error *err) {
    double searched[LOW_CELLS_MOST];
    if (!chance->told)
        return 0;
    int status = summit_cells_count(map, &chance->modes, 1, 1, searched, err);
    if (status != 0)
        return status;
    summit_errors_measure(hills, out->areal.spd, map->grid, searched, chance->heights,
                          &chance->modes, &out->hill_errors);
    out->hills_have_errors = true;
    return 0;
}

static int measure_areal(struct map_characterisation *out, const struct measured_map *map,
                         const struct map_chance *chance, enum map_extent extent,
                         struct error *err) {
    struct summit_list hills = {0};
    struct roughness roughness = out->parameters.roughness;
    if (map->boundary != BOUNDARY_OPEN)
        open_roughness_measure(map, &roughness);
    if (extent == MAP_MAIN) {
        areal_measure_heights(map, &roughness, chance->correlation, &out->areal);
        return map_functional_measure_strata(&out->functional, map, err);
    }
    int status = areal_measure(map, &roughness, chance->correlation, &hills, &out->areal, err);
    if (status == 0)
        status = map_functional_measure(&out->functional, map, &hills, out->areal.sz, chance, err);
    if (status == 0)
        status = measure_hill_errors(out, map, chance, &hills, err);
    summit_list_clear(&hills);
    return status;
}

/* --- statistical errors --- */

static void fill_certainty(struct map_certainty *out, const struct map_chance *chance) {
    double none = (double)NAN;
    *out = (struct map_certainty){.has_errors = chance->told,
                                  .reason = chance->reason,
                                  .lengths = chance->lengths,
                                  .freedom = chance->told ? (double)chance->modes.count : none,
                                  .factor =
                                      chance->told ? low_modes_factor(chance->modes.count) : none};
}

/* What several parts are measured from. */
struct common {
    const struct measured_map *map;
    const struct map_chance *chance;
    struct map_spectrum *spectrum;   /* owned; NULL for a profile under a window */
    struct cell_differences nearest; /* at a lag of one point */
    bool spiky;                      /* spikes of the map count (map_artefacts.h) */
    enum map_extent extent;
};

/* Heights that a law fits at this level are taken to have its tails. Those of a map whose
 * spikes count are not: a law has no spikes, so that its influences over those of the map would
 * make errors small. */
static const double LAW_LEVEL = 0.001;

static int heights_by_law(struct map_characterisation *out, const struct common *common,
                          struct error *err) {
    const struct height_fit *best = &out->height_fits.list[out->height_fits.best];
    const double before = out->errors.sq;
    const bool stratified = isfinite(out->functional.plateau.ratio);
    const bool clearly = plateau_is_clear(&out->functional.plateau);
    struct map_height_law law;
    if (!clearly && !map_height_law_find(&law, out))
        return 0;
    if (clearly && !common->spiky)
        scalar_errors_by_strata(&out->errors, common->map, &out->functional.plateau);
    else if (!clearly && !common->spiky && best->p_value >= LAW_LEVEL)
        scalar_errors_by_law(&out->errors, common->map, &law.heights, &law.moments);
    for (int s = 0; s < MAP_STENCILS; s++)
        out->parameters.summits[s].errors.height_deviation *= out->errors.sq / before;
    /* tilts make the fit itself worse: whatever its level is, its ends are the best that is known
     */
    return out->functional.has_errors && !stratified
               ? functional_errors_by_law(&out->functional.errors, common->chance, &law.heights,
                                          &law.moments, grid_is_profile(common->map->grid), err)
               : 0;
}

static int measure_chance(struct map_characterisation *out, const struct common *common,
                          struct error *err) {
    const struct measured_map *map = common->map;
    const struct map_chance *chance = common->chance;
    int status = 0;
    fill_certainty(&out->certainty, chance);
    if (chance->told) {
        scalar_errors_heights(chance->heights, &chance->modes, &out->errors);
        scalar_errors_differences(&common->nearest, chance->heights, &chance->modes, &out->errors);
    }
    height_fit_measure(chance->heights, map_chance_modes(chance), &out->height_fits);
    if (chance->told) {
        status = heights_by_law(out, common, err);
        scalar_errors_inside(&out->errors, out->parameters.moments_share, &out->moment_errors);
    }
    if (!grid_is_profile(map->grid))
        map_directions_measure(&out->directions, map, chance, common->spectrum, &common->nearest);
    out->stationarity = (struct stationarity){.p_value = {(double)NAN, (double)NAN}};
    if (chance->told)
        stationarity_measure(map, chance->heights, &common->nearest, &chance->modes,
                             chance->correlation, &out->stationarity);
    out->stationarity_p_value = least_p_value(out->stationarity.p_value, STATIONARY_DIVISIONS);
    return status;
}

/* --- all --- */

/* Heights that a Gaussian law fits at this level scatter as such. */
static const double GAUSSIAN_LEVEL = 0.01;

static int measure_correlation(struct map_curve *out, const struct correlation *correlation,
                               enum map_extent extent, struct error *err) {
    int status = curve_create(out, correlation_rings(correlation), "an autocorrelation", err);
    if (status == 0 && extent == MAP_WHOLE)
        correlation_radial(correlation, out->x, out->y);
    else if (status == 0)
        curve_leave_out(out);
    return status;
}

static int measure_spectra(struct map_characterisation *out, const struct measured_map *map,
                           const struct map_spectrum *spectrum,
                           const struct map_directions *directions, const struct low_modes *modes,
                           bool under_window, const struct spectrum_fit_request *trusted,
                           enum map_extent extent, struct error *err) {
    const struct height_fits *fits = &out->height_fits;
    const bool gaussian =
        fits->best == HEIGHTS_GAUSSIAN && !(fits->list[HEIGHTS_GAUSSIAN].p_value < GAUSSIAN_LEVEL);
    struct spectrum_fit_request of_map = *trusted;
    of_map.map = modes != NULL && !gaussian ? map : NULL;
    of_map.modes = modes;
    int status = map_spectra_measure(&out->spectra, map, spectrum, directions, under_window,
                                     &of_map, extent, err);
    bool taken = out->spectra.has_fit && out->spectra.fit.to_end == SPECTRUM_END_LOW_PASS;
    if (status == 0 && taken && out->height_fits.best != HEIGHTS_GAUSSIAN)
        status = map_spectra_measure_scores(&out->spectra, map, directions, trusted, err);
    return status;
}

/* Measures the spectra of what is left of a map without its grooves, which would be peaks in them.
 */
static int measure_rest(struct map_characterisation *out, const struct measured_map *map,
                        const struct low_modes *modes, const struct spectrum_fit_request *trusted,
                        enum map_extent extent, struct error *err) {
    struct map_directions directions = {.p_value = 1};
    struct map_spectrum *spectrum = NULL;
    struct roughness roughness;
    double *z;
    int status = map_grooves_rest(&z, &out->grooves, map->grid, map->z, err);
    if (status != 0)
        return status;
    const struct measured_map rest = {map->grid, z, map->boundary};
    open_roughness_measure(&rest, &roughness);
    out->rest_height = roughness.rms_height;
    status = map_spectrum_create(&spectrum, &rest, err);
    if (status == 0 && !grid_is_profile(map->grid))
        status = map_directions_find(&directions, &rest, spectrum, err);
    if (status == 0)
        status =
            measure_spectra(out, &rest, spectrum, &directions, modes, false, trusted, extent, err);
    map_spectrum_destroy(&spectrum);
    free(z);
    return status;
}

static int measure_common(struct map_characterisation *out, struct common *common,
                          bool under_window, const struct spectrum_fit_request *trusted,
                          struct error *err) {
    const struct measured_map *map = common->map;
    if (!(grid_is_profile(map->grid) && under_window)) {
        int status = map_spectrum_create(&common->spectrum, map, err);
        if (status != 0)
            return status;
    }
    cell_differences_measure(map, &common->chance->modes, 1, &common->nearest);
    int status = measure_chance(out, common, err);
    if (status != 0)
        return status;
    if (common->extent == MAP_WHOLE) {
        count_heights(&out->histogram, map);
        map_scales_measure(&out->scales, map, common->chance, &common->nearest);
    }
    out->rest_height = (double)NAN;
    const struct low_modes *modes = map_chance_modes(common->chance);
    status = map_form_find(&out->form, map, err);
    if (status == 0 && !under_window)
        status = map_grooves_find(&out->grooves, map, err);
    if (status == 0 && out->grooves.families > 0)
        return measure_rest(out, map, modes, trusted, common->extent, err);
    return status == 0 ? measure_spectra(out, map, common->spectrum, &out->directions, modes,
                                         under_window, trusted, common->extent, err)
                       : status;
}

static int measure_profile(struct map_characterisation *out, const struct measured_map *map,
                           const struct map_chance *chance, enum map_extent extent,
                           struct error *err) {
    return extent == MAP_WHOLE ? map_functional_measure(&out->functional, map, NULL, 0, chance, err)
                               : map_functional_measure_strata(&out->functional, map, err);
}

static bool is_under_window(const struct preparation_record *record) {
    return record->window_power < 1;
}

static int measure(struct map_characterisation *out, const struct measured_map *map,
                   const struct map_chance *chance, const struct preparation_record *record,
                   const struct spectrum_fit_request *trusted, enum map_extent extent,
                   struct error *err) {
    struct common common = {.map = map,
                            .chance = chance,
                            .spiky = map_spikes_count(&record->artefacts),
                            .extent = extent};
    int status = map_parameters_measure(&out->parameters, map, map->grid->nx / 2, map->grid->ny / 2,
                                        chance, extent, err);
    if (status == 0)
        status = grid_is_profile(map->grid) ? measure_profile(out, map, chance, extent, err)
                                            : measure_areal(out, map, chance, extent, err);
    if (status == 0)
        status = measure_common(out, &common, is_under_window(record), trusted, err);
    map_spectrum_destroy(&common.spectrum);
    return status == 0 ? measure_correlation(&out->correlation, chance->correlation, extent, err)
                       : status;
}

int map_characterise(struct map_characterisation *out, const struct height_map *map,
                     const struct preparation_record *record,
                     const struct spectrum_fit_request *trusted, enum map_extent extent,
                     struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, record->boundary};
    struct map_chance *chance = NULL;
    int status = map_chance_create(&chance, &measured, err);
    if (status != 0)
        return status;
    if (is_under_window(record))
        map_chance_forgo(chance, "none: the map is under a window");
    status = measure(out, &measured, chance, record, trusted, extent, err);
    if (status == 0 && out->certainty.has_errors)
        status = map_remedies_add(&(struct map_remedied){.areal = &out->areal,
                                                         .errors = &out->errors,
                                                         .moment_errors = &out->moment_errors,
                                                         .functional = &out->functional,
                                                         .directions = &out->directions,
                                                         .parameters = &out->parameters,
                                                         .scales = &out->scales,
                                                         .spectra = &out->spectra},
                                  &measured, record, err);
    map_chance_destroy(&chance);
    size_t heights = grid_points(&map->grid) - height_map_holes(map);
    return status == 0 ? measure_quantiles(&out->quantiles, &measured, heights, extent, err)
                       : status;
}

bool map_is_stratified(const struct map_characterisation *of) {
    return of->grooves.families == 0 &&
           !(of->height_fits.list[HEIGHTS_GAUSSIAN].p_value >= GAUSSIAN_LEVEL) &&
           plateau_is_clear(&of->functional.plateau);
}
