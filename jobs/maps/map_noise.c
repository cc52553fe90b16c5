#include "jobs/maps/map_noise.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/spectrum_fit.h"

int map_noise_measure(struct map_noise *out, const struct measured_map *map, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit fit;
    struct roughness roughness;
    *out = (struct map_noise){.governs = false};
    int status = map_spectrum_create(&spectrum, map, err);
    if (status == 0)
        status = spectrum_fit_measure(spectrum, &by_the_map, &fit, err);
    map_spectrum_destroy(&spectrum);
    if (status != 0 || !fit.fitted)
        return status;
    map_roughness_measure(map, &roughness);
    const double share = spectrum_fit_noise_share(&fit, map->grid, roughness.rms_curvature);
    *out = (struct map_noise){share > NOISE_SHARE_MOST && fit.rms_slope.value < roughness.rms_slope,
                              roughness.rms_slope, fit.rms_slope.value};
    return 0;
}
