/* What a reader of files is, and the readers of this folder, a file each: rows of the table in
 * instrument.c. */
#ifndef RUGO_CORE_INSTRUMENT_FORMATS_H
#define RUGO_CORE_INSTRUMENT_FORMATS_H

#include "core/map/height_map.h"

/* What the caller wants of a file. */
struct instrument_request {
    const char *layer; /* borrowed: name of a layer (channel), or its number from 1; NULL: the first
                          that holds heights */
};

/* A reader takes the bytes of a file, data[size] being 0, and fills *out, which the caller owns
 * then: lengths in metres where the file tells their units (height_map.h), z in rows of rising y as
 * the file has them, NaN where the file has no height. ERROR_INPUT names what is at fault, its
 * value and what is allowed, and for an absent layer those that there are; ERROR_MEMORY. *out is
 * untouched on failure. Memory is bounded by a small multiple of the bytes of the file, and where
 * it is compressed by that of height_map_shape's bound and of what the file says that it holds,
 * checked while it is unpacked. */
typedef int instrument_reader(struct height_map *out, const char *data, size_t size,
                              const struct instrument_request *request, struct error *err);

struct instrument_format {
    const char *name;    /* "x3p", as messages and provenance say it */
    const char *endings; /* of names of files, with spaces between: "sdf bsdf" */
    bool (*owns)(const char *data, size_t size); /* by the first bytes; NULL: cannot be told so */
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
/* For what neither begins nor is named as a row of the table. */
extern const struct instrument_format INSTRUMENT_TEXT;

#endif
