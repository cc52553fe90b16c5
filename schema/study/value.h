/* Checks values against the rows of a parameter table. */
#ifndef RUGO_SCHEMA_STUDY_VALUE_H
#define RUGO_SCHEMA_STUDY_VALUE_H

#include "schema/json/json.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <stdint.h>

enum { POINTER_SIZE = 256 };

/* Returns whether value is one valid value of the parameter (no list of them); else adds a fault at
 * pointer. */
bool value_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                 struct fault_list *faults);
/* Returns whether value is a list of values (a sweep) of the parameter. */
bool value_is_list(const struct parameter *parameter, const cJSON *value);
/* Adds the fault that a required value is missing. */
void value_missing(const struct parameter *parameter, struct fault_list *faults);
/* Returns the default of a row, which the caller deletes; NULL where it has none, or out of
 * memory. */
cJSON *value_default(const struct parameter *parameter);
/* Reads the seed of a checked value; false for a string that is no decimal number of 64 bits. */
bool value_seed(const cJSON *value, uint64_t *seed);
/* Writes the names of choices: "\"first\", \"second\"". */
void value_choices(const struct choice *choices, char *text, size_t size);
/* Writes the allowed range: "(0, 1]". */
void value_range(const struct parameter *parameter, char *text, size_t size);

#endif
