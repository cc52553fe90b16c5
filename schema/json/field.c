#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* This is the largest integer that every JSON reader keeps exactly. */
static const double INTEGER_MOST = 9007199254740992.0; /* 2^53 */

bool field_put(cJSON *object, const char *key, cJSON *item) {
    if (item != NULL && cJSON_AddItemToObject(object, key, item))
        return true;
    cJSON_Delete(item);
    return false;
}

bool field_put_text(cJSON *object, const char *key, const char *text) {
    return field_put(object, key, cJSON_CreateString(text));
}

bool field_put_count(cJSON *object, const char *key, uint64_t count) {
    return field_put(object, key, cJSON_CreateNumber((double)count));
}

bool list_put(cJSON *list, cJSON *item) {
    if (item != NULL && cJSON_AddItemToArray(list, item))
        return true;
    cJSON_Delete(item);
    return false;
}

cJSON *list_put_object(cJSON *list) {
    cJSON *object = cJSON_CreateObject();
    return list_put(list, object) ? object : NULL;
}

cJSON *fields_finish(cJSON *value, bool complete) {
    if (complete)
        return value;
    cJSON_Delete(value);
    return NULL;
}

int field_fault(const cJSON *value, const char *key, const char *what, struct error *err) {
    char text[48];
    if (value == NULL)
        return error_set(err, ERROR_INPUT, "/%s: missing; it is %s", key, what);
    json_describe(value, text, sizeof text);
    return error_set(err, ERROR_INPUT, "/%s: %s is not %s", key, text, what);
}

const cJSON *field_at(const cJSON *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

double field_number(const cJSON *object, const char *key) {
    const cJSON *value = field_at(object, key);
    return cJSON_IsNumber(value) ? value->valuedouble : (double)NAN;
}

int field_text(const cJSON *object, const char *key, size_t size, const char **out,
               struct error *err) {
    const cJSON *item = field_at(object, key);
    const char *text = cJSON_GetStringValue(item);
    if (text == NULL || *text == '\0' || strlen(text) >= size) {
        char what[48];
        snprintf(what, sizeof what, "a string of 1 to %zu bytes", size - 1);
        return field_fault(item, key, what, err);
    }
    *out = text;
    return 0;
}

int field_copy(const cJSON *object, const char *key, size_t size, char *out, struct error *err) {
    const char *text = "";
    int status = field_text(object, key, size, &text, err);
    if (status == 0)
        memcpy(out, text, strlen(text) + 1);
    return status;
}

int field_count(const cJSON *object, const char *key, uint64_t *out, struct error *err) {
    const cJSON *item = field_at(object, key);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= INTEGER_MOST) ||
        item->valuedouble != floor(item->valuedouble))
        return field_fault(item, key, "an integer of 0 to 2^53", err);
    *out = (uint64_t)item->valuedouble;
    return 0;
}

int field_seconds(const cJSON *object, const char *key, double *out, struct error *err) {
    const cJSON *item = field_at(object, key);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= 1e12))
        return field_fault(item, key, "a number of seconds, 0 or more", err);
    *out = item->valuedouble;
    return 0;
}

int field_bool(const cJSON *object, const char *key, bool *out, struct error *err) {
    const cJSON *item = field_at(object, key);
    if (item != NULL && !cJSON_IsBool(item))
        return field_fault(item, key, "true or false", err);
    *out = cJSON_IsTrue(item);
    return 0;
}
