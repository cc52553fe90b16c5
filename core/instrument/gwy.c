/* Gwyddion's own format, GWY: the channels of a file by number or title, a channel's mask as its
 * holes. Graphs, spectra, volumes and point clouds are named where a layer is missed, and not read.
 */
#include "core/instrument/formats.h"
#include "core/instrument/gwy_field.h"
#include "core/instrument/layers.h"
#include "core/instrument/little_endian.h"
#include "core/instrument/unit_of.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

/* Whether a name is "/NUMBER" and then this ending. */
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

/* The first pass: counts the channels, which may stand in any order, and what is no channel. */
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

/* Where the mask or the title of a channel stands, by its number; the channels are sorted. */
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

static int choose_channel(const struct gwy_file *file, const char *asked, size_t *out,
                          struct error *err) {
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
        status = layer_choose(layers, file->count, asked, others, out, err);
    free(layers);
    return status;
}

/* Gwyddion writes units without prefixes and takes them so: a prefix says that another program
 * wrote the file, and not whether its numbers follow it. */
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
    return status == 0 && channel->mask.at != NULL
               ? apply_mask(map->z, &map->grid, channel->mask, err)
               : status;
}

static int read_file(struct gwy_file *file, struct height_map *map, const char *data, size_t size,
                     const char *asked, struct error *err) {
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
        status = choose_channel(file, asked, &chosen, err);
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
    int status = read_file(&file, &map, data, size, request->layer, err);
    free(file.channels);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

const struct instrument_format INSTRUMENT_GWY = {"gwy", "gwy", owns, read_gwy};
