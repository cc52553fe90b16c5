/* What is needed to estimate the errors of one map, made once a map. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_MAP_CHANCE_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_MAP_CHANCE_H

#include "core/statistics/uncertainty/cell_heights.h"

/* Filled by map_chance_create; fields are read by all, changed by none. */
struct map_chance {
    struct correlation *correlation; /* owned */
    struct cell_heights *heights;    /* owned */
    struct low_modes modes;
    double lengths;     /* correlation_lengths_inside */
    bool told;          /* whether errors are known; if not, modes are the lattice of cells alone */
    const char *reason; /* "standard", or why not; static */
};
/* ERROR_MEMORY, and ERROR_INPUT for a map of holes alone. */
int map_chance_create(struct map_chance **out, const struct measured_map *map, struct error *err);
/* Leaves errors unknown, for a reason, which is static. */
void map_chance_forgo(struct map_chance *chance, const char *reason);
void map_chance_destroy(struct map_chance **chance);

/* Returns the waves, or NULL where errors are not known. */
static inline const struct low_modes *map_chance_modes(const struct map_chance *chance) {
    return chance->told ? &chance->modes : NULL;
}

#endif
