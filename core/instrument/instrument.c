#include "core/file/text_mark.h"
#include "core/instrument/archive/zip_archive.h"
#include "core/instrument/foreign.h"
#include "core/instrument/formats.h"
#include "core/instrument/text/columns.h"
#include "core/instrument/text/decimal_column.h"
#include "core/map/height_map_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* X3P follows NPZ: it owns every other zip archive, so that its reader reports the fault. */
const struct instrument_format *const INSTRUMENT_FORMATS[] = {
    &INSTRUMENT_GWY,  &INSTRUMENT_SDF,    &INSTRUMENT_NPZ,
    &INSTRUMENT_X3P,  &INSTRUMENT_ZYGO,   &INSTRUMENT_SURFER,
    &INSTRUMENT_ESRI, &INSTRUMENT_POINTS, NULL,
};

static bool has_ending(const char *name, const char *endings) {
    const char *dot = strrchr(name, '.');
    if (dot == NULL || dot[1] == '\0')
        return false;
    const size_t length = strlen(dot + 1);
    for (const char *at = endings; *at != '\0';) {
        size_t word = strcspn(at, " ");
        if (word == length && strncasecmp(at, dot + 1, word) == 0)
            return true;
        at += word + strspn(at + word, " ");
    }
    return false;
}

static const struct instrument_format *owner_of(const char *data, size_t size) {
    for (size_t f = 0; INSTRUMENT_FORMATS[f] != NULL; f++)
        if (INSTRUMENT_FORMATS[f]->owns != NULL && INSTRUMENT_FORMATS[f]->owns(data, size))
            return INSTRUMENT_FORMATS[f];
    return NULL;
}

static const struct instrument_format *format_of(const char *name, const char *data, size_t size) {
    const struct instrument_format *owner = owner_of(data, size);
    if (owner != NULL)
        return owner;
    for (size_t f = 0; INSTRUMENT_FORMATS[f] != NULL; f++)
        if (has_ending(name, INSTRUMENT_FORMATS[f]->endings))
            return INSTRUMENT_FORMATS[f];
    return INSTRUMENT_TEXT.owns(data, size) ? &INSTRUMENT_TEXT : NULL;
}

/* Returns whether a zip archive is one of those that are read; other programs pack theirs so too.
 */
static bool is_known_archive(const char *data, size_t size) {
    return zip_archive_names(data, size, "main.xml") || zip_archive_names(data, size, ".npy");
}

bool instrument_takes(const char *name, const char *data, size_t size) {
    if (size == 0 || memchr(data, 0, size) == NULL || data[0] == '\x93' ||
        text_mark_is_utf16(data, size, NULL))
        return true;
    const struct instrument_format *owner = owner_of(data, size);
    if (owner != NULL)
        return owner != &INSTRUMENT_X3P || is_known_archive(data, size);
    return foreign_format_of(data, size) == NULL &&
           (height_map_format_of(name) < HEIGHT_MAP_FORMATS || format_of(name, data, size) != NULL);
}

/* Writes ".npy, .csv, .xyz, .gwy ...": the endings that files may have, each once. */
static void list_endings(char *out, size_t size) {
    size_t used = 0;
    for (size_t f = 0; f < HEIGHT_MAP_FORMATS; f++)
        used += (size_t)snprintf(out + used, size - used, "%s.%s", f > 0 ? ", " : "",
                                 HEIGHT_MAP_NAMES[f]);
    for (size_t f = 0; INSTRUMENT_FORMATS[f] != NULL; f++)
        for (const char *at = INSTRUMENT_FORMATS[f]->endings; *at != '\0';) {
            char ending[16];
            size_t word = strcspn(at, " ");
            snprintf(ending, sizeof ending, ", .%.*s", (int)word, at);
            at += word + strspn(at + word, " ");
            if (strstr(out, ending) == NULL && used < size)
                used += (size_t)snprintf(out + used, size - used, "%s", ending);
        }
}

/* Refuses what is no text: a file without a mark or an ending that is known is read as text. */
static int check_text(const char *name, const char *data, size_t size, struct error *err) {
    char endings[256];
    const char *slash = strrchr(name, '/'), *dot = strrchr(slash != NULL ? slash : name, '.');
    if (size == 0 || memchr(data, 0, size) == NULL)
        return 0;
    list_endings(endings, sizeof endings);
    return error_set(err, ERROR_INPUT,
                     "neither its first bytes nor its ending%s%.20s belong to a format that is "
                     "known; allowed: %s, and text",
                     dot != NULL ? " " : "", dot != NULL ? dot : "", endings);
}

