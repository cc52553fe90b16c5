/* The tree in a file of Gwyddion: objects of named components, which may be objects again. Nothing
 * is copied: what is found points into the bytes of the file. Private to gwy*.c. */
#ifndef RUGO_CORE_INSTRUMENT_GWY_TREE_H
#define RUGO_CORE_INSTRUMENT_GWY_TREE_H

#include "core/error.h"
#include <stddef.h>

/* Bytes of the file that are still to be read. */
struct gwy_span {
    const char *file; /* borrowed: where the file begins, for places in messages */
    const char *at;   /* borrowed */
    size_t size;
};

struct gwy_component {
    const char *name;      /* borrowed, ends with 0 */
    char type;             /* b c i q d s o, and C I Q D S O for arrays of these */
    size_t count;          /* values of an array; 1 otherwise */
    const char *kind;      /* borrowed: the name of an object's type ("GwyDataField"); else NULL */
    struct gwy_span value; /* the bytes of the value, of an object its components; a text ends with
                              0 */
};

/* Takes the next component, any type, off *rest. ERROR_INPUT names it and its byte. */
int gwy_next(struct gwy_span *rest, struct gwy_component *out, struct error *err);
/* Takes an object off *rest: its type and its components. */
int gwy_object(struct gwy_span *rest, struct gwy_component *out, struct error *err);
/* The last component of this name and type among those of an object: out->name is NULL where there
 * is none. */
int gwy_find(struct gwy_span object, const char *name, char type, struct gwy_component *out,
             struct error *err);

#endif
