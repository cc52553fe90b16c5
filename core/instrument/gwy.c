/* Gwyddion's own format, GWY: the channels of a file by number or title, a channel's mask as its
 * holes. Rows stand from the top of the picture down, and are reversed. Graphs, spectra, volumes
 * and point clouds are not read, but counted in the message about an absent layer. */
#include "core/error.h"
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/little_endian.h"
#include "core/instrument/unit_of.h"
#include "core/map/height_map.h"
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the tree: objects of named components, which may be objects again. Nothing is copied: results
 * point into the bytes of the file. --- */

/* Bytes of the file that are not read yet. */
struct gwy_span {
    const char *file; /* borrowed: where the file begins, for offsets in messages */
    const char *at;   /* borrowed */
    size_t size;
};

struct gwy_component {
    const char *name;      /* borrowed, ends with 0 */
    char type;             /* b c i q d s o, and C I Q D S O for arrays of these */
    size_t count;          /* values of an array; 1 otherwise */
    const char *kind;      /* borrowed: the name of an object's type ("GwyDataField"); else NULL */
    struct gwy_span value; /* the bytes of the value, of an object its components; a text ends with
                              0 */
};

static void advance(struct gwy_span *span, size_t bytes) {
    span->at += bytes;
    span->size -= bytes;
}

static int ends_early(const struct gwy_span *rest, const char *name, const char *what,
                      struct error *err) {
    return error_set(err, ERROR_INPUT, "'%.60s' at byte %zu: %s does not fit into the file", name,
                     (size_t)(rest->at - rest->file), what);
}

/* Reads a text that ends with 0. */
static int take_text(struct gwy_span *rest, const char *name, const char **out, struct error *err) {
    const char *stop = rest->size > 0 ? memchr(rest->at, 0, rest->size) : NULL;
    if (stop == NULL)
        return ends_early(rest, name, "a text", err);
    *out = rest->at;
    advance(rest, (size_t)(stop - rest->at) + 1);
    return 0;
}

static int take_count(struct gwy_span *rest, const char *name, size_t *out, struct error *err) {
    if (rest->size < 4)
        return ends_early(rest, name, "a count", err);
    *out = (size_t)little_integer(rest->at, 4);
    advance(rest, 4);
    return 0;
}

/* Takes an object from *rest: its type and its components. */
static int gwy_object(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    const char *name = out->name != NULL ? out->name : "the whole";
    size_t size;
    int status = take_text(rest, name, &out->kind, err);
    if (status == 0)
        status = take_count(rest, name, &size, err);
    if (status != 0)
        return status;
    if (size > rest->size)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: the object says %zu bytes, %zu are there; the file "
                         "is cut off or damaged",
                         name, (size_t)(rest->at - rest->file), size, rest->size);
    out->value = (struct gwy_span){rest->file, rest->at, size};
    advance(rest, size);
    return 0;
}

/* Returns the bytes of a value of this type; 0 where that depends on the value or there is no such
 * type. */
static size_t value_size(char type) {
    switch (type) {
    case 'b':
    case 'c':
    case 'C':
        return 1;
    case 'i':
    case 'I':
        return 4;
    case 'q':
    case 'Q':
    case 'd':
    case 'D':
        return 8;
    default:
        return 0;
    }
}

/* Reads values of `size` > 0 bytes each. */
static int take_values(struct gwy_span *rest, size_t size, struct gwy_component *out,
                       struct error *err) {
    if (out->count > rest->size / size)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: %zu values of %zu bytes, %zu bytes are there; the "
                         "file is cut off or damaged",
                         out->name, (size_t)(rest->at - rest->file), out->count, size, rest->size);
    out->value = (struct gwy_span){rest->file, rest->at, out->count * size};
    advance(rest, out->count * size);
    return 0;
}

/* Reads an array of texts or of objects: each has at least a byte of the file. */
static int take_members(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    struct gwy_span whole = *rest;
    int status = 0;
    for (size_t member = 0; member < out->count && status == 0; member++) {
        struct gwy_component object = {.name = out->name};
        const char *text;
        status = out->type == 'O' ? gwy_object(rest, &object, err)
                                  : take_text(rest, out->name, &text, err);
    }
    whole.size -= rest->size;
    out->value = whole;
    return status;
}

static int take_string(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    const char *text;
    struct gwy_span whole = *rest;
    int status = take_text(rest, out->name, &text, err);
    whole.size -= rest->size;
    out->value = whole;
    return status;
}

