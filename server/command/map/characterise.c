/* rugo characterise FILE: what a height map in a file is like. */
#include "core/map/length_unit.h"
#include "jobs/maps/map_planes.h"
#include "server/command/command.h"
#include "server/command/input_file.h"
#include "server/command/map/like_study.h"
#include "server/command/map/map_file.h"
#include "server/command/map/map_output.h"
#include "server/command/map/together.h"
#include "server/command/output_file.h"
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/map_report.h"
#include "server/show/map/map_summary.h"
#include "server/show/quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct characterise_options {
    struct map_options map;
    const char *trust_from, *trust_to; /* NULL: by the map */
    int format;
    bool all, together, hold;
    const char *sent;             /* sizes of files on standard input; NULL: they are on the disk */
    const char *group;            /* NULL: none is asked for */
    const char *picture, *report; /* NULL: none, as the next */
    const char *acf, *psd;
};
#define AT(member) offsetof(struct characterise_options, member)
static const struct option_row OPTIONS[] = {
    MAP_OPTION_ROWS(struct characterise_options, map),
    MAP_EXTEND_ROW(struct characterise_options, map),
    MAP_BOUNDARY_ROW(struct characterise_options, map),
    {"trust-from", 0, OPTION_TEXT, 0, 0, AT(trust_from), "LENGTH", NULL,
     "the longest waves whose spectrum is fitted, such as 50um (by the map); not with --format "
     "study"},
    {"trust-to", 0, OPTION_TEXT, 0, 0, AT(trust_to), "LENGTH", NULL,
     "the shortest ones (by the map: where noise, or what the instrument takes, begins)"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(format), "text|json|svg|study", "text",
     "what to print; svg: the page of --report; study: one of surfaces like the map, stratified "
     "ones where it is"},
    {"hold", 0, OPTION_FLAG, 0, 0, AT(hold), NULL, NULL,
     "--format study: its surfaces hold the map itself and go on as its law says"},
    {"all", 0, OPTION_FLAG, 0, 0, AT(all), NULL, NULL,
     "print all values and tables in place of one screen"},
    {"together", 0, OPTION_FLAG, 0, 0, AT(together), NULL, NULL,
     "several files are of one surface: fit one law to them; --report draws their spectra"},
    {"sent", 0, OPTION_TEXT, 0, 0, AT(sent), "SIZE[,SIZE]", NULL,
     "the files, of so many bytes, come one behind the other on standard input, and for --format "
     "study perhaps a study that names them"},
    {"group", 0, OPTION_TEXT, 0, 0, AT(group), "NAME[,NAME]", NULL,
     "print these groups of values and tables, as text or JSON"},
    {"picture", 0, OPTION_TEXT, 0, 0, AT(picture), "FILE.svg|FILE.png", NULL,
     "draw the map as it was measured, without its trend, with its summits marked"},
    {"report", 0, OPTION_TEXT, 0, 0, AT(report), "FILE.svg|FILE.png", NULL,
     "draw a page for print: map, heights, spectrum, scales, main parameters, where they come "
     "from"},
    {"acf", 0, OPTION_TEXT, 0, 0, AT(acf), "FILE", NULL,
     "write the autocorrelation R(tx, ty), in heights squared, with the lag 0 in the middle, as "
     "npy, csv, xyz, png or svg"},
    {"psd", 0, OPTION_TEXT, 0, 0, AT(psd), "FILE", NULL,
     "the spectral density C(kx, ky), likewise, with the wave vector 0 in the middle; its integral "
     "is the mean square height, of an open map under its window"},
    {0}};

enum { FORMAT_TEXT, FORMAT_JSON, FORMAT_SVG, FORMAT_STUDY };

static int print_study(const struct map_figure *figure, bool hold, struct error *err) {
    cJSON *study = NULL;
    const struct plateau_law *strata =
        !hold && map_is_stratified(figure->measured) ? &figure->measured->functional.plateau : NULL;
    int status = like_study_make(&study, 1, figure->map, figure->record, strata, hold, err);
    if (status == 0)
        status = output_document(study, err);
    cJSON_Delete(study);
    return status;
}

