/* A strict check before cJSON, which alone accepts duplicate keys, bad UTF-8, 01, 1e999, a BOM and
 * text after the end. */
#ifndef RUGO_SCHEMA_JSON_JSON_H
#define RUGO_SCHEMA_JSON_JSON_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdio.h>

struct json_limits {
    size_t bytes;  /* largest text */
    size_t depth;  /* deepest nesting */
    size_t values; /* most values (numbers, strings, objects, ...) in all */
};
extern const struct json_limits JSON_LIMITS; /* 16 MiB, 32, 1 000 000 */

/* Parses exactly one RFC 8259 value: valid UTF-8, strict numbers within double's range, no
 * duplicate keys, nothing behind it, a mark of UTF-8 before it at most. ERROR_INPUT with line and
 * column. limits may be NULL for JSON_LIMITS. *out is the caller's to delete. */
int json_parse(const char *text, size_t size, const struct json_limits *limits, cJSON **out,
               struct error *err);
/* Prints compact text in which numbers read back to the same double, NaN and infinities as null.
 * The caller frees it; NULL when out of memory. */
char *json_print(const cJSON *value);
/* Prints for people: one value a line, indented by two spaces a level, with a newline at the
 * end. */
char *json_print_pretty(const cJSON *value);
/* The fewest digits that read back to the same double; null for NaN and infinities. */
void json_print_number(FILE *file, double number);
/* Prints the string in quotes, escaped; false when out of memory. */
bool json_print_text(FILE *file, const char *text);
/* Writes the value as it was given for messages, cut to fit. */
void json_describe(const cJSON *value, char *text, size_t size);
/* Returns the value at an RFC 6901 pointer, or NULL. */
const cJSON *json_at(const cJSON *root, const char *pointer);
/* Returns the number at a pointer, or `otherwise` where there is none. */
double json_number_at(const cJSON *root, const char *pointer, double otherwise);
/* Makes a number, or null where it is NaN or infinite. Returns NULL when out of memory. */
cJSON *json_number(double value);
cJSON *json_numbers(const double *values, size_t n);

/* These encode and decode RFC 4648 base64 with padding. The caller frees *out. */
int base64_encode(const unsigned char *data, size_t size, char **out, struct error *err);
int base64_decode(const char *text, unsigned char **out, size_t *size, struct error *err);

#endif
