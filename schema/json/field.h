/* One field of a JSON object, written, found, or read with its check: the one set of helpers that
 * every writer and reader of JSON uses. */
#ifndef RUGO_SCHEMA_JSON_WIRE_FIELD_H
#define RUGO_SCHEMA_JSON_WIRE_FIELD_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

/* Takes item (NULL: out of memory) into the object; false when it cannot. */
bool field_put(cJSON *object, const char *key, cJSON *item);
bool field_put_text(cJSON *object, const char *key, const char *text);
bool field_put_count(cJSON *object, const char *key, uint64_t count);
/* The finished value, or NULL and nothing left behind where it is not complete. */
cJSON *fields_finish(cJSON *value, bool complete);

/* Returns a borrowed member; NULL where it is absent, or object is NULL. */
const cJSON *field_at(const cJSON *object, const char *key);
/* Returns NaN for what is no number. */
double field_number(const cJSON *object, const char *key);
/* Sets "KEY must be WHAT"; ERROR_INPUT, as every reader below that does not like what it finds. */
int field_fault(const char *key, const char *what, struct error *err);
/* Reads a non-empty string of less than `size` bytes; *out borrows it. */
int field_text(const cJSON *object, const char *key, size_t size, const char **out,
               struct error *err);
/* Copies the same into out[0..size). */
int field_copy(const cJSON *object, const char *key, size_t size, char *out, struct error *err);
/* Reads an integer of 0 to 2^53. */
int field_count(const cJSON *object, const char *key, uint64_t *out, struct error *err);
int field_seconds(const cJSON *object, const char *key, double *out, struct error *err);
/* Reads true or false; false where it is absent. */
int field_bool(const cJSON *object, const char *key, bool *out, struct error *err);

#endif
