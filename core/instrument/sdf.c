/* Surface data files, SDF: ISO 25178-71, versions 1.0 and 2.0, and the proposal BCR 1.0. */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/little_endian.h"
#include "core/map/height_map.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct sdf_header {
    size_t points, profiles;          /* along x and along y */
    double x_scale, y_scale, z_scale; /* metres between points, and metres in one unit of z */
    unsigned data_type;               /* 0 to 7: SDF_TYPES */
    bool bcr; /* of the proposal (EUR 15178) that came before the standard */
};

struct sdf_type {
    const char *name;
    size_t bytes;
    double lowest, highest;
};
enum { SDF_TYPE_COUNT = 8 };

static const struct sdf_type SDF_TYPES[SDF_TYPE_COUNT] = {
    {"unsigned 8 bit", 1, 0, UINT8_MAX},        {"unsigned 16 bit", 2, 0, UINT16_MAX},
    {"unsigned 32 bit", 4, 0, UINT32_MAX},      {"float", 4, -FLT_MAX, FLT_MAX},
    {"signed 8 bit", 1, INT8_MIN, INT8_MAX},    {"signed 16 bit", 2, INT16_MIN, INT16_MAX},
    {"signed 32 bit", 4, INT32_MIN, INT32_MAX}, {"double", 8, -DBL_MAX, DBL_MAX},
};

static int check_scale(const char *name, double scale, struct error *err) {
    if (scale > 0 && isfinite(scale))
        return 0;
    return error_set(err, ERROR_INPUT, "%s is %g; allowed: metres above 0", name, scale);
}

/* Checks counts, scales and the type, and sets the shape and the units of the map. */
static int sdf_header_check(const struct sdf_header *header, struct height_map *map,
                            struct error *err) {
    int status = height_map_shape(map, header->profiles, header->points, 1, err);
    if (status == 0)
        status = check_scale("Xscale", header->x_scale, err);
    if (status == 0 && header->profiles > 1) /* unused by a profile */
        status = check_scale("Yscale", header->y_scale, err);
    if (status == 0)
        status = check_scale("Zscale", header->z_scale, err);
    if (status == 0 && header->data_type >= SDF_TYPE_COUNT)
        status = error_set(err, ERROR_INPUT, "DataType is %u; allowed: 0 to 7", header->data_type);
    if (status != 0)
        return status;
    double y_scale = header->profiles > 1 ? header->y_scale : header->x_scale;
    map->grid.lx = header->x_scale * (double)header->points;
    map->grid.ly = y_scale * (double)header->profiles;
    memcpy(map->xy_unit, "m", 2);
    memcpy(map->z_unit, "m", 2);
    return grid_check(&map->grid, err);
}

/* Returns whether a number stands for a height that was not measured. It is the standard's lowest
 * of the type or the proposal's highest, which programs mix. */
static bool sdf_is_hole(const struct sdf_header *header, double number) {
    const struct sdf_type *type = &SDF_TYPES[header->data_type];
    bool real = type->bytes == 8 || type->lowest == -FLT_MAX;
    if (isnan(number) || (type->lowest < 0 && number == type->lowest))
        return true;
    return number == type->highest && (real || header->bcr || type->lowest == 0);
}

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

/* Finds the next line without its comment, which begins with ';', and without blanks at its
 * ends. */
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

/* Reads the value of a field: a number, or NULL, which the proposal has for 0. */
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

/* Moves to the next height; returns false where the heights end, at '*' or with the file. */
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

/* Reads a height, or BAD. The file may end after it only if the height is not cut off. */
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
    if (points > rest / 2 + 1) /* a height and its separator */
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

/* Each reads a whole file that begins with its mark, and fills *map. On failure *map may hold
 * heights, which the caller clears. text[size] must be 0. */
