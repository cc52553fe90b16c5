#include "core/statistics/uncertainty/map_chance.h"
#include <stdlib.h>

int map_chance_create(struct map_chance **out, const struct measured_map *map, struct error *err) {
    struct map_chance *chance = array_create(1, sizeof *chance);
    if (chance == NULL)
        return error_memory(err, sizeof *chance, "the errors of a map");
    int status = correlation_create(&chance->correlation, map, err);
    if (status == 0) {
        chance->lengths = correlation_lengths_inside(chance->correlation, map->grid);
        bool enough = chance->lengths >= LENGTHS_INSIDE_LEAST;
        chance->told =
            low_modes_fill(map, enough ? chance->correlation : NULL, &chance->modes) && enough;
        chance->reason = chance->told ? "standard"
                         : chance->lengths > 0
                             ? "none: too few correlation lengths"
                             : "none: along some direction heights stay correlated all over the "
                               "map, as along grooves";
        status = cell_heights_create(&chance->heights, map, &chance->modes, err);
    }
    if (status == 0)
        *out = chance;
    else
        map_chance_destroy(&chance);
    return status;
}

void map_chance_forgo(struct map_chance *chance, const char *reason) {
    chance->told = false;
    chance->reason = reason;
}

void map_chance_destroy(struct map_chance **chance) {
    if (*chance == NULL)
        return;
    cell_heights_destroy(&(*chance)->heights);
    correlation_destroy(&(*chance)->correlation);
    free(*chance);
    *chance = NULL;
}
