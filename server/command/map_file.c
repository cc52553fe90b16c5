#include "server/command/map_file.h"
#include "server/command/command.h"
#include <stdlib.h>

static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

int map_file_read(struct height_map *out, const char *path, double dx, struct error *err) {
    char *text = NULL;
    size_t size;
    int status = file_read(path, FILE_MOST, &text, &size, err);
    if (status != 0)
        return status;
    enum height_map_format format = height_map_format_of(path);
    if (format == HEIGHT_MAP_FORMATS)
        format = size > 0 && text[0] == '\x93' ? HEIGHT_MAP_NPY : HEIGHT_MAP_CSV;
    status = height_map_parse(out, format, text, size, dx, err);
    free(text);
    return status == 0 ? 0 : error_context(err, "%s", path);
}
