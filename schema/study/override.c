#include "schema/study/override.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Reads the value as JSON, or as a string where it is none. */
static int override_value(const char *text, cJSON **out, struct error *err) {
    struct error parsed = {0};
    if (json_parse(text, strlen(text), NULL, out, &parsed) == 0)
        return 0;
    if (parsed.code == ERROR_MEMORY)
        return error_set(err, ERROR_MEMORY, "%s", parsed.text);
    *out = cJSON_CreateString(text);
    return *out != NULL ? 0 : error_memory(err, strlen(text), "a value");
}

/* Returns the member `name` of object, made if missing; NULL when it is no object. */
static cJSON *member_object(cJSON *object, const char *name) {
    cJSON *member = cJSON_GetObjectItemCaseSensitive(object, name);
    if (member == NULL)
        member = cJSON_AddObjectToObject(object, name);
    return cJSON_IsObject(member) ? member : NULL;
}

static int put(cJSON *object, const char *name, cJSON *value, struct error *err) {
    bool replace = cJSON_GetObjectItemCaseSensitive(object, name) != NULL;
    bool good = replace ? cJSON_ReplaceItemInObjectCaseSensitive(object, name, value)
                        : cJSON_AddItemToObject(object, name, value);
    if (good)
        return 0;
    cJSON_Delete(value);
    return error_memory(err, strlen(name), "a member");
}

int override_apply(cJSON *document, const char *text, struct error *err) {
    const char *equals = strchr(text, '=');
    if (equals == NULL || equals == text)
        return error_set(err, ERROR_INPUT, "\"%.100s\" is not PATH=VALUE, as in surface/hurst=0.8",
                         text);
    if (equals[1] == '\0')
        return error_set(err, ERROR_INPUT,
                         "\"%.100s\" has no value behind the =: a number, a word or JSON, as in "
                         "surface/hurst=0.8 or surface/hurst=[0.2,0.8]; an empty text is \"\"",
                         text);
    char *path = strndup(text, (size_t)(equals - text));
    if (path == NULL)
        return error_memory(err, strlen(text), "a path");
    const char *separator = strchr(path, '/') != NULL ? "/" : ".";
    cJSON *object = document, *value = NULL;
    char *rest = NULL, *name = strtok_r(path, separator, &rest);
    int status = name != NULL ? 0
                              : error_set(err, ERROR_INPUT,
                                          "\"%.100s\" names no member before the =, as in "
                                          "surface/hurst=0.8",
                                          text);
    while (status == 0 && name != NULL) {
        char *next = strtok_r(NULL, separator, &rest);
        if (!cJSON_IsObject(object)) {
            status = error_set(err, ERROR_INPUT,
                               "\"%.100s\": what is before \"%.60s\" is not an object", text, name);
        } else if (next != NULL) {
            bool there = cJSON_GetObjectItemCaseSensitive(object, name) != NULL;
            object = member_object(object, name);
            if (object == NULL && !there)
                status = error_memory(err, strlen(name), "a member");
        } else {
            status = override_value(equals + 1, &value, err);
            if (status == 0)
                status = put(object, name, value, err);
        }
        name = next;
    }
    free(path);
    return status;
}
