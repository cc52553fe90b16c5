#include "core/instrument/sdf_header.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum field { POINTS, PROFILES, X_SCALE, Y_SCALE, Z_SCALE, DATA_TYPE, COMPRESSION, CHECK, FIELDS };
static const char *const FIELD_NAMES[FIELDS] = {"NumPoints",   "NumProfiles", "Xscale",
                                                "Yscale",      "Zscale",      "DataType",
                                                "Compression", "CheckType"};

struct reading {
    const char *at, *end; /* borrowed: what is not read yet */
    size_t line;
    double fields[FIELDS];
    bool there[FIELDS];
};

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* The next line without its comment, which begins with ';', and without blanks at its ends. */
static bool next_line(struct reading *reading, const char **line, size_t *length) {
    if (reading->at >= reading->end)
        return false;
    const char *stop = memchr(reading->at, '\n', (size_t)(reading->end - reading->at));
    stop = stop != NULL ? stop : reading->end;
    const char *first = reading->at, *last = memchr(first, ';', (size_t)(stop - first));
    last = last != NULL ? last : stop;
    while (first < last && is_blank(*first))
        first++;
    while (last > first && is_blank(last[-1]))
        last--;
    *line = first;
    *length = (size_t)(last - first);
    reading->at = stop + (stop < reading->end);
    reading->line++;
    return true;
}

static bool is_word(const char *text, size_t length, const char *word) {
    return strlen(word) == length && strncasecmp(text, word, length) == 0;
}

/* The value of a field: a number, or NULL, which the proposal has for 0. */
static int read_value(const struct reading *reading, const char *name, const char *text,
                      size_t length, double *out, struct error *err) {
    char copy[40] = "", *stop;
    if (is_word(text, length, "NULL")) {
        *out = 0;
        return 0;
    }
    if (length > 0 && length < sizeof copy && strspn(text, "+-.0123456789eE") >= length) {
        memcpy(copy, text, length);
        *out = strtod(copy, &stop);
        if (*stop == '\0' && isfinite(*out))
            return 0;
    }
    return error_set(err, ERROR_INPUT, "line %zu: %s is '%.*s'; allowed: a number", reading->line,
                     name, length < 40 ? (int)length : 40, text);
}

static int read_field(struct reading *reading, const char *line, size_t length, struct error *err) {
    const char *equal = memchr(line, '=', length);
    size_t name = equal != NULL ? (size_t)(equal - line) : 0;
    while (name > 0 && is_blank(line[name - 1]))
        name--;
    for (int f = 0; f < FIELDS && equal != NULL; f++) {
        if (!is_word(line, name, FIELD_NAMES[f]))
            continue;
        const char *value = equal + 1;
        while (value < line + length && is_blank(*value))
            value++;
        if (reading->there[f])
            return error_set(err, ERROR_INPUT, "line %zu: %s is there twice", reading->line,
                             FIELD_NAMES[f]);
        reading->there[f] = true;
        return read_value(reading, FIELD_NAMES[f], value, (size_t)(line + length - value),
                          &reading->fields[f], err);
    }
    return 0; /* a maker's own field */
}

/* Reads up to the line with '*' that ends the header. */
static int read_fields(struct reading *reading, struct error *err) {
    const char *line;
    size_t length;
    int status = 0;
    while (next_line(reading, &line, &length)) {
        if (length > 0 && *line == '*')
            return status;
        status = length > 0 ? read_field(reading, line, length, err) : 0;
        if (status != 0)
            return status;
    }
    return error_set(err, ERROR_INPUT, "the header does not end: no line with * is there");
}

static int read_count(const struct reading *reading, enum field field, size_t *out,
                      struct error *err) {
    double count = reading->fields[field];
    if (!(count >= 1 && count <= 2147483648.0 && count == floor(count)))
        return error_set(err, ERROR_INPUT, "%s is %g; allowed: 1 to 2147483648", FIELD_NAMES[field],
                         count);
    *out = (size_t)count;
    return 0;
}

