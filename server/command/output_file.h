/* Files that commands write beside standard output. */
#ifndef RUGO_SERVER_COMMAND_OUTPUT_FILE_H
#define RUGO_SERVER_COMMAND_OUTPUT_FILE_H

#include "server/show/plot/plot_map.h"
#include <stdio.h>

/* ERROR_SYSTEM where the file could not be written as things are: asked before a long computation,
 * it makes nothing. */
int output_file_check(const char *path, struct error *err);
/* Whether a file of this name is to hold a PNG. */
bool output_file_is_png(const char *path);
/* Writes a picture into a file of its own: a pixel a point where its name ends in .png, else as
 * output_file_draw. */
int output_file_picture(const char *path, const struct map_picture *picture, struct error *err);
/* Returns ERROR_INPUT for a name that ends in none of these, which end with NULL: the message calls
 * the file `what`. */
int output_file_check_ending(const char *path, const char *what, const char *const *endings,
                             struct error *err);
/* Likewise for one that ends in none of .svg, .png, .pdf and .eps. */
int output_file_check_drawn(const char *path, struct error *err);
/* Prints what is to be drawn, an SVG. context: as given to output_file_draw. */
typedef int output_drawing(const void *context, FILE *file, struct error *err);
/* Draws in memory first, then writes a file of its own in the format that its name ends in: but for
 * .svg by rsvg-convert. An earlier file stays where the drawing fails or there is no rsvg-convert;
 * none is left where what was drawn cannot be written. */
int output_file_draw(const char *path, output_drawing *draw, const void *context,
                     struct error *err);

#endif