static int print(const struct characterise_options *options, const struct map_figure *figure,
                 struct error *err) {
    const int format = options->format;
    int status = 0;
    if (format == FORMAT_TEXT && !options->all && options->group == NULL)
        map_summary_print(stdout, figure);
    else if (format == FORMAT_TEXT)
        named_values_print(stdout, figure->found);
    else if (format == FORMAT_SVG)
        status = map_figure_draw(figure, stdout, err);
    else if (format == FORMAT_STUDY)
        status = print_study(figure, options->hold, err);
    else if (named_values_print_json(stdout, figure->found))
        putchar('\n');
    else
        status = error_memory(err, sizeof *figure->found, "the characterisation");
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout) != 0))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    return status;
}

/* Leaves what --group names. */
static int keep_groups(struct named_values *found, const char *groups, struct error *err) {
    const char *unknown;
    size_t length;
    char known[400];
    if (groups == NULL || named_values_keep(found, groups, &unknown, &length))
        return 0;
    named_values_groups(found, known, sizeof known);
    return error_set(err, ERROR_INPUT, "--group %.60s: there is no group '%.*s'; the map has %s",
                     groups, length < 40 ? (int)length : 40, unknown, known);
}

static int check_group(const struct characterise_options *options, struct error *err) {
    if (options->group == NULL || (options->format <= FORMAT_JSON && !options->all))
        return 0;
    return error_set(err, ERROR_INPUT, "--group goes with --format text or json, and not --all");
}

static int draw(const char *path, const char *name, const struct height_map *map,
                enum boundary boundary, struct error *err) {
    const struct map_picture picture = {.name = name,
                                        .subject = boundary == BOUNDARY_OPEN ? "open" : "periodic",
                                        .x_label = "x",
                                        .y_label = "y",
                                        .z_label = "height z",
                                        .xy_unit = map->xy_unit,
                                        .z_unit = map->z_unit,
                                        .grid = &map->grid,
                                        .z = map->z,
                                        .boundary = boundary};
    return output_file_picture(path, &picture, err);
}

/* A picture or a page under a name of another kind would not be what it seems. */
static int check_drawn(const struct characterise_options *options, struct error *err) {
    int status = options->picture != NULL ? output_file_check_drawn(options->picture, err) : 0;
    if (status != 0 || options->report == NULL)
        return status;
    status = output_file_check_drawn(options->report, err);
    return status != 0 ? error_context(err, "--report; --format svg prints the page") : 0;
}

static int draw_page(const void *figure, FILE *file, struct error *err) {
    return map_figure_draw(figure, file, err);
}

/* --- the autocorrelation and the spectrum over the plane --- */

/* A file of a plane. */
struct plane_file {
    const char *path; /* NULL: none */
    int (*make)(struct map_plane *out, const struct measured_map *map, struct error *err);
    struct map_picture labels;
    bool spectral; /* over wave vectors, with logarithms in pictures; else over lags */
};
enum { PLANE_FILES = 2 };

static void plane_files(const struct characterise_options *options,
                        struct plane_file out[PLANE_FILES]) {
    out[0] = (struct plane_file){options->acf,
                                 map_acf_plane,
                                 {.name = "autocorrelation",
                                  .subject = "",
                                  .x_label = "tx",
                                  .y_label = "ty",
                                  .z_label = "R"},
                                 false};
    out[1] = (struct plane_file){options->psd,
                                 map_psd_plane,
                                 {.name = "spectral density",
                                  .subject = "",
                                  .x_label = "kx",
                                  .y_label = "ky",
                                  .z_label = "log10 C"},
                                 true};
}

static int check_planes(const struct characterise_options *options, struct error *err) {
    struct plane_file files[PLANE_FILES];
    int status = 0;
    plane_files(options, files);
    for (size_t f = 0; f < PLANE_FILES && status == 0; f++)
        if (files[f].path != NULL)
            status = map_output_check(files[f].path, err);
    return status;
}

