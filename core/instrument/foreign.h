/* Formats that this program does not read, by their first bytes, for messages and for a converter
 * that reads them. */
#ifndef RUGO_CORE_INSTRUMENT_FOREIGN_H
#define RUGO_CORE_INSTRUMENT_FOREIGN_H

#include <stdbool.h>
#include <stddef.h>

struct foreign_format {
    const char *mark; /* the first bytes */
    size_t length;    /* of the mark */
    const char *name; /* "Alicona's AL3D", as in messages and provenance */
    bool picture;     /* holds shades or colours and no heights */
};

/* Returns the format that the first bytes name; NULL for others. */
const struct foreign_format *foreign_format_of(const char *data, size_t size);

#endif
