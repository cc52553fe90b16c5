#include "jobs/maps/map_together.h"
#include "core/map/length_unit.h"
#include "core/statistics/uncertainty/map_directions.h"
#include <stdlib.h>

static int check_map(const struct map_together *together, const struct height_map *map,
                     struct error *err) {
    if (together->count == JOINT_PATCHES_MOST)
        return error_set(err, ERROR_INPUT, "more than %d maps together", JOINT_PATCHES_MOST);
    if (together->count == 0)
        return 0;
    if (together->profile != grid_is_profile(&map->grid))
        return error_set(err, ERROR_INPUT, "profiles and surfaces together");
    if (together->in_metres != length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "lengths are in \"%s\", and those of the maps before are not",
                         map->xy_unit);
    return 0;
}

static int find_lay(struct together_map *one, const struct measured_map *map, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    struct map_directions directions;
    one->lay = LAY_NONE;
    if (grid_is_profile(map->grid))
        return 0;
    int status = map_directions_find(&directions, map, one->spectrum, err);
    return status == 0 ? map_directions_lay(&one->lay, &directions, one->spectrum, &by_the_map, err)
                       : status;
}

static int measure(struct together_map *one, const struct measured_map *map, struct error *err) {
    int status = map_spectrum_create(&one->spectrum, map, err);
    return status == 0 ? find_lay(one, map, err) : status;
}

static int measure_rest(struct together_map *one, const struct measured_map *map,
                        struct error *err) {
    double *z;
    int status = map_grooves_rest(&z, &one->grooves, map->grid, map->z, err);
    if (status == 0)
        status = measure(one, &(struct measured_map){map->grid, z, map->boundary}, err);
    free(z);
    return status;
}

int map_together_add(struct map_together *together, const char *file, const struct height_map *map,
                     enum boundary boundary, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, boundary};
    struct together_map *one = &together->maps[together->count];
    int status = check_map(together, map, err);
    if (status != 0)
        return status;
    *one = (struct together_map){.file = file, .grid = map->grid};
    together->profile = grid_is_profile(&map->grid);
    together->in_metres = length_unit_is_metre(map->xy_unit);
    status = map_grooves_find(&one->grooves, &measured, err);
    if (status == 0)
        status = one->grooves.families > 0 ? measure_rest(one, &measured, err)
                                           : measure(one, &measured, err);
    if (status != 0)
        map_spectrum_destroy(&one->spectrum);
    else
        together->count++;
    return status;
}

int map_together_fit(struct map_together *together, struct error *err) {
    struct lay lays[JOINT_PATCHES_MOST];
    int status = 0;
    for (size_t m = 0; m < together->count; m++)
        lays[m] = together->maps[m].lay;
    together->lay = joint_fit_lay(together->count, lays);
    for (size_t m = 0; m < together->count && status == 0; m++) {
        struct together_map *map = &together->maps[m];
        status =
            spectrum_fit_along(map->spectrum, &together->lay, &(struct spectrum_fit_request){0},
                               &map->ellipses, &map->fit, err);
        together->patches[m] =
            (struct joint_patch){.spectrum = together_map_rings(map), .fit = &map->fit};
    }
    if (status != 0)
        return status;
    return joint_fit_measure(together->count, together->patches, &together->fit, err);
}

void map_together_clear(struct map_together *together) {
    for (size_t m = 0; m < together->count; m++) {
        map_spectrum_destroy(&together->maps[m].ellipses);
        map_spectrum_destroy(&together->maps[m].spectrum);
    }
    *together = (struct map_together){0};
}
