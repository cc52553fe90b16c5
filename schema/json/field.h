/* Fields of JSON objects: writing, finding, and reading with checks. Every writer and reader of
 * JSON uses these helpers. */
#ifndef RUGO_SCHEMA_JSON_WIRE_FIELD_H
#define RUGO_SCHEMA_JSON_WIRE_FIELD_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

/* Adds the item to the object, which then owns it; false when item is NULL (out of memory) or
 * cannot be added. */
bool field_put(cJSON *object, const char *key, cJSON *item);
bool field_put_text(cJSON *object, const char *key, const char *text);
bool field_put_count(cJSON *object, const char *key, uint64_t count);
/* Takes item (NULL: out of memory) as the last one of a list; false when it cannot. */
bool list_put(cJSON *list, cJSON *item);
/* Returns a new object, the last one of a list; NULL when out of memory. */
cJSON *list_put_object(cJSON *list);
/* Returns the value if it is complete; else deletes it and returns NULL. */
cJSON *fields_finish(cJSON *value, bool complete);

/* Returns a borrowed member; NULL where it is absent, or object is NULL. */
const cJSON *field_at(const cJSON *object, const char *key);
/* Returns NaN where the member is absent or no number. */
double field_number(const cJSON *object, const char *key);
/* Sets "/KEY: VALUE is not WHAT", or that it is missing where value is NULL, and returns
 * ERROR_INPUT, as each reader below does for a value that is not as described. */
int field_fault(const cJSON *value, const char *key, const char *what, struct error *err);
/* Reads a non-empty string of less than `size` bytes; *out borrows it. */
int field_text(const cJSON *object, const char *key, size_t size, const char **out,
               struct error *err);
/* Reads such a string and copies it into out[0..size). */
int field_copy(const cJSON *object, const char *key, size_t size, char *out, struct error *err);
/* Reads an integer of 0 to 2^53. */
int field_count(const cJSON *object, const char *key, uint64_t *out, struct error *err);
/* Reads a number of 0 to 10^12. */
int field_seconds(const cJSON *object, const char *key, double *out, struct error *err);
/* Reads true or false; false where it is absent. */
int field_bool(const cJSON *object, const char *key, bool *out, struct error *err);

#endif
