/* The JSON Schema of studies, from the same tables that read them. */
#include "schema/study/study.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Adds value (taken) to object; false, and gone, when out of memory. */
static bool put(cJSON *object, const char *name, cJSON *value) {
    if (object && value && cJSON_AddItemToObject(object, name, value))
        return true;
    cJSON_Delete(value);
    return false;
}

static bool put_text(cJSON *object, const char *name, const char *text) {
    return put(object, name, cJSON_CreateString(text));
}

static bool put_bounds(cJSON *schema, const struct parameter *parameter) {
    bool complete = true;
    if (isfinite(parameter->minimum))
        complete = put(schema, parameter->above_minimum ? "exclusiveMinimum" : "minimum",
                       cJSON_CreateNumber(parameter->minimum));
    if (complete && isfinite(parameter->maximum))
        complete = put(schema, parameter->below_maximum ? "exclusiveMaximum" : "maximum",
                       cJSON_CreateNumber(parameter->maximum));
    return complete;
}

static cJSON *checked(cJSON *schema, bool complete) {
    if (complete)
        return schema;
    cJSON_Delete(schema);
    return NULL;
}

static cJSON *number_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    bool integer = parameter->type == PARAMETER_INTEGER;
    return checked(schema, put_text(schema, "type", integer ? "integer" : "number") &&
                               put_bounds(schema, parameter));
}

static cJSON *choice_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    int count = 0;
    while (parameter->choices[count])
        count++;
    return checked(schema, put(schema, "enum", cJSON_CreateStringArray(parameter->choices, count)));
}

/* {"anyOf": [first, second]}; takes both. */
static cJSON *either(cJSON *first, cJSON *second) {
    cJSON *schema = cJSON_CreateObject();
    cJSON *forms = schema ? cJSON_AddArrayToObject(schema, "anyOf") : NULL;
    bool complete = forms && first && cJSON_AddItemToArray(forms, first);
    if (!complete)
        cJSON_Delete(first);
    if (!complete || !second || !cJSON_AddItemToArray(forms, second)) {
        cJSON_Delete(second);
        complete = false;
    }
    return checked(schema, complete);
}

/* One choice alone, or an array of different ones. */
static cJSON *choices_schema(const struct parameter *parameter) {
    cJSON *list = cJSON_CreateObject();
    bool complete = put_text(list, "type", "array") &&
                    put(list, "items", choice_schema(parameter)) &&
                    put(list, "minItems", cJSON_CreateNumber(1)) &&
                    put(list, "uniqueItems", cJSON_CreateTrue());
    return either(choice_schema(parameter), checked(list, complete));
}

/* A choice, or an object of one number named by its unit. */
static cJSON *measure_schema(const struct parameter *parameter) {
    cJSON *object = cJSON_CreateObject(), *units = cJSON_CreateObject();
    bool complete = units != NULL;
    for (const char *const *unit = parameter->units; complete && *unit; unit++)
        complete = put(units, *unit, number_schema(parameter));
    units = checked(units, complete);
    complete = put(object, "properties", units) && put_text(object, "type", "object") &&
               put(object, "additionalProperties", cJSON_CreateFalse()) &&
               put(object, "minProperties", cJSON_CreateNumber(1)) &&
               put(object, "maxProperties", cJSON_CreateNumber(1));
    return either(choice_schema(parameter), checked(object, complete));
}

static cJSON *numbers_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    return checked(schema,
                   put_text(schema, "type", "array") &&
                       put(schema, "items", number_schema(parameter)) &&
                       put(schema, "minItems", cJSON_CreateNumber((double)parameter->items_low)) &&
                       put(schema, "maxItems", cJSON_CreateNumber((double)parameter->items_high)));
}

/* Schema of one value, without sweeps. */
static cJSON *value_schema(const struct parameter *parameter) {
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_INTEGER:
        return number_schema(parameter);
    case PARAMETER_CHOICE:
        return choice_schema(parameter);
    case PARAMETER_NUMBERS:
        return numbers_schema(parameter);
    case PARAMETER_CHOICES:
        return choices_schema(parameter);
    case PARAMETER_MEASURE:
        return measure_schema(parameter);
    }
    return NULL;
}

