/* The points of an X3P file, read one after another as they are unpacked, and their map. Private to
 * x3p.c. */
#ifndef RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_POINTS_H
#define RUGO_CORE_INSTRUMENT_ARCHIVE_X3P_POINTS_H

#include "core/instrument/archive/x3p_layout.h"
#include "core/map/height_map.h"

struct x3p_points;
/* layer: of a matrix, from 0; points of other layers are skipped. Allocates 8 bytes a point of the
 * layer for each absolute axis. */
int x3p_points_create(struct x3p_points **out, const struct x3p_layout *layout, size_t layer,
                      struct error *err);
void x3p_points_destroy(struct x3p_points **points);

/* Reads whole points of the binary file; ERROR_INPUT where there are more than the layout
 * states. */
int x3p_points_take_binary(struct x3p_points *points, const char *bytes, size_t count,
                           struct error *err);
/* Reads the text of one listed point; "" is a hole. */
int x3p_points_take_text(struct x3p_points *points, const char *text, struct error *err);
/* Reads bytes of the file of valid points: a bit a point, the lowest of a byte first; where it is 0
 * the point is a hole. All points must have been read. */
int x3p_points_take_valid(struct x3p_points *points, const char *bytes, size_t count,
                          struct error *err);

/* Makes a map of the points when all were read, and moves their memory into it. ERROR_INPUT where
 * some are missing, a height is infinite, or they do not lie on a grid. */
int x3p_points_map(struct x3p_points *points, struct height_map *out, struct error *err);

#endif
