#include "server/command/map/map_file.h"
#include "core/instrument/archive/gzip.h"
#include "jobs/maps/map_preparation.h"
#include "server/command/input_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

static const char *name_of(const char *path, const struct map_options *options) {
    return options->name != NULL ? options->name : path;
}

/* The file and what was unpacked of it, whose memory is the struct's. */
struct opened {
    struct map_source source;
    char *data, *content, *name, step[PREPARATION_TEXT];
};

/* A name without the ending .gz, for the format of what was unpacked. */
static int unpack(struct opened *opened, struct error *err) {
    struct map_source *source = &opened->source;
    size_t length = strlen(source->name);
    if (length > 3 && strcasecmp(source->name + length - 3, ".gz") == 0)
        length -= 3;
    opened->name = strndup(source->name, length);
    if (opened->name == NULL)
        return error_memory(err, length, "a file's name");
    int status =
        gzip_unpack(&opened->content, &source->content_size, source->data, source->size, err);
    if (status != 0)
        return error_context(err, "%s", source->name);
    snprintf(opened->step, sizeof opened->step, "by gzip, %zu bytes", source->content_size);
    source->content = opened->content;
    source->content_name = opened->name;
    source->step = "unpacked";
    source->step_text = opened->step;
    return 0;
}

static int read_layer(struct height_map *out, const char *path, const struct map_options *options,
                      struct preparation_record *record, struct error *err) {
    struct opened opened = {.source = {.name = name_of(path, options),
                                       .layer = options->layer,
                                       .columns = (enum instrument_columns)options->columns}};
    struct map_source *source = &opened.source;
    int status = input_file_read(path, FILE_MOST, &opened.data, &source->size, err);
    source->data = opened.data;
    if (status == 0 && gzip_begins(source->data, source->size))
        status = unpack(&opened, err);
    if (status == 0)
        status = map_source_read(out, record, source, err);
    free(opened.data);
    free(opened.content);
    free(opened.name);
    return status;
}

int map_file_read(struct height_map *out, const char *path, struct error *err) {
    return read_layer(out, path, &(struct map_options){0}, NULL, err);
}

int map_options_read_any(struct height_map *map, struct preparation_record *record,
                         const char *path, const struct map_options *options, struct error *err) {
    struct preparation asked;
    struct height_map read = {0};
    int status = preparation_parse(&asked, &options->words, err);
    if (status == 0)
        status = read_layer(&read, path, options, record, err);
    if (status == 0)
        status = map_prepare(&read, record, name_of(path, options), &asked, err);
    if (status == 0)
        *map = read;
    return status;
}

int map_options_read(struct height_map *map, struct preparation_record *record, const char *path,
                     const struct map_options *options, struct error *err) {
    int status = map_options_read_any(map, record, path, options, err);
    if (status != 0)
        return status;
    status = height_map_check_units(map, err);
    if (status == 0)
        return 0;
    height_map_clear(map);
    return error_context(err, "%s", name_of(path, options));
}
