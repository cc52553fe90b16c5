#include "jobs/maps/map_spectra.h"
#include "core/statistics/heights/normal_scores.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int density_create(struct map_density *out, size_t count, struct error *err) {
    double *room = array_create(count > 0 ? count : 1, 5 * sizeof *room);
    if (room == NULL)
        return error_memory(err, 5 * count * sizeof *room, "a spectral density");
    *out = (struct map_density){.count = count,
                                .wave_number = room,
                                .density = room + count,
                                .low = room + 2 * count,
                                .high = room + 3 * count,
                                .law = room + 4 * count};
    return 0;
}

/* Fills densities that are not measured with NaN. */
static int density_leave_out(struct map_density *out, size_t count, struct error *err) {
    int status = count > 0 ? density_create(out, count, err) : 0;
    for (size_t n = 0; n < 5 * out->count && status == 0; n++)
        out->wave_number[n] = (double)NAN;
    return status;
}

void map_spectra_clear(struct map_spectra *spectra) {
    free(spectra->rings.wave_number);
    free(spectra->line[0].wave_number);
    free(spectra->line[1].wave_number);
    *spectra = (struct map_spectra){.has_fit = false};
}

/* The law at the wave numbers of the rings. */
static void fill_law(struct map_density *rings, const struct spectrum_fit *fit) {
    for (size_t r = 0; r < rings->count; r++) {
        double density = r > 0 ? spectrum_fit_density(fit, rings->wave_number[r]) : 0;
        rings->law[r] = density > 0 ? density : (double)NAN;
    }
}

static int leave_out(struct map_spectra *out, const struct measured_map *map,
                     const struct map_spectrum *spectrum, struct error *err) {
    int status = density_leave_out(&out->rings, radial_bins(map->grid), err);
    for (int axis = 0; axis < 2 && status == 0 && spectrum != NULL; axis++)
        status = density_leave_out(&out->line[axis], line_psd_count(spectrum, axis), err);
    return status;
}

static int measure_rings(struct map_spectra *out, const struct map_spectrum *spectrum,
                         struct error *err) {
    struct map_density *rings = &out->rings;
    size_t bytes = spectrum->bins * sizeof *spectrum->density;
    int status = density_create(rings, spectrum->bins, err);
    if (status != 0)
        return status;
    memcpy(rings->wave_number, spectrum->wave_number, bytes);
    memcpy(rings->density, spectrum->density, bytes);
    for (size_t r = 0; r < rings->count; r++)
        map_spectrum_band(spectrum, r, &rings->low[r], &rings->high[r]);
    if (out->fit.fitted)
        fill_law(rings, &out->fit);
    else
        rings->law = NULL;
    return 0;
}

static int measure_line(struct map_density *out, const struct map_spectrum *spectrum, int axis,
                        struct error *err) {
    size_t count = line_psd_count(spectrum, axis);
    int status = count > 0 ? density_create(out, count, err) : 0;
    if (status != 0 || count == 0)
        return status;
    line_psd_measure(spectrum, axis, out->wave_number, out->density, out->low, out->high);
    out->law = NULL;
    return 0;
}

static int measure_densities(struct map_spectra *out, const struct map_spectrum *spectrum,
                             struct error *err) {
    int status = measure_rings(out, spectrum, err);
    for (int axis = 0; axis < 2 && status == 0; axis++)
        status = measure_line(&out->line[axis], spectrum, axis, err);
    return status;
}

/* The density of a map under a window of its own. */
static int measure_plain(struct map_density *out, const struct measured_map *map,
                         struct error *err) {
    int status = density_create(out, radial_bins(map->grid), err);
    if (status != 0)
        return status;
    out->low = out->high = out->law = NULL;
    return psd_measure(map->grid, map->z, out->wave_number, out->density, err);
}

/* Fits the law over the ellipses of a lay, where there is one. */
static int surface_law_fit(const struct map_spectrum *spectrum,
                           const struct map_directions *directions,
                           const struct spectrum_fit_request *request, struct spectrum_fit *out,
                           struct error *err) {
    struct map_spectrum *ellipses = NULL;
    struct lay lay;
    int status = map_directions_lay(&lay, directions, spectrum, request, err);
    if (status == 0)
        status = spectrum_fit_along(spectrum, &lay, request, &ellipses, out, err);
    map_spectrum_destroy(&ellipses);
    return status;
}

/* Fits the law: of a long profile by its parts, which takes as long as it has points. */
static int law_fit(const struct measured_map *map, const struct map_spectrum *spectrum,
                   const struct map_directions *directions,
                   const struct spectrum_fit_request *request, struct spectrum_fit *out,
                   struct error *err) {
    struct map_spectrum *pieces = NULL;
    bool is_long = grid_is_profile(map->grid) && map->grid->nx >= 2 * (size_t)PROFILE_PIECE;
    if (!grid_is_profile(map->grid))
        return surface_law_fit(spectrum, directions, request, out, err);
    if (!is_long)
        return spectrum_fit_measure(spectrum, request, out, err);
    int status = profile_spectrum_create(&pieces, map, err);
    if (status == 0)
        status = spectrum_fit_measure(pieces, request, out, err);
    map_spectrum_destroy(&pieces);
    return status;
}

int map_spectra_measure(struct map_spectra *out, const struct measured_map *map,
                        const struct map_spectrum *spectrum,
                        const struct map_directions *directions, bool under_window,
                        const struct spectrum_fit_request *request, enum map_extent extent,
                        struct error *err) {
    if (under_window)
        return extent == MAP_WHOLE ? measure_plain(&out->rings, map, err)
                                   : leave_out(out, map, NULL, err);
    int status = law_fit(map, spectrum, directions, request, &out->fit, err);
    if (status == 0)
        status = extent == MAP_WHOLE ? measure_densities(out, spectrum, err)
                                     : leave_out(out, map, spectrum, err);
    out->has_fit = status == 0;
    return status;
}

/* The end itself is left out: scores of a patch, whose order is not that of all heights, have a
 * tail beyond it. */
static int scores_fit(struct map_spectra *out, const struct measured_map *scored,
                      const struct map_spectrum *spectrum, const struct map_directions *directions,
                      const struct spectrum_fit_request *request, struct error *err) {
    struct spectrum_range range;
    int status = spectrum_range_find(spectrum, request, &range, err);
    if (status != 0 || range.edge <= SPECTRUM_BLURRED)
        return status;
    struct spectrum_fit_request before = *request;
    before.shortest = spectrum->side / ((double)range.edge - SPECTRUM_BLURRED);
    before.map = NULL; /* scores are Gaussian */
    status = law_fit(scored, spectrum, directions, &before, &out->scores, err);
    out->has_scores =
        status == 0 && out->scores.fitted && out->scores.deviance <= out->scores.deviance_limit;
    out->scores_end = spectrum->side / (double)range.edge;
    return status;
}

int map_spectra_measure_scores(struct map_spectra *out, const struct measured_map *map,
                               const struct map_directions *directions,
                               const struct spectrum_fit_request *request, struct error *err) {
    const size_t points = grid_points(map->grid);
    struct map_spectrum *spectrum = NULL;
    double *z = array_create(points, sizeof *z);
    if (z == NULL)
        return error_memory(err, points * sizeof *z, "normal scores of a map");
    const struct measured_map scored = {map->grid, z, map->boundary};
    int status = normal_scores_fill(map, z, err);
    if (status == 0)
        status = map_spectrum_create(&spectrum, &scored, err);
    if (status == 0)
        status = scores_fit(out, &scored, spectrum, directions, request, err);
    map_spectrum_destroy(&spectrum);
    free(z);
    return status;
}
