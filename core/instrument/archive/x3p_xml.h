/* The main.xml of an X3P file, read in chunks: the texts of the elements that describe the points,
 * and the points themselves where they are listed. A document type, and with it any entities of its
 * own, is refused. Depth, names, texts and tokens are bounded, so that memory does not grow with
 * what a file states. Private to x3p.c. */
#ifndef RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_XML_H
#define RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_XML_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

enum x3p_field {
    X3P_FEATURE,
    X3P_AXIS_X, /* the fields of an axis stand in this order for each of x, y and z */
    X3P_DATA_X,
    X3P_INCREMENT_X,
    X3P_OFFSET_X,
    X3P_AXIS_Y,
    X3P_DATA_Y,
    X3P_INCREMENT_Y,
    X3P_OFFSET_Y,
    X3P_AXIS_Z,
    X3P_DATA_Z,
    X3P_INCREMENT_Z,
    X3P_OFFSET_Z,
    X3P_ROTATION_33,
    X3P_SIZE_X,
    X3P_SIZE_Y,
    X3P_SIZE_Z,
    X3P_LIST,
    X3P_POINTS_LINK,
    X3P_POINTS_MD5,
    X3P_VALID_LINK,
    X3P_VALID_MD5,
    X3P_CHECKSUM_LINK,
    X3P_FIELDS
};
/* The path of a field below the root, as in messages: "Record1/Axes/CX/Increment". */
extern const char *const X3P_PATHS[X3P_FIELDS];

enum { X3P_TEXT = 256 };
struct x3p_fields {
    char text[X3P_FIELDS][X3P_TEXT]; /* without blanks around it; "" where there is none */
};

/* Takes the text of a listed point ("1e-6;0;2.5e-7", "" for a hole) without blanks around it. The
 * fields before it are filled. */
typedef int x3p_datum(void *context, const struct x3p_fields *fields, const char *text,
                      struct error *err);

struct x3p_xml;
/* fields and context are borrowed; *fields is cleared. */
int x3p_xml_create(struct x3p_xml **out, struct x3p_fields *fields, x3p_datum *take, void *context,
                   struct error *err);
/* ERROR_INPUT names the line; nothing can be fed after a failure, nor after the last chunk. */
int x3p_xml_feed(struct x3p_xml *xml, const char *bytes, size_t count, bool last,
                 struct error *err);
void x3p_xml_destroy(struct x3p_xml **xml);

#endif
