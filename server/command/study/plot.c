/* `rugo plot`: one picture of a study's results, or of a map in a file, as SVG or PNG. */
#include "server/command/access/access_source.h"
#include "server/command/map/map_file.h"
#include "server/command/output_file.h"
#include "server/show/map/map_png.h"
#include "server/show/plot/picture.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    struct access_options place;
    int64_t case_number; /* -1: all */
    int64_t difference[2];
    const char *quantity, *x, *colour, *dash, *panel, *model, *series, *level, *width, *out;
    const char **where;
    int axes, total; /* total: the second word is no */
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"quantity", 0, OPTION_TEXT, 0, 0, AT(quantity), "Q", NULL,
     "of curves, such as contact_area; a scalar, such as summit_density; or a value of curves, "
     "such "
     "as contact_area@0.1 or contact_area:layered:nodes@0.1"},
    {"where", 0, OPTION_LIST, 0, 0, AT(where), "NAME=VALUE", NULL,
     "only cases with this value, e.g. hurst=0.8; several with commas between, or given again: any "
     "of one name, all of different names"},
    {"x", 0, OPTION_TEXT, 0, 0, AT(x), "PARAMETER", NULL,
     "of a scalar or a value of curves: over this parameter (the number that the study sweeps "
     "most)"},
    {"colour", 0, OPTION_TEXT, 0, 0, AT(colour), "NAME", NULL,
     "a colour for each value of a parameter, of model, series, level or pressure (the number of "
     "most values)"},
    {"dash", 0, OPTION_TEXT, 0, 0, AT(dash), "NAME", NULL,
     "dashes for each value, of up to 6 (words of few values)"},
    {"panel", 0, OPTION_TEXT, 0, 0, AT(panel), "NAME", NULL,
     "a panel for each value (whatever else differs)"},
    {"model", 0, OPTION_TEXT, 0, 0, AT(model), "MODEL", NULL, "of curves: of this model alone"},
    {"series", 0, OPTION_TEXT, 0, 0, AT(series), "SERIES", NULL,
     "of curves: of this series alone, such as nodes"},
    {"level", 0, OPTION_TEXT, 0, 0, AT(level), "N", NULL, "of curves: of this level alone"},
    {"log", 0, OPTION_CHOICE, 0, 0, AT(axes), AXES_WORDS, "auto",
     "which axes are logarithmic; auto: as suits the quantity and the steps of x; one-plus: y as "
     "log10(1 + y); of a difference x alone"},
    {"total", 0, OPTION_CHOICE, 0, 0, AT(total), "yes|no", "yes",
     "total errors, to 95 %, around the standard errors"},
    {"width", 0, OPTION_TEXT, 0, 0, AT(width), "MM", NULL,
     "for print: so many millimetres wide, or one (85) or two (178) columns; without the title"},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(out), "FILE", NULL,
     "in place of standard output: .svg, or by rsvg-convert .png, .pdf or .eps"},
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", NULL,
     "of curves: this case only, without --where"},
    {"difference", 0, OPTION_PAIR, 0, 0, AT(difference), "A B", NULL,
     "of curves: case A less case B"},
    {0}};

static int draw(struct access *access, const char *id, const struct options *options, FILE *file,
                struct error *err) {
    const struct access_origin origin = {access, id};
    const struct picture_source source = access_source(&origin);
    const struct comparison comparison = {.minuend = (uint64_t)options->difference[0],
                                          .subtrahend = (uint64_t)options->difference[1],
                                          .quantity = options->quantity};
    const struct picture_request request = {
        .quantity = options->quantity,
        .x = options->x,
        .where = options->where != NULL && options->where[0] != NULL ? options->where : NULL,
        .colour = options->colour,
        .dash = options->dash,
        .panel = options->panel,
        .model = options->model,
        .series = options->series,
        .level = options->level,
        .width = options->width,
        .axes = options->axes,
        .without_total = options->total != 0,
        .case_number = options->case_number,
        .difference = options->difference[0] >= 0 ? &comparison : NULL};
    return picture_draw(&source, &request, file, err);
}

/* What a file is drawn of. */
struct drawing {
    struct access *access;
    const char *id;
    const struct options *options;
};

