/* The JSON Schema of studies, made from the tables by which studies are read. */
#include "schema/json/field.h"
#include "schema/study/common.h"
#include "schema/study/value.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool put_bounds(cJSON *schema, const struct parameter *parameter) {
    bool complete = true;
    if (isfinite(parameter->minimum))
        complete = field_put(schema, parameter->above_minimum ? "exclusiveMinimum" : "minimum",
                             cJSON_CreateNumber(parameter->minimum));
    if (complete && isfinite(parameter->maximum))
        complete = field_put(schema, parameter->below_maximum ? "exclusiveMaximum" : "maximum",
                             cJSON_CreateNumber(parameter->maximum));
    return complete;
}

static cJSON *number_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    bool integer = parameter->type == PARAMETER_INTEGER || parameter->type == PARAMETER_SEED;
    return fields_finish(schema, field_put_text(schema, "type", integer ? "integer" : "number") &&
                                     put_bounds(schema, parameter));
}

static cJSON *choice_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    cJSON *names = schema != NULL ? cJSON_AddArrayToObject(schema, "enum") : NULL;
    bool complete = names != NULL;
    for (const struct choice *choice = parameter->choices; complete && choice->name != NULL;
         choice++)
        complete = list_put(names, cJSON_CreateString(choice->name));
    return fields_finish(schema, complete);
}

static cJSON *flag_schema(void) {
    cJSON *schema = cJSON_CreateObject();
    return fields_finish(schema, field_put_text(schema, "type", "boolean"));
}

/* Makes {"anyOf": [first, second]}; takes both. */
static cJSON *either(cJSON *first, cJSON *second) {
    cJSON *schema = cJSON_CreateObject();
    cJSON *forms = schema != NULL ? cJSON_AddArrayToObject(schema, "anyOf") : NULL;
    bool complete = list_put(forms, first); /* takes both, whatever comes of it */
    complete = list_put(forms, second) && complete;
    return fields_finish(schema, complete);
}

/* Makes the schema of one choice alone, or an array of different ones. */
static cJSON *choices_schema(const struct parameter *parameter) {
    cJSON *list = cJSON_CreateObject();
    bool complete = field_put_text(list, "type", "array") &&
                    field_put(list, "items", choice_schema(parameter)) &&
                    field_put(list, "minItems", cJSON_CreateNumber(1)) &&
                    field_put(list, "uniqueItems", cJSON_CreateTrue());
    return either(choice_schema(parameter), fields_finish(list, complete));
}

/* Makes the schema of a choice, or an object of one number named by its unit. */
static cJSON *measure_schema(const struct parameter *parameter) {
    cJSON *object = cJSON_CreateObject(), *units = cJSON_CreateObject();
    bool complete = units != NULL;
    for (const struct choice *unit = parameter->units; complete && unit->name != NULL; unit++)
        complete = field_put(units, unit->name, number_schema(parameter));
    units = fields_finish(units, complete);
    complete = field_put(object, "properties", units) && field_put_text(object, "type", "object") &&
               field_put(object, "additionalProperties", cJSON_CreateFalse()) &&
               field_put(object, "minProperties", cJSON_CreateNumber(1)) &&
               field_put(object, "maxProperties", cJSON_CreateNumber(1));
    return either(choice_schema(parameter), fields_finish(object, complete));
}

static cJSON *numbers_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    return fields_finish(
        schema,
        field_put_text(schema, "type", "array") &&
            field_put(schema, "items", number_schema(parameter)) &&
            field_put(schema, "minItems", cJSON_CreateNumber((double)parameter->items_low)) &&
            field_put(schema, "maxItems", cJSON_CreateNumber((double)parameter->items_high)));
}

static cJSON *text_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    return fields_finish(
        schema, field_put_text(schema, "type", "string") &&
                    field_put_text(schema, "pattern", "^[^\\u0000-\\u001f\\u007f-\\u009f]*$") &&
                    field_put(schema, "minLength", cJSON_CreateNumber(parameter->minimum)) &&
                    field_put(schema, "maxLength", cJSON_CreateNumber(parameter->maximum)));
}

/* Writes a pattern of the decimal numbers up to 2^64 - 1. It has those of fewer digits, and those
 * that begin with digits of the largest one and then have a smaller digit. */
