#include "core/map/map_law.h"
#include "core/error.h"
#include "core/statistics/uncertainty/map_directions.h"
#include <math.h>

static const double GUARD = 1e-9;

/* Finds the lay of a surface whose directions differ. */
static int find_lay(struct lay *lay, const struct measured_map *map,
                    const struct map_spectrum *circles, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    *lay = LAY_NONE;
    if (grid_is_profile(map->grid))
        return 0;
    int status = map_directions_find(&directions, map, circles, err);
    return status == 0 ? map_directions_lay(lay, &directions, circles, &by_the_map, err) : status;
}

int map_law_fit(struct map_law *out, const struct measured_map *map, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    *out = (struct map_law){.fit.fitted = false};
    int status = map_spectrum_create(&out->circles, map, err);
    if (status == 0)
        status = find_lay(&out->lay, map, out->circles, err);
    if (status == 0)
        status = spectrum_fit_along(out->circles, &out->lay, &by_the_map, &out->ellipses, &out->fit,
                                    err);
    if (status == 0)
        out->fit.lay_ratio.value = 1; /* densities are those of waves across */
    else
        map_law_clear(out);
    return status;
}

void map_law_clear(struct map_law *law) {
    map_spectrum_destroy(&law->ellipses);
    map_spectrum_destroy(&law->circles);
}

static bool is_shorter(const struct map_law *law, double wave_number) {
    return wave_number * law->fit.shortest > 2 * M_PI * (1 + GUARD);
}

double map_law_density(const struct map_law *law, double wave_number) {
    const double longest = fmin(law->fit.longest, law->fit.trusted_from) * (1 - GUARD);
    return is_shorter(law, wave_number)
               ? 0
               : spectrum_fit_density(&law->fit, fmax(wave_number, 2 * M_PI / longest));
}

/* Returns the density of the map's rings, straight between them in logarithms; 0 beyond. */
static double ring_density(const struct map_spectrum *rings, double wave_number) {
    const double at = wave_number * rings->side / (2 * M_PI);
    const size_t ring = (size_t)fmax(at, 0);
    if (ring + 1 >= rings->bins)
        return 0;
    const double low = rings->density[ring], high = rings->density[ring + 1];
    return low > 0 && high > 0 ? low * pow(high / low, at - (double)ring) : fmin(low, high);
}

double map_law_whole_density(const struct map_law *law, double wave_number) {
    const struct spectrum_fit *fit = &law->fit;
    const struct map_spectrum *rings = law->ellipses != NULL ? law->ellipses : law->circles;
    const double ring = 2 * M_PI / rings->side, end = 2 * M_PI / fit->shortest;
    if (wave_number * fit->trusted_from < 2 * M_PI * (1 - GUARD))
        return ring_density(rings, fmax(wave_number, ring));
    if (!is_shorter(law, wave_number) || fit->noise > 0)
        return map_law_density(law, wave_number);
    if (fit->to_end != SPECTRUM_END_CUTOFF)
        return ring_density(rings, wave_number);
    /* A sharp end is known to within a ring, and blurred in those behind. */
    if (wave_number < end + ring)
        return map_law_density(law, end);
    return ring_density(rings, fmax(wave_number, end + (SPECTRUM_BLURRED + 1) * ring));
}

void map_law_fill(const struct map_law *law, const struct grid *cell,
                  double of_wave(const struct map_law *law, double wave_number), double *out) {
    const struct lay_frame frame = lay_frame_of(&law->lay);
    const double x = 2 * M_PI / cell->lx, y = 2 * M_PI / cell->ly;
    for (size_t mx = 0; mx <= cell->nx / 2; mx++)
        for (size_t row = 0; row < cell->ny; row++) {
            const double my = row <= cell->ny / 2 ? (double)row : (double)row - (double)cell->ny;
            *out++ =
                of_wave(law, grid_is_profile(cell) ? (double)mx * x
                                                   : lay_length(&frame, (double)mx * x, my * y));
        }
}
