/* X3P files to the letter of the standard, made in memory, part by part as a test wants them; a
 * failure fails the test. */
#ifndef RUGO_TESTS_SUPPORT_X3P_FILE_H
#define RUGO_TESTS_SUPPORT_X3P_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* What stands in main.xml; NULL: what X3P_USUAL has. */
struct x3p_sheet {
    const char *head;      /* before the root */
    const char *root;      /* its name */
    const char *feature;   /* "SUR" */
    const char *x, *y, *z; /* what stands in CX, CY, CZ */
    const char *rotation;  /* behind them */
    const char *dimension; /* first in Record3 */
    const char *data;      /* behind it; NULL: a link to bindata/data.bin with its sum */
    const char *tail;      /* behind Record4's link */
    const char *sum;       /* text of md5checksum.hex; NULL: the right one */
    const void *points;    /* the binary file, which the caller has; NULL: none */
    size_t size;
    const unsigned char *valid; /* bytes of valid.bin, with its sum; NULL: none */
    size_t valid_size;
    const char *folder; /* before each name */
    bool stored;        /* else deflated */
};
/* A surface of 3 x 2 points, 2 and 3 micrometres apart, of doubles. */
extern const struct x3p_sheet X3P_USUAL;
enum { X3P_SHEET_MOST = 1 << 16 };

#define X3P_INCREMENTAL(step)                                                                      \
    "<AxisType>I</AxisType><Increment>" step "</Increment><Offset>0</Offset>"
#define X3P_ABSOLUTE(type, step, offset)                                                           \
    "<AxisType>A</AxisType><DataType>" type "</DataType><Increment>" step "</Increment>"           \
    "<Offset>" offset "</Offset>"
#define X3P_MATRIX(nx, ny, nz)                                                                     \
    "<MatrixDimension><SizeX>" nx "</SizeX><SizeY>" ny "</SizeY><SizeZ>" nz                        \
    "</SizeZ></MatrixDimension>"

/* The text of main.xml, below X3P_SHEET_MOST bytes. */
size_t x3p_sheet_print(char *out, const struct x3p_sheet *sheet);
/* Packs all; NUL behind it. The caller frees. */
char *x3p_file_create(const struct x3p_sheet *sheet, size_t *size);
/* 32 hexadecimal digits and NUL. */
void x3p_file_md5(char out[33], const void *data, size_t size);

#endif
