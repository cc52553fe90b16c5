/* From the bytes of a file to a map that is ready to be measured, with the record of how. */
#ifndef RUGO_JOBS_MAPS_MAP_PREPARATION_H
#define RUGO_JOBS_MAPS_MAP_PREPARATION_H

#include "core/map/preparation.h"

/* Reads a map from the bytes of a file of that name, by its first bytes or by the ending of the
 * name. layer: which one; NULL: the first with heights. *record, {0} at first, or NULL, gets the
 * name, size, digest, format and layer. Errors name the file; ERROR_INPUT also for a layer of a
 * format that has one alone. */
int map_layer_read(struct height_map *out, struct preparation_record *record, const char *name,
                   const char *data, size_t size, const char *layer, struct error *err);
/* Prepares the map in place, and notes the steps and the program in *record. The map is cleared
 * after a failure, whose error names the file. */
int map_prepare(struct height_map *map, struct preparation_record *record, const char *name,
                const struct preparation *asked, struct error *err);

#endif
