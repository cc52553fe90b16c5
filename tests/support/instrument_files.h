/* Files of instruments in tests: fixtures of the tree, and bytes made by the test, each read from
 * memory of its own size, so that sanitizers see a read behind its end. */
#ifndef RUGO_TESTS_SUPPORT_INSTRUMENT_FILES_H
#define RUGO_TESTS_SUPPORT_INSTRUMENT_FILES_H

#include "core/instrument/instrument.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct bytes {
    char *data; /* owned; 0 behind it */
    size_t size;
};

static inline struct bytes bytes_of(const void *data, size_t size) {
    struct bytes copy = {malloc(size + 1), size};
    assert_non_null(copy.data);
    if (size > 0)
        memcpy(copy.data, data, size);
    copy.data[size] = '\0';
    return copy;
}

static inline struct bytes bytes_of_text(const char *text) {
    return bytes_of(text, strlen(text));
}

/* The fixture of this name; RUGO_SOURCE says where the tree is when that is not the folder. */
static inline struct bytes bytes_of_fixture(const char *name) {
    char path[512];
    static char room[1 << 16];
    const char *source = getenv("RUGO_SOURCE");
    snprintf(path, sizeof path, "%s/tests/fixtures/instrument/%s", source != NULL ? source : ".",
             name);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        fail_msg("%s is not there", path);
    size_t size = fread(room, 1, sizeof room, file);
    assert_true(size > 0 && size < sizeof room);
    fclose(file);
    return bytes_of(room, size);
}

/* A change of a file: `with` is put so many bytes behind each position where `mark` begins. */
struct damage {
    const char *mark;
    size_t length; /* of the mark */
    size_t behind;
    const void *with; /* borrowed */
    size_t size;
    const char *words; /* that the refusal has */
};

static inline void bytes_damage(struct bytes *bytes, const struct damage *damage) {
    size_t places = 0;
    for (size_t at = 0; at + damage->behind + damage->size <= bytes->size; at++)
        if (at + damage->length <= bytes->size &&
            memcmp(bytes->data + at, damage->mark, damage->length) == 0) {
            memcpy(bytes->data + at + damage->behind, damage->with, damage->size);
            places++;
        }
    if (places == 0)
        fail_msg("'%s' is not in the file that is changed", damage->mark);
}

/* Takes the bytes: reads them under this name and frees them. */
static inline int bytes_read(struct bytes bytes, const char *name, const char *layer,
                             struct height_map *map, struct error *err) {
    const struct instrument_request request = {.layer = layer};
    *map = (struct height_map){0};
    *err = (struct error){0};
    int status = instrument_read(map, name, bytes.data, bytes.size, 0, &request, NULL, err);
    free(bytes.data);
    return status;
}

static inline struct height_map bytes_map(struct bytes bytes, const char *name, const char *layer) {
    struct height_map map;
    struct error err;
    if (bytes_read(bytes, name, layer, &map, &err) != 0)
        fail_msg("%s: %s", name, err.text);
    return map;
}

/* Takes the bytes: they must be refused with words among which these are, and leave no map. */
static inline void bytes_refused(struct bytes bytes, const char *name, const char *layer,
                                 const char *words) {
    struct height_map map;
    struct error err;
    int status = bytes_read(bytes, name, layer, &map, &err);
    if (status != ERROR_INPUT || map.z != NULL || strstr(err.text, words) == NULL)
        fail_msg("%s: status %d, '%s', not '%s'", name, status, err.text, words);
}

/* Takes the bytes: of this layer, NULL for none, the reader must say so much. */
static inline void expect_layer(struct bytes bytes, const char *layer, const char *said) {
    char read[INSTRUMENT_LAYER] = "?";
    const struct instrument_request request = {.layer = layer, .layer_read = read};
    struct height_map map = {0};
    struct error err = {0};
    if (instrument_read(&map, "a.txt", bytes.data, bytes.size, 0, &request, NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_string_equal(read, said);
    height_map_clear(&map);
    free(bytes.data);
}

/* A small file cut at every byte, and with each byte changed: an error, of most of these, or a map
 * that check takes and may clear. */
static inline void expect_damage_told(const char *name, const char *file, size_t size,
                                      void (*check)(struct height_map *map)) {
    size_t refused = 0;
    for (size_t at = 0; at < 2 * size; at++) {
        struct height_map map = {0};
        struct error err = {0};
        struct bytes copy = bytes_of(file, at < size ? at : size);
        if (at >= size)
            copy.data[at - size] = (char)(copy.data[at - size] ^ 0x41);
        int status = instrument_read(&map, name, copy.data, copy.size, 0,
                                     &(struct instrument_request){0}, NULL, &err);
        assert_true(status == 0 || (status == ERROR_INPUT && *err.text != 0));
        assert_true(status != 0 || at >= size);
        refused += status != 0 ? 1 : 0;
        if (status == 0)
            check(&map);
        height_map_clear(&map);
        free(copy.data);
    }
    assert_true(refused > size + size / 2);
}

/* The heights of the fixtures in metres (tests/fixtures/instrument/README.md). */
static inline double fixture_height(size_t i, size_t j) {
    double x = (double)i, y = (double)j;
    return 1e-9 * (x * x - 3 * y + 0.25 * x * y);
}

/* The map must be the 7 x 5 heights of the fixtures, within so much; holes are left out and
 * counted. */
static inline size_t check_fixture_map(const struct height_map *map, double tolerance) {
    size_t holes = 0;
    assert_int_equal(map->grid.nx, 7);
    assert_int_equal(map->grid.ny, 5);
    assert_true(fabs(map->grid.lx - 7e-6) <= 1e-12 && fabs(map->grid.ly - 2.5e-6) <= 1e-12);
    assert_string_equal(map->xy_unit, "m");
    assert_string_equal(map->z_unit, "m");
    for (size_t j = 0; j < 5; j++)
        for (size_t i = 0; i < 7; i++) {
            double z = map->z[j * 7 + i];
            if (isnan(z))
                holes++;
            else if (!(fabs(z - fixture_height(i, j)) <= tolerance))
                fail_msg("column %zu, row %zu: %.17g, not %.17g", i, j, z, fixture_height(i, j));
        }
    return holes;
}

#endif
