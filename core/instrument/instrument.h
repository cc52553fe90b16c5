/* Height maps in files of instruments and of other programs: which formats there are, and how a
 * file is read. Each format is one file of this folder, behind one row of the table below
 * (formats.h). */
#ifndef RUGO_CORE_INSTRUMENT_INSTRUMENT_H
#define RUGO_CORE_INSTRUMENT_INSTRUMENT_H

#include "core/instrument/formats.h"

/* Ends with a row without name. */
extern const struct instrument_format *const INSTRUMENT_FORMATS[];

/* Reads a file by its first bytes, or by the ending of its name where these do not tell; dx 0: the
 * spacing that the file tells, or 1. *format, where not NULL: its name, static. */
int instrument_read(struct height_map *out, const char *name, const char *data, size_t size,
                    double dx, const struct instrument_request *request, const char **format,
                    struct error *err);

#endif
