/* Height maps in files: NumPy's npy, CSV, and x y z lines.
 *
 * npy: versions 1 to 3, f2, f4, f8, and i and u of 1 to 8 bytes, in either order of bytes and of
 * points, shape (ny, nx) or (n,). csv: one grid row a line,
 * separated by commas, semicolons, tabs or spaces; lines that start with # and empty lines are
 * skipped; one column is a profile. xyz: three numbers a line, x fastest, a regular grid. A height
 * that was not measured is NaN, in text "nan". */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_FILE_H
#define RUGO_CORE_MAP_HEIGHT_MAP_FILE_H

#include "core/map/height_map.h"
#include <stdio.h>

enum height_map_format { HEIGHT_MAP_NPY, HEIGHT_MAP_CSV, HEIGHT_MAP_XYZ, HEIGHT_MAP_FORMATS };
extern const char *const HEIGHT_MAP_NAMES[HEIGHT_MAP_FORMATS]; /* "npy", "csv", "xyz" */

/* Returns the format of a name's ending, or HEIGHT_MAP_FORMATS for any other ending. */
enum height_map_format height_map_format_of(const char *name);

/* Reads a map from the bytes of a file; text[size] must be 0. dx: spacing of points in x and y,
 * where the file has none (0: 1). ERROR_INPUT names the line or field at fault; an infinite height
 * is a fault, NaN is none. *out is untouched on failure. */
int height_map_parse(struct height_map *out, enum height_map_format format, const char *text,
                     size_t size, double dx, struct error *err);

/* Writes heights so that reading returns the same bits. ERROR_SYSTEM when a write fails. */
int height_map_write(FILE *file, enum height_map_format format, const struct grid *grid,
                     const double *z, struct error *err);

/* The same into the file of a path, which is whole or not there (core/file/written_file.h); errors
 * begin with the path or name it. */
int height_map_save(const char *path, enum height_map_format format, const struct grid *grid,
                    const double *z, struct error *err);
/* The same of values whose first point is at origin, x and y, which xyz alone says. */
int height_map_save_from(const char *path, enum height_map_format format, const struct grid *grid,
                         const double origin[2], const double *z, struct error *err);

#endif
