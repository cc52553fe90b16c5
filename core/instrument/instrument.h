/* Height maps in files of instruments and of other programs: the table of formats, and reading.
 * Each format is one file of this folder and one row of the table below (formats.h). */
#ifndef RUGO_CORE_INSTRUMENT_INSTRUMENT_H
#define RUGO_CORE_INSTRUMENT_INSTRUMENT_H

#include "core/instrument/formats.h"

/* Ends with a row without name. */
extern const struct instrument_format *const INSTRUMENT_FORMATS[];

/* Returns whether instrument_read() has a reader for a file: false for bytes that are no text and
 * whose first ones or, without a mark, whose name are of no format of the table. */
bool instrument_takes(const char *name, const char *data, size_t size);

/* Reads a file. Its format is recognised by its first bytes, or where they have no mark by the
 * ending of its name. dx 0: the spacing in the file, or 1. *format, where not NULL: the format's
 * name, static. */
int instrument_read(struct height_map *out, const char *name, const char *data, size_t size,
                    double dx, const struct instrument_request *request, const char **format,
                    struct error *err);

#endif
