#include "core/instrument/word_reader.h"
#include <math.h>

static bool is_between(char c) {
    return text_is_blank(c) || c == '\n';
}

struct word_reader word_reader_of(const char *text, size_t size) {
    return (struct word_reader){.at = text, .end = text + size, .line = 1, .dialect = {' ', '\0'}};
}

struct text_field word_next(struct word_reader *reader) {
    while (reader->at < reader->end && is_between(*reader->at)) {
        reader->line += *reader->at == '\n' ? 1 : 0;
        reader->at++;
    }
    struct text_field word = {reader->at, reader->at, false};
    while (word.end < reader->end && !is_between(*word.end))
        word.end++;
    reader->at = word.end;
    word.last = word.end == reader->end;
    return word;
}

static int refuse(const struct word_reader *reader, const struct text_field *word, const char *what,
                  const char *allowed, struct error *err) {
    if (word->at == word->end)
        return error_set(err, ERROR_INPUT, "the file ends before %s", what);
    return error_set(err, ERROR_INPUT, "line %zu: %s is '%.*s'; allowed: %s", reader->line, what,
                     word->end - word->at < 40 ? (int)(word->end - word->at) : 40, word->at,
                     allowed);
}

int word_number(struct word_reader *reader, const char *what, bool holes, double *out,
                struct error *err) {
    struct text_field word = word_next(reader);
    enum text_value value = text_value_of(&word, &reader->dialect, out);
    if (value == TEXT_NUMBER || (value == TEXT_HOLE && holes && word.at < word.end))
        return 0;
    return refuse(reader, &word, what, holes ? "a number, and nan for a hole" : "a number", err);
}

int word_count(struct word_reader *reader, const char *what, size_t *out, struct error *err) {
    double count;
    struct text_field word = word_next(reader);
    if (text_value_of(&word, &reader->dialect, &count) != TEXT_NUMBER || !(count >= 1) ||
        !(count <= 2147483648.0) || count != floor(count))
        return refuse(reader, &word, what, "1 to 2147483648", err);
    *out = (size_t)count;
    return 0;
}

int word_heights(struct word_reader *reader, struct height_map *map, struct error *err) {
    size_t points = grid_points(&map->grid), rest = (size_t)(reader->end - reader->at);
    int status = 0;
    if (points > rest / 2 + 1) /* a height and what parts it from the next */
        return error_set(err, ERROR_INPUT,
                         "%zu x %zu points do not fit into %zu bytes; the file is cut off or its "
                         "counts are wrong",
                         map->grid.nx, map->grid.ny, rest);
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    for (size_t point = 0; point < points && status == 0; point++)
        status = word_number(reader, "a height", true, &map->z[point], err);
    if (status != 0)
        return status;
    struct text_field more = word_next(reader);
    if (more.at < more.end)
        return error_set(err, ERROR_INPUT,
                         "line %zu: more heights than the %zu x %zu of the header", reader->line,
                         map->grid.nx, map->grid.ny);
    return 0;
}