static double largest_of(const struct map_plane *plane) {
    double most = 0;
    for (size_t a = 0; a < grid_points(&plane->grid); a++)
        most = fmax(most, plane->values[a]);
    return most;
}

/* Takes logarithms of values over the scale. Those many decades below the highest are of no
 * interest in a picture. */
static void take_logarithms(struct map_plane *plane, double scale) {
    static const double SEEN = 1e-8;
    const double most = largest_of(plane);
    for (size_t a = 0; a < grid_points(&plane->grid) && most > 0; a++)
        plane->values[a] = log10(fmax(plane->values[a], SEEN * most) / scale);
}

enum { PLANE_UNIT = 48 };

/* Writes the unit of the lags or wave vectors of a map, "" where its lengths have none. */
static void plane_unit(const struct height_map *map, bool spectral, char out[PLANE_UNIT]) {
    const char *unit = map->xy_unit;
    snprintf(out, PLANE_UNIT, "%s%s", spectral && *unit != '\0' ? "rad/" : "", unit);
}

/* Writes the unit of heights squared, of a density times an area or, of a profile, a length. */
static void value_unit(const struct height_map *map, bool spectral, char out[PLANE_UNIT]) {
    const char *z = map->z_unit, *xy = map->xy_unit;
    const int power = grid_is_profile(&map->grid) ? 1 : 2;
    out[0] = '\0';
    if (*z == '\0' || (spectral && *xy == '\0'))
        return;
    if (!spectral)
        snprintf(out, PLANE_UNIT, "%s^2", z);
    else if (strcmp(z, xy) == 0)
        snprintf(out, PLANE_UNIT, "%s^%d", z, 2 + power);
    else
        snprintf(out, PLANE_UNIT, "%s^2 %s%s", z, xy, power == 2 ? "^2" : "");
}

/* Prepares values and labels for a picture. A picture of pixels has no units. */
static void plane_show(const struct plane_file *file, const struct height_map *map,
                       struct map_plane *plane, char units[2][PLANE_UNIT],
                       struct map_picture *labels) {
    double scale = 1;
    plane_unit(map, file->spectral, units[0]);
    value_unit(map, file->spectral, units[1]);
    labels->xy_unit = units[0];
    labels->z_unit = units[1];
    if (!file->spectral)
        return;
    const bool metres = length_unit_is_metre(map->z_unit) && length_unit_is_metre(map->xy_unit);
    if (metres && !output_file_is_png(file->path)) {
        char unit[PLANE_UNIT];
        snprintf(unit, sizeof unit, "%s", units[1]);
        scale = unit_readable(unit, largest_of(plane), units[1], PLANE_UNIT);
    }
    take_logarithms(plane, scale);
}

/* Makes a plane, and writes its file. */
static int write_plane(const struct plane_file *file, const struct height_map *map,
                       const struct measured_map *measured, struct error *err) {
    struct map_plane plane = {0};
    struct map_picture labels = file->labels;
    char units[2][PLANE_UNIT];
    int status = file->make(&plane, measured, err);
    const size_t half_x = plane.grid.nx / 2, half_y = plane.grid.ny / 2; /* 0 is in the middle */
    if (status == 0) {
        labels.x0 = -(double)half_x * grid_dx(&plane.grid);
        labels.y0 = -(double)half_y * grid_dy(&plane.grid);
    }
    if (status == 0 && map_output_is_picture(file->path))
        plane_show(file, map, &plane, units, &labels);
    if (status == 0)
        status = map_output_write(file->path, &labels, &plane.grid, plane.values, err);
    map_plane_clear(&plane);
    return status;
}

static int write_planes(const struct characterise_options *options, const struct height_map *map,
                        enum boundary boundary, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, boundary};
    struct plane_file files[PLANE_FILES];
    int status = 0;
    plane_files(options, files);
    for (size_t f = 0; f < PLANE_FILES && status == 0; f++)
        if (files[f].path != NULL)
            status = write_plane(&files[f], map, &measured, err);
    return status;
}

