/* Printing numbers that read back: cJSON settles for 15 digits where those come within a relative
 * 2^-52, which is another double. */
#include "schema/json/json.h"

#include "core/memory_file.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

void json_print_number(FILE *file, double number) {
    char text[32];
    if (!isfinite(number)) {
        fputs("null", file);
        return;
    }
    bool large = fabs(number) > 0x1p53; /* no integer to be read exactly: give it an exponent */
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, large ? "%.*e" : "%.*g", digits - large, number);
        if (strtod(text, NULL) == number) {
            break;
        }
    }
    fputs(text, file);
}

/* Strings, true, false, null: false when out of memory. */
static bool put_plain(FILE *file, const cJSON *value) {
    char *text = cJSON_PrintUnformatted(value);
    if (text) {
        fputs(text, file);
    }
    cJSON_free(text);
    return text != NULL;
}

bool json_print_text(FILE *file, const char *text) {
    cJSON *value = cJSON_CreateStringReference(text);
    bool done = value != NULL && put_plain(file, value);
    cJSON_Delete(value);
    return done;
}

static bool put_key(FILE *file, const char *key) {
    bool done = json_print_text(file, key);
    fputc(':', file);
    return done;
}

static bool put_value(FILE *file, const cJSON *value) {
    if (cJSON_IsNumber(value)) {
        json_print_number(file, value->valuedouble);
        return true;
    }
    bool object = cJSON_IsObject(value), done = true;
    if (!object && !cJSON_IsArray(value)) {
        return put_plain(file, value);
    }
    const cJSON *item;
    fputc(object ? '{' : '[', file);
    cJSON_ArrayForEach(item, value) {
        if (item != value->child) {
            fputc(',', file);
        }
        done = done && (!object || put_key(file, item->string)) && put_value(file, item);
    }
    fputc(object ? '}' : ']', file);
    return done;
}

char *json_print(const cJSON *value) {
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return NULL;
    bool done = put_value(memory.file, value);
    char *text = memory_file_close(&memory, NULL);
    if (done)
        return text;
    free(text);
    return NULL;
}
