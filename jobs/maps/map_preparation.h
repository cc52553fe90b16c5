/* From the bytes of a file to a map that is ready to be measured, with the record of how. */
#ifndef RUGO_JOBS_MAPS_MAP_PREPARATION_H
#define RUGO_JOBS_MAPS_MAP_PREPARATION_H

#include "core/instrument/formats.h"
#include "core/map/preparation/preparation.h"

/* A file of a map; borrows. */
struct map_source {
    const char *name; /* its ending gives the format where its first bytes do not */
    const char *data; /* followed by 0 */
    size_t size;
    const char *layer; /* NULL: the first with heights, of NPZ the only one */
    enum instrument_columns columns;
    const char *content; /* what is read in place of the bytes, followed by 0; NULL: these */
    size_t content_size;
    const char *content_name;         /* of a file with the content, as `name` */
    const char *unpacked, *converted; /* by what the content was made; NULL: by neither */
};

/* Reads a map from the bytes of a file, by their first ones or by the ending of its name. *record,
 * {0} at first, or NULL, gets the name, size and digest of the file, how its content was made, its
 * format, layer and columns. Errors name the file; ERROR_INPUT also for a layer of a format that
 * has one alone. */
int map_source_read(struct height_map *out, struct preparation_record *record,
                    const struct map_source *source, struct error *err);
/* Prepares the map in place, and notes the steps and the program in *record. The map is cleared
 * after a failure, whose error names the file. */
int map_prepare(struct height_map *map, struct preparation_record *record, const char *name,
                const struct preparation *asked, struct error *err);

#endif
