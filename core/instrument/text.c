/* Text exports with headers: matrices of heights and lists of points, as Gwyddion, SPIP, Keyence's
 * programs and many others write them (README.md). */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/text_map.h"
#include "core/map/height_map_file.h"
#include <stdlib.h>
#include <string.h>

static bool owns(const char *data, size_t size) {
    static const char *const MARKS[] = {"\xff\xfe", "\xfe\xff"};
    for (size_t mark = 0; mark < 2; mark++)
        if (size >= 2 && memcmp(data, MARKS[mark], 2) == 0)
            return true;
    return text_blocks_own(data, size);
}

static int choose_block(const struct text_blocks *blocks, const char *asked, size_t *out,
                        struct error *err) {
    struct layer *layers = array_create(blocks->count, sizeof *layers);
    if (layers == NULL)
        return error_memory(err, blocks->count * sizeof *layers, "the blocks of a text");
    for (size_t b = 0; b < blocks->count; b++) {
        const struct text_header *header = &blocks->blocks[b].header;
        const char *scaled = header->numbers[TEXT_Z_SCALE].unit;
        layers[b] = (struct layer){*header->title != '\0' ? header->title : NULL,
                                   *scaled != '\0' ? scaled : header->z_unit};
    }
    int status = layer_choose(layers, blocks->count, asked, "", out, err);
    free(layers);
    return status;
}

/* Names of columns say that a block is a list of points, and so do three columns and a unit along x
 * where nothing says what a row of a matrix would be long. */
static bool is_list(const struct text_block *block, const struct text_table *table, bool points) {
    const struct text_quantity *numbers = block->header.numbers;
    bool matrix = false;
    for (int key = TEXT_COLUMNS; key <= TEXT_DY; key++)
        matrix = matrix || numbers[key].there;
    if (block->columns.named)
        return true;
    return table->columns == 3 && !matrix && (points || block->header.x_unit[0] != '\0');
}

static int read_block(struct height_map *map, const struct text_block *block, const char *end,
                      bool points, struct error *err) {
    const struct text_quantity *columns = &block->header.numbers[TEXT_COLUMNS];
    bool told = !block->columns.named && columns->there && columns->value > 1 &&
                columns->value < 2147483648.0;
    struct text_table table = {0};
    int status = text_table_read(&table, block, end, told ? (size_t)columns->value : 0, err);
    if (status == 0)
        status = is_list(block, &table, points) ? text_points_map(map, &table, block, err)
                                                : text_matrix_map(map, &table, &block->header, err);
    free(table.numbers);
    return status;
}

static int read_text(struct height_map *out, const char *data, size_t size, const char *layer,
                     bool points, struct error *err) {
    struct text_file file = {0};
    struct text_blocks blocks = {0};
    struct height_map map = {0};
    size_t chosen;
    int status = text_file_open(&file, data, size, err);
    if (status == 0)
        status = text_blocks_find(&blocks, &file, err);
    if (status == 0)
        status = choose_block(&blocks, layer, &chosen, err);
    if (status == 0)
        status = read_block(&map, &blocks.blocks[chosen], file.text + file.size, points, err);
    text_blocks_clear(&blocks);
    text_file_close(&file);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

static int read_export(struct height_map *out, const char *data, size_t size,
                       const struct instrument_request *request, struct error *err) {
    return read_text(out, data, size, request->layer, false, err);
}

/* A plain list in the program's own order is read as such, bit for bit. */
static int read_points(struct height_map *out, const char *data, size_t size,
                       const struct instrument_request *request, struct error *err) {
    struct error why;
    if (request->layer == NULL && !owns(data, size)) {
        int status = height_map_parse(out, HEIGHT_MAP_XYZ, data, size, 0, &why);
        if (status == ERROR_MEMORY)
            return error_set(err, ERROR_MEMORY, "%s", why.text);
        if (status == 0)
            return 0;
    }
    return read_text(out, data, size, request->layer, true, err);
}

const struct instrument_format INSTRUMENT_TEXT = {"text", "", owns, read_export};
const struct instrument_format INSTRUMENT_POINTS = {"xyz", "xyz", NULL, read_points};