static int draw_drawing(const void *context, FILE *file, struct error *err) {
    const struct drawing *of = context;
    return draw(of->access, of->id, of->options, file, err);
}

static int show(struct access *access, const char *id, const struct options *options,
                struct error *err) {
    struct drawing drawing = {access, id, options};
    if (options->out != NULL)
        return output_file_draw(options->out, draw_drawing, &drawing, err);
    int status = draw(access, id, options, stdout, err);
    return status == 0 ? output_flush(err) : status;
}

/* --- a map in a file --- */

/* Returns whether a map may be of pressures: many of its values are exactly 0, and none is below.
 */
static bool map_is_clipped(const struct height_map *map) {
    static const size_t PART = 50; /* a fiftieth of the points */
    size_t points = grid_points(&map->grid), zeros = 0;
    for (size_t n = 0; n < points; n++) {
        if (map->z[n] < 0)
            return false;
        zeros += map->z[n] == 0;
    }
    return zeros > 1 && zeros > points / PART; /* heights may begin at one zero */
}

static int draw_map(const char *path, const struct options *options, struct error *err) {
    const char *slash = strrchr(path, '/');
    struct height_map map = {0};
    int status = map_file_read(&map, path, err);
    if (status != 0)
        return status;
    char subject[64];
    snprintf(subject, sizeof subject, "%zu x %zu points", map.grid.nx, map.grid.ny);
    bool clipped = map_is_clipped(&map);
    if (clipped)
        map_blank_open(&map.grid, map.z);
    const struct map_picture picture = {.name = slash != NULL ? slash + 1 : path,
                                        .subject = subject,
                                        .x_label = "x",
                                        .y_label = "y",
                                        .z_label = "z",
                                        .xy_unit = map.xy_unit,
                                        .z_unit = map.z_unit,
                                        .note = clipped ? "blank: 0" : NULL,
                                        .grid = &map.grid,
                                        .z = map.z,
                                        .boundary = BOUNDARY_OPEN,
                                        .unmarked = true};
    if (options->out != NULL)
        status = output_file_picture(options->out, &picture, err);
    else if ((status = plot_map(&picture, stdout, err)) == 0)
        status = output_flush(err);
    height_map_clear(&map);
    return status;
}

/* Returns whether an option of the table was given, which has none of other types; of a choice,
 * whether it is not the first. */
static bool is_given(const struct option_row *row, const struct options *options) {
    const void *value = (const char *)options + row->at;
    if (row->type == OPTION_FLAG)
        return *(const bool *)value;
    if (row->type == OPTION_CHOICE)
        return *(const int *)value != 0;
    if (row->type == OPTION_INDEX || row->type == OPTION_PAIR)
        return *(const int64_t *)value >= 0;
    if (row->type == OPTION_LIST)
        return **(const char *const *const *)value != NULL;
    return *(const char *const *)value != NULL;
}

/* A map has one look, and is in a file: returns 0, or EXIT_USAGE after a word on standard error. */
static int check_map(const char *path, const struct options *options) {
    if (height_map_format_of(path) == HEIGHT_MAP_FORMATS)
        return usage_error("plot", "--quantity is missing: the name of curves or of a scalar; a "
                                   "map is drawn from a file in .npy, .csv or .xyz");
    for (const struct option_row *row = OPTIONS; row->name != NULL; row++)
        if (row->at != AT(out) && is_given(row, options))
            return usage_error("plot",
                               "--%s belongs to the --quantity of a study, which is missing; a map "
                               "in a file takes --out alone",
                               row->name);
    return 0;
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    if (access_options_check("plot", &options->place) != 0)
        return EXIT_USAGE;
    if (options->quantity == NULL) {
        if (check_map(arguments[0], options) != 0)
            return EXIT_USAGE;
        return draw_map(arguments[0], options, &err) != 0 ? command_fail("plot", &err) : EXIT_DONE;
    }
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, "plot", arguments[0], id, &err);
    if (status == 0)
        status = show(access, id, options, &err);
    access_close(&access);
    return status != 0 ? command_fail("plot", &err) : EXIT_DONE;
}

const struct command COMMAND_PLOT = {
    .name = "plot",
    .arguments = "ID|MAP.npy",
    .summary =
        "a picture (SVG, PNG) of curves, of a scalar or values over what was swept, or of a map",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
