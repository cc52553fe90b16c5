/* What remedies for an instrument's artefacts leave open of a map. */
#ifndef RUGO_JOBS_MAPS_MAP_REMEDIES_H
#define RUGO_JOBS_MAPS_MAP_REMEDIES_H

#include "core/map/preparation/preparation.h"
#include "core/statistics/heights/areal.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "jobs/maps/map_functional.h"
#include "jobs/maps/map_parameters.h"
#include "jobs/maps/map_scales.h"
#include "jobs/maps/map_spectra.h"

/* The errors of a map's characterisation, and the values that they are of. All borrowed. */
struct map_remedied {
    const struct areal *areal;
    struct scalar_errors *errors, *moment_errors;
    struct map_functional *functional;
    struct map_directions *directions;
    struct map_parameters *parameters;
    struct map_scales *scales;
    struct map_spectra *spectra;
};
/* Adds to them what levelled scan lines took of the surface itself, and what noise that was taken
 * out hides of short waves; nothing where neither was done. ERROR_MEMORY. */
int map_remedies_add(const struct map_remedied *found, const struct measured_map *map,
                     const struct preparation_record *record, struct error *err);

#endif