static void seed_pattern(char *text, size_t size) {
    static const char LARGEST[] = "18446744073709551615";
    size_t digits = strlen(LARGEST);
    int used = snprintf(text, size, "^0*([0-9]{1,%zu}|%s", digits - 1, LARGEST);
    for (size_t d = 0; d < digits && used > 0 && (size_t)used < size; d++)
        if (LARGEST[d] > '0')
            used += snprintf(text + used, size - (size_t)used, "|%.*s[0-%c][0-9]{%zu}", (int)d,
                             LARGEST, LARGEST[d] - 1, digits - 1 - d);
    if (used > 0 && (size_t)used < size)
        snprintf(text + used, size - (size_t)used, ")$");
}

/* Makes the schema of a seed: an integer that JSON numbers hold exactly, or any of 64 bits as a
 * string. */
static cJSON *seed_schema(const struct parameter *parameter) {
    char pattern[1024];
    seed_pattern(pattern, sizeof pattern);
    cJSON *string = cJSON_CreateObject();
    bool complete =
        field_put_text(string, "type", "string") && field_put_text(string, "pattern", pattern);
    return either(number_schema(parameter), fields_finish(string, complete));
}

/* Makes the schema of one value, without sweeps. */
static cJSON *value_schema(const struct parameter *parameter) {
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_INTEGER:
        return number_schema(parameter);
    case PARAMETER_TEXT:
        return text_schema(parameter);
    case PARAMETER_SEED:
        return seed_schema(parameter);
    case PARAMETER_CHOICE:
        return choice_schema(parameter);
    case PARAMETER_FLAG:
        return flag_schema();
    case PARAMETER_NUMBERS:
        return parameter->choices == NULL
                   ? numbers_schema(parameter)
                   : either(numbers_schema(parameter), choice_schema(parameter));
    case PARAMETER_CHOICES:
        return choices_schema(parameter);
    case PARAMETER_MEASURE:
        return measure_schema(parameter);
    }
    return NULL;
}

/* Adds the help, unit, default and example of a value to its schema. */
static bool put_remarks(cJSON *schema, const struct parameter *parameter) {
    char text[600];
    snprintf(text, sizeof text, "%s%s%s%s", parameter->help, parameter->unit != NULL ? " [" : "",
             parameter->unit != NULL ? parameter->unit : "", parameter->unit != NULL ? "]" : "");
    bool complete = field_put_text(schema, "description", text);
    if (complete && parameter->default_json != NULL && parameter->default_text == NULL)
        complete = field_put(schema, "default", value_default(parameter));
    cJSON *examples = complete && parameter->example_json != NULL
                          ? cJSON_AddArrayToObject(schema, "examples")
                          : NULL;
    if (!complete || parameter->example_json == NULL)
        return complete;
    return list_put(examples, cJSON_Parse(parameter->example_json));
}

/* Makes the schema of one value, or where it can be swept a list of at least one. */
static cJSON *parameter_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    bool complete = put_remarks(schema, parameter);
    cJSON *forms = complete ? cJSON_AddArrayToObject(schema, "anyOf") : NULL;
    if (!list_put(forms, value_schema(parameter)))
        return fields_finish(schema, false);
    if (!parameter->sweep)
        return schema;
    cJSON *list = cJSON_CreateObject();
    complete = field_put_text(list, "type", "array") &&
               field_put(list, "items", value_schema(parameter)) &&
               field_put(list, "minItems", cJSON_CreateNumber(1));
    return fields_finish(schema, list_put(forms, fields_finish(list, complete)));
}

static cJSON *object_schema(void) {
    cJSON *schema = cJSON_CreateObject();
    bool complete = field_put_text(schema, "type", "object") &&
                    field_put(schema, "properties", cJSON_CreateObject()) &&
                    field_put(schema, "required", cJSON_CreateArray()) &&
                    field_put(schema, "additionalProperties", cJSON_CreateFalse());
    return fields_finish(schema, complete);
}

static bool require(cJSON *schema, const char *name) {
    cJSON *required = cJSON_GetObjectItemCaseSensitive(schema, "required");
    for (const cJSON *known = required->child; known != NULL; known = known->next)
        if (strcmp(known->valuestring, name) == 0)
            return true;
    return list_put(required, cJSON_CreateString(name));
}