/* One value, or where it can be swept a list of at least one. */
static cJSON *parameter_schema(const struct parameter *parameter) {
    cJSON *schema = cJSON_CreateObject();
    bool complete = put_text(schema, "description", parameter->help);
    if (complete && parameter->default_json)
        complete = put(schema, "default", cJSON_Parse(parameter->default_json));
    cJSON *forms = complete ? cJSON_AddArrayToObject(schema, "anyOf") : NULL;
    cJSON *value = value_schema(parameter);
    if (!forms || !value || !cJSON_AddItemToArray(forms, value)) {
        cJSON_Delete(value);
        return checked(schema, false);
    }
    if (!parameter->sweep)
        return schema;
    cJSON *list = cJSON_CreateObject();
    complete = put_text(list, "type", "array") && put(list, "items", value_schema(parameter)) &&
               put(list, "minItems", cJSON_CreateNumber(1));
    list = checked(list, complete);
    if (!list || !cJSON_AddItemToArray(forms, list))
        return checked(schema, false);
    return schema;
}

static cJSON *object_schema(void) {
    cJSON *schema = cJSON_CreateObject();
    bool complete = put_text(schema, "type", "object") &&
                    put(schema, "properties", cJSON_CreateObject()) &&
                    put(schema, "required", cJSON_CreateArray()) &&
                    put(schema, "additionalProperties", cJSON_CreateFalse());
    return checked(schema, complete);
}

static bool require(cJSON *schema, const char *name) {
    cJSON *required = cJSON_GetObjectItemCaseSensitive(schema, "required");
    for (const cJSON *known = required->child; known; known = known->next)
        if (strcmp(known->valuestring, name) == 0)
            return true;
    cJSON *text = cJSON_CreateString(name);
    return text && cJSON_AddItemToArray(required, text);
}

/* Puts a parameter where its pointer leads, with the objects on the way. */
static bool place(cJSON *schema, const struct parameter *parameter) {
    char name[128];
    const char *at = parameter->path + 1;
    for (;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (parameter->required && !require(schema, name))
            return false;
        cJSON *properties = cJSON_GetObjectItemCaseSensitive(schema, "properties");
        if (!at[length])
            return put(properties, name, parameter_schema(parameter));
        if (!cJSON_HasObjectItem(properties, name) && !put(properties, name, object_schema()))
            return false;
        schema = cJSON_GetObjectItemCaseSensitive(properties, name);
        at += length + 1;
    }
}

/* What every study has; study.c reads the same. */
static bool place_common(cJSON *schema, const struct study_kind *kind) {
    static const char *const TEXTS[][2] = {
        {"name", "{\"type\": \"string\", \"minLength\": 1, \"maxLength\": 200}"},
        {"seed",
         "{\"description\": \"up to 2^53; larger ones, up to 2^64 - 1, as a decimal string\", "
         "\"anyOf\": [{\"type\": \"integer\", \"minimum\": 0, \"maximum\": 9007199254740992}, "
         "{\"type\": \"string\", \"pattern\": \"^[0-9]{1,20}$\"}], \"default\": 1}"},
        {"realisations",
         "{\"description\": \"of each case\", \"type\": \"integer\", \"minimum\": 1, "
         "\"maximum\": 10000000}"},
    };
    cJSON *properties = cJSON_GetObjectItemCaseSensitive(schema, "properties");
    cJSON *constant = cJSON_CreateObject();
    bool complete = put_text(constant, "const", kind->name);
    constant = checked(constant, complete);
    complete =
        put(properties, "kind", constant) && require(schema, "name") && require(schema, "kind");
    for (size_t t = 0; complete && t < sizeof TEXTS / sizeof *TEXTS; t++)
        complete = put(properties, TEXTS[t][0], cJSON_Parse(TEXTS[t][1]));
    return complete;
}

static cJSON *kind_schema(const struct study_kind *kind) {
    cJSON *schema = object_schema();
    bool complete = schema && place_common(schema, kind);
    for (size_t p = 0; complete && p < kind->parameter_count; p++)
        complete = place(schema, &kind->parameters[p]);
    return checked(schema, complete);
}

cJSON *study_schema(const struct study_kind *kinds, size_t kind_count) {
    cJSON *schema = cJSON_CreateObject();
    bool complete =
        put_text(schema, "$schema", "https://json-schema.org/draft/2020-12/schema") &&
        put_text(schema, "title", "Rugo study") &&
        put_text(
            schema, "description",
            "Structure, types and ranges. What no single value shows (a grid too large for memory, "
            "parameters that exclude each other) is told by rugo check.");
    cJSON *forms = complete ? cJSON_AddArrayToObject(schema, "oneOf") : NULL;
    complete = forms != NULL;
    for (size_t k = 0; complete && k < kind_count; k++) {
        cJSON *kind = kind_schema(&kinds[k]);
        complete = kind && cJSON_AddItemToArray(forms, kind);
    }
    return checked(schema, complete);
}
