/* Curves as one table for spreadsheets and plotting programs. */
#include "schema/json/wire_field.h"
#include "worker/aggregate.h"

#include "core/memory_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THEORIES_MOST = 16 };

/* Theories found in any curve of the document: a column each. Borrowed. */
struct theories {
    size_t count;
    const char *names[THEORIES_MOST];
};

static void theories_collect(struct theories *theories, const cJSON *document) {
    const cJSON *one, *curve, *theory;
    cJSON_ArrayForEach(one, field_at(document, "cases")) {
        cJSON_ArrayForEach(curve, field_at(one, "curves")) {
            cJSON_ArrayForEach(theory, field_at(curve, "theory")) {
                size_t n = 0;
                while (n < theories->count && strcmp(theories->names[n], theory->string) != 0) {
                    n++;
                }
                if (n == theories->count && n < THEORIES_MOST) {
                    theories->names[theories->count++] = theory->string;
                }
            }
        }
    }
}

/* Quoted where RFC 4180 asks for it. */
static void put_text(FILE *file, const char *text) {
    if (!strpbrk(text, ",\"\r\n")) {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"') {
            fputc('"', file);
        }
        fputc(*text, file);
    }
    fputc('"', file);
}

/* The fewest digits that read back to the same double; nothing for what is no number. */
static void put_number(FILE *file, const cJSON *number) {
    char text[32];
    if (!cJSON_IsNumber(number)) {
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number->valuedouble);
        if (strtod(text, NULL) == number->valuedouble) {
            break;
        }
    }
    fputs(text, file);
}

static void put_value(FILE *file, const cJSON *value) {
    if (cJSON_IsString(value)) {
        put_text(file, value->valuestring);
    } else {
        put_number(file, value);
    }
}

/* A walk along an array; cJSON's arrays are lists. */
static const cJSON *first(const cJSON *array) {
    return array ? array->child : NULL;
}

static const cJSON *next(const cJSON *item) {
    return item ? item->next : NULL;
}

/* Places in the columns of one curve (or of one row of a matrix). */
enum { VALUES = 5 };
static const char *const VALUE_KEYS[VALUES] = {"y", "standard_error", "discretisation_error",
                                               "model_error", "valueless"};
struct place {
    const cJSON *value[VALUES], *theory[THEORIES_MOST];
};

static struct place place_begin(const cJSON *curve, const struct theories *theories) {
    struct place place;
    for (size_t n = 0; n < VALUES; n++) {
        place.value[n] = first(field_at(curve, VALUE_KEYS[n]));
    }
    for (size_t n = 0; n < theories->count; n++) {
        place.theory[n] = first(field_at(field_at(curve, "theory"), theories->names[n]));
    }
    return place;
}

static struct place place_inner(const struct place *row, size_t theories) {
    struct place place;
    for (size_t n = 0; n < VALUES; n++) {
        place.value[n] = first(row->value[n]);
    }
    for (size_t n = 0; n < theories; n++) {
        place.theory[n] = first(row->theory[n]);
    }
    return place;
}

static void place_next(struct place *place, size_t theories) {
    for (size_t n = 0; n < VALUES; n++) {
        place->value[n] = next(place->value[n]);
    }
    for (size_t n = 0; n < theories; n++) {
        place->theory[n] = next(place->theory[n]);
    }
}

/* One line: the curve, its point (x2 NULL but in a matrix), its values. */
static void put_line(FILE *file, const cJSON *number, const cJSON *curve, const cJSON *x,
                     const cJSON *x2, const struct place *place, size_t theories) {
    static const char *const labels[] = {"quantity",   "series", "model",
                                         "kinematics", "level",  "pressure"};
    put_number(file, number);
    for (size_t n = 0; n < sizeof labels / sizeof *labels; n++) {
        fputc(',', file);
        put_value(file, field_at(curve, labels[n]));
    }
    fputc(',', file);
    put_number(file, x);
    fputc(',', file);
    put_number(file, x2);
    for (size_t n = 0; n < VALUES; n++) {
        fputc(',', file);
        put_number(file, place->value[n]);
    }
    for (size_t n = 0; n < theories; n++) {
        fputc(',', file);
        put_number(file, place->theory[n]);
    }
    fputs("\r\n", file);
}

static void put_curve(FILE *file, const cJSON *number, const cJSON *curve,
                      const struct theories *theories) {
    struct place place = place_begin(curve, theories);
    const cJSON *x = first(field_at(curve, "x"));
    for (; x; x = next(x), place_next(&place, theories->count)) {
        if (!cJSON_IsArray(place.value[0])) {
            put_line(file, number, curve, x, NULL, &place, theories->count);
            continue;
        }
        struct place inner = place_inner(&place, theories->count);
        const cJSON *x2 = first(field_at(curve, "x2"));
        for (; x2; x2 = next(x2), place_next(&inner, theories->count)) {
            put_line(file, number, curve, x, x2, &inner, theories->count);
        }
    }
}

int aggregate_csv(const cJSON *curves, char **out, struct error *err) {
    struct theories theories = {0};
    const cJSON *one, *curve;
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return error_set(err, ERROR_MEMORY, "no memory left for a table");
    FILE *file = memory.file;
    theories_collect(&theories, curves);
    fputs("case,quantity,series,model,kinematics,level,pressure,x,x2", file);
    for (size_t n = 0; n < VALUES; n++) {
        fprintf(file, ",%s", VALUE_KEYS[n]);
    }
    for (size_t n = 0; n < theories.count; n++) {
        fprintf(file, ",theory_%s", theories.names[n]);
    }
    fputs("\r\n", file);
    cJSON_ArrayForEach(one, field_at(curves, "cases")) {
        cJSON_ArrayForEach(curve, field_at(one, "curves")) {
            put_curve(file, field_at(one, "case"), curve, &theories);
        }
    }
    char *text = memory_file_close(&memory, NULL);
    if (text == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for a table");
    *out = text;
    return 0;
}