static int check_fields(const struct reading *reading, struct sdf_header *header,
                        struct error *err) {
    for (int f = 0; f < COMPRESSION; f++)
        if (!reading->there[f] && !(f == Y_SCALE && reading->fields[PROFILES] == 1))
            return error_set(err, ERROR_INPUT, "the header has no %s", FIELD_NAMES[f]);
    for (int f = COMPRESSION; f <= CHECK; f++)
        if (reading->fields[f] != 0)
            return error_set(err, ERROR_INPUT, "%s is %g; allowed: 0, the heights as they are",
                             FIELD_NAMES[f], reading->fields[f]);
    double type = reading->fields[DATA_TYPE];
    if (!(type >= 0 && type < SDF_TYPE_COUNT && type == floor(type)))
        return error_set(err, ERROR_INPUT, "DataType is %g; allowed: 0 to 7", type);
    int status = read_count(reading, POINTS, &header->points, err);
    if (status == 0)
        status = read_count(reading, PROFILES, &header->profiles, err);
    header->x_scale = reading->fields[X_SCALE];
    header->y_scale = reading->fields[Y_SCALE];
    header->z_scale = reading->fields[Z_SCALE];
    header->data_type = (unsigned)type;
    return status;
}

/* Moves to the next height; false where the heights end, at '*' or with the file. */
static bool find_number(struct reading *reading) {
    while (reading->at < reading->end) {
        if (*reading->at == ';') {
            const char *stop = memchr(reading->at, '\n', (size_t)(reading->end - reading->at));
            reading->at = stop != NULL ? stop : reading->end;
        } else if (is_blank(*reading->at)) {
            reading->line += *reading->at == '\n' ? 1 : 0;
            reading->at++;
        } else {
            return *reading->at != '*';
        }
    }
    return false;
}

static int refuse_height(const struct reading *reading, size_t length, const char *why,
                         struct error *err) {
    return error_set(err, ERROR_INPUT,
                     "line %zu: the height '%.*s' %s; allowed: numbers as -1.5e-6, and BAD for "
                     "holes",
                     reading->line + 1, length < 40 ? (int)length : 40, reading->at, why);
}

/* One height, or BAD; the file may end behind it only where it was not cut off in it. */
static int read_height(struct reading *reading, const struct sdf_header *header, double *out,
                       struct error *err) {
    size_t length = strcspn(reading->at, " \t\r\n;*");
    char *stop;
    if (reading->at + length >= reading->end)
        return refuse_height(reading, length, "may be cut off: the file ends with it", err);
    if (is_word(reading->at, length, "BAD") || is_word(reading->at, length, "NAN")) {
        *out = NAN;
    } else {
        if (strspn(reading->at, "+-.0123456789eE") != length)
            return refuse_height(reading, length, "is no number", err);
        double number = strtod(reading->at, &stop);
        if (stop != reading->at + length)
            return refuse_height(reading, length, "is no number", err);
        *out = sdf_is_hole(header, number) ? NAN : number * header->z_scale;
        if (isinf(*out))
            return refuse_height(reading, length, "is too large", err);
    }
    reading->at += length;
    return 0;
}

static int read_heights(struct reading *reading, const struct sdf_header *header,
                        struct height_map *map, struct error *err) {
    size_t points = header->points * header->profiles, rest = (size_t)(reading->end - reading->at);
    int status = 0;
    if (points > rest / 2 + 1) /* a height and what parts it from the next */
        return error_set(
            err, ERROR_INPUT,
            "%zu points in %zu profiles do not fit into %zu bytes; the file is cut off "
            "or its counts are wrong",
            header->points, header->profiles, rest);
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    size_t count = 0;
    while (status == 0 && find_number(reading)) {
        if (count == points)
            return error_set(err, ERROR_INPUT,
                             "line %zu: more heights than the %zu of NumPoints %zu and NumProfiles "
                             "%zu",
                             reading->line + 1, points, header->points, header->profiles);
        status = read_height(reading, header, &map->z[count++], err);
    }
    if (status != 0 || count == points)
        return status;
    return error_set(err, ERROR_INPUT,
                     "%zu heights are there, NumPoints %zu and NumProfiles %zu make %zu", count,
                     header->points, header->profiles, points);
}

int sdf_text_read(struct height_map *map, const char *text, size_t size, struct error *err) {
    struct reading reading = {.at = text, .end = text + size};
    struct sdf_header header = {.bcr = text[1] == 'B'};
    const char *line;
    size_t length;
    if (memchr(text, 0, size) != NULL)
        return error_set(err, ERROR_INPUT, "a surface data file of text holds no zero byte");
    next_line(&reading, &line, &length);
    int status = read_fields(&reading, err);
    if (status == 0)
        status = check_fields(&reading, &header, err);
    if (status == 0)
        status = sdf_header_check(&header, map, err);
    return status == 0 ? read_heights(&reading, &header, map, err) : status;
}
