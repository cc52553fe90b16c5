/* The interface of a reader of files, and the readers of this folder, one a file: rows of the table
 * in instrument.c. */
#ifndef RUGO_CORE_INSTRUMENT_FORMATS_H
#define RUGO_CORE_INSTRUMENT_FORMATS_H

#include "core/map/height_map.h"

/* What plain columns of a text are; in the order of INSTRUMENT_COLUMNS. */
enum instrument_columns { COLUMNS_AUTO, COLUMNS_XZ, COLUMNS_XYZ, COLUMNS_MAP };
#define INSTRUMENT_COLUMNS "auto|xz|xyz|map"
enum { INSTRUMENT_DONE = 160, INSTRUMENT_LAYER = 120 };

/* The caller's request. */
struct instrument_request {
    const char *layer; /* borrowed: name of a layer (channel), or its number from 1; NULL: the first
                          that holds heights, of an NPZ archive the only one */
    enum instrument_columns columns;
    char *done; /* borrowed, NULL or INSTRUMENT_DONE bytes: gets what was made of plain columns, ""
                   where they are a map */
    char *layer_read; /* borrowed, NULL or INSTRUMENT_LAYER bytes: gets which of several layers was
                         read, "1 'Amplitude' of 2"; "" where the file has one */
};

/* A reader takes the bytes of a file, data[size] being 0, and fills *out, which the caller then
 * owns. Lengths are in metres where the file has their units (height_map.h). z is in rows of rising
 * y: as in the file, or reversed where its format has y fall. NaN: the file has no height.
 * ERROR_INPUT names the fault, its value and what is allowed, and for an absent layer those
 * present; ERROR_MEMORY. *out is untouched on failure. Memory is bounded by a small multiple of the
 * bytes of the file. For a compressed file the bounds are that of height_map_shape and the size
 * that the file states, which is checked while it is unpacked. */
typedef int instrument_reader(struct height_map *out, const char *data, size_t size,
                              const struct instrument_request *request, struct error *err);

struct instrument_format {
    const char *name;    /* "x3p", as in messages and provenance */
    const char *endings; /* endings of file names, separated by spaces: "sdf bsdf" */
    bool (*owns)(const char *data,
                 size_t size); /* recognises the first bytes; NULL: they have no mark */
    instrument_reader *read;
};

extern const struct instrument_format INSTRUMENT_GWY;
extern const struct instrument_format INSTRUMENT_NPZ;
extern const struct instrument_format INSTRUMENT_SDF;
extern const struct instrument_format INSTRUMENT_X3P;
extern const struct instrument_format INSTRUMENT_ZYGO;
extern const struct instrument_format INSTRUMENT_SURFER;
extern const struct instrument_format INSTRUMENT_ESRI;
extern const struct instrument_format INSTRUMENT_POINTS;
/* For files that no row of the table recognises by first bytes or name. */
extern const struct instrument_format INSTRUMENT_TEXT;

#endif
