/* Steps of a preparation in files of their own, and what they share. Private to core/map. */
#ifndef RUGO_CORE_MAP_PREPARATION_INTERNAL_H
#define RUGO_CORE_MAP_PREPARATION_INTERNAL_H

#include "core/error.h"

/* Those of preparation.h. */
struct asked_length;
struct height_map;
struct preparation;
struct preparation_record;

/* Returns a length as messages have it, "2.5 \xc2\xb5m" of a map in metres. */
const char *preparation_length_text(const struct height_map *map, double length, char text[40]);
/* Sets *out to a length that was asked for, in the map's unit; ERROR_INPUT names the option. */
int preparation_length(double *out, const struct height_map *map, const struct asked_length *asked,
                       const char *option, struct error *err);

int preparation_units(struct preparation_record *record, struct height_map *map,
                      const struct preparation *asked, struct error *err);
int preparation_resample(struct preparation_record *record, struct height_map *map,
                         const struct preparation *asked, struct error *err);

#endif