/* Reads a wavelength in the unit of the map, or with one; *out stays where text is NULL. */
static int wavelength_read(double *out, const char *option, const char *text,
                           const struct height_map *map, struct error *err) {
    struct asked_length length = {0};
    if (text == NULL)
        return 0;
    if (!asked_length_parse(&length, text, strlen(text)) || !(length.value > 0))
        return error_set(err, ERROR_INPUT,
                         "--%s is \"%.40s\"; allowed: a length above 0, such as 50um", option,
                         text);
    if (length.has_unit && !length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "--%s is \"%.40s\", but the map has no unit of length (--unit says it)",
                         option, text);
    *out = length.value;
    return 0;
}

/* One screen shows the main values alone. */
static enum map_extent extent_of(const struct characterise_options *options) {
    const bool screen = options->format == FORMAT_TEXT && !options->all && options->group == NULL &&
                        options->report == NULL;
    return screen ? MAP_MAIN : MAP_WHOLE;
}

static int characterise(struct map_characterisation *measured, struct named_values *found,
                        const struct height_map *map, const struct preparation_record *record,
                        const struct characterise_options *options, struct error *err) {
    struct spectrum_fit_request trusted = {0};
    int status = wavelength_read(&trusted.longest, "trust-from", options->trust_from, map, err);
    if (status == 0)
        status = wavelength_read(&trusted.shortest, "trust-to", options->trust_to, map, err);
    if (status == 0)
        status = map_characterise(measured, map, record, &trusted, extent_of(options), err);
    return status == 0 ? map_report_fill(found, measured, map, record, err) : status;
}

/* --- several maps --- */

static int check_together(const struct characterise_options *options, struct error *err) {
    if (options->trust_from != NULL || options->trust_to != NULL || options->picture != NULL ||
        options->acf != NULL || options->psd != NULL)
        return error_set(err, ERROR_INPUT,
                         "--together goes with --report, and not with --trust-from, --trust-to, "
                         "--picture, --acf and --psd");
    return 0;
}

static int print_together(const struct characterise_options *options, struct named_values *found,
                          struct error *err) {
    static const char ONE_SCREEN[] = "files,together,maps";
    const bool text = options->format == FORMAT_TEXT;
    const char *groups =
        options->group == NULL && text && !options->all ? ONE_SCREEN : options->group;
    int status = keep_groups(found, groups, err);
    if (status == 0 && text)
        named_values_print(stdout, found);
    else if (status == 0 && named_values_print_json(stdout, found))
        putchar('\n');
    else if (status == 0)
        status = error_memory(err, sizeof *found, "the characterisation");
    return status;
}

static int study_together(const struct characterise_options *options, const char *const *files,
                          struct error *err) {
    cJSON *study = NULL;
    int status = options->report == NULL
                     ? together_study(files, &options->map, options->hold, &study, err)
                     : error_set(err, ERROR_INPUT, "--report does not go with --format study");
    if (status == 0)
        status = output_document(study, err);
    cJSON_Delete(study);
    return status;
}

static int characterise_together(const struct characterise_options *options,
                                 const char *const *files, struct error *err) {
    struct named_values found = {0};
    int status = check_drawn(options, err);
    if (status == 0)
        status = check_group(options, err);
    if (status == 0)
        status = check_together(options, err);
    if (status == 0 && options->format == FORMAT_STUDY)
        return study_together(options, files, err);
    if (status == 0)
        status = together_run(files, &options->map, options->report, options->format == FORMAT_SVG,
                              &found, err);
    if (status == 0 && options->format != FORMAT_SVG)
        status = print_together(options, &found, err);
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout) != 0))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    named_values_clear(&found);
    return status;
}

