/* What remedies for an instrument's artefacts leave open of a map. */
#ifndef RUGO_JOBS_MAPS_MAP_REMEDIES_H
#define RUGO_JOBS_MAPS_MAP_REMEDIES_H

#include "jobs/maps/map_characterisation.h"

/* Adds to the errors of a map what levelled scan lines took of the surface itself, and what noise
 * that was taken out hides of short waves; nothing where neither was done. ERROR_MEMORY. */
int map_remedies_add(struct map_characterisation *found, const struct measured_map *map,
                     const struct preparation_record *record, struct error *err);

#endif
