/* The main.xml of X3P files, and the points behind a NUL, without the archive around them: what is
 * read is a map whose heights are finite or holes. */
#include "core/instrument/archive/x3p_points.h"
#include "core/surface/grid.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

struct reader {
    struct x3p_layout layout;
    struct x3p_points *points;
    size_t most;
};

static int begin(struct reader *reader, const struct x3p_fields *fields, struct error *err) {
    int status = x3p_layout_read(&reader->layout, fields, reader->most, err);
    if (status == 0)
        status =
            x3p_points_create(&reader->points, &reader->layout, reader->layout.layers - 1, err);
    return status;
}

static int take(void *context, const struct x3p_fields *fields, const char *text,
                struct error *err) {
    struct reader *reader = context;
    int status = reader->points == NULL ? begin(reader, fields, err) : 0;
    return status == 0 ? x3p_points_take_text(reader->points, text, err) : status;
}

/* In two parts, as an archive hands it on. */
static int read_xml(struct reader *reader, struct x3p_fields *fields, const char *text, size_t size,
                    struct error *err) {
    struct x3p_xml *xml = NULL;
    int status = x3p_xml_create(&xml, fields, take, reader, err);
    if (status == 0)
        status = x3p_xml_feed(xml, text, size / 2, false, err);
    if (status == 0)
        status = x3p_xml_feed(xml, text + size / 2, size - size / 2, true, err);
    x3p_xml_destroy(&xml);
    return status;
}

/* A quarter of what stands behind main.xml is bits of valid points. */
static int read_binary(struct reader *reader, const struct x3p_fields *fields, const char *data,
                       size_t size, struct error *err) {
    size_t bits = *fields->text[X3P_VALID_LINK] != '\0' ? size / 4 : 0;
    int status = reader->points == NULL ? begin(reader, fields, err) : 0;
    if (status == 0)
        status = x3p_points_take_binary(reader->points, data + bits, size - bits, err);
    if (status == 0 && bits > 0)
        status = x3p_points_take_valid(reader->points, data, bits, err);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = text_of(data, size);
    size_t length = strlen(text), rest = length < size ? size - length - 1 : 0;
    struct reader reader = {.most = size};
    struct x3p_fields fields;
    struct height_map map = {0};
    struct error err = {0};
    int status = read_xml(&reader, &fields, text, length, &err);
    if (status == 0 && (rest > 0 || reader.points == NULL))
        status = read_binary(&reader, &fields, text + size - rest, rest, &err);
    if (status == 0)
        status = x3p_points_map(reader.points, &map, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0 && map.z == NULL));
    if (status == 0) {
        MUST(grid_check(&map.grid, &err) == 0);
        for (size_t point = 0; point < grid_points(&map.grid); point++)
            MUST(!isinf(map.z[point]));
    }
    x3p_points_destroy(&reader.points);
    height_map_clear(&map);
    free(text);
    return 0;
}
