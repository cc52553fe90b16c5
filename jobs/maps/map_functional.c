#include "jobs/maps/map_functional.h"
#include <math.h>

static const double RATIOS[MAP_RATIOS] = {0,    0.01, 0.02, 0.025, 0.05, 0.1,  0.15,
                                          0.2,  0.3,  0.4,  0.5,   0.6,  0.7,  0.8,
                                          0.85, 0.9,  0.95, 0.975, 0.98, 0.99, 1};

int map_functional_measure(struct map_functional *out, const struct measured_map *map,
                           const struct summit_list *hills, double sz,
                           const struct map_chance *chance, struct error *err) {
    struct material_curve curve;
    int status = material_curve_create(&curve, map, err);
    if (status != 0)
        return status;
    const double mean = curve.mean;
    functional_measure(&curve, &out->found);
    plateau_fit(&curve, &out->plateau);
    for (size_t r = 0; r < MAP_RATIOS; r++) {
        out->ratio[r] = RATIOS[r];
        out->height[r] = material_height(&curve, RATIOS[r]);
    }
    out->has_errors = chance != NULL && chance->told;
    if (out->has_errors)
        status = functional_errors_measure(&out->errors, map, &curve, chance, err);
    material_curve_clear(&curve);
    if (status != 0)
        return status;
    if (hills != NULL)
        return ten_points_measure(map, hills, mean, sz, &out->ten_points, err);
    profile_spacing_measure(map, mean, &out->spacing);
    return 0;
}

int map_functional_measure_strata(struct map_functional *out, const struct measured_map *map,
                                  struct error *err) {
    const double none = (double)NAN;
    const struct material_core core = {none, none, none, none, none};
    *out = (struct map_functional){.found = {core, core, none, none, none, none, none},
                                   .ten_points = {.s5p = none, .s5v = none, .s10z = none},
                                   .spacing = {.rsm = none, .rsm_old = none}};
    for (size_t r = 0; r < MAP_RATIOS; r++) {
        out->ratio[r] = RATIOS[r];
        out->height[r] = none;
    }
    struct material_curve curve;
    int status = material_curve_create(&curve, map, err);
    if (status != 0)
        return status;
    plateau_fit(&curve, &out->plateau);
    material_curve_clear(&curve);
    return 0;
}