/* Adds a parameter at its pointer, and the objects above it. An object of what was read from a file
 * must have the file's digest (study_reader.c). */
static bool put_parameter(cJSON *schema, const struct parameter *parameter) {
    char name[128];
    const char *at = parameter->path + 1;
    for (;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (parameter->required && !require(schema, name))
            return false;
        cJSON *properties = cJSON_GetObjectItemCaseSensitive(schema, "properties");
        if (at[length] == '\0')
            return field_put(properties, name, parameter_schema(parameter)) &&
                   (strcmp(name, "sha256") != 0 || require(schema, name));
        if (!cJSON_HasObjectItem(properties, name) && !field_put(properties, name, object_schema()))
            return false;
        schema = cJSON_GetObjectItemCaseSensitive(properties, name);
        at += length + 1;
    }
}

/* Makes the schema of what every study has; other members are checked by the schema of the kind. */
static cJSON *common_schema(const struct study_kind *const *kinds) {
    cJSON *schema = object_schema();
    struct choice *choices = kind_choices(kinds);
    bool complete = schema != NULL && choices != NULL;
    for (size_t p = 0; complete && p < COMMON_PARAMETERS.count; p++) {
        struct parameter row = COMMON_PARAMETERS.rows[p];
        if (row.type == PARAMETER_CHOICE && row.choices == NULL)
            row.choices = choices;
        complete = put_parameter(schema, &row);
    }
    free(choices);
    if (complete)
        cJSON_DeleteItemFromObjectCaseSensitive(schema, "additionalProperties");
    return fields_finish(schema, complete);
}

/* Makes {"properties": {"kind": {"const": name}}, "required": ["kind"]}. */
static cJSON *condition_schema(const struct study_kind *kind) {
    cJSON *schema = cJSON_CreateObject();
    cJSON *properties = schema != NULL ? cJSON_AddObjectToObject(schema, "properties") : NULL;
    cJSON *named = properties != NULL ? cJSON_AddObjectToObject(properties, "kind") : NULL;
    bool complete = field_put_text(named, "const", kind->name) &&
                    field_put(schema, "required", cJSON_CreateArray()) && require(schema, "kind");
    return fields_finish(schema, complete);
}

/* Makes the schema of a study of the kind. It allows the names that all studies have, and no
 * others. */
static cJSON *kind_schema(const struct study_kind *kind) {
    cJSON *schema = object_schema();
    const struct parameter *row;
    bool complete = schema != NULL;
    for (size_t p = 0; complete && (row = parameter_row(kind->tables, p)) != NULL; p++)
        complete = put_parameter(schema, row);
    cJSON *properties = cJSON_GetObjectItemCaseSensitive(schema, "properties");
    for (size_t p = 0; complete && p < COMMON_PARAMETERS.count; p++)
        complete = field_put(properties, COMMON_PARAMETERS.rows[p].path + 1, cJSON_CreateObject());
    cJSON *count = cJSON_GetObjectItemCaseSensitive(properties, "realisations");
    complete = complete &&
               field_put(count, "default", cJSON_CreateNumber((double)kind->default_realisations));
    return fields_finish(schema, complete);
}

/* Makes {"if": the kind is this one, "then": its schema}. A validator then reports faults of the
 * kind that a study names, not of all kinds. */
static cJSON *branch_schema(const struct study_kind *kind) {
    cJSON *schema = cJSON_CreateObject();
    return fields_finish(schema, field_put(schema, "if", condition_schema(kind)) &&
                                     field_put(schema, "then", kind_schema(kind)));
}

cJSON *study_schema(const struct study_kind *const *kinds) {
    cJSON *schema = common_schema(kinds);
    bool complete =
        field_put_text(schema, "$schema", "https://json-schema.org/draft/2020-12/schema") &&
        field_put_text(schema, "title", "Rugo study") &&
        field_put_text(
            schema, "description",
            "Structure, types and ranges. What no single value shows (a grid too large for memory, "
            "parameters that exclude each other) is reported by rugo check.");
    cJSON *branches = complete ? cJSON_AddArrayToObject(schema, "allOf") : NULL;
    complete = branches != NULL;
    for (size_t k = 0; complete && kinds[k] != NULL; k++)
        complete = list_put(branches, branch_schema(kinds[k]));
    return fields_finish(schema, complete);
}