/* Takes the next component, of any type, from *rest. ERROR_INPUT names it and its byte. */
static int gwy_next(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    *out = (struct gwy_component){.count = 1};
    int status = take_text(rest, "a component", &out->name, err);
    if (status != 0)
        return status;
    if (rest->size < 1)
        return ends_early(rest, out->name, "a type", err);
    out->type = *rest->at;
    advance(rest, 1);
    if (out->type == '\0' || strchr("bciqdsoCIQDSO", out->type) == NULL)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: there is no type '%c'; allowed: one of bciqdso and "
                         "CIQDSO",
                         out->name, (size_t)(rest->at - rest->file) - 1, out->type);
    if (strchr("CIQDSO", out->type) != NULL)
        status = take_count(rest, out->name, &out->count, err);
    if (status != 0)
        return status;
    size_t size = value_size(out->type);
    if (size > 0)
        return take_values(rest, size, out, err);
    if (out->type == 's')
        return take_string(rest, out, err);
    return out->type == 'o' ? gwy_object(rest, out, err) : take_members(rest, out, err);
}

/* Finds the last component of this name and type in an object; out->name is NULL where there is
 * none. */
static int gwy_find(struct gwy_span object, const char *name, char type, struct gwy_component *out,
                    struct error *err) {
    *out = (struct gwy_component){0};
    while (object.size > 0) {
        struct gwy_component component;
        int status = gwy_next(&object, &component, err);
        if (status != 0)
            return status;
        if (component.type == type && strcmp(component.name, name) == 0)
            *out = component;
    }
    return 0;
}

/* --- a data field: numbers on a grid with units --- */

struct gwy_field {
    struct grid grid;
    const char *numbers;          /* borrowed: grid_points doubles, lowest byte first, row by row */
    const char *xy_unit, *z_unit; /* borrowed: "" where the file has none */
};

static int need(struct gwy_span object, const char *name, char type, struct gwy_component *out,
                struct error *err) {
    int status = gwy_find(object, name, type, out, err);
    if (status == 0 && out->name == NULL)
        status = error_set(err, ERROR_INPUT, "the data field has no '%s'", name);
    return status;
}

static int read_resolution(struct gwy_span object, const char *name, size_t *out,
                           struct error *err) {
    struct gwy_component found;
    int status = need(object, name, 'i', &found, err);
    if (status != 0)
        return status;
    uint64_t count = little_integer(found.value.at, 4);
    if (count < 1 || count > INT32_MAX)
        return error_set(err, ERROR_INPUT, "%s is %d; allowed: 1 and above", name,
                         (int)(int32_t)(uint32_t)count);
    *out = (size_t)count;
    return 0;
}

static int read_length(struct gwy_span object, const char *name, double *out, struct error *err) {
    struct gwy_component found;
    int status = need(object, name, 'd', &found, err);
    if (status == 0)
        *out = little_double(found.value.at);
    return status;
}

/* Reads one of its units, "si_unit_xy" or "si_unit_z"; "" where there is none. */
static int gwy_unit_read(struct gwy_span object, const char *name, const char **out,
                         struct error *err) {
    struct gwy_component unit, text = {0};
    int status = gwy_find(object, name, 'o', &unit, err);
    if (status == 0 && unit.name != NULL)
        status = gwy_find(unit.value, "unitstr", 's', &text, err);
    *out = status == 0 && text.name != NULL ? text.value.at : "";
    return status;
}

/* Reads a GwyDataField, and checks its header against its data. */
static int gwy_field_read(struct gwy_span object, struct gwy_field *out, struct error *err) {
    struct gwy_component data;
    struct gwy_field field = {0};
    int status = read_resolution(object, "xres", &field.grid.nx, err);
    if (status == 0)
        status = read_resolution(object, "yres", &field.grid.ny, err);
    if (status == 0)
        status = read_length(object, "xreal", &field.grid.lx, err);
    if (status == 0)
        status = read_length(object, "yreal", &field.grid.ly, err);
    if (status == 0)
        status = gwy_unit_read(object, "si_unit_xy", &field.xy_unit, err);
    if (status == 0)
        status = gwy_unit_read(object, "si_unit_z", &field.z_unit, err);
    if (status == 0)
        status = need(object, "data", 'D', &data, err);
    if (status != 0)
        return status;
    if (data.count / field.grid.nx != field.grid.ny || data.count % field.grid.nx != 0)
        return error_set(err, ERROR_INPUT,
                         "xres %zu and yres %zu do not make the %zu numbers of "
                         "the data field",
                         field.grid.nx, field.grid.ny, data.count);
    field.numbers = data.value.at;
    *out = field;
    return 0;
}

/* --- the channels of a file --- */

static const char MAGIC[] = "GWYP";

static bool owns(const char *data, size_t size) {
    return size >= 4 && (memcmp(data, MAGIC, 4) == 0 || memcmp(data, "GWYO", 4) == 0);
}

struct channel {
    unsigned long number; /* as in the name of its data, "/3/data" */
    struct gwy_span data; /* the components of its data field */
    struct gwy_span mask; /* at NULL: none */
    const char *title;    /* borrowed; NULL: none */
};