static int sdf_text_read(struct height_map *map, const char *text, size_t size, struct error *err) {
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

/* Where the fields of the header begin, after the mark, the maker and the two dates; version 2.0
 * has counts of 4 bytes. */
enum { COUNTS_AT = 42, VERSION_1_BYTES = 81, VERSION_2_BYTES = 85 };

static int check_plain(const char *name, unsigned char found, struct error *err) {
    if (found == 0)
        return 0;
    return error_set(err, ERROR_INPUT, "%s is %u; allowed: 0, the heights as they are", name,
                     (unsigned)found);
}

static int read_header(struct sdf_header *header, const char *data, size_t size, size_t *begin,
                       struct error *err) {
    size_t wide = data[5] == '2' ? 4 : 2;
    *begin = wide == 4 ? VERSION_2_BYTES : VERSION_1_BYTES;
    if (size < *begin)
        return error_set(err, ERROR_INPUT, "the file has %zu bytes, its header alone has %zu", size,
                         *begin);
    const char *at = data + COUNTS_AT + 2 * wide;
    *header = (struct sdf_header){.points = (size_t)little_integer(data + COUNTS_AT, wide),
                                  .profiles = (size_t)little_integer(data + COUNTS_AT + wide, wide),
                                  .x_scale = little_double(at),
                                  .y_scale = little_double(at + 8),
                                  .z_scale = little_double(at + 16),
                                  .data_type = (unsigned char)at[33],
                                  .bcr = data[1] == 'B'};
    int status = check_plain("Compression", (unsigned char)at[32], err);
    return status == 0 ? check_plain("CheckType", (unsigned char)at[34], err) : status;
}

/* Returns whether two more words, always 5 and 1, follow the header of version 1.0, as Olympus's
 * programs write them. */
static bool has_more_header(const char *data, size_t size, size_t heights) {
    return data[1] == 'I' && data[5] == '1' && size == VERSION_1_BYTES + 8 + heights &&
           little_integer(data + VERSION_1_BYTES, 4) == 5 &&
           little_integer(data + VERSION_1_BYTES + 4, 4) == 1;
}

static double number_at(const char *at, unsigned type) {
    switch (type) {
    case 3:
        return (double)little_float(at);
    case 4:
        return (double)(int8_t)little_integer(at, 1);
    case 5:
        return (double)(int16_t)little_integer(at, 2);
    case 6:
        return (double)(int32_t)little_integer(at, 4);
    case 7:
        return little_double(at);
    default:
        return (double)little_integer(at, SDF_TYPES[type].bytes);
    }
}

static int sdf_binary_read(struct height_map *map, const char *data, size_t size,
                           struct error *err) {
    struct sdf_header header;
    size_t begin;
    int status = read_header(&header, data, size, &begin, err);
    if (status == 0)
        status = sdf_header_check(&header, map, err);
    if (status != 0)
        return status;
    size_t points = header.points * header.profiles, bytes = SDF_TYPES[header.data_type].bytes;
    if (points > (size - begin) / bytes)
        return error_set(err, ERROR_INPUT,
                         "%zu points in %zu profiles of %s need %zu bytes, %zu are there; the file "
                         "is cut off or its counts are wrong",
                         header.points, header.profiles, SDF_TYPES[header.data_type].name,
                         points * bytes, size - begin);
    if (has_more_header(data, size, points * bytes))
        begin += 8;
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    for (size_t point = 0; point < points; point++) {
        double number = number_at(data + begin + point * bytes, header.data_type);
        map->z[point] = sdf_is_hole(&header, number) ? NAN : number * header.z_scale;
        if (isinf(map->z[point]))
            return error_set(err, ERROR_INPUT,
                             "the height in profile %zu, point %zu is infinite; allowed: numbers, "
                             "and nan for holes",
                             point / header.points + 1, point % header.points + 1);
    }
    return 0;
}

static bool is_mark(const char *data, size_t size, char kind) {
    static const char *const NAMES[] = {"ISO-1.0", "ISO-2.0", "BCR-1.0", "BCR-0.0"};
    for (size_t name = 0; name < 4; name++)
        if (size >= 8 && data[0] == kind && memcmp(data + 1, NAMES[name], 7) == 0)
            return true;
    return false;
}

/* Any version is of this format; the reader refuses an unknown one by its name. */
static bool owns(const char *data, size_t size) {
    return size >= 8 && (data[0] == 'a' || data[0] == 'b') &&
           (memcmp(data + 1, "ISO-", 4) == 0 || memcmp(data + 1, "BCR-", 4) == 0);
}

static int read_sdf(struct height_map *out, const char *data, size_t size,
                    const struct instrument_request *request, struct error *err) {
    struct height_map map = {0};
    int status;
    if (layer_check_only(request->layer, err) != 0)
        return ERROR_INPUT;
    if (is_mark(data, size, 'a'))
        status = sdf_text_read(&map, data, size, err);
    else if (is_mark(data, size, 'b'))
        status = sdf_binary_read(&map, data, size, err);
    else
        status = error_set(
            err, ERROR_INPUT,
            "this is no surface data file that is read: it begins with '%.8s'; "
            "allowed: aISO-1.0, bISO-1.0, aISO-2.0, bISO-2.0, aBCR-1.0, bBCR-1.0, aBCR-0.0",
            data);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

const struct instrument_format INSTRUMENT_SDF = {"sdf", "sdf", owns, read_sdf};
