#include "server/command/map/map_file.h"
#include "jobs/maps/map_preparation.h"
#include "server/command/input_file.h"
#include <stdlib.h>

static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

static const char *name_of(const char *path, const struct map_options *options) {
    return options->name != NULL ? options->name : path;
}

static int read_layer(struct height_map *out, const char *path, const struct map_options *options,
                      struct preparation_record *record, struct error *err) {
    char *text = NULL;
    size_t size;
    int status = input_file_read(path, FILE_MOST, &text, &size, err);
    if (status == 0)
        status =
            map_layer_read(out, record, name_of(path, options), text, size, options->layer, err);
    free(text);
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