struct gwy_file {
    struct channel *channels; /* owned, sorted by number */
    size_t count;
    size_t graphs, spectra, volumes, clouds; /* what is not read */
};

/* Returns whether a name is "/NUMBER" followed by this ending. */
static bool is_key(const char *name, const char *ending, unsigned long *number) {
    if (name[0] != '/' || name[1] < '0' || name[1] > '9' || strlen(name) > 24)
        return false;
    char *stop;
    *number = strtoul(name + 1, &stop, 10);
    return strcmp(stop, ending) == 0;
}

static bool is_field(const struct gwy_component *component) {
    return component->type == 'o' && strcmp(component->kind, "GwyDataField") == 0;
}

static int by_number(const void *left, const void *right) {
    unsigned long a = ((const struct channel *)left)->number;
    unsigned long b = ((const struct channel *)right)->number;
    return (a > b) - (a < b);
}

static void count_other(struct gwy_file *file, const struct gwy_component *component) {
    static const struct {
        const char *kind;
        size_t offset;
    } KINDS[] = {{"GwyGraphModel", offsetof(struct gwy_file, graphs)},
                 {"GwySpectra", offsetof(struct gwy_file, spectra)},
                 {"GwyBrick", offsetof(struct gwy_file, volumes)},
                 {"GwyLawn", offsetof(struct gwy_file, volumes)},
                 {"GwySurface", offsetof(struct gwy_file, clouds)}};
    for (size_t k = 0; k < sizeof KINDS / sizeof KINDS[0]; k++)
        if (component->type == 'o' && strcmp(component->kind, KINDS[k].kind) == 0)
            ++*(size_t *)((char *)file + KINDS[k].offset);
}

/* The first pass: counts the channels, which may be in any order, and objects of other types. */
static int count_channels(struct gwy_file *file, struct gwy_span rest, struct error *err) {
    size_t count = 0;
    while (rest.size > 0) {
        struct gwy_component component;
        unsigned long number;
        int status = gwy_next(&rest, &component, err);
        if (status != 0)
            return status;
        count += is_field(&component) && is_key(component.name, "/data", &number) ? 1 : 0;
        count_other(file, &component);
    }
    file->channels = array_create(count > 0 ? count : 1, sizeof *file->channels);
    return file->channels != NULL
               ? 0
               : error_memory(err, count * sizeof *file->channels, "the channels of a file");
}

/* Finds a channel by its number, to set its mask or title; the channels are sorted. */
static struct channel *channel_of(const struct gwy_file *file, unsigned long number) {
    const struct channel key = {.number = number};
    return bsearch(&key, file->channels, file->count, sizeof key, by_number);
}

static void take_channel(struct gwy_file *file, const struct gwy_component *component) {
    unsigned long number;
    if (is_field(component) && is_key(component->name, "/data", &number))
        file->channels[file->count++] =
            (struct channel){.number = number, .data = component->value};
}

static void take_rest(struct gwy_file *file, const struct gwy_component *component) {
    unsigned long number;
    struct channel *channel;
    if (is_field(component) && is_key(component->name, "/mask", &number) &&
        (channel = channel_of(file, number)) != NULL)
        channel->mask = component->value;
    if (component->type == 's' && is_key(component->name, "/data/title", &number) &&
        (channel = channel_of(file, number)) != NULL)
        channel->title = component->value.at;
}

static int each_component(struct gwy_file *file, struct gwy_span rest,
                          void (*take)(struct gwy_file *, const struct gwy_component *),
                          struct error *err) {
    while (rest.size > 0) {
        struct gwy_component component;
        int status = gwy_next(&rest, &component, err);
        if (status != 0)
            return status;
        take(file, &component);
    }
    return 0;
}

static int find_channels(struct gwy_file *file, struct gwy_span content, struct error *err) {
    int status = count_channels(file, content, err);
    if (status == 0)
        status = each_component(file, content, take_channel, err);
    if (status != 0)
        return status;
    qsort(file->channels, file->count, sizeof *file->channels, by_number);
    for (size_t c = 1; c < file->count; c++)
        if (file->channels[c].number == file->channels[c - 1].number)
            return error_set(err, ERROR_INPUT, "channel /%lu is there twice",
                             file->channels[c].number);
    return each_component(file, content, take_rest, err);
}

static int read_z_units(const struct gwy_file *file, struct layer *layers, struct error *err) {
    int status = 0;
    for (size_t c = 0; c < file->count && status == 0; c++) {
        status = gwy_unit_read(file->channels[c].data, "si_unit_z", &layers[c].z_unit, err);
        layers[c].title = file->channels[c].title;
    }
    return status;
}