/* Reads the program's own plain format, whose columns may be others than those of a map. */
static int read_plain(struct height_map *out, enum height_map_format own, const char *data,
                      size_t size, double dx, const struct instrument_request *request,
                      struct error *err) {
    char done[INSTRUMENT_DONE] = "";
    struct height_map map = {0};
    int status = height_map_parse(&map, own, data, size, dx, err);
    if (status == 0 && own == HEIGHT_MAP_CSV)
        status = columns_of_plain(&map, request->columns, done, err);
    if (status != 0) {
        height_map_clear(&map);
        return status;
    }
    if (request->done != NULL)
        memcpy(request->done, done, sizeof done);
    *out = map;
    return 0;
}

static int check_columns(enum instrument_columns columns, const struct instrument_format *foreign,
                         enum height_map_format own, struct error *err) {
    if (columns == COLUMNS_AUTO || foreign == &INSTRUMENT_TEXT || foreign == &INSTRUMENT_POINTS ||
        (foreign == NULL && own == HEIGHT_MAP_CSV))
        return 0;
    return error_set(err, ERROR_INPUT, "a %s file says what it holds, so that --columns does not",
                     foreign != NULL ? foreign->name : HEIGHT_MAP_NAMES[own]);
}

static void set_spacing(struct height_map *map, double dx) {
    map->grid.lx = dx * (double)map->grid.nx;
    map->grid.ly = dx * (double)map->grid.ny;
}

static int read_unmarked(struct height_map *out, const char *name, const char *data, size_t size,
                         double dx, const struct instrument_request *request, const char **format,
                         struct error *err) {
    const struct instrument_format *foreign = format_of(name, data, size);
    enum height_map_format own = height_map_format_of(name);
    bool guessed = own == HEIGHT_MAP_FORMATS && (size == 0 || data[0] != '\x93');
    if (own == HEIGHT_MAP_FORMATS)
        own = size > 0 && data[0] == '\x93' ? HEIGHT_MAP_NPY : HEIGHT_MAP_CSV;
    if (dx != 0 && !(dx > 0 && isfinite(dx)))
        return error_set(err, ERROR_INPUT, "the spacing of points must be above 0, not %g", dx);
    int status = foreign == NULL && guessed ? check_text(name, data, size, err) : 0;
    if (status == 0)
        status = check_columns(request->columns, foreign, own, err);
    if (status != 0)
        return status;
    if (request->done != NULL)
        *request->done = '\0';
    if (request->layer_read != NULL)
        *request->layer_read = '\0';
    status = foreign != NULL ? foreign->read(out, data, size, request, err)
                             : read_plain(out, own, data, size, dx, request, err);
    if (status != 0)
        return status;
    if (dx > 0)
        set_spacing(out, dx);
    if (format != NULL)
        *format = foreign != NULL ? foreign->name : HEIGHT_MAP_NAMES[own];
    return 0;
}

static int ask_for_commas(size_t rows, struct error *err) {
    return error_set(err, ERROR_INPUT,
                     "%zu rows of digits, a comma and digits are either one height each, with a "
                     "decimal comma, or two whole numbers; allowed: points in place of the commas, "
                     "or --columns xz or --columns map, which take them for two (\"columns\" in "
                     "studies and requests)",
                     rows);
}

/* Reads a text whose rows have one comma each: one column of heights where that is sure. A map of
 * two columns is asked about. */
static int read_commas(struct height_map *out, const char *name, struct unmarked_text *file,
                       double dx, const struct instrument_request *request, const char **format,
                       struct error *err) {
    size_t rows;
    struct height_map map = {0};
    enum decimal_column column = decimal_column_judge(file->text, file->size, &rows);
    const bool may = request->columns == COLUMNS_AUTO || request->columns == COLUMNS_MAP;
    const bool one = column == DECIMAL_YES && may;
    int status = one ? unmarked_text_own(file, err) : 0;
    if (status == 0 && one)
        decimal_column_point(file->owned, file->size);
    if (status == 0)
        status = read_unmarked(&map, name, file->text, file->size, dx, request, format, err);
    if (status == 0 && column == DECIMAL_OPEN && request->columns == COLUMNS_AUTO &&
        map.grid.nx == 2 && map.grid.ny == rows)
        status = ask_for_commas(rows, err);
    if (status != 0) {
        height_map_clear(&map);
        return status;
    }
    if (one && request->done != NULL)
        snprintf(request->done, INSTRUMENT_DONE, "z, %zu rows with decimal commas", rows);
    *out = map;
    return 0;
}

int instrument_read(struct height_map *out, const char *name, const char *data, size_t size,
                    double dx, const struct instrument_request *request, const char **format,
                    struct error *err) {
    struct unmarked_text file = {0}; /* texts of all formats may have a mark */
    int status = text_unmark(&file, data, size, err);
    if (status == 0)
        status = read_commas(out, name, &file, dx, request, format, err);
    unmarked_text_clear(&file);
    return status;
}