static int characterise_one(const struct characterise_options *options, const char *const *files,
                            struct error *err) {
    struct height_map map = {0};
    struct map_characterisation measured = {0};
    struct named_values found = {0};
    struct preparation_record record = {0};
    int status = files[1] == NULL
                     ? check_drawn(options, err)
                     : error_set(err, ERROR_INPUT,
                                 "several files; --together fits them as maps of one surface");
    if (status == 0)
        status = check_group(options, err);
    if (status == 0)
        status = check_planes(options, err);
    if (status == 0)
        status = map_options_read(&map, &record, files[0], &options->map, err);
    if (status == 0) {
        status = characterise(&measured, &found, &map, &record, options, err);
        if (status != 0)
            error_context(err, "%s", files[0]);
    }
    if (status == 0 && options->picture != NULL)
        status = draw(options->picture, files[0], &map, record.boundary, err);
    if (status == 0)
        status = write_planes(options, &map, record.boundary, err);
    const struct map_figure figure = {&measured, &found, &map, &record};
    if (status == 0 && options->report != NULL)
        status = output_file_draw(options->report, draw_page, &figure, err);
    if (status == 0)
        status = keep_groups(&found, options->group, err);
    if (status == 0)
        status = print(options, &figure, err);
    named_values_clear(&found);
    map_characterisation_clear(&measured);
    height_map_clear(&map);
    return status;
}

static int characterise_files(const struct characterise_options *options, const char *const *files,
                              struct error *err) {
    return options->together ? characterise_together(options, files, err)
                             : characterise_one(options, files, err);
}

/* --- files on standard input --- */

/* Fits the study behind the files to these, and prints it. */
static int print_sent(const struct characterise_options *options, char **text, size_t *size,
                      struct error *err) {
    int status = options->format == FORMAT_STUDY
                     ? like_study_fit_sent(text, size, &options->map, err)
                     : error_set(err, ERROR_INPUT,
                                 "a study that is sent with files goes with the format study");
    if (status == 0)
        puts(*text);
    return status == 0 ? output_flush(err) : status;
}

static int characterise_sent(const struct characterise_options *options, const char *const *names,
                             struct error *err) {
    static const size_t BYTES_MOST = (size_t)1 << 36; /* as of a file */
    struct characterise_options own = *options;
    struct sent_files files = {0};
    char *text = NULL, *study = NULL;
    size_t size, study_size = 0;
    int status = options->map.name == NULL
                     ? input_file_read("-", BYTES_MOST, &text, &size, err)
                     : error_set(err, ERROR_INPUT, "--sent does not go with --name");
    if (status == 0)
        status = sent_files_take(&files, text, size, options->sent, names, err);
    if (status == 0)
        status = sent_files_study(&files, &study, &study_size, err);
    own.map.sent = &files;
    if (status == 0 && study_size > 0)
        status = print_sent(&own, &study, &study_size, err);
    else if (status == 0)
        status = characterise_files(&own, names, err);
    free(study);
    sent_files_clear(&files);
    return status;
}

/* The law of a study is fitted by the map, whatever its reader is to trust. */
static int check_study(const struct characterise_options *options, struct error *err) {
    const bool study = options->format == FORMAT_STUDY;
    if (options->hold && !study)
        return error_set(err, ERROR_INPUT,
                         "--hold goes with --format study, whose surfaces hold the map");
    if (study && (options->trust_from != NULL || options->trust_to != NULL))
        return error_set(err, ERROR_INPUT,
                         "--trust-from and --trust-to do not go with --format study, whose law is "
                         "fitted to the waves that the map says");
    return 0;
}

static int run(const void *values, const char *const *arguments) {
    const struct characterise_options *options = values;
    struct error err = {0};
    int status = check_study(options, &err);
    if (status == 0)
        status = options->sent != NULL ? characterise_sent(options, arguments, &err)
                                       : characterise_files(options, arguments, &err);
    return status == 0 ? EXIT_DONE : command_fail("characterise", &err);
}

const struct command COMMAND_CHARACTERISE = {
    .name = "characterise",
    .arguments = "FILE [FILE...]",
    .summary = "parameters and summits of a height map in a file",
    .least = 1,
    .most = JOINT_PATCHES_MOST,
    .options = OPTIONS,
    .options_size = sizeof(struct characterise_options),
    .run = run,
};
