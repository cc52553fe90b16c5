#include "server/show/characterise_spectrum.h"
#include "core/statistics/roughness.h"
#include <math.h>
#include <string.h>

/* Columns of one density, all of them there or none. */
struct density_columns {
    double *wave_number, *density, *low, *high;
};

static int columns_create(struct characterisation *out, const char *group, size_t count, int power,
                          struct density_columns *columns, struct error *err) {
    columns->wave_number = characterisation_column_length(out, group, "wave_number", count, -1);
    columns->density = characterisation_column_length(out, group, "density", count, power);
    columns->low = characterisation_column_length(out, group, "density_low", count, power);
    columns->high = characterisation_column_length(out, group, "density_high", count, power);
    return columns->wave_number != NULL && columns->density != NULL && columns->low != NULL &&
                   columns->high != NULL
               ? 0
               : error_memory(err, count * sizeof *columns->density, "a spectral density");
}

static int density_power(const struct grid *grid) {
    return grid_is_profile(grid) ? 3 : 4;
}

/* The law at the wave numbers of the rings: NaN beyond its ends. */
static int add_law(struct characterisation *out, const struct map_spectrum *spectrum,
                   const struct spectrum_fit *fit, struct error *err) {
    double *law = characterisation_column_length(out, "psd", "density_fitted", spectrum->bins,
                                                 density_power(&spectrum->modes.grid));
    if (law == NULL)
        return error_memory(err, spectrum->bins * sizeof *law, "a fitted density");
    for (size_t r = 0; r < spectrum->bins; r++) {
        double density = r > 0 ? spectrum_fit_density(fit, spectrum->wave_number[r]) : 0;
        law[r] = density > 0 ? density : (double)NAN;
    }
    return 0;
}

static int add_rings(struct characterisation *out, const struct map_spectrum *spectrum,
                     const struct spectrum_fit *fit, struct error *err) {
    struct density_columns columns;
    size_t count = spectrum->bins, bytes = count * sizeof *spectrum->density;
    int status =
        columns_create(out, "psd", count, density_power(&spectrum->modes.grid), &columns, err);
    if (status != 0)
        return status;
    memcpy(columns.wave_number, spectrum->wave_number, bytes);
    memcpy(columns.density, spectrum->density, bytes);
    for (size_t r = 0; r < count; r++)
        map_spectrum_band(spectrum, r, &columns.low[r], &columns.high[r]);
    return fit->fitted ? add_law(out, spectrum, fit, err) : 0;
}

static int add_lines(struct characterisation *out, const struct map_spectrum *spectrum,
                     struct error *err) {
    static const char *const GROUPS[] = {"psd_x", "psd_y"};
    int status = 0;
    for (int axis = 0; axis < 2 && status == 0; axis++) {
        struct density_columns columns;
        size_t count = line_psd_count(spectrum, axis);
        if (count == 0)
            continue;
        status = columns_create(out, GROUPS[axis], count, 3, &columns, err);
        if (status == 0)
            line_psd_measure(spectrum, axis, columns.wave_number, columns.density, columns.low,
                             columns.high);
    }
    return status;
}

static void add_fit(struct characterisation *out, const struct spectrum_fit *fit) {
    static const char GROUP[] = "spectrum_fit";
    const int power = fit->profile ? 3 : 4;
    const struct {
        const char *name, *low, *high;
        const struct interval *interval;
        int power;
    } rows[] = {
        {"hurst", "hurst_low", "hurst_high", &fit->hurst, 0},
        {"rolloff_wavelength", "rolloff_wavelength_low", "rolloff_wavelength_high",
         &fit->rolloff_wavelength, 1},
        {"short_wavelength", "short_wavelength_low", "short_wavelength_high",
         &fit->short_wavelength, 1},
        {"long_wavelength", "long_wavelength_low", "long_wavelength_high", &fit->long_wavelength,
         1},
        {"amplitude", "amplitude_low", "amplitude_high", &fit->amplitude, power},
        {"rms_height", "rms_height_low", "rms_height_high", &fit->rms_height, 1},
        {"rms_slope", "rms_slope_low", "rms_slope_high", &fit->rms_slope, 0},
    };
    characterisation_add_length(out, GROUP, "trusted_from", fit->trusted_from, 1);
    characterisation_add_text(out, GROUP, "trusted_from_by", SPECTRUM_END_NAMES[fit->from_end]);
    characterisation_add_length(out, GROUP, "trusted_to", fit->trusted_to, 1);
    characterisation_add_text(out, GROUP, "trusted_to_by", SPECTRUM_END_NAMES[fit->to_end]);
    characterisation_add_length(out, GROUP, "noise", fit->noise, power);
    for (size_t n = 0; n < sizeof rows / sizeof *rows && fit->fitted; n++) {
        characterisation_add_length(out, GROUP, rows[n].name, rows[n].interval->value,
                                    rows[n].power);
        characterisation_add_length(out, GROUP, rows[n].low, rows[n].interval->low, rows[n].power);
        characterisation_add_length(out, GROUP, rows[n].high, rows[n].interval->high,
                                    rows[n].power);
    }
    if (!fit->fitted)
        return;
    characterisation_add_length(out, GROUP, "amplitude_at", fit->reference_wavelength, 1);
    characterisation_add(out, GROUP, "deviance", fit->deviance);
    characterisation_add(out, GROUP, "freedom", fit->freedom);
}

/* The density of a map under a window of its own. */
static int add_plain(struct characterisation *out, const struct measured_map *map,
                     struct error *err) {
    size_t bins = radial_bins(map->grid);
    double *wave_number = characterisation_column_length(out, "psd", "wave_number", bins, -1);
    double *density =
        characterisation_column_length(out, "psd", "density", bins, density_power(map->grid));
    return wave_number != NULL && density != NULL
               ? psd_measure(map->grid, map->z, wave_number, density, err)
               : error_memory(err, bins * sizeof *density, "a spectral density");
}

/* Fits the law: of a long profile by its pieces, which takes as long as it has points. */
static int law_fit(const struct measured_map *map, const struct map_spectrum *spectrum,
                   const struct spectrum_fit_request *request, struct spectrum_fit *out,
                   struct error *err) {
    struct map_spectrum *pieces = NULL;
    bool is_long = grid_is_profile(map->grid) && map->grid->nx >= 2 * (size_t)PROFILE_PIECE;
    if (!is_long)
        return spectrum_fit_measure(spectrum, request, out, err);
    int status = profile_spectrum_create(&pieces, map, err);
    if (status == 0)
        status = spectrum_fit_measure(pieces, request, out, err);
    map_spectrum_destroy(&pieces);
    return status;
}

int characterise_spectrum(struct characterisation *out, const struct measured_map *map,
                          bool under_window, const struct spectrum_fit_request *request,
                          struct error *err) {
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit fit;
    if (under_window)
        return add_plain(out, map, err);
    int status = map_spectrum_create(&spectrum, map, err);
    if (status == 0)
        status = law_fit(map, spectrum, request, &fit, err);
    if (status == 0)
        status = add_rings(out, spectrum, &fit, err);
    if (status == 0)
        status = add_lines(out, spectrum, err);
    if (status == 0)
        add_fit(out, &fit);
    map_spectrum_destroy(&spectrum);
    return status;
}
