#include "jobs/maps/map_preparation.h"
#include "core/instrument/instrument.h"
#include "core/map/height_map_file.h"
#include "schema/digest.h"
#include "schema/hex.h"
#include "schema/program.h"
#include <string.h>

static void note_file(struct preparation_record *record, const struct map_source *source,
                      const char *format, const char *done, const char *layer) {
    unsigned char digest[DIGEST_SIZE];
    char digits[2 * DIGEST_SIZE + 1];
    const char *slash = strrchr(source->name, '/');
    digest_bytes(source->data, source->size, digest);
    hex_print(digest, DIGEST_SIZE, digits);
    preparation_note(record, "file", "%s", slash != NULL ? slash + 1 : source->name);
    preparation_note(record, "bytes", "%zu", source->size);
    preparation_note(record, "sha256", "%s", digits);
    if (source->unpacked != NULL)
        preparation_note(record, "unpacked", "%s", source->unpacked);
    if (source->converted != NULL)
        preparation_note(record, "converted", "%s", source->converted);
    preparation_note(record, "format", "%s", format);
    if (layer != NULL)
        preparation_note(record, "layer", "%s", layer);
    if (*done != '\0')
        preparation_note(record, "columns", "%s", done);
}

static bool has_one_layer(const char *format) {
    enum height_map_format own = HEIGHT_MAP_NPY;
    while (own < HEIGHT_MAP_FORMATS && strcmp(format, HEIGHT_MAP_NAMES[own]) != 0)
        own++;
    return own < HEIGHT_MAP_FORMATS;
}

int map_source_read(struct height_map *out, struct preparation_record *record,
                    const struct map_source *source, struct error *err) {
    char done[INSTRUMENT_DONE] = "";
    char layer_read[INSTRUMENT_LAYER] = "";
    const struct instrument_request request = {source->layer, source->columns, done, layer_read};
    const bool other = source->content != NULL;
    const char *format = NULL, *layer = source->layer;
    int status = instrument_read(
        out, other ? source->content_name : source->name, other ? source->content : source->data,
        other ? source->content_size : source->size, 0, &request, &format, err);
    if (status != 0)
        return error_context(err, "%s", source->name);
    if (layer != NULL && has_one_layer(format)) {
        height_map_clear(out);
        return error_set(err, ERROR_INPUT,
                         "%s: a %s file has one layer, without a name, not '%.40s'", source->name,
                         format, layer);
    }
    if (record != NULL)
        note_file(record, source, format, done, *layer_read != '\0' ? layer_read : layer);
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
