/* The little of JSON that jobs need: values of the case's object, and numbers on the way out. */
#ifndef RUGO_JOBS_VALUE_H
#define RUGO_JOBS_VALUE_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* The value at a pointer of a parameter table (object keys alone, no escapes), or NULL. */
const cJSON *value_at(const cJSON *root, const char *pointer);
/* A number, or null where it is NaN or infinite; NULL when out of memory. */
cJSON *value_number(double number);
cJSON *value_numbers(size_t n, const double *numbers);
/* rows x columns numbers, row by row, as an array of arrays. */
cJSON *value_matrix(size_t rows, size_t columns, const double *numbers);
/* Takes item (NULL: it could not be made) into the object; false, and item deleted, on failure. */
bool value_put(cJSON *object, const char *key, cJSON *item);
bool value_append(cJSON *array, cJSON *item);

#endif
