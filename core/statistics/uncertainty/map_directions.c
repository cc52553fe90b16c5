#include "core/statistics/uncertainty/map_directions.h"
#include <math.h>

/* Measures at a lag in points along x, whose differences are these. */
static void isotropy_at(const struct measured_map *map, const struct map_chance *chance, size_t lag,
                        const struct cell_differences *differences, struct isotropy *out) {
    double length = (double)lag * grid_dx(map->grid);
    double excess = chance->told ? low_modes_excess_slopes(&chance->modes, chance->correlation,
                                                           map->grid, length)
                                 : (double)NAN;
    isotropy_measure(differences, length, &chance->modes, excess, out);
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

void map_directions_measure(struct map_directions *out, const struct measured_map *map,
                            const struct map_chance *chance, const struct map_spectrum *spectrum,
                            const struct cell_differences *nearest) {
    size_t lag = coarse_lag(map, chance);
    struct cell_differences farther;
    if (lag > 1)
        cell_differences_measure(map, &chance->modes, lag, &farther);
    angular_spectrum_measure(spectrum, &out->angular);
    isotropy_at(map, chance, 1, nearest, &out->fine);
    isotropy_at(map, chance, lag, lag > 1 ? &farther : nearest, &out->coarse);
    const double p_values[] = {out->fine.p_value, out->coarse.p_value};
    out->p_value = least_p_value(p_values, out->coarse.length > out->fine.length ? 2 : 1);
    out->texture = angular_spectrum_peak(&out->angular);
}

int map_directions_find(struct map_directions *out, const struct measured_map *map,
                        const struct map_spectrum *spectrum, struct error *err) {
    struct map_chance *chance = NULL;
    struct cell_differences nearest;
    int status = map_chance_create(&chance, map, err);
    if (status != 0)
        return status;
    cell_differences_measure(map, &chance->modes, 1, &nearest);
    map_directions_measure(out, map, chance, spectrum, &nearest);
    map_chance_destroy(&chance);
    return 0;
}

static const double SIGNIFICANCE = 0.01;

bool map_directions_differ(const struct map_directions *directions) {
    static const double RATIO_PLAIN = 2; /* of slopes, where there is no p-value */
    return isnan(directions->p_value) ? directions->fine.ratio > RATIO_PLAIN
                                      : directions->p_value < SIGNIFICANCE;
}

int map_directions_lay(struct lay *out, const struct map_directions *directions,
                       const struct map_spectrum *spectrum,
                       const struct spectrum_fit_request *asked, struct error *err) {
    const bool known = !isnan(directions->p_value);
    const bool coarse = directions->coarse.p_value < directions->fine.p_value;
    const struct isotropy *surer = coarse ? &directions->coarse : &directions->fine;
    *out = LAY_NONE;
    if (known && !(directions->p_value < SIGNIFICANCE))
        return 0;
    const struct lay start = {.ratio = surer->ratio, .angle = surer->direction + M_PI / 2};
    int status = lay_fit_measure(out, &start, spectrum, asked, err);
    if (status == 0 && !known && !(lay_p_value(out) < SIGNIFICANCE))
        *out = LAY_NONE;
    return status;
}
