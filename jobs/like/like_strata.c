#include "jobs/like/like_strata.h"
#include "core/statistics/spectra/strata_fit.h"
#include "jobs/surface/surface_case.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdio.h>

static bool put(cJSON *object, const char *name, double value) {
    return field_put(object, name, json_number(value));
}

/* Waves that are longer than the shorter side of the cell are as long as that. */
static double longest_of(const struct strata_law *law, enum stratum stratum, double side) {
    return fmin(law->wavelength_long[stratum], side);
}

static bool put_valleys(cJSON *surface, const struct strata_law *law, const struct grid *map,
                        double rms_height) {
    const bool profile = grid_is_profile(map);
    const double dx = grid_dx(map), shortest = law->wavelength_short;
    const double lx = dx * (double)surface_case_side(2 * (double)map->nx - 0.5);
    const double ly = profile ? lx : dx * (double)surface_case_side(2 * (double)map->ny - 0.5);
    const double longest = longest_of(law, STRATUM_VALLEYS, fmin(lx, ly));
    return put(surface, "dimension", profile ? 1 : 2) &&
           put(surface, "hurst", law->hurst[STRATUM_VALLEYS]) &&
           put(surface, "wavelength_ratio", longest / shortest) &&
           put(surface, "points_per_wavelength", fmax(2, shortest / dx)) &&
           put(surface, "length_ratio", lx / longest) &&
           (ly == lx || put(surface, "length_ratio_y", ly / longest)) &&
           put(surface, "rms_height", rms_height / shortest) &&
           field_put_text(surface, "amplitudes", "random");
}

static bool put_plateau(cJSON *surface, const struct strata_law *law) {
    cJSON *plateau = cJSON_AddObjectToObject(surface, "plateau");
    const double lx = json_number_at(surface, "/length_ratio", 1) *
                      json_number_at(surface, "/wavelength_ratio", 1) * law->wavelength_short;
    const double ly = lx * json_number_at(surface, "/length_ratio_y", 1) /
                      json_number_at(surface, "/length_ratio", 1);
    const bool square = json_at(surface, "/length_ratio_y") == NULL;
    const double longest = longest_of(law, STRATUM_PLATEAU, square ? lx : fmin(lx, ly));
    return plateau != NULL && put(plateau, "rms_ratio", law->rms_ratio) &&
           put(plateau, "offset", law->offset) &&
           put(plateau, "hurst", law->hurst[STRATUM_PLATEAU]) &&
           put(plateau, "wavelength_ratio", longest / law->wavelength_short) &&
           put(plateau, "length_ratio", lx / longest);
}

int like_strata_put(cJSON *surface, const struct height_map *map, const struct plateau_law *heights,
                    char words[LIKE_STRATA_TEXT], struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, BOUNDARY_OPEN};
    const char *unit = map->xy_unit, *gap = *unit != '\0' ? " " : "";
    struct strata_law law;
    int status = strata_fit(&law, &measured, heights, err);
    if (status != 0)
        return status;
    if (!put_valleys(surface, &law, &map->grid, heights->valley_rms) || !put_plateau(surface, &law))
        return error_memory(err, sizeof law, "a stratified surface");
    snprintf(words, LIKE_STRATA_TEXT,
             "two laws: valleys of RMS height %.3g%s%.10s (H %.2g, waves of %.3g to %.3g%s%.10s) "
             "below a plateau of %.3g%s%.10s (H %.2g, waves to %.3g%s%.10s)",
             heights->valley_rms, gap, unit, law.hurst[STRATUM_VALLEYS], law.wavelength_short,
             law.wavelength_long[STRATUM_VALLEYS], gap, unit, heights->plateau_rms, gap, unit,
             law.hurst[STRATUM_PLATEAU], law.wavelength_long[STRATUM_PLATEAU], gap, unit);
    return 0;
}
