#include "jobs/maps/map_preparation.h"
#include "core/instrument/instrument.h"
#include "core/map/height_map_file.h"
#include "schema/digest.h"
#include "schema/hex.h"
#include "schema/program.h"
#include <string.h>

static void note_file(struct preparation_record *record, const char *name, const char *data,
                      size_t size, const char *format) {
    unsigned char digest[DIGEST_SIZE];
    char digits[2 * DIGEST_SIZE + 1];
    const char *slash = strrchr(name, '/');
    digest_bytes(data, size, digest);
    hex_print(digest, DIGEST_SIZE, digits);
    preparation_note(record, "file", "%s", slash != NULL ? slash + 1 : name);
    preparation_note(record, "bytes", "%zu", size);
    preparation_note(record, "sha256", "%s", digits);
    preparation_note(record, "format", "%s", format);
}

static bool has_one_layer(const char *format) {
    enum height_map_format own = HEIGHT_MAP_NPY;
    while (own < HEIGHT_MAP_FORMATS && strcmp(format, HEIGHT_MAP_NAMES[own]) != 0)
        own++;
    return own < HEIGHT_MAP_FORMATS;
}

int map_layer_read(struct height_map *out, struct preparation_record *record, const char *name,
                   const char *data, size_t size, const char *layer, struct error *err) {
    const struct instrument_request request = {.layer = layer};
    const char *format = NULL;
    int status = instrument_read(out, name, data, size, 0, &request, &format, err);
    if (status != 0)
        return error_context(err, "%s", name);
    if (layer != NULL && has_one_layer(format)) {
        height_map_clear(out);
        return error_set(err, ERROR_INPUT,
                         "%s: a %s file has one layer, without a name, not '%.40s'", name, format,
                         layer);
    }
    if (record == NULL)
        return 0;
    note_file(record, name, data, size, format);
    if (layer != NULL)
        preparation_note(record, "layer", "%s", layer);
    return 0;
}

int map_prepare(struct height_map *map, struct preparation_record *record, const char *name,
                const struct preparation *asked, struct error *err) {
    char program[PROGRAM_SIZE];
    int status = preparation_run(record, map, asked, err);
    if (status != 0) {
        height_map_clear(map);
        return error_context(err, "%s", name);
    }
    program_write(program);
    preparation_note(record, "program", "rugo %s", program);
    return 0;
}