static int choose_channel(const struct gwy_file *file, const struct instrument_request *request,
                          size_t *out, struct error *err) {
    char others[100] = "";
    struct layer *layers = array_create(file->count > 0 ? file->count : 1, sizeof *layers);
    if (layers == NULL)
        return error_memory(err, file->count * sizeof *layers, "the channels of a file");
    if (file->graphs + file->spectra + file->volumes + file->clouds > 0)
        snprintf(others, sizeof others,
                 "; not read: %zu graphs, %zu spectra, %zu volumes, %zu point clouds", file->graphs,
                 file->spectra, file->volumes, file->clouds);
    int status = read_z_units(file, layers, err);
    if (status == 0)
        status = layer_choose(layers, file->count, request->layer, others, out, request->layer_read,
                              err);
    free(layers);
    return status;
}

/* Gwyddion writes units without prefixes and reads them so. A unit with a prefix is from another
 * program, whose numbers may or may not include it. */
static int keep_unit(char kept[UNIT_ROOM], const char *name, struct error *err) {
    double metres;
    unit_keep(kept, name, &metres);
    if (metres == 1)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "the unit '%.20s' has a prefix; allowed: units without, as m", name);
}

static int fill_heights(double *z, const struct gwy_field *field, struct error *err) {
    for (size_t point = 0; point < grid_points(&field->grid); point++) {
        z[point] = little_double(field->numbers + 8 * point);
        if (isinf(z[point]))
            return error_set(err, ERROR_INPUT,
                             "the height in row %zu, column %zu is infinite; allowed: numbers, and "
                             "nan for holes",
                             point / field->grid.nx + 1, point % field->grid.nx + 1);
    }
    return 0;
}

/* Makes holes where the mask is above 0. */
static int apply_mask(double *z, const struct grid *grid, struct gwy_span object,
                      struct error *err) {
    struct gwy_field mask;
    int status = gwy_field_read(object, &mask, err);
    if (status == 0 && (mask.grid.nx != grid->nx || mask.grid.ny != grid->ny))
        status = error_set(err, ERROR_INPUT, "%zu x %zu points; allowed: as the channel, %zu x %zu",
                           mask.grid.nx, mask.grid.ny, grid->nx, grid->ny);
    if (status != 0)
        return error_context(err, "its mask");
    for (size_t point = 0; point < grid_points(grid); point++)
        if (little_double(mask.numbers + 8 * point) > 0)
            z[point] = NAN;
    return 0;
}

static int read_channel(struct height_map *map, const struct channel *channel, struct error *err) {
    struct gwy_field field;
    int status = gwy_field_read(channel->data, &field, err);
    if (status == 0)
        status = height_map_shape(map, field.grid.ny, field.grid.nx, 1, err);
    if (status == 0)
        status = grid_check(&field.grid, err);
    if (status == 0)
        status = keep_unit(map->xy_unit, field.xy_unit, err);
    if (status == 0)
        status = keep_unit(map->z_unit, field.z_unit, err);
    if (status != 0)
        return status;
    map->grid = field.grid;
    map->z = array_create(grid_points(&map->grid), sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, grid_points(&map->grid) * sizeof *map->z, "a height map");
    status = fill_heights(map->z, &field, err);
    if (status == 0 && channel->mask.at != NULL)
        status = apply_mask(map->z, &map->grid, channel->mask, err);
    if (status == 0)
        height_map_reverse_rows(map);
    return status;
}

static int read_file(struct gwy_file *file, struct height_map *map, const char *data, size_t size,
                     const struct instrument_request *request, struct error *err) {
    struct gwy_span rest = {data, data + 4, size - 4};
    struct gwy_component root = {0};
    size_t chosen;
    int status = gwy_object(&rest, &root, err);
    if (status == 0 && strcmp(root.kind, "GwyContainer") != 0)
        status = error_set(err, ERROR_INPUT, "the file holds a '%.40s'; allowed: a GwyContainer",
                           root.kind);
    if (status == 0)
        status = find_channels(file, root.value, err);
    if (status == 0)
        status = choose_channel(file, request, &chosen, err);
    if (status != 0)
        return status;
    status = read_channel(map, &file->channels[chosen], err);
    return status == 0 ? 0
                       : error_context(err, "channel %zu of %zu (/%lu)", chosen + 1, file->count,
                                       file->channels[chosen].number);
}

static int read_gwy(struct height_map *out, const char *data, size_t size,
                    const struct instrument_request *request, struct error *err) {
    struct gwy_file file = {0};
    struct height_map map = {0};
    if (size < 4 || memcmp(data, MAGIC, 4) != 0)
        return error_set(
            err, ERROR_INPUT, "this is no file of Gwyddion 2: it does not begin with %s%s", MAGIC,
            owns(data, size) ? " but with GWYO, of Gwyddion 1; save it anew there" : "");
    int status = read_file(&file, &map, data, size, request, err);
    free(file.channels);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

const struct instrument_format INSTRUMENT_GWY = {"gwy", "gwy", owns, read_gwy};
