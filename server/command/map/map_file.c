#include "server/command/map/map_file.h"
#include "core/instrument/archive/gzip.h"
#include "core/instrument/instrument.h"
#include "jobs/maps/map_preparation.h"
#include "server/command/input_file.h"
#include "server/command/map/gwyddion.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

static const char *name_of(const char *path, const struct map_options *options) {
    return options->name != NULL ? options->name : path;
}

/* The file and what it was unpacked to and converted to. */
struct opened {
    struct map_source source;
    char *data, *unpacked, *name; /* owned */
    char step[64];
    struct gwyddion_file converted;
};

static void opened_clear(struct opened *opened) {
    free(opened->data);
    free(opened->unpacked);
    free(opened->name);
    gwyddion_file_clear(&opened->converted);
}

/* A name without the ending .gz is that of what was unpacked. */
static int unpack(struct opened *opened, struct error *err) {
    struct map_source *source = &opened->source;
    size_t length = strlen(source->name);
    if (length > 3 && strcasecmp(source->name + length - 3, ".gz") == 0)
        length -= 3;
    opened->name = strndup(source->name, length);
    if (opened->name == NULL)
        return error_memory(err, length, "a file's name");
    int status =
        gzip_unpack(&opened->unpacked, &source->content_size, source->data, source->size, err);
    if (status != 0)
        return status;
    snprintf(opened->step, sizeof opened->step, "by gzip, %zu bytes", source->content_size);
    source->content = opened->unpacked;
    source->content_name = opened->name;
    source->unpacked = opened->step;
    return 0;
}

/* Reads the seconds of --convert; none where it is not given. */
static int read_seconds(unsigned *out, const char *text, struct error *err) {
    char *end = NULL;
    unsigned long seconds = text != NULL ? strtoul(text, &end, 10) : 0;
    if (text != NULL &&
        (*text < '0' || *text > '9' || *end != '\0' || seconds > GWYDDION_SECONDS_MOST))
        return error_set(err, ERROR_INPUT, "--convert %.40s is not a number of seconds, 0 to %d",
                         text, GWYDDION_SECONDS_MOST);
    *out = (unsigned)seconds;
    return 0;
}

static int convert(struct opened *opened, unsigned seconds, struct error *err) {
    struct map_source *source = &opened->source;
    const bool unpacked = source->content != NULL;
    const char *name = unpacked ? source->content_name : source->name;
    const char *data = unpacked ? source->content : source->data;
    const size_t size = unpacked ? source->content_size : source->size;
    if (instrument_takes(name, data, size))
        return 0;
    int status = gwyddion_convert(&opened->converted, name, data, size, seconds, err);
    if (status != 0)
        return status;
    source->content = opened->converted.data;
    source->content_size = opened->converted.size;
    source->content_name = "converted.gwy";
    source->converted = opened->converted.step;
    return 0;
}

static int open_content(struct opened *opened, unsigned seconds, struct error *err) {
    int status = gzip_begins(opened->source.data, opened->source.size) ? unpack(opened, err) : 0;
    if (status == 0)
        status = convert(opened, seconds, err);
    return status == 0 ? 0 : error_context(err, "%s", opened->source.name);
}

static int read_file(struct opened *opened, const char *path, const struct sent_files *sent,
                     struct error *err) {
    size_t *size = &opened->source.size;
    return sent != NULL ? sent_files_read(sent, path, &opened->data, size, err)
                        : input_file_read(path, FILE_MOST, &opened->data, size, err);
}

static int read_layer(struct height_map *out, const char *path, const struct map_options *options,
                      struct preparation_record *record, struct error *err) {
    struct opened opened = {.source = {.name = name_of(path, options),
                                       .layer = options->layer,
                                       .columns = (enum instrument_columns)options->columns}};
    struct map_source *source = &opened.source;
    unsigned seconds = 0;
    int status = read_seconds(&seconds, options->convert, err);
    if (status == 0)
        status = read_file(&opened, path, options->sent, err);
    source->data = opened.data;
    if (status == 0)
        status = open_content(&opened, seconds, err);
    if (status == 0)
        status = map_source_read(out, record, source, err);
    opened_clear(&opened);
    return status;
}

int map_file_read(struct height_map *out, const char *path, struct error *err) {
    return read_layer(out, path, &(struct map_options){0}, NULL, err);
}

static int read_prepared(struct height_map *map, struct preparation_record *record,
                         const char *path, const struct map_options *options, bool artefacts,
                         struct error *err) {
    struct preparation asked;
    struct height_map read = {0};
    int status = preparation_parse(&asked, &options->words, err);
    asked.artefacts = artefacts;
    if (status == 0)
        status = read_layer(&read, path, options, record, err);
    if (status == 0)
        status = map_prepare(&read, record, name_of(path, options), &asked, err);
    if (status == 0)
        *map = read;
    return status;
}

int map_options_read_any(struct height_map *map, struct preparation_record *record,
                         const char *path, const struct map_options *options, struct error *err) {
    return read_prepared(map, record, path, options, false, err);
}

int map_options_read(struct height_map *map, struct preparation_record *record, const char *path,
                     const struct map_options *options, struct error *err) {
    int status = read_prepared(map, record, path, options, true, err);
    if (status != 0)
        return status;
    status = height_map_check_units(map, err);
    if (status == 0)
        return 0;
    height_map_clear(map);
    return error_context(err, "%s", name_of(path, options));
}
