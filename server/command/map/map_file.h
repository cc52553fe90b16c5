/* A height map in a file that was named on the command line, and the options by which commands
 * read and prepare it. */
#ifndef RUGO_SERVER_COMMAND_MAP_MAP_FILE_H
#define RUGO_SERVER_COMMAND_MAP_MAP_FILE_H

#include "core/instrument/formats.h"
#include "core/map/height_map_file.h"
#include "core/map/preparation/preparation_words.h"
#include "server/command/map/sent_files.h"
#include "server/command/options.h"

/* Part of a command's options. */
struct map_options {
    const char *name;    /* of the file; NULL: that of its path */
    const char *layer;   /* NULL: the first with heights, of NPZ the only one */
    int columns;         /* enum instrument_columns */
    const char *convert; /* seconds that a converter may take; NULL, "0": none is asked */
    struct preparation_words words;
    const struct sent_files *sent; /* borrowed: files are those, and none of the disk; NULL: none
                                    * was sent */
};

#define MAP_CONVERT_SECONDS "60" /* unless another number is given */

/* Rows of a table of options: those of a struct map_options that is `member` of the struct `type`.
 * The boundary is a row of its own, for commands that know others. */
#define MAP_ROW(type, member, name, kind, field, argument, standard, help)                         \
    {                                                                                              \
        name, 0, kind, 0, 0, offsetof(type, member) + offsetof(struct map_options, field),         \
            argument, standard, help                                                               \
    }
#define MAP_BOUNDARY_ROW(type, member)                                                             \
    MAP_ROW(type, member, "boundary", OPTION_CHOICE, words.boundary, MAP_BOUNDARIES, "auto",       \
            "whether the map repeats; auto: where its seam is smooth, and Gwyddion did not "       \
            "convert it")
/* For commands that take the map as it is, and fit no surfaces to it. */
#define MAP_EXTEND_ROW(type, member)                                                               \
    MAP_ROW(type, member, "extend", OPTION_OPTIONAL, words.extend, "[DRAW]", MAP_EXTEND,           \
            "to a map of twice its sides that repeats, holds it and goes on by its law")
#define MAP_OPTION_ROWS(type, member) MAP_OPTION_ROWS_DETREND(type, member, "auto")
/* The same for commands that take out no trend unless it is asked for. */
#define MAP_OPTION_ROWS_DETREND(type, member, standard)                                            \
    MAP_ROW(type, member, "name", OPTION_TEXT, name, "NAME", NULL,                                 \
            "of the file, such as patch.x3p, where it comes by standard input (-)"),               \
        MAP_ROW(type, member, "layer", OPTION_TEXT, layer, "NAME|NUMBER", NULL,                    \
                "layer of the file (the first with heights, of NPZ the only one); a name that "    \
                "is none lists them"),                                                             \
        MAP_ROW(type, member, "columns", OPTION_CHOICE, columns, INSTRUMENT_COLUMNS, "auto",       \
                "what plain columns are: a trace x z, points x y z, or rows of a map"),            \
        MAP_ROW(type, member, "convert", OPTION_TEXT, convert, "SECONDS", MAP_CONVERT_SECONDS,     \
                "how long Gwyddion may take over a format that is not read here; 0: not at all"),  \
        MAP_ROW(type, member, "dx", OPTION_TEXT, words.dx, "DX[,DY]", NULL,                        \
                "distance of points, such as 0.5um (what the file says, or 1)"),                   \
        MAP_ROW(type, member, "unit", OPTION_TEXT, words.unit, "UNIT", NULL,                       \
                "of x and y, such as um, where the file tells none"),                              \
        MAP_ROW(type, member, "z-unit", OPTION_TEXT, words.z_unit, "UNIT", NULL,                   \
                "of heights, such as nm, where the file tells none"),                              \
        MAP_ROW(type, member, "missing", OPTION_TEXT, words.missing, "VALUE[,VALUE]|none", NULL,   \
                "heights that mark points without one, such as -9999, become holes; none: all "    \
                "are heights (refused where one looks like such a mark)"),                         \
        MAP_ROW(type, member, "crop", OPTION_TEXT, words.crop, "X0,Y0,WIDTH,HEIGHT", NULL,         \
                "the part to take, in points or in lengths such as 10um"),                         \
        MAP_ROW(type, member, "stride", OPTION_TEXT, words.stride, "NX[,NY]", NULL,                \
                "keep every NX-th column and every NY-th row, from the first on"),                 \
        MAP_ROW(type, member, "lines", OPTION_CHOICE, words.lines, MAP_LINES, "none",              \
                "take out of each scan line its mean, median or polynomial"),                      \
        MAP_ROW(type, member, "lines-along", OPTION_CHOICE, words.lines_along, MAP_LINES_ALONG,    \
                "x", "the axis of the scan lines"),                                                \
        MAP_ROW(type, member, "despike", OPTION_OPTIONAL, words.despike, "[N]", MAP_DESPIKE,       \
                "make holes of points N robust deviations from their neighbours"),                 \
        MAP_ROW(type, member, "deconvolve", OPTION_TEXT, words.tip, "tip=RADIUS[,holes]", NULL,    \
                "erode by a paraboloid tip; holes: where it did not reach"),                       \
        MAP_ROW(type, member, "transpose", OPTION_FLAG, words.transpose, NULL, NULL,               \
                "exchange x and y"),                                                               \
        MAP_ROW(type, member, "rotate", OPTION_TEXT, words.rotate, "DEGREES", NULL,                \
                "turn counter-clockwise: by right angles exactly, else in the rectangle inside"),  \
        MAP_ROW(type, member, "detrend", OPTION_CHOICE, words.detrend, MAP_DETRENDS, standard,     \
                "trend taken out first; auto: a plane, of an open map"),                           \
        MAP_ROW(type, member, "degroove", OPTION_FLAG, words.degroove, NULL, NULL,                 \
                "take out periodic grooves, as turning, grinding and honing leave them"),          \
        MAP_ROW(type, member, "fill", OPTION_FLAG, words.fill, NULL, NULL,                         \
                "fill holes with the smoothest membrane"),                                         \
        MAP_ROW(type, member, "denoise", OPTION_FLAG, words.denoise, NULL, NULL,                   \
                "take out noise that governs the slopes, by the law of the spectrum"),             \
        MAP_ROW(type, member, "filter", OPTION_TEXT, words.filter, "S=LENGTH,L=LENGTH,robust",     \
                NULL, "Gaussian filters: S keeps waves longer than this, L takes them out"),       \
        MAP_ROW(type, member, "resample", OPTION_TEXT, words.resample, "NX[,NY]|SPACING", NULL,    \
                "other points: so many, or so far apart, such as 0.5um or dx=0.5"),                \
        MAP_ROW(type, member, "window", OPTION_CHOICE, words.window, MAP_WINDOWS, "none",          \
                "let heights fall towards the sides, so that the map repeats")

/* Reads the file and prepares the map; *record, {0} at first, gets the name of the file and the
 * steps of the preparation, and what the instrument left. Errors name the file. A map whose units
 * give slopes no meaning is refused (height_map_check_units). */
int map_options_read(struct height_map *map, struct preparation_record *record, const char *path,
                     const struct map_options *options, struct error *err);
/* Does the same whatever the units, and looks for nothing that was left. */
int map_options_read_any(struct height_map *map, struct preparation_record *record,
                         const char *path, const struct map_options *options, struct error *err);

/* Reads a map as it is, by the first bytes of the file or by the ending of its name. Errors name
 * the file. */
int map_file_read(struct height_map *out, const char *path, struct error *err);

#endif
