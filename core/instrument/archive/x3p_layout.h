/* The layout of the points of an X3P file by its fields: their number, the numbers stored for each,
 * and their conversion to lengths. Private to x3p.c. */
#ifndef RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_LAYOUT_H
#define RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_LAYOUT_H

#include "core/instrument/archive/x3p_xml.h"

enum { X3P_X, X3P_Y, X3P_Z, X3P_AXES };

struct x3p_axis {
    bool absolute; /* a number is stored for each point; else position is index * increment */
    char type;     /* of an absolute axis: I int16, L int32, F float32, D float64 */
    size_t bytes;  /* of a number in the binary file; 0 where none is stored */
    double increment, offset; /* metres; a length is offset + number * increment */
};

struct x3p_layout {
    struct x3p_axis axes[X3P_AXES];
    bool list;             /* points in no order, all axes absolute; else a matrix */
    size_t nx, ny, layers; /* of a matrix: x runs fastest, layers slowest; of a list: n, 1, 1 */
    size_t n;              /* points in all */
    size_t absolute;       /* number of absolute axes, and so of numbers a point */
    size_t record;         /* bytes of a point in the binary file, x first; at most 24 */
};

/* Checks the fields before the points. ERROR_INPUT names the element. most: points that the file
 * has room for, whatever it states. */
int x3p_layout_read(struct x3p_layout *out, const struct x3p_fields *fields, size_t most,
                    struct error *err);

#endif
