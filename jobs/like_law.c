#include "jobs/like_law.h"
#include "core/statistics/height_fit.h"
#include "core/statistics/isotropy.h"
#include "core/statistics/map_chance.h"
#include "core/statistics/map_spectrum.h"
#include "core/statistics/spectrum_fit.h"
#include <math.h>

/* An isotropic surface looks anisotropic by chance so seldom. */
static const double CHANCE = 0.01;
/* And is plainly anisotropic where the map is too small to tell chance. */
static const double RATIO_PLAIN = 2;

int like_law_fit(const struct measured_map *map, struct spectrum *law, double trusted[2],
                 struct error *err) {
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit fit;
    int status = map_spectrum_create(&spectrum, map, err);
    if (status == 0)
        status = spectrum_fit_measure(spectrum, &(struct spectrum_fit_request){0}, &fit, err);
    map_spectrum_destroy(&spectrum);
    if (status != 0)
        return status;
    trusted[0] = fit.trusted_from;
    trusted[1] = fit.trusted_to;
    return law != NULL ? spectrum_fit_law(&fit, law, err) : 0;
}

#define NAME(type, name) name,
static const char *const NAMES[HEIGHTS_QUANTILE] = {HEIGHT_DISTRIBUTIONS(NAME)};

int like_law_heights(const struct measured_map *map, const char **name, double *shape,
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

int like_law_anisotropy(const struct measured_map *map, double *ratio, double *across,
                        struct error *err) {
    struct map_chance *chance = NULL;
    struct cell_differences differences;
    struct isotropy isotropy;
    *ratio = 1;
    *across = 0;
    if (grid_is_profile(map->grid))
        return 0;
    int status = map_chance_create(&chance, map, err);
    if (status != 0)
        return status;
    double spacing = grid_dx(map->grid);
    double excess = chance->told ? low_modes_excess_slopes(&chance->modes, chance->correlation,
                                                           map->grid, spacing)
                                 : (double)NAN;
    cell_differences_measure(map, &chance->modes, 1, &differences);
    isotropy_measure(&differences, spacing, &chance->modes, excess, &isotropy);
    bool sure = isnan(isotropy.p_value) ? isotropy.ratio > RATIO_PLAIN
                                        : isotropy.p_value < CHANCE && isotropy.ratio > 1;
    *ratio = sure ? isotropy.ratio : 1;
    *across = sure ? isotropy.direction : 0;
    map_chance_destroy(&chance);
    return 0;
}
