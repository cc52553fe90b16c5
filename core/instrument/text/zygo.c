/* Zygo's text export of points, "Zygo XYZ Data File - Format 1": fourteen lines of header up to a
 * line "#", then column, row and height of each pixel, or "No Data". Heights are in micrometres,
 * and line 8 has the size of a pixel in metres. */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/text/text_number.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char MARK[] = "Zygo XYZ Data File";
enum { PHASE_LINE = 4, CAMERA_LINE = 8, CAMERA_WORD = 7, BYTES_A_PIXEL = 4 };

static bool owns(const char *data, size_t size) {
    return size >= sizeof MARK - 1 && memcmp(data, MARK, sizeof MARK - 1) == 0;
}

struct zygo {
    double origin[2], size[2]; /* of the pixels with heights: column and row */
    double pixel;              /* metres; 0: not in the file */
};

/* Reads the first numbers of a line, all of them finite. */
static int read_numbers(struct text_line line, double *out, size_t count, struct error *err) {
    struct text_dialect dialect = {' ', '\0'};
    struct text_field field;
    for (size_t n = 0; n < count; n++)
        if (!text_field_next(&line, ' ', &field) ||
            text_value_of(&field, &dialect, &out[n]) != TEXT_NUMBER)
            return error_set(err, ERROR_INPUT,
                             "line %zu: word %zu is no number; allowed: %zu numbers", line.number,
                             n + 1, count);
    return 0;
}

static int check_frame(const struct zygo *zygo, size_t line, struct error *err) {
    const double numbers[4] = {zygo->origin[0], zygo->origin[1], zygo->size[0], zygo->size[1]};
    for (size_t n = 0; n < 4; n++)
        if (!(numbers[n] >= (n < 2 ? 0 : 1) && numbers[n] <= 2147483648.0 &&
              numbers[n] == floor(numbers[n])))
            return error_set(
                err, ERROR_INPUT,
                "line %zu: the frame of pixels is %g %g %g %g; allowed: an origin from "
                "0 and a size from 1",
                line, numbers[0], numbers[1], numbers[2], numbers[3]);
    return 0;
}

static int read_header(struct zygo *zygo, struct text_line *line, const char **next,
                       const char *end, struct error *err) {
    double frame[4], camera[CAMERA_WORD];
    int status = 0;
    while (status == 0 && text_line_next(line, next, end)) {
        if (line->number > CAMERA_LINE && line->end - line->at == 1 && *line->at == '#')
            return 0;
        if (line->number == PHASE_LINE) {
            status = read_numbers(*line, frame, 4, err);
            if (status != 0)
                break;
            *zygo = (struct zygo){{frame[0], frame[1]}, {frame[2], frame[3]}, 0};
            status = check_frame(zygo, line->number, err);
        } else if (line->number == CAMERA_LINE) {
            status = read_numbers(*line, camera, CAMERA_WORD, err);
            if (status != 0)
                break;
            zygo->pixel = camera[CAMERA_WORD - 1];
            if (!(zygo->pixel >= 0))
                status =
                    error_set(err, ERROR_INPUT, "line %zu: a pixel has %g m; allowed: 0 and above",
                              line->number, zygo->pixel);
        }
    }
    return status != 0 ? status
                       : error_set(err, ERROR_INPUT, "the header does not end: no line # is there");
}

/* Reads a pixel: its node of the map, and its height in metres. */
static int read_pixel(const struct zygo *zygo, struct text_line line, size_t *node, double *height,
                      struct error *err) {
    struct text_dialect dialect = {' ', '\0'};
    struct text_field field;
    double at[2];
    int status = read_numbers(line, at, 2, err);
    if (status != 0)
        return status;
    for (size_t axis = 0; axis < 2; axis++) {
        at[axis] -= zygo->origin[axis];
        if (!(at[axis] >= 0 && at[axis] < zygo->size[axis] && at[axis] == floor(at[axis])))
            return error_set(
                err, ERROR_INPUT,
                "line %zu: a pixel is outside the frame of %g x %g pixels from (%g, %g)",
                line.number, zygo->size[0], zygo->size[1], zygo->origin[0], zygo->origin[1]);
    }
    for (size_t word = 0; word < 3; word++)
        if (!text_field_next(&line, ' ', &field))
            return error_set(err, ERROR_INPUT, "line %zu: the pixel has no height", line.number);
    if (text_value_of(&field, &dialect, height) == TEXT_OTHER)
        return error_set(
            err, ERROR_INPUT, "line %zu: the height is '%.*s'; allowed: a number, or No Data",
            line.number, field.end - field.at < 40 ? (int)(field.end - field.at) : 40, field.at);
    *height *= 1e-6;
    *node = (size_t)at[1] * (size_t)zygo->size[0] + (size_t)at[0];
    return 0;
}

static int read_pixels(struct height_map *map, const struct zygo *zygo, struct text_line line,
                       const char *next, const char *end, struct error *err) {
    size_t pixels = 0, points = grid_points(&map->grid), node;
    double height;
    int status = 0;
    while (status == 0 && text_line_next(&line, &next, end)) {
        if (line.at == line.end)
            continue;
        if (*line.at == '#')
            break;
        status = read_pixel(zygo, line, &node, &height, err);
        if (status == 0) {
            map->z[node] = height;
            pixels++;
        }
    }
    if (status != 0 || pixels == points)
        return status;
    return error_set(err, ERROR_INPUT,
                     "%zu pixels are there, the frame has %zu; the file is cut off", pixels,
                     points);
}

static int read_file(struct height_map *map, const char *text, size_t size, struct error *err) {
    struct text_line line = {0};
    struct zygo zygo = {0};
    const char *next = text, *end = text + size;
    int status = read_header(&zygo, &line, &next, end, err);
    if (status == 0)
        status = height_map_shape(map, (size_t)zygo.size[1], (size_t)zygo.size[0],
                                  zygo.pixel > 0 ? zygo.pixel : 1, err);
    if (status != 0)
        return status;
    size_t points = grid_points(&map->grid);
    if (points > (size_t)(end - next) / BYTES_A_PIXEL)
        return error_set(err, ERROR_INPUT,
                         "%zu x %zu pixels do not fit into %zu bytes; the file is cut off or its "
                         "frame is wrong",
                         map->grid.nx, map->grid.ny, (size_t)(end - next));
    memcpy(map->z_unit, "m", 2);
    if (zygo.pixel > 0)
        memcpy(map->xy_unit, "m", 2);
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    for (size_t point = 0; point < points; point++)
        map->z[point] = NAN;
    return read_pixels(map, &zygo, line, next, end, err);
}

static int read_zygo(struct height_map *out, const char *data, size_t size,
                     const struct instrument_request *request, struct error *err) {
    struct height_map map = {0};
    if (layer_check_only(request->layer, err) != 0)
        return ERROR_INPUT;
    int status = text_check(data, size, err);
    if (status == 0)
        status = read_file(&map, data, size, err);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

const struct instrument_format INSTRUMENT_ZYGO = {"zygo", "", owns, read_zygo};
