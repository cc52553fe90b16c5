/* Prints numbers that read back to the same double. cJSON is content with 15 digits that come
 * within a relative 2^-52, which may be another double. */
#include "schema/json/json.h"

#include "core/file/memory_file.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Counts and numbers of jobs have 15 digits or fewer, which need no search. */
static bool is_short_integer(double number) {
    return fabs(number) < 1e15 && number == trunc(number) && !(number == 0 && signbit(number));
}

void json_print_number(FILE *file, double number) {
    char text[32];
    if (!isfinite(number)) {
        fputs("null", file);
        return;
    }
    if (is_short_integer(number)) {
        fprintf(file, "%lld", (long long)number);
        return;
    }
    bool large = fabs(number) > 0x1p53; /* not kept exactly by every reader: gets an exponent */
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, large ? "%.*e" : "%.*g", digits - large, number);
        if (strtod(text, NULL) == number)
            break;
    }
    fputs(text, file);
}

/* Returns whether the text can be printed in quotes without escapes. */
static bool is_plain(const char *text) {
    const unsigned char *at = (const unsigned char *)text;
    while (*at >= 0x20 && *at != '"' && *at != '\\')
        at++;
    return *at == '\0';
}

/* Prints through cJSON; returns false when out of memory. */
static bool put_by_cjson(FILE *file, const cJSON *value) {
    char *text = cJSON_PrintUnformatted(value);
    if (text != NULL)
        fputs(text, file);
    cJSON_free(text);
    return text != NULL;
}

/* Most strings are names. Printing them through cJSON would take longer than the rest of a
 * document. */
bool json_print_text(FILE *file, const char *text) {
    if (text != NULL && is_plain(text)) {
        fputc('"', file);
        fputs(text, file);
        fputc('"', file);
        return true;
    }
    cJSON *value = cJSON_CreateStringReference(text);
    bool done = value != NULL && put_by_cjson(file, value);
    cJSON_Delete(value);
    return done;
}

/* Prints strings, true, false and null; returns false when out of memory. */
static bool put_plain(FILE *file, const cJSON *value) {
    const char *text = cJSON_GetStringValue(value);
    return text != NULL ? json_print_text(file, text) : put_by_cjson(file, value);
}

/* This stands for the indentation of a text on one line. */
enum { COMPACT = -1 };

/* Starts a line that is indented by `depth` times two spaces; prints nothing in a text on one
 * line. */
static void put_line(FILE *file, int depth) {
    if (depth != COMPACT)
        fprintf(file, "\n%*s", 2 * depth, "");
}

static bool put_key(FILE *file, const char *key, int depth) {
    bool done = json_print_text(file, key);
    fputs(depth == COMPACT ? ":" : ": ", file);
    return done;
}

static bool put_value(FILE *file, const cJSON *value, int depth) {
    if (cJSON_IsNumber(value)) {
        json_print_number(file, value->valuedouble);
        return true;
    }
    bool object = cJSON_IsObject(value), done = true;
    if (!object && !cJSON_IsArray(value))
        return put_plain(file, value);
    int inside = depth == COMPACT ? COMPACT : depth + 1;
    const cJSON *item;
    fputc(object ? '{' : '[', file);
    cJSON_ArrayForEach(item, value) {
        if (item != value->child)
            fputc(',', file);
        put_line(file, inside);
        done = done && (!object || put_key(file, item->string, inside)) &&
               put_value(file, item, inside);
    }
    if (value->child != NULL)
        put_line(file, depth);
    fputc(object ? '}' : ']', file);
    return done;
}

static char *print(const cJSON *value, int depth, const char *end) {
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return NULL;
    bool done = put_value(memory.file, value, depth);
    fputs(end, memory.file);
    char *text = memory_file_close(&memory, NULL);
    if (done)
        return text;
    free(text);
    return NULL;
}

char *json_print(const cJSON *value) {
    return print(value, COMPACT, "");
}

char *json_print_pretty(const cJSON *value) {
    return print(value, 0, "\n");
}

void json_describe(const cJSON *value, char *text, size_t size) {
    char *printed = json_print(value);
    snprintf(text, size, "%s", printed != NULL ? printed : "a value");
    if (printed != NULL && strlen(printed) >= size)
        memcpy(text + size - 4, "...", 4);
    free(printed);
}
