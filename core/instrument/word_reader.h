/* The words of a text between blanks and ends of lines. Private to the readers of grids. */
#ifndef RUGO_CORE_INSTRUMENT_WORD_READER_H
#define RUGO_CORE_INSTRUMENT_WORD_READER_H

#include "core/instrument/text_number.h"
#include "core/map/height_map.h"

struct word_reader {
    const char *at, *end; /* borrowed: what is not read yet */
    size_t line;          /* of the last word, from 1 */
    struct text_dialect dialect;
};

struct word_reader word_reader_of(const char *text, size_t size);
/* The next word, of length 0 behind the last. */
struct text_field word_next(struct word_reader *reader);
/* The next word as a number; holes: a word for a hole is NaN, else it is refused. */
int word_number(struct word_reader *reader, const char *what, bool holes, double *out,
                struct error *err);
/* The next word as a count from 1 to 2^31. */
int word_count(struct word_reader *reader, const char *what, size_t *out, struct error *err);
/* The heights of a map whose shape is set, and then nothing: makes map->z. */
int word_heights(struct word_reader *reader, struct height_map *map, struct error *err);

#endif
