/* Options of a map's preparation: any words are refused, or lead to a map that is whole where it
 * says so, or to a refusal. */
#include "core/map/preparation/preparation_words.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WORDS = 10,
    NX = 30,
    NY = 26,
};

/* Cuts a line off the text; NULL where it is empty. */
static const char *cut(char **text) {
    char *line = *text, *end = strchr(line, '\n');
    *text = end != NULL ? end + 1 : line + strlen(line);
    if (end != NULL)
        *end = '\0';
    return *line != '\0' ? line : NULL;
}

static void prepare(const struct preparation *asked, bool holes) {
    struct height_map map = {.grid = {NX, NY, NX, NY}};
    struct preparation_record record = {0};
    struct error err = {0};
    map.z = array_create((size_t)NX * NY, sizeof *map.z);
    MUST(map.z != NULL);
    for (size_t point = 0; point < (size_t)NX * NY; point++)
        map.z[point] = holes && point % 7 == 3 ? (double)NAN : sin(0.37 * (double)(point * point));
    int status = preparation_run(&record, &map, asked, &err);
    MUST(status == 0 || *err.text != 0);
    if (status == 0) {
        MUST(grid_check(&map.grid, &err) == 0);
        MUST(record.count <= PREPARATION_STEPS_MOST);
        MUST(!asked->fill || height_map_holes(&map) == 0);
    }
    height_map_clear(&map);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0)
        return 0;
    const unsigned choices = data[0];
    char *text = text_of(data + 1, size - 1), *at = text;
    struct preparation_words words = {.boundary = (int)(choices % 3),
                                      .detrend = (int)(choices / 3 % 5),
                                      .window = (int)(choices / 15 % 3),
                                      .fill = choices / 45 % 2 == 1};
    struct preparation asked;
    struct error err = {0};
    const char **const lines[WORDS] = {&words.dx,     &words.unit,     &words.z_unit,  &words.crop,
                                       &words.filter, &words.resample, &words.despike, &words.tip,
                                       &words.rotate, &words.missing};
    for (size_t w = 0; w < WORDS; w++)
        *lines[w] = cut(&at);
    const unsigned char letter = (unsigned char)*at; /* more choices; 0: none of them */
    words.lines = letter % 5;
    words.lines_along = letter / 5 % 2;
    words.transpose = letter / 10 % 2 == 1;
    words.denoise = letter / 40 % 2 == 1;
    words.degroove = letter / 80 % 2 == 1;
    words.extend = letter / 80 % 2 == 1 ? "3" : NULL;
    words.stride = letter / 20 % 2 == 1 ? "2,1" : NULL;
    int status = preparation_parse(&asked, &words, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0));
    /* New points by their number are as many as asked for, which takes time and nothing else. */
    if (status == 0 && asked.resample_x <= 256 && asked.resample_y <= 256 &&
        asked.resample_dx.value == 0)
        prepare(&asked, choices / 90 % 2 == 1);
    free(text);
    return 0;
}
