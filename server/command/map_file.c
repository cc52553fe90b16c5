#include "server/command/map_file.h"
#include "core/instrument/instrument.h"
#include "schema/digest.h"
#include "schema/hex.h"
#include "schema/program.h"
#include "server/command/input_file.h"
#include <stdlib.h>
#include <string.h>

static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

static int read_layer(struct height_map *out, const char *path, const struct map_options *options,
                      const char **format, struct preparation_record *record, struct error *err) {
    const char *name = options->name != NULL ? options->name : path;
    unsigned char digest[DIGEST_SIZE];
    char *text = NULL, digits[2 * DIGEST_SIZE + 1];
    size_t size;
    int status = input_file_read(path, FILE_MOST, &text, &size, err);
    if (status != 0)
        return status;
    const struct instrument_request request = {.layer = options->layer};
    status = instrument_read(out, name, text, size, 0, &request, format, err);
    if (status == 0 && record != NULL) {
        digest_bytes(text, size, digest);
        hex_print(digest, DIGEST_SIZE, digits);
        const char *slash = strrchr(name, '/');
        preparation_note(record, "file", "%s", slash != NULL ? slash + 1 : name);
        preparation_note(record, "bytes", "%zu", size);
        preparation_note(record, "sha256", "%s", digits);
        preparation_note(record, "format", "%s", *format);
    }
    free(text);
    return status == 0 ? 0 : error_context(err, "%s", name);
}

int map_file_read(struct height_map *out, const char *path, struct error *err) {
    return read_layer(out, path, &(struct map_options){0}, NULL, NULL, err);
}

static bool has_one_layer(const char *format) {
    enum height_map_format own = HEIGHT_MAP_NPY;
    while (own < HEIGHT_MAP_FORMATS && strcmp(format, HEIGHT_MAP_NAMES[own]) != 0)
        own++;
    return own < HEIGHT_MAP_FORMATS;
}

int map_options_read_any(struct height_map *map, struct preparation_record *record,
                         const char *path, const struct map_options *options, struct error *err) {
    struct preparation asked;
    struct height_map read = {0};
    const char *format, *name = options->name != NULL ? options->name : path;
    char program[PROGRAM_SIZE];
    int status = preparation_parse(&asked, &options->words, err);
    if (status == 0)
        status = read_layer(&read, path, options, &format, record, err);
    if (status != 0)
        return status;
    if (options->layer != NULL && has_one_layer(format)) {
        height_map_clear(&read);
        return error_set(err, ERROR_INPUT,
                         "%s: a %s file has one layer, without a name, not '%.40s'", name, format,
                         options->layer);
    }
    if (options->layer != NULL)
        preparation_note(record, "layer", "%s", options->layer);
    status = preparation_run(record, &read, &asked, err);
    if (status != 0) {
        height_map_clear(&read);
        return error_context(err, "%s", name);
    }
    program_write(program);
    preparation_note(record, "program", "rugo %s", program);
    *map = read;
    return 0;
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
    return error_context(err, "%s", options->name != NULL ? options->name : path);
}
